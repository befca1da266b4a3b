// Embree 3 as a contestant: see README.md for what a contestant reads and answers.
//
//     embree MESH.tri RAYS CONFIGURATION
//
// Configurations: `single` (one ray a call, Embree's defaults), `bvh8` (one ray a call, frequency_level=simd256, which
// makes it build eight-wide nodes), `packet8` and `packet16` (rays in packets, flagged coherent but for diffuse ones).
// All with the robust flag where the name ends in `-robust`.

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <pmmintrin.h>
#include <string>
#include <thread>
#include <vector>
#include <xmmintrin.h>

namespace {

// Rays a thread takes at a time.
constexpr size_t CHUNK = 4096;

struct Mesh {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
};

// As the files hold it.
struct Ray {
    float origin[3], t_min, direction[3], t_max;
};

struct Sum {
    uint64_t hits = 0;
    double t = 0;
};

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "embree: %s\n", why.c_str());
    std::exit(1);
}

template <class T>
std::vector<T> read(std::FILE* file, size_t count) {
    std::vector<T> values(count);
    if (std::fread(values.data(), sizeof(T), count, file) != count) fail("a file is too short");
    return values;
}

std::FILE* open(const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) fail("cannot open " + path);
    return file;
}

Mesh read_mesh(const std::string& path) {
    std::FILE* file = open(path);
    const auto counts = read<uint32_t>(file, 2);
    Mesh mesh;
    mesh.positions = read<float>(file, 3 * size_t{counts[0]});
    mesh.indices = read<uint32_t>(file, 3 * size_t{counts[1]});
    std::fclose(file);
    return mesh;
}

std::vector<Ray> read_rays(const std::string& path) {
    std::FILE* file = open(path);
    std::fseek(file, 0, SEEK_END);
    const size_t count = size_t(std::ftell(file)) / sizeof(Ray);
    std::rewind(file);
    auto rays = read<Ray>(file, count);
    std::fclose(file);
    return rays;
}

double seconds(clockid_t clock) {
    timespec time;
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double wall() { return seconds(CLOCK_MONOTONIC); }
double cpu() { return seconds(CLOCK_PROCESS_CPUTIME_ID); }

// What Embree's manual asks of every thread that traces.
void flush_denormals() {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

std::atomic<ssize_t> bytes{0};

bool count_bytes(void*, ssize_t change, bool) {
    bytes += change;
    return true;
}

struct Scene {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    double wall = 0, cpu = 0;

    void release() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
        scene = nullptr;
        device = nullptr;
    }

    void build(const Mesh& mesh, const std::string& configuration, int threads) {
        release();
        std::string options = "threads=" + std::to_string(threads) + ",user_threads=" + std::to_string(threads);
        if (configuration.rfind("bvh8", 0) == 0) options += ",frequency_level=simd256";
        device = rtcNewDevice(options.c_str());
        bytes = 0;
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, nullptr);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* positions = rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size() / 3);
        std::memcpy(positions, mesh.positions.data(), 4 * mesh.positions.size());
        void* indices = rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.indices.size() / 3);
        std::memcpy(indices, mesh.indices.data(), 4 * mesh.indices.size());
        const bool robust = configuration.find("-robust") != std::string::npos;
        const double wall_before = ::wall(), cpu_before = ::cpu();
        rtcCommitGeometry(geometry);
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        wall = ::wall() - wall_before;
        cpu = ::cpu() - cpu_before;
    }
};

void set(RTCRay& to, const Ray& from) {
    to.org_x = from.origin[0], to.org_y = from.origin[1], to.org_z = from.origin[2];
    to.dir_x = from.direction[0], to.dir_y = from.direction[1], to.dir_z = from.direction[2];
    to.tnear = from.t_min, to.tfar = from.t_max;
    to.time = 0, to.mask = ~0u, to.id = 0, to.flags = 0;
}

void trace_single(RTCScene scene, const Ray* rays, size_t count, bool shadow, bool, Sum& sum) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (size_t i = 0; i < count; i++) {
        if (shadow) {
            RTCRay ray;
            set(ray, rays[i]);
            rtcOccluded1(scene, &context, &ray);
            sum.hits += ray.tfar < 0;
        } else {
            RTCRayHit hit;
            set(hit.ray, rays[i]);
            hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene, &context, &hit);
            if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) sum.hits++, sum.t += hit.ray.tfar;
        }
    }
}

