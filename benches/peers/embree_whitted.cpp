// A minimal Whitted renderer on Embree 3, a ray a call with its robust flag: what one would write in an afternoon.
//
//     embree_whitted SCENE.txt THREADS PICTURE.ppm
//
// Reads what scenes.py writes for it, draws one frame and prints one line of JSON: seconds of reading and building and of
// tracing, on the wall and of the processor, and counts of rays. Clear things cast no shadows.

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <pmmintrin.h>
#include <sstream>
#include <string>
#include <thread>
#include <vector>
#include <xmmintrin.h>

namespace {

constexpr int WIDTH = 800, HEIGHT = 600, TILE = 16, BOUNCES = 4;
constexpr float CUTOFF = 1 / 255.f, OFFSET = 1e-4f;
// Masks: shadow rays see opaque things only.
constexpr unsigned OPAQUE = 1, CLEAR = 2;

struct Vec {
    float x = 0, y = 0, z = 0;
};
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec unit(Vec a) { return a * (1 / std::sqrt(dot(a, a))); }

struct Material {
    Vec color;
    float ambient = 0, diffuse = 0, highlight = 0, exponent = 1, mirror = 0, index = 0;
};

struct Light {
    Vec position;
    float strength = 1;
};

struct Counts {
    uint64_t primary = 0, bounced = 0, shadow = 0;
};

struct Scene {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<Material> materials;  // by geometry
    std::vector<Light> lights;
    Vec background, eye, target, up;
    float angle = 45;
    bool floor = false, smooth = false;
    float bright = 0, dark = 0;
    Material floor_material;
    unsigned mesh = RTC_INVALID_GEOMETRY_ID;
    std::vector<Vec> normals;
    std::vector<uint32_t> indices;
};

double seconds(clockid_t clock) {
    timespec time;
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

void flush_denormals() {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

void attach(Scene& to, RTCGeometry geometry, const Material& material) {
    rtcSetGeometryMask(geometry, material.index > 0 ? CLEAR : OPAQUE);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(to.scene, geometry);
    rtcReleaseGeometry(geometry);
    to.materials.push_back(material);
}

void attach_mesh(Scene& to, const std::string& path, const Material& material) {
    std::ifstream file(path, std::ios::binary);
    uint32_t counts[2] = {0, 0};
    file.read(reinterpret_cast<char*>(counts), 8);
    RTCGeometry geometry = rtcNewGeometry(to.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, counts[0]));
    file.read(reinterpret_cast<char*>(positions), 12 * std::streamsize(counts[0]));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, counts[1]));
    file.read(reinterpret_cast<char*>(indices), 12 * std::streamsize(counts[1]));
    if (to.smooth) {
        to.indices.assign(indices, indices + 3 * counts[1]);
        to.normals.resize(counts[0]);
        const auto point = [&](uint32_t i) { return Vec{positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}; };
        for (size_t i = 0; i < to.indices.size(); i += 3) {
            const uint32_t* corner = &to.indices[i];
            const Vec a = point(corner[0]);
            const Vec normal = cross(point(corner[1]) - a, point(corner[2]) - a);
            for (int k = 0; k < 3; k++) to.normals[corner[k]] = to.normals[corner[k]] + normal;
        }
        for (Vec& normal : to.normals) normal = dot(normal, normal) > 0 ? unit(normal) : Vec{0, 1, 0};
    }
    to.mesh = unsigned(to.materials.size());
    attach(to, geometry, material);
}

void attach_spheres(Scene& to, const std::vector<float>& spheres, const Material& material) {
    if (spheres.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(to.device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    void* buffer = rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, spheres.size() / 4);
    std::memcpy(buffer, spheres.data(), 4 * spheres.size());
    attach(to, geometry, material);
}

void read(Scene& to, const char* path) {
    std::ifstream file(path);
    Material material;
    std::vector<float> spheres;
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        std::string word;
        in >> word;
        const auto vec = [&](Vec& v) { in >> v.x >> v.y >> v.z; };
        if (word == "camera") vec(to.eye), vec(to.target), vec(to.up), in >> to.angle;
        else if (word == "background") vec(to.background);
        else if (word == "light") {
            Light light;
            vec(light.position), in >> light.strength;
            to.lights.push_back(light);
        } else if (word == "material") {
            attach_spheres(to, spheres, material);
            spheres.clear();
            vec(material.color);
            in >> material.ambient >> material.diffuse >> material.highlight >> material.exponent >> material.mirror;
            in >> material.index;
        } else if (word == "floor") to.floor = true, to.floor_material = material, in >> to.bright >> to.dark;
        else if (word == "mesh") {
            std::string mesh;
            in >> to.smooth >> mesh;
            attach_mesh(to, mesh, material);
        } else if (word == "sphere") {
            float numbers[4];
            for (float& number : numbers) in >> number;
            spheres.insert(spheres.end(), numbers, numbers + 4);
        }
    }
    attach_spheres(to, spheres, material);
}

