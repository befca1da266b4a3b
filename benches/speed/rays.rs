//! Sets of rays of four kinds about one mesh, the same for Snell and for its peers.
//!
//! A camera looks at the mesh; every primary ray that hits sends one ray toward a light, one mirrored, and one in a
//! random direction about the normal (cosine-distributed: the incoherent set). Rays are `f32`, as the peers trace them;
//! those from the surface start a ten-thousandth of the mesh's diagonal above it, so that no kernel's rounding decides
//! what is hit.

use snell::{
    Methods,
    components::{
        math,
        packet::{PACKET, Packet},
        primitive::Cost,
        random::SplitMix64,
        shape::PackedMesh,
        space::Ray,
    },
    prelude::{DVec3, Mesh, Primitive, TriangleMesh},
    systems::accelerate::{Bests, Geometry},
};
use std::{
    fs,
    hint::black_box,
    io::{self, Error, ErrorKind},
    path::{Path, PathBuf},
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

/// Primary rays along one edge of their square.
const EDGE: u32 = 1024;

/// Rays a thread takes at a time.
const CHUNK: usize = 64 * PACKET;

/// What rays are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Primary,
    Shadow,
    Mirror,
    Diffuse,
}

impl Kind {
    pub(crate) const ALL: [Self; 4] = [Self::Primary, Self::Shadow, Self::Mirror, Self::Diffuse];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Mirror => "mirror",
            Self::Diffuse => "diffuse",
        }
    }
}

/// A ray as the files hold it: eight little-endian `f32`, with the nearest distance (always 0) after the origin.
#[derive(Clone, Copy)]
pub(crate) struct FileRay {
    origin: [f32; 3],
    direction: [f32; 3],
    t_max: f32,
}

impl FileRay {
    fn new(origin: DVec3, direction: DVec3, t_max: f64) -> Self {
        let single = |v: DVec3| v.to_array().map(|x| x as f32);
        Self { origin: single(origin), direction: single(direction), t_max: t_max as f32 }
    }

    fn ray(&self) -> Ray {
        let double = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        Ray { origin: double(self.origin), direction: double(self.direction) }
    }
}

