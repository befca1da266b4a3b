//! The suite for shapes, lights and patterns catches faults: each of these is a ball, a light or a pattern with one.

use snell::{
    components::{
        packet::{Hits, Mask, PACKET, Packet, PerRay, Vectors, each, hit_each, those},
        primitive::surface_alone,
        surfaces::{Meeting, Surfaces},
    },
    conformance::{Form, check, check_light, check_texture},
    prelude::*,
};
use std::sync::{
    Arc,
    atomic::{AtomicU32, Ordering},
};

macro_rules! faults {
    ($($fault:ident = $number:literal, $test:ident: $check:literal;)*) => {$(
        const $fault: u8 = $number;

        #[test]
        fn $test() {
            let report = check(&[Broken::<$fault> { radius: 1.0 }], Form::Closed);
            assert!(report.has($check), "{report}");
        }
    )*};
}

const SOUND: u8 = 0;

#[test]
fn without_a_fault_all_is_well() {
    check(&[Broken::<SOUND> { radius: 1.0 }], Form::Closed).assert();
}

faults! {
    BOUNDS_TOO_SMALL = 1, bounds_that_are_too_small: "bounds";
    BOUNDS_NOT_FINITE = 2, bounds_that_are_not_finite: "pack";
    FAR_HIT = 3, the_farther_hit: "nearest";
    LIMIT_IGNORED = 4, a_limit_that_is_ignored: "nearest";
    LIMIT_EXCLUDED = 5, a_limit_that_is_left_out: "nearest";
    BEHIND = 6, a_distance_behind_the_origin: "nearest";
    EXHAUSTIVE_BY_ONE_BIT = 7, one_bit_between_the_hits: "nearest";
    BLOCKS_TOO_LATE = 8, shadows_that_come_late: "blocks";
    NORMAL_BENT = 9, a_bent_normal: "normal";
    NORMAL_OF_ONE_PATCH = 10, a_bent_normal_in_one_place: "normal";
    NORMAL_INWARD = 11, an_inward_normal: "parity";
    NORMAL_LONG = 12, a_long_normal: "surface";
    POINT_OFF = 13, a_point_beside_the_surface: "surface";
    ERROR_NOT_TOLD = 14, an_error_that_is_not_told: "surface";
    HOLE = 15, a_hole: "parity";
    INSIDE_OPEN = 16, a_surface_that_inside_does_not_see: "leak";
    CRACK = 17, a_crack: "leak";
    SCALE_IGNORED = 18, a_scale_that_is_ignored: "placement";
    PANICS_WHEN_LARGE = 19, a_panic_at_extreme_values: "extremes";
    FIELD_FORGOTTEN = 20, a_field_that_is_not_read: "text";
    OTHER_WITHOUT_UV = 21, another_surface_without_texture: "surface";
    PACKET_BY_ONE_BIT = 22, one_bit_between_packet_and_ray: "packet";
    PACKET_BLOCKS_AT_END = 23, shadows_of_packets_at_their_end: "packet";
    SURFACE_OF_PACKET_BY_ONE_BIT = 24, one_bit_between_the_surfaces_of_packet_and_ray: "packet";
    SURFACE_OF_ANOTHER_RAY = 25, a_surface_written_where_another_stands: "packet";
}

/// A ball about the origin with a fault.
#[derive(Component, Clone, Default)]
struct Broken<const FAULT: u8> {
    radius: f64,
}

impl<const FAULT: u8> Describe for Broken<FAULT> {
    const TAG: &'static str = "Broken";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        let mut forgotten = 1.0;
        let place = if FAULT == FIELD_FORGOTTEN { &mut forgotten } else { &mut self.radius };
        fields.field("radius", Value::Number(place), Spec::positive("object units").required());
    }
}

#[derive(Clone)]
struct Packed {
    sphere: <Sphere as Primitive>::Packed,
    center: DVec3,
    radius: f64,
}