bool blocked(const Scene& scene, Vec from, Vec way, float distance) {
    RTCRay ray{};
    ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z, ray.dir_x = way.x, ray.dir_y = way.y, ray.dir_z = way.z;
    ray.tfar = distance, ray.mask = OPAQUE;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene.scene, &context, &ray);
    return ray.tfar < 0;
}

Vec trace(const Scene& scene, Vec from, Vec way, int bounces, float weight, Counts& counts) {
    RTCRayHit hit{};
    RTCRay& ray = hit.ray;
    ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z, ray.dir_x = way.x, ray.dir_y = way.y, ray.dir_z = way.z;
    ray.tnear = OFFSET, ray.tfar = 1e30f, ray.mask = ~0u;
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene.scene, &context, &hit);

    const float to_floor = scene.floor && way.y != 0 ? -from.y / way.y : -1;
    const bool on_floor = to_floor > OFFSET && to_floor < ray.tfar;
    if (!on_floor && hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return scene.background;
    const Vec point = from + way * (on_floor ? to_floor : ray.tfar);
    const Material& material = on_floor ? scene.floor_material : scene.materials[hit.hit.geomID];
    Vec color = material.color, normal = {0, 1, 0};
    if (on_floor) {
        const float shade = (int(std::floor(point.x)) + int(std::floor(point.z))) & 1 ? scene.dark : scene.bright;
        color = {shade, shade, shade};
    } else if (scene.smooth && hit.hit.geomID == scene.mesh) {
        const uint32_t* corner = &scene.indices[3 * size_t{hit.hit.primID}];
        const float u = hit.hit.u, v = hit.hit.v;
        normal = scene.normals[corner[0]] * (1 - u - v) + scene.normals[corner[1]] * u + scene.normals[corner[2]] * v;
        normal = unit(normal);
    } else normal = unit({hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z});

    const bool inside = dot(normal, way) > 0;
    if (inside) normal = normal * -1;
    const Vec outside = point + normal * OFFSET, within = point - normal * OFFSET;
    Vec sum = color * material.ambient;
    if (material.diffuse > 0) {
        for (const Light& light : scene.lights) {
            Vec to_light = light.position - point;
            const float distance = std::sqrt(dot(to_light, to_light));
            to_light = to_light * (1 / distance);
            const float slant = dot(normal, to_light);
            if (slant <= 0) continue;
            counts.shadow++;
            if (blocked(scene, outside, to_light, distance)) continue;
            sum = sum + color * (light.strength * material.diffuse * slant);
            const float shine = -dot(normal * (2 * slant) - to_light, way);
            if (material.highlight > 0 && shine > 0) {
                const float bright = light.strength * material.highlight * std::pow(shine, material.exponent);
                sum = sum + Vec{bright, bright, bright};
            }
        }
    }
    if (bounces == 0) return sum;
    const float cosine = -dot(normal, way);
    const Vec mirrored = way + normal * (2 * cosine);
    const auto follow = [&](Vec start, Vec direction, float share) {
        if (weight * share < CUTOFF) return;
        counts.bounced++;
        sum = sum + trace(scene, start, direction, bounces - 1, weight * share, counts) * share;
    };
    if (material.index > 0) {
        const float ratio = inside ? material.index : 1 / material.index;
        const float squared = 1 - ratio * ratio * (1 - cosine * cosine);
        float reflected = 1;
        if (squared >= 0) {
            const float refracted = std::sqrt(squared);
            const float s = (ratio * cosine - refracted) / (ratio * cosine + refracted);
            const float p = (ratio * refracted - cosine) / (ratio * refracted + cosine);
            reflected = 0.5f * (s * s + p * p);
            follow(within, unit(way * ratio + normal * (ratio * cosine - refracted)), 1 - reflected);
        }
        follow(outside, mirrored, reflected);
    } else if (material.mirror > 0) follow(outside, mirrored, material.mirror);
    return sum;
}