/// How far a search goes.
#[derive(Clone, Copy)]
pub(crate) enum Search<'a> {
    /// In the tree of one mesh, to distance and triangle.
    Mesh { packed: &'a PackedMesh },
    /// In all geometry, to distance, object, triangle and the triangle's normal, which is not of unit length.
    Nearest { geometry: &'a Geometry, mesh: &'a TriangleMesh },
    /// The same for packets of rays.
    Packets { geometry: &'a Geometry, mesh: &'a TriangleMesh },
    /// In all geometry, to the whole surface at the hit.
    Surface { geometry: &'a Geometry },
}

/// What a packet needs.
struct Room {
    packet: Packet,
    t_max: [f64; PACKET],
    best: Bests,
}

/// What a set of rays met.
#[derive(Clone, Copy, Default)]
pub(crate) struct Met {
    pub(crate) hits: u64,
    /// Sum of the distances.
    pub(crate) t: f64,
    pub(crate) cost: Cost,
}

/// Rays of one kind.
pub(crate) struct Rays {
    pub(crate) kind: Kind,
    pub(crate) rays: Vec<FileRay>,
}

impl Rays {
    /// All four sets about a mesh within a box.
    pub(crate) fn about(geometry: &Geometry, min: DVec3, max: DVec3) -> [Self; 4] {
        let size = (max - min).length();
        let center = 0.5 * (min + max);
        let back = DVec3::new(0.3, 0.25, 1.0).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let eye = center + 1.15 * size * back;
        let light = center + size * DVec3::new(1.2, 1.6, 0.9);
        let half = math::tan_degrees(19.0);
        let mut random = SplitMix64::new(977);
        let mut sets = Kind::ALL.map(|kind| Self { kind, rays: vec![] });
        let [primary, shadow, mirror, diffuse] = &mut sets;
        let screen = |i: u32| (2.0 * (f64::from(i) + 0.5) / f64::from(EDGE) - 1.0) * half;
        for (x, y) in (0..EDGE * EDGE).map(|i| (screen(i % EDGE), -screen(i / EDGE))) {
            let ray = FileRay::new(eye, (x * right + y * up - back).normalize(), f64::from(FAR));
            primary.rays.push(ray);
            let ray = ray.ray();
            let found = geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
            let Some(hit) = found else { continue };
            let normal = if hit.surface.normal.dot(ray.direction) > 0.0 { -1.0 } else { 1.0 } * hit.surface.normal;
            let start = hit.surface.point + 1e-4 * size * normal;
            let to_light = light - start;
            shadow.rays.push(FileRay::new(start, to_light.normalize(), to_light.length()));
            let mirrored = ray.direction - 2.0 * normal.dot(ray.direction) * normal;
            mirror.rays.push(FileRay::new(start, mirrored.normalize(), f64::from(FAR)));
            diffuse.rays.push(FileRay::new(start, cosine(normal, &mut random), f64::from(FAR)));
        }
        sets
    }

    /// Traces all rays on some threads.
    pub(crate) fn trace(&self, with: &Search<'_>, threads: usize) -> Met {
        let methods = &Methods::default();
        let shadow = self.kind == Kind::Shadow;
        // One loop for each, so that none is asked for a ray.
        match *with {
            Search::Mesh { packed, .. } if shadow => {
                self.each(threads, |ray, t_max, cost| Mesh::blocks(packed, ray, t_max, cost).then_some(0.0))
            }
            Search::Nearest { geometry, .. } | Search::Surface { geometry } if shadow => {
                self.each(threads, |ray, t_max, cost| geometry.blocked(ray, t_max, methods, cost).then_some(0.0))
            }
            Search::Packets { geometry, .. } if shadow => self.packets(threads, |room, cost| {
                let Room { packet, t_max, .. } = room;
                (geometry.blocked_packet(packet, packet.all(), t_max, methods, cost).count_ones(), 0.0)
            }),
            Search::Mesh { packed } => {
                self.each(threads, |ray, t_max, cost| Some(black_box(Mesh::hit(packed, ray, t_max, cost)?).t))
            }
            Search::Nearest { geometry, mesh } => self.each(threads, |ray, t_max, cost| {
                let nearest = geometry.nearest(ray, t_max, methods, cost)?;
                let [a, b, c] = mesh.corners(nearest.hit.part as usize);
                black_box(&(b - a).cross(c - a));
                black_box((nearest.hit.part, nearest.object));
                Some(nearest.hit.t)
            }),
            Search::Packets { geometry, mesh } => self.packets(threads, |room, cost| {
                room.best.begin(room.packet.all(), f64::INFINITY);
                room.best.limit = room.t_max;
                geometry.nearest_packet(&room.packet, room.packet.all(), methods, &mut room.best, cost);
                let nearest = (0..room.packet.len()).filter_map(|i| room.best.nearest(i));
                nearest.fold((0, 0.0), |(hits, sum), nearest| {
                    let [a, b, c] = mesh.corners(nearest.hit.part as usize);
                    black_box(&(b - a).cross(c - a));
                    black_box((nearest.hit.part, nearest.object));
                    (hits + 1, sum + nearest.hit.t)
                })
            }),
            Search::Surface { geometry } => {
                self.each(threads, |ray, t_max, cost| Some(black_box(&geometry.closest(ray, t_max, methods, cost)?).t))
            }
        }
    }

    /// Traces all rays on some threads; `trace` tells how far away a ray ends, if it meets anything before `t_max`.
    fn each(&self, threads: usize, trace: impl Fn(&Ray, f64, &mut Cost) -> Option<f64> + Sync) -> Met {
        self.chunks(threads, |rays, met| {
            for ray in rays {
                if let Some(t) = trace(&ray.ray(), f64::from(ray.t_max), &mut met.cost) {
                    met.hits += 1;
                    met.t += t;
                }
            }
        })
    }

    /// Traces all rays on some threads in packets; `trace` tells how many meet anything, and the sum of the distances.
    fn packets(&self, threads: usize, trace: impl Fn(&mut Room, &mut Cost) -> (u32, f64) + Sync) -> Met {
        self.chunks(threads, |rays, met| {
            let mut room = Room { packet: Packet::default(), t_max: [0.0; PACKET], best: Bests::default() };
            for rays in rays.chunks(PACKET) {
                room.packet.clear();
                for ray in rays {
                    room.t_max[room.packet.push(&ray.ray())] = f64::from(ray.t_max);
                }
                let (hits, t) = trace(&mut room, &mut met.cost);
                met.hits += u64::from(hits);
                met.t += t;
            }
        })
    }

    /// Hands rays out to some threads, a chunk at a time.
    fn chunks(&self, threads: usize, trace: impl Fn(&[FileRay], &mut Met) + Sync) -> Met {
        let next = AtomicUsize::new(0);
        let work = || {
            let mut met = Met::default();
            while let Some(rays) = self.rays.get(next.fetch_add(CHUNK, Ordering::Relaxed)..) {
                trace(&rays[..rays.len().min(CHUNK)], &mut met);
            }
            met
        };
        thread::scope(|scope| {
            let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
            others.into_iter().map(|other| other.join().expect("no panic")).fold(work(), |sum, met| {
                let mut cost = sum.cost;
                cost += met.cost;
                Met { hits: sum.hits + met.hits, t: sum.t + met.t, cost }
            })
        })
    }

    /// Writes the set beside others whose files begin with `prefix`.
    pub(crate) fn write(&self, prefix: &Path) -> io::Result<()> {
        let numbers = |r: &FileRay| {
            let ([ox, oy, oz], [dx, dy, dz]) = (r.origin, r.direction);
            [ox, oy, oz, 0.0, dx, dy, dz, r.t_max].map(f32::to_le_bytes)
        };
        let bytes: Vec<u8> = self.rays.iter().flat_map(numbers).flatten().collect();
        fs::write(file(prefix, self.kind), bytes)
    }

    /// Reads what [`Rays::write`] wrote.
    pub(crate) fn read(prefix: &Path, kind: Kind) -> io::Result<Self> {
        let bytes = fs::read(file(prefix, kind))?;
        let (rays, rest) = bytes.as_chunks::<32>();
        if !rest.is_empty() {
            return Err(Error::new(ErrorKind::InvalidData, "a file of rays is not a whole number of rays"));
        }
        let ray = |ray: &[u8; 32]| {
            let (numbers, _) = ray.as_chunks();
            let n = |i: usize| f32::from_le_bytes(numbers[i]);
            FileRay { origin: [n(0), n(1), n(2)], direction: [n(4), n(5), n(6)], t_max: n(7) }
        };
        Ok(Self { kind, rays: rays.iter().map(ray).collect() })
    }
}

/// Farther than anything.
const FAR: f32 = 1e30;

fn file(prefix: &Path, kind: Kind) -> PathBuf {
    let mut path = prefix.as_os_str().to_owned();
    path.push(format!(".{}.rays", kind.name()));
    path.into()
}

/// A direction about a normal whose density goes with the cosine of the angle between them.
fn cosine(normal: DVec3, random: &mut SplitMix64) -> DVec3 {
    let (radius, angle) = (random.unit(), 360.0 * random.unit());
    let (sin, cos) = math::sin_cos_degrees(angle);
    let (x, y) = normal.any_orthonormal_pair();
    ((x * cos + y * sin) * radius.sqrt() + normal * (1.0 - radius).sqrt()).normalize()
}