template <int WIDTH>
struct Packet;
template <>
struct Packet<8> {
    using Ray = RTCRay8;
    using Hit = RTCRayHit8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Packet<16> {
    using Ray = RTCRay16;
    using Hit = RTCRayHit16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

template <int WIDTH>
void trace_packets(RTCScene scene, const Ray* rays, size_t count, bool shadow, bool coherent, Sum& sum) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int valid[WIDTH];
    for (size_t first = 0; first < count; first += WIDTH) {
        alignas(64) typename Packet<WIDTH>::Hit hit;
        for (int lane = 0; lane < WIDTH; lane++) {
            valid[lane] = first + lane < count ? -1 : 0;
            const Ray& ray = rays[first + lane < count ? first + lane : count - 1];
            hit.ray.org_x[lane] = ray.origin[0], hit.ray.org_y[lane] = ray.origin[1], hit.ray.org_z[lane] = ray.origin[2];
            hit.ray.dir_x[lane] = ray.direction[0], hit.ray.dir_y[lane] = ray.direction[1];
            hit.ray.dir_z[lane] = ray.direction[2];
            hit.ray.tnear[lane] = ray.t_min, hit.ray.tfar[lane] = ray.t_max;
            hit.ray.time[lane] = 0, hit.ray.mask[lane] = ~0u, hit.ray.id[lane] = lane, hit.ray.flags[lane] = 0;
            hit.hit.geomID[lane] = hit.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        if (shadow) Packet<WIDTH>::occluded(valid, scene, &context, &hit.ray);
        else Packet<WIDTH>::intersect(valid, scene, &context, &hit);
        for (int lane = 0; lane < WIDTH; lane++) {
            if (!valid[lane]) continue;
            if (shadow) sum.hits += hit.ray.tfar[lane] < 0;
            else if (hit.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) sum.hits++, sum.t += hit.ray.tfar[lane];
        }
    }
}

using Trace = void (*)(RTCScene, const Ray*, size_t, bool shadow, bool coherent, Sum&);

Trace tracer(const std::string& configuration) {
    if (configuration.rfind("packet16", 0) == 0) return trace_packets<16>;
    if (configuration.rfind("packet8", 0) == 0) return trace_packets<8>;
    if (configuration.rfind("single", 0) == 0 || configuration.rfind("bvh8", 0) == 0) return trace_single;
    fail("there is no configuration " + configuration);
}

void answer_trace(RTCScene scene, Trace trace, const std::vector<Ray>& rays, const std::string& kind, int threads) {
    const bool shadow = kind == "shadow", coherent = kind != "diffuse";
    std::atomic<size_t> next{0};
    std::vector<Sum> sums(static_cast<size_t>(threads));
    const auto work = [&](Sum& sum) {
        flush_denormals();
        Sum mine;
        for (;;) {
            const size_t first = next.fetch_add(CHUNK);
            if (first >= rays.size()) break;
            trace(scene, &rays[first], std::min(CHUNK, rays.size() - first), shadow, coherent, mine);
        }
        sum = mine;
    };
    const double wall_before = wall(), cpu_before = cpu();
    std::vector<std::thread> others;
    for (int i = 1; i < threads; i++) others.emplace_back(work, std::ref(sums[size_t(i)]));
    work(sums[0]);
    for (auto& other : others) other.join();
    const double wall_after = wall(), cpu_after = cpu();
    Sum total;
    for (const Sum& sum : sums) total.hits += sum.hits, total.t += sum.t;
    std::printf("{\"items\": %zu, \"hits\": %llu, \"t\": %.9g, \"wall\": %.6f, \"cpu\": %.6f}\n", rays.size(),
        static_cast<unsigned long long>(total.hits), total.t, wall_after - wall_before, cpu_after - cpu_before);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 4) fail("usage: embree MESH.tri RAYS CONFIGURATION");
    flush_denormals();
    const Mesh mesh = read_mesh(arguments[1]);
    const std::string prefix = arguments[2], configuration = arguments[3];
    const Trace trace = tracer(configuration);
    std::vector<std::pair<std::string, std::vector<Ray>>> rays;
    for (const char* kind : {"primary", "shadow", "mirror", "diffuse"})
        rays.emplace_back(kind, read_rays(prefix + "." + kind + ".rays"));
    Scene scene;
    scene.build(mesh, configuration, 1);
    std::printf("{\"name\": \"Embree %s\"}\n", RTC_VERSION_STRING);
    std::fflush(stdout);
    char command[32], kind[32];
    int threads;
    for (char line[128]; std::fgets(line, sizeof line, stdin);) {
        if (std::sscanf(line, "build %d", &threads) == 1) {
            scene.build(mesh, configuration, threads);
            std::printf("{\"items\": %zu, \"bytes\": %zd, \"wall\": %.6f, \"cpu\": %.6f}\n", mesh.indices.size() / 3,
                bytes.load(), scene.wall, scene.cpu);
        } else if (std::sscanf(line, "%31s %31s %d", command, kind, &threads) == 3 && !std::strcmp(command, "trace")) {
            for (const auto& [name, set] : rays)
                if (name == kind) answer_trace(scene.scene, trace, set, name, threads);
        } else fail(std::string("not understood: ") + line);
        std::fflush(stdout);
    }
    scene.release();
}