uint8_t encoded(float linear) {
    const float value = std::min(std::max(linear, 0.f), 1.f);
    const float code = value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
    return uint8_t(255 * code + 0.5f);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 4) return std::fprintf(stderr, "usage: embree_whitted SCENE.txt THREADS PICTURE.ppm\n"), 1;
    flush_denormals();
    const int threads = std::atoi(arguments[2]);
    const double wall_0 = seconds(CLOCK_MONOTONIC), cpu_0 = seconds(CLOCK_PROCESS_CPUTIME_ID);
    Scene scene;
    const std::string number = std::to_string(threads);
    scene.device = rtcNewDevice(("threads=" + number + ",user_threads=" + number).c_str());
    scene.scene = rtcNewScene(scene.device);
    rtcSetSceneFlags(scene.scene, RTC_SCENE_FLAG_ROBUST);
    read(scene, arguments[1]);
    rtcCommitScene(scene.scene);
    const double wall_1 = seconds(CLOCK_MONOTONIC), cpu_1 = seconds(CLOCK_PROCESS_CPUTIME_ID);

    const Vec back = unit(scene.eye - scene.target), right = unit(cross(scene.up, back)), up = cross(back, right);
    const float half = std::tan(0.5f * scene.angle * float(M_PI) / 180);
    std::vector<uint8_t> picture(3 * WIDTH * HEIGHT);
    const int across = (WIDTH + TILE - 1) / TILE, down = (HEIGHT + TILE - 1) / TILE;
    std::atomic<int> next{0};
    std::vector<Counts> counts(static_cast<size_t>(threads));
    const auto work = [&](Counts& total) {
        flush_denormals();
        Counts mine;
        for (int tile; (tile = next++) < across * down;) {
            const int left = tile % across * TILE, top = tile / across * TILE;
            for (int y = top; y < std::min(top + TILE, HEIGHT); y++)
                for (int x = left; x < std::min(left + TILE, WIDTH); x++) {
                    const Vec way = right * ((2 * (float(x) + 0.5f) - WIDTH) / HEIGHT * half) +
                                    up * ((1 - 2 * (float(y) + 0.5f) / HEIGHT) * half) - back;
                    mine.primary++;
                    const Vec light = trace(scene, scene.eye, unit(way), BOUNCES, 1, mine);
                    uint8_t* pixel = &picture[size_t(3 * (y * WIDTH + x))];
                    pixel[0] = encoded(light.x), pixel[1] = encoded(light.y), pixel[2] = encoded(light.z);
                }
        }
        total = mine;
    };
    std::vector<std::thread> others;
    for (int i = 1; i < threads; i++) others.emplace_back(work, std::ref(counts[size_t(i)]));
    work(counts[0]);
    for (auto& other : others) other.join();
    const double wall_2 = seconds(CLOCK_MONOTONIC), cpu_2 = seconds(CLOCK_PROCESS_CPUTIME_ID);

    Counts total;
    for (const Counts& of : counts)
        total.primary += of.primary, total.bounced += of.bounced, total.shadow += of.shadow;
    std::ofstream out(arguments[3], std::ios::binary);
    out << "P6\n" << WIDTH << " " << HEIGHT << "\n255\n";
    out.write(reinterpret_cast<const char*>(picture.data()), std::streamsize(picture.size()));
    std::printf("{\"load_wall\": %.6f, \"load_cpu\": %.6f, \"trace_wall\": %.6f, \"trace_cpu\": %.6f, "
                "\"rays\": %llu, \"primary\": %llu, \"bounced\": %llu, \"shadow\": %llu}\n",
        wall_1 - wall_0, cpu_1 - cpu_0, wall_2 - wall_1, cpu_2 - cpu_1,
        static_cast<unsigned long long>(total.primary + total.bounced + total.shadow),
        static_cast<unsigned long long>(total.primary), static_cast<unsigned long long>(total.bounced),
        static_cast<unsigned long long>(total.shadow));
}
