//! Makes the models and textures that the project's own scenes use.
//!
//! `cargo run --release --example make_assets [FOLDER]` writes them below `scenes/gallery`, or below FOLDER; a test
//! checks that the committed files are what this program writes.

use snell::components::math;
use std::{error::Error, f64::consts::TAU, fmt::Write as _, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "scenes/gallery".into());
    write_assets(Path::new(&folder))
}

/// Writes all models and textures below a folder.
pub(crate) fn write_assets(folder: &Path) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder.join("models"))?;
    fs::create_dir_all(folder.join("textures"))?;
    fs::write(folder.join("models/vase.obj"), vase())?;
    fs::write(folder.join("models/vase.mtl"), VASE_MATERIALS)?;
    fs::write(folder.join("models/knot.obj"), knot())?;
    texture(folder, "planks", 512, 512, planks)?;
    texture(folder, "planet", 1024, 512, planet)?;
    texture(folder, "glaze", 256, 256, glaze)?;
    Ok(())
}

const VASE_MATERIALS: &str = "\
# Materials of vase.obj.
newmtl glaze
Kd 0.9 0.9 0.9
Ka 0.2 0.2 0.2
Ks 0.5 0.5 0.5
Ns 80
map_Kd ../textures/glaze.png
newmtl rim
Kd 0.75 0.55 0.2
Ka 0.2 0.2 0.2
Ks 0.6 0.6 0.6
Ns 40
";

/// Half profile of the vase, from the foot up and over the rim into the inside: radius, height.
const PROFILE: [(f64, f64); 12] = [
    (0.00, 0.00),
    (0.26, 0.00),
    (0.30, 0.06),
    (0.42, 0.30),
    (0.50, 0.60),
    (0.44, 0.92),
    (0.26, 1.18),
    (0.20, 1.34),
    (0.25, 1.50),
    (0.22, 1.50),
    (0.17, 1.34),
    (0.22, 1.16),
];

/// A vase: the profile, smoothed by a Catmull–Rom spline, turned about Oy.
fn vase() -> String {
    let (around, per_span) = (48, 5);
    let mut profile = vec![];
    for i in 1..PROFILE.len() - 2 {
        for step in 0..per_span {
            profile.push(catmull_rom(&PROFILE[i - 1..i + 3], f64::from(step) / f64::from(per_span)));
        }
    }
    profile.push(PROFILE[PROFILE.len() - 2]);
    let rows = profile.len();
    let mut obj = String::from("# A vase. Made by examples/make_assets.rs.\nmtllib vase.mtl\n");
    for (radius, height) in &profile {
        for column in 0..around {
            let (sin, cos) = turn(column, around);
            let _ = writeln!(obj, "v {:.5} {:.5} {:.5}", radius * cos, height, radius * sin);
        }
    }
    for row in 0..rows {
        // Across the profile's tangent, outward.
        let (r0, h0) = profile[row.saturating_sub(1)];
        let (r1, h1) = profile[(row + 1).min(rows - 1)];
        let length = ((r1 - r0) * (r1 - r0) + (h1 - h0) * (h1 - h0)).sqrt();
        let (out, up) = ((h1 - h0) / length, (r0 - r1) / length);
        for column in 0..around {
            let (sin, cos) = turn(column, around);
            let _ = writeln!(obj, "vn {:.4} {:.4} {:.4}", out * cos, up, out * sin);
        }
    }
    for (_, height) in &profile {
        for column in 0..=around {
            let _ = writeln!(obj, "vt {:.5} {:.5}", 4.0 * f64::from(column) / f64::from(around), height * 1.6);
        }
    }
    // The rim: from a little below the highest point on.
    let rim = profile.iter().position(|(_, height)| *height > 1.44).unwrap_or(rows);
    for row in 0..rows - 1 {
        if row == 0 {
            obj.push_str("usemtl glaze\n");
        } else if row == rim {
            obj.push_str("usemtl rim\n");
        }
        for column in 0..around as usize {
            let corner = |row: usize, column: usize| {
                let vertex = row * around as usize + column % around as usize + 1;
                let texel = row * (around as usize + 1) + column + 1;
                format!("{vertex}/{texel}/{vertex}")
            };
            let (a, b) = (corner(row, column), corner(row + 1, column));
            let (c, d) = (corner(row + 1, column + 1), corner(row, column + 1));
            let _ = writeln!(obj, "f {a} {b} {c} {d}");
        }
    }
    obj
}