impl<const FAULT: u8> Primitive for Broken<FAULT> {
    type Packed = Packed;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, Packed), Degenerate> {
        assert!(FAULT != PANICS_WHEN_LARGE || self.radius < 1e100, "too large");
        let placed = match FAULT {
            SCALE_IGNORED => DAffine3::from_translation(world_from_object.translation),
            _ => *world_from_object,
        };
        let (extent, sphere) = Sphere { radius: self.radius.abs() }.pack(&placed)?;
        let Extent::Bounded(mut bounds) = extent else { return Err(Degenerate("spheres are bounded".into())) };
        let (center, half) = (0.5 * (bounds.min + bounds.max), 0.5 * (bounds.max - bounds.min));
        match FAULT {
            BOUNDS_TOO_SMALL => bounds.max.y -= 0.05 * half.y,
            BOUNDS_NOT_FINITE => bounds.max.y = f64::INFINITY,
            _ => {}
        }
        Ok((Extent::Bounded(bounds), Packed { sphere, center, radius: half.max_element() }))
    }

    fn hit(packed: &Packed, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        let limit = if FAULT == LIMIT_IGNORED { f64::INFINITY } else { t_max };
        let hit = Sphere::hit(&packed.sphere, ray, limit, cost);
        let place = |hit: Hit| (ray.at(hit.t) - packed.center) / packed.radius;
        let inside = || (ray.origin - packed.center).length() < 0.4 * packed.radius;
        match FAULT {
            // The farther of two.
            FAR_HIT => {
                let first = hit?;
                let rest = Ray { origin: ray.at(first.t * (1.0 + 1e-9)), direction: ray.direction };
                let second = Sphere::hit(&packed.sphere, &rest, t_max, cost);
                second.map(|hit| Hit { t: hit.t + first.t, ..hit }).filter(|hit| hit.t <= t_max).or(Some(first))
            }
            LIMIT_EXCLUDED => hit.filter(|hit| hit.t < t_max),
            BEHIND => hit.map(|hit| Hit { t: -hit.t, ..hit }),
            HOLE => hit.filter(|hit| place(*hit).y < 0.97),
            INSIDE_OPEN => hit.filter(|_| !inside()),
            CRACK => hit.filter(|hit| !(place(*hit).x.abs() < 2e-3 && place(*hit).z > 0.0)),
            _ => hit,
        }
    }

    fn hit_with(packed: &Packed, ray: &Ray, t_max: f64, _: &Methods, cost: &mut Cost) -> Option<Hit> {
        let hit = Self::hit(packed, ray, t_max, cost);
        let next = |hit: Hit| Hit { t: hit.t.next_up(), ..hit };
        if FAULT == EXHAUSTIVE_BY_ONE_BIT { hit.map(next) } else { hit }
    }

    fn blocks(packed: &Packed, ray: &Ray, t_max: f64, cost: &mut Cost) -> bool {
        let limit = |t: f64| if FAULT == BLOCKS_TOO_LATE { t * 0.999 } else { t };
        Self::hit(packed, ray, limit(t_max), cost).is_some_and(|hit| hit.t < limit(t_max))
    }

    fn hit_packet(
        packed: &Packed,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        hits: &mut Hits,
        cost: &mut Cost,
    ) -> Mask {
        let met = hit_each(rays, hits, |i| Self::hit(packed, &packet.ray(i), t_max[i], cost));
        if FAULT == PACKET_BY_ONE_BIT {
            hits.t[5] = hits.t[5].next_down();
        }
        met
    }

    fn blocks_packet(packed: &Packed, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask {
        match FAULT {
            PACKET_BLOCKS_AT_END => those(rays, |i| Self::hit(packed, &packet.ray(i), t_max[i], cost).is_some()),
            _ => those(rays, |i| Self::blocks(packed, &packet.ray(i), t_max[i], cost)),
        }
    }

    fn surface_packet(shapes: &[Packed], met: &Meeting<'_>, surfaces: &mut Surfaces) {
        for i in each(met.rays) {
            let (ray, shape, hit) = met.of(i);
            surface_alone::<Self>(&shapes[shape], &ray, hit, met.textured >> i & 1 != 0, i, surfaces);
            match FAULT {
                SURFACE_OF_PACKET_BY_ONE_BIT if i == 10 => surfaces.lift[2][10] = f64::from_bits(1),
                SURFACE_OF_ANOTHER_RAY => surfaces.error[(i + 1) % PACKET] = 0.0,
                _ => {}
            }
        }
    }

    fn surface(packed: &Packed, ray: &Ray, hit: Hit) -> Surface {
        let mut surface = Sphere::surface(&packed.sphere, ray, hit);
        let place = (surface.point - packed.center) / packed.radius;
        let bent = (surface.normal + DVec3::new(0.0, 0.01, 0.0)).normalize();
        match FAULT {
            NORMAL_BENT => surface.normal = bent,
            // About one hit of a hundred.
            NORMAL_OF_ONE_PATCH if place.x > 0.97 => surface.normal = bent,
            NORMAL_INWARD => surface.normal = -surface.normal,
            NORMAL_LONG => surface.shading_normal *= 1.01,
            POINT_OFF => surface.point += surface.normal * 1e-6 * packed.radius,
            ERROR_NOT_TOLD => {
                // A point below the surface by more than is told.
                surface.point -= surface.normal * 1e-12 * packed.radius;
                surface.error = 0.0;
            }
            _ => {}
        }
        surface
    }

    fn surface_without_uv(packed: &Packed, ray: &Ray, hit: Hit) -> Surface {
        let surface = Self::surface(packed, ray, hit);
        let error = if FAULT == OTHER_WITHOUT_UV { surface.error.next_up() } else { surface.error };
        Surface { error, ..surface }
    }
}

macro_rules! light_and_pattern_faults {
    ($($fault:ident = $number:literal, $test:ident: $check:ident $($expected:literal)*;)*) => {$(
        const $fault: u8 = $number;

        #[test]
        fn $test() {
            let report = $check(&[Gloomy::<$fault> { level: 0.75 }]);
            let failed: Vec<&str> = report.failures.iter().map(|failure| failure.check).collect();
            let expected: &[&str] = &[$($expected),*];
            assert_eq!(failed, expected, "{report}");
        }
    )*};
}

