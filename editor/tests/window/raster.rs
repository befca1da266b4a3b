//! What the window looks like, drawn by the processor: the same where there is no graphics card.

use egui::{
    Context, FullOutput, Rect, TextureId, TexturesDelta,
    epaint::{ImageData, Mesh, Primitive, Vertex},
};
use egui_kittest::TestRenderer;
use image::{Rgb, RgbImage};
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex},
};

/// A texture: its size, and premultiplied red, green, blue and opacity.
#[derive(Clone, Default)]
struct Texture {
    size: [usize; 2],
    pixels: Vec<[f32; 4]>,
}

impl Texture {
    /// Between the four nearest texels.
    fn at(&self, u: f32, v: f32) -> [f32; 4] {
        let [width, height] = self.size;
        let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
        let texel = |x: f32, y: f32| {
            let clamped = |x: f32, size: usize| (x.max(0.0) as usize).min(size - 1);
            self.pixels[clamped(y, height) * width + clamped(x, width)]
        };
        let (left, top) = (x.floor(), y.floor());
        let (s, t) = (x - left, y - top);
        let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(dx, dy)| texel(left + dx, top + dy));
        [0, 1, 2, 3].map(|i| (a[i] * (1.0 - s) + b[i] * s) * (1.0 - t) + (c[i] * (1.0 - s) + d[i] * s) * t)
    }
}

/// Keeps the textures of a harness.
#[derive(Clone, Default)]
pub(crate) struct Raster(Arc<Mutex<BTreeMap<TextureId, Texture>>>);

impl TestRenderer for Raster {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        let mut textures = self.0.lock().expect("no panic");
        for (id, deltas) in &delta.set {
            for delta in deltas {
                let ImageData::Color(image) = &delta.image;
                let pixels = image.pixels.iter().map(|color| color.to_array().map(|x| f32::from(x) / 255.0));
                let [x, y] = delta.pos.unwrap_or_default();
                let texture = textures.entry(*id).or_default();
                if delta.pos.is_none() {
                    *texture = Texture { size: image.size, pixels: pixels.collect() };
                    continue;
                }
                for (number, pixel) in pixels.enumerate() {
                    let (column, row) = (x + number % image.size[0], y + number / image.size[0]);
                    texture.pixels[row * texture.size[0] + column] = pixel;
                }
            }
        }
        // egui wants to know that it was all taken.
        delta.clear();
    }
}

impl Raster {
    /// The window as it was shown last.
    pub(crate) fn picture(&self, ctx: &Context, output: &FullOutput, size: [u32; 2]) -> RgbImage {
        let mut picture = vec![[0.0_f32; 3]; (size[0] * size[1]) as usize];
        let textures = self.0.lock().expect("no panic");
        for part in ctx.tessellate(output.shapes.clone(), output.pixels_per_point) {
            if let Primitive::Mesh(mesh) = &part.primitive
                && let Some(texture) = textures.get(&mesh.texture_id)
            {
                draw(&mut picture, size, part.clip_rect, mesh, texture);
            }
        }
        RgbImage::from_fn(size[0], size[1], |x, y| {
            Rgb(picture[(y * size[0] + x) as usize].map(|x| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8))
        })
    }
}

fn draw(picture: &mut [[f32; 3]], size: [u32; 2], clip: Rect, mesh: &Mesh, texture: &Texture) {
    let clip = clip.intersect(Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(size[0] as f32, size[1] as f32)));
    for corners in mesh.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|i| &mesh.vertices[corners[i] as usize]);
        let edge = |from: &Vertex, to: &Vertex, x: f32, y: f32| {
            (to.pos.x - from.pos.x) * (y - from.pos.y) - (to.pos.y - from.pos.y) * (x - from.pos.x)
        };
        let area = edge(a, b, c.pos.x, c.pos.y);
        if area == 0.0 {
            continue;
        }
        let around = Rect::from_points(&[a.pos, b.pos, c.pos]).intersect(clip);
        for row in around.top().floor().max(0.0) as u32..around.bottom().ceil().max(0.0) as u32 {
            for column in around.left().floor().max(0.0) as u32..around.right().ceil().max(0.0) as u32 {
                let (x, y) = (column as f32 + 0.5, row as f32 + 0.5);
                let weights = [edge(b, c, x, y), edge(c, a, x, y), edge(a, b, x, y)].map(|weight| weight / area);
                // A pixel on an edge belongs to one of the two triangles: that whose side it is by a hair.
                let is_in = weights.iter().all(|weight| *weight > -1e-6);
                if !is_in || !clip.contains(egui::pos2(x, y)) || row >= size[1] || column >= size[0] {
                    continue;
                }
                let mix = |of: fn(&Vertex) -> f32| of(a) * weights[0] + of(b) * weights[1] + of(c) * weights[2];
                let texel = texture.at(mix(|v| v.uv.x), mix(|v| v.uv.y));
                let channel: [fn(&Vertex) -> f32; 4] = [
                    |v| f32::from(v.color.r()),
                    |v| f32::from(v.color.g()),
                    |v| f32::from(v.color.b()),
                    |v| f32::from(v.color.a()),
                ];
                let color = [0, 1, 2, 3].map(|i| mix(channel[i]) / 255.0 * texel[i]);
                let pixel = &mut picture[(row * size[0] + column) as usize];
                for i in 0..3 {
                    pixel[i] = color[i] + pixel[i] * (1.0 - color[3]);
                }
            }
        }
    }
}