/// A tube along a (2, 3) torus knot, without normals: smoothing is the scene's choice.
fn knot() -> String {
    let (along, around, tube) = (144u32, 20u32, 0.17);
    let center = |t: f64| {
        let (sin2, cos2) = sin_cos(2.0 * t);
        let (sin3, cos3) = sin_cos(3.0 * t);
        [(0.62 + 0.24 * cos3) * cos2, 0.34 * sin3, (0.62 + 0.24 * cos3) * sin2]
    };
    let mut obj = String::from("# A (2, 3) torus knot. Made by examples/make_assets.rs.\n");
    for i in 0..along {
        let t = TAU * f64::from(i) / f64::from(along);
        let here = center(t);
        let tangent = unit(sub(center(t + 1e-4), center(t - 1e-4)));
        let side = unit(cross(tangent, [0.0, 1.0, 0.0]));
        let over = cross(side, tangent);
        for j in 0..around {
            let (sin, cos) = turn(j, around);
            let at = |k: usize| here[k] + tube * (cos * side[k] + sin * over[k]);
            let _ = writeln!(obj, "v {:.5} {:.5} {:.5}", at(0), at(1), at(2));
        }
    }
    for i in 0..along {
        for j in 0..around {
            let vertex = |i: u32, j: u32| (i % along) * around + j % around + 1;
            let (a, b, c, d) = (vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j));
            let _ = writeln!(obj, "f {a} {d} {c} {b}");
        }
    }
    obj
}

fn sin_cos(radians: f64) -> (f64, f64) {
    math::sin_cos_degrees(radians * 360.0 / TAU)
}

fn turn(part: u32, of: u32) -> (f64, f64) {
    math::sin_cos_degrees(360.0 * f64::from(part) / f64::from(of))
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
    a.map(|x| x / length)
}

fn catmull_rom(points: &[(f64, f64)], t: f64) -> (f64, f64) {
    let blend = |p: [f64; 4]| {
        let [a, b, c, d] = p;
        0.5 * (2.0 * b
            + (c - a) * t
            + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t
            + (3.0 * b - a - 3.0 * c + d) * t * t * t)
    };
    let component = |of: fn(&(f64, f64)) -> f64| blend([0, 1, 2, 3].map(|i| of(&points[i])));
    (component(|p| p.0), component(|p| p.1))
}

/// Writes an image of a function of u and v in 0..1, v upward, that gives sRGB-encoded colours.
fn texture(
    folder: &Path,
    name: &str,
    width: u32,
    height: u32,
    color: impl Fn(f64, f64) -> [f64; 3],
) -> Result<(), Box<dyn Error>> {
    let image = image::RgbImage::from_fn(width, height, |x, y| {
        let u = (f64::from(x) + 0.5) / f64::from(width);
        let v = 1.0 - (f64::from(y) + 0.5) / f64::from(height);
        image::Rgb(color(u, v).map(|channel| (channel.clamp(0.0, 1.0) * 255.0 + 0.5) as u8))
    });
    image.save(folder.join("textures").join(format!("{name}.png")))?;
    Ok(())
}

/// Floor boards, two across and staggered; repeats.
fn planks(u: f64, v: f64) -> [f64; 3] {
    let board = (u * 4.0) as u32;
    let along = v * 2.0 + 0.37 * f64::from(board);
    let piece = board * 7 + math::floor(along) as u32 % 2 * 3;
    let tone = 0.85 + 0.25 * hash(piece, 11, 5);
    // Grain runs along the board; periodic in v, so that the image repeats.
    let grain = noise(u * 96.0, v * 4.0 + 4.0 * hash(piece, 3, 1), 4) - 0.5;
    let fine = noise(u * 256.0, v * 8.0, 8) - 0.5;
    let (across, end) = (fraction(u * 4.0), fraction(along));
    let gap = if across < 0.015 || end < 0.006 { 0.35 } else { 1.0 };
    let shade = tone * gap * (1.0 + 0.28 * grain + 0.10 * fine);
    [0.60 * shade, 0.42 * shade, 0.26 * shade]
}