light_and_pattern_faults! {
    SOUND_SHADE = 0, a_sound_light_has_none: check_light;
    SOUND_PATTERN = 1, a_sound_pattern_has_none: check_texture;
    LIGHT_BY_ONE_BIT = 2, a_light_brighter_than_told_by_one_bit: check_light "brightest";
    LIGHT_BELOW_ZERO = 3, a_light_that_takes_light_away: check_light "light";
    LIGHT_FROM_NOWHERE = 4, a_light_from_nowhere: check_light "light";
    LIGHT_UNMOVED = 5, a_light_that_does_not_turn: check_light "placement";
    LIGHT_OF_CHANCE = 6, a_light_of_chance: check_light "repeatable" "placement";
    LIGHT_FIELD_FORGOTTEN = 7, a_field_of_a_light_that_is_not_read: check_light "text";
    COLOR_BY_ONE_BIT = 8, a_colour_brighter_than_told_by_one_bit: check_texture "brightest";
    COLOR_NOT_A_NUMBER = 9, a_colour_that_is_not_a_number: check_texture "pattern";
    COLOR_OF_CHANCE = 10, a_colour_of_chance: check_texture "repeatable" "footprint" "packet";
    FOOTPRINT_NOT_TOLD = 11, a_footprint_that_is_not_told: check_texture "footprint";
    COLOR_OF_PACKET_BY_ONE_BIT = 12, one_bit_between_the_colours_of_packet_and_ray: check_texture "packet";
}

/// A light that comes from above, and an even pattern, with a fault.
#[derive(Component, Clone, Debug, Default)]
struct Gloomy<const FAULT: u8> {
    level: f64,
}

impl<const FAULT: u8> Describe for Gloomy<FAULT> {
    const TAG: &'static str = "Gloomy";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        let mut forgotten = 1.0;
        let place = if FAULT == LIGHT_FIELD_FORGOTTEN { &mut forgotten } else { &mut self.level };
        fields.field("level", Value::Number(place), Spec::not_negative("how bright").required());
    }
}

/// Another number every time.
fn chance() -> f64 {
    static ASKED: AtomicU32 = AtomicU32::new(0);
    f64::from(ASKED.fetch_add(1, Ordering::Relaxed) % 1000) * 1e-3
}

/// The way to a light, and how bright it is.
#[derive(Clone, Debug)]
struct Shining<const FAULT: u8>(DVec3, f64);

impl<const FAULT: u8> Light for Gloomy<FAULT> {
    type Packed = Shining<FAULT>;

    fn pack(&self, world_from_object: &DAffine3) -> Shining<FAULT> {
        let placed = if FAULT == LIGHT_UNMOVED { DAffine3::IDENTITY } else { *world_from_object };
        Shining(placed.transform_vector3(DVec3::Y), self.level)
    }
}

impl<const FAULT: u8> Lamp for Shining<FAULT> {
    fn illuminate(&self, _: DVec3, _: DVec2) -> Option<Illumination> {
        let level = match FAULT {
            LIGHT_BY_ONE_BIT => self.1.next_up(),
            LIGHT_BELOW_ZERO => -self.1,
            LIGHT_OF_CHANCE => self.1 * chance(),
            _ => self.1,
        };
        let to_light = if FAULT == LIGHT_FROM_NOWHERE { DVec3::ZERO } else { self.0 };
        Some(Illumination { to_light, distance: f64::INFINITY, intensity: Rgb::splat(level), shadows: true })
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(Rgb::splat(self.1))
    }
}

impl<const FAULT: u8> Texture for Gloomy<FAULT> {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        Some(Arc::new(self.clone()))
    }
}

impl<const FAULT: u8> Pattern for Gloomy<FAULT> {
    fn color(&self, at: &TexturePoint) -> Rgb {
        Rgb::splat(match FAULT {
            // One square of many.
            COLOR_BY_ONE_BIT if at.uv.min_element() > 0.5 => self.level.next_up(),
            COLOR_NOT_A_NUMBER if at.uv.x > 25.0 => f64::NAN,
            COLOR_OF_CHANCE => self.level * chance(),
            FOOTPRINT_NOT_TOLD => self.level / (1.0 + at.footprint.uv[0].length()),
            _ => self.level,
        })
    }

    fn color_packet(&self, surfaces: &Surfaces, rays: Mask, colors: &mut Vectors) {
        for i in each(rays) {
            let (uv, point) = (surfaces.get(i).uv, surfaces.get(i).point);
            let color = self.color(&TexturePoint { uv, point, ..TexturePoint::default() });
            for (axis, color) in color.to_array().into_iter().enumerate() {
                let wrong = FAULT == COLOR_OF_PACKET_BY_ONE_BIT && (axis, i) == (1, 6);
                colors[axis][i] = if wrong { color.next_down() } else { color };
            }
        }
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(Rgb::splat(self.level))
    }
}
