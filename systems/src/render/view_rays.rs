//! Rays through the picture: four at once.

use super::wave::Wave;
use crate::snapshot::View;
use snell_components::{
    lanes::{Job, Lanes, vector},
    packet::{Mask, PerRay, four, groups},
};

/// [`View::ray`] for some rays of a wave, through points of a picture of some width and height.
pub(super) struct ViewRays<'a> {
    pub wave: &'a mut Wave,
    pub rays: Mask,
    pub places: &'a [PerRay; 2],
    pub view: &'a View,
    pub size: (u32, u32),
}

impl Job for ViewRays<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { wave, rays, places, view, size } = self;
        let (width, height) = (f64::from(size.0), f64::from(size.1));
        let [right, up] = [vector::splat(l, view.right), vector::splat(l, view.up)];
        let [eye, forward] = [vector::splat(l, view.eye), vector::splat(l, view.forward)];
        let (middle_x, middle_y, height) = (l.d_splat(0.5 * width), l.d_splat(0.5 * height), l.d_splat(height));
        for (group, which) in groups(rays) {
            let [x, y] = places;
            let to_right = l.d_div(l.d_sub(l.d_load(four(x, group)), middle_x), height);
            let upward = l.d_div(l.d_sub(middle_y, l.d_load(four(y, group))), height);
            let across = vector::add(l, vector::times(l, right, to_right), vector::times(l, up, upward));
            let direction = vector::unit(l, vector::add(l, across, forward));
            vector::store(l, eye, which, &mut wave.packet.origins, group);
            vector::store(l, direction, which, &mut wave.packet.directions, group);
        }
    }
}
