//! Lights and patterns.

use super::{Report, watch::Watch};
use crate::render::Key;
use glam::{DAffine3, DVec2, DVec3};
use snell_components::{
    color::Rgb,
    light::{Illumination, Lamp, Light},
    packet::{Mask, PACKET, each, set_vector, vector_of},
    surfaces::Surfaces,
    texture::{Footprint, Pattern, Texture, TexturePoint},
    transform::{Step, Transform},
};

/// Points that a light or a pattern is tried at.
const POINTS: u32 = 3000;

pub(super) fn check_light<L: Light>(light: &L, name: &str, watch: &Watch, report: &mut Report) {
    let steps = [Step::RotateY(20.0), Step::RotateX(-65.0), Step::Translate(DVec3::new(3.0, -7.0, 2.0))];
    let moves = Transform::new(steps).matrix();
    let (lamp, moved) = (light.pack(&DAffine3::IDENTITY), light.pack(&moves));
    let (mut lit, mut lost) = (0, 0);
    for n in 0..POINTS {
        watch.asks(name, None);
        let key = Key::of_pixel(n, 21, 7);
        let (point, sample) = (anywhere(key, n), key.sample(9));
        let arrives = lamp.illuminate(point, sample);
        if arrives != lamp.illuminate(point, sample) {
            report.add("repeatable", name, format!("at {point}, {sample} it gives another light when asked again"));
        }
        let there = moved.illuminate(moves.transform_point3(point), sample);
        lost += u32::from(arrives.is_some() != there.is_some());
        let Some(light) = arrives else { continue };
        lit += 1;
        if let Some(why) = unsound(&light) {
            report.add("light", name, format!("at {point}, {sample} {why}"));
        } else if lamp.brightest().is_some_and(|most| light.intensity.cmpgt(most).any()) {
            let (intensity, most) = (light.intensity, lamp.brightest().unwrap_or_default());
            report.add("brightest", name, format!("at {point}, {sample} it gives {intensity}, more than {most}"));
        }
        let Some(there) = there else { continue };
        let expected = moves.transform_vector3(light.to_light);
        let off = there.to_light.distance(expected) / (expected.length() + point.length() + 10.0);
        let other = (there.intensity - light.intensity).abs().max_element() / light.intensity.max_element().max(1.0);
        if !(off < 1e-9 && other < 1e-6) {
            let what = format!("at {point}, {sample} it gives {light:?}; placed, it gives {there:?} there");
            report.add("placement", name, what);
        }
    }
    if lit == 0 {
        report.add("light", name, format!("at none of {POINTS} points about the origin it gives light"));
    }
    // Points at the edge of what is lit.
    if lost * 50 > POINTS {
        let what = format!("{lost} of {POINTS} points are lit in one placement and not in another");
        report.add("placement", name, what);
    }
}

/// What is wrong with some light, if anything.
fn unsound(light: &Illumination) -> Option<String> {
    let Illumination { to_light, distance, intensity, .. } = *light;
    if !(to_light.is_finite() && to_light != DVec3::ZERO) {
        Some(format!("the way to the light is {to_light}"))
    } else if distance.is_nan() || distance <= 0.0 {
        Some(format!("the light is at distance {distance}"))
    } else {
        is_no_light(intensity).then(|| format!("the intensity is {intensity}"))
    }
}

fn is_no_light(color: Rgb) -> bool {
    !(color.is_finite() && color.cmpge(Rgb::ZERO).all())
}

pub(super) fn check_texture<T: Texture>(texture: &T, name: &str, watch: &Watch, report: &mut Report) {
    let Some(pattern) = texture.pack() else {
        report.add("pattern", name, "there is nothing to show");
        return;
    };
    let mut together = Together::default();
    for n in 0..POINTS {
        watch.asks(name, None);
        let key = Key::of_pixel(n, 22, 7);
        let uv = (key.sample(9) * 2.0 - 1.0) * [1.0, 30.0, 1e6][n as usize % 3];
        let at = TexturePoint { uv, point: anywhere(key, n), footprint: Footprint::default() };
        let color = pattern.color(&at);
        if is_no_light(color) {
            report.add("pattern", name, format!("at {uv}, {} the colour is {color}", at.point));
        } else if pattern.brightest().is_some_and(|most| color.cmpgt(most).any()) {
            let most = pattern.brightest().unwrap_or_default();
            report.add("brightest", name, format!("at {uv}, {} the colour is {color}, more than {most}", at.point));
        }
        let differs = |other: Rgb| other.to_array().map(f64::to_bits) != color.to_array().map(f64::to_bits);
        if differs(pattern.color(&at)) {
            report.add("repeatable", name, format!("at {uv}, {} it gives another colour when asked again", at.point));
        }
        if let Some(other) = together.color(&*pattern, n as usize % PACKET, &at)
            && differs(other)
        {
            let what = format!("at {uv}, {} it gives {color} alone and {other} in a packet", at.point);
            report.add("packet", name, what);
        }
        let wide = Footprint { uv: [DVec2::X, DVec2::Y], point: [DVec3::X, DVec3::Z] };
        if !pattern.filters() && differs(pattern.color(&TexturePoint { footprint: wide, ..at })) {
            let what = format!("at {uv} the colour depends on the footprint, but `filters` says that it does not");
            report.add("footprint", name, what);
        }
    }
}

/// Points that a pattern is asked about together.
#[derive(Default)]
struct Together(Surfaces);

impl Together {
    /// Puts a point among the others, and gives its colour where it is among those asked for.
    fn color(&mut self, pattern: &dyn Pattern, i: usize, at: &TexturePoint) -> Option<Rgb> {
        set_vector(&mut self.0.point, i, at.point);
        self.0.set_uv(i, at.uv);
        // All of them now and then, and a few.
        let rays = if i == PACKET - 1 { Mask::MAX } else { (0x8421_0000_0000_1248 >> i & 1) << i };
        let mut colors = [[f64::NAN; PACKET]; 3];
        pattern.color_packet(&self.0, rays, &mut colors);
        let others = each(!rays).all(|i| vector_of(&colors, i).is_nan());
        (rays >> i & 1 != 0).then(|| if others { vector_of(&colors, i) } else { Rgb::NAN })
    }
}

/// A point about the origin, near or far.
fn anywhere(key: Key, n: u32) -> DVec3 {
    let (a, b) = (key.sample(0), key.sample(1));
    (DVec3::new(a.x, a.y, b.x) * 2.0 - 1.0) * [1.0, 10.0, 1000.0][n as usize % 3]
}