/// A planet: seas, land, deserts and ice by latitude; seamless in u.
fn planet(u: f64, v: f64) -> [f64; 3] {
    let (sin, cos) = math::sin_cos_degrees(360.0 * u);
    let (up, out) = math::sin_cos_degrees(180.0 * (v - 0.5));
    let p = [out * cos, up, out * sin];
    let mut height = 0.0;
    let (mut size, mut weight) = (1.7, 0.5);
    for octave in 0..7 {
        height += weight * (noise3(p.map(|x| x * size + 17.0 * f64::from(octave))) - 0.5);
        (size, weight) = (size * 2.03, weight * 0.53);
    }
    let ice = up.abs() + 0.25 * height;
    if ice > 0.86 {
        [0.93, 0.95, 0.97]
    } else if height < 0.02 {
        let depth = (0.02 - height) * 4.0;
        [0.10 - 0.06 * depth, 0.36 - 0.20 * depth, 0.58 - 0.22 * depth]
    } else {
        let dry = (1.0 - up.abs() * 2.2).max(0.0) * (0.5 + 2.0 * height);
        let high = (height * 3.0 - 0.35).clamp(0.0, 1.0);
        let land = [0.20 + 0.48 * dry, 0.42 + 0.14 * dry, 0.16 + 0.16 * dry];
        core::array::from_fn(|i| land[i] * (1.0 - high) + [0.55, 0.5, 0.45][i] * high)
    }
}

/// A blue and white glaze: rows of petals; repeats.
fn glaze(u: f64, v: f64) -> [f64; 3] {
    let row = math::floor(v * 3.0);
    let x = fraction(u * 3.0 + 0.5 * row) - 0.5;
    let y = fraction(v * 3.0) - 0.5;
    let angle = math::atan2(y, x);
    let radius = (x * x + y * y).sqrt();
    let (_, cos) = sin_cos(6.0 * angle);
    let petal = radius < 0.26 + 0.13 * cos && radius > 0.07;
    let band = y.abs() > 0.46;
    let crackle = 1.0 - 0.06 * noise(u * 32.0, v * 32.0, 32);
    let color = if petal || band { [0.10, 0.22, 0.55] } else { [0.93, 0.93, 0.90] };
    color.map(|channel| channel * crackle)
}

fn fraction(x: f64) -> f64 {
    x - math::floor(x)
}

/// A number in 0..1 for three whole ones.
fn hash(x: u32, y: u32, z: u32) -> f64 {
    let mut h = x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b) ^ z.wrapping_mul(0xc2b2_ae35);
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    f64::from(h ^ (h >> 16)) / f64::from(u32::MAX)
}

/// Value noise in the plane; repeats every `period` in y.
fn noise(x: f64, y: f64, period: u32) -> f64 {
    let (cell_x, cell_y) = (math::floor(x), math::floor(y));
    let (fx, fy) = (smooth(x - cell_x), smooth(y - cell_y));
    let at = |dx: u32, dy: u32| hash(cell_x as u32 + dx, (cell_y as u32 + dy) % period, 1);
    mix(mix(at(0, 0), at(1, 0), fx), mix(at(0, 1), at(1, 1), fx), fy)
}

/// Value noise in space; coordinates from −1000.
fn noise3(p: [f64; 3]) -> f64 {
    let cell = p.map(|x| math::floor(x + 1000.0));
    let [fx, fy, fz] = core::array::from_fn(|i| smooth(p[i] + 1000.0 - cell[i]));
    let at = |d: [u32; 3]| hash(cell[0] as u32 + d[0], cell[1] as u32 + d[1], cell[2] as u32 + d[2]);
    let plane = |z: u32| mix(mix(at([0, 0, z]), at([1, 0, z]), fx), mix(at([0, 1, z]), at([1, 1, z]), fx), fy);
    mix(plane(0), plane(1), fz)
}

fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}
