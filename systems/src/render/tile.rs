//! The picture in tiles, drawn in parallel; stopping, progress.

use super::{Counts, Picture, Region, antialias::Pixels};
use crate::snapshot::Snapshot;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use rayon::prelude::*;
use snell_components::method::Methods;
use std::sync::Arc;

/// Stops a render from another thread; clones stop the same render.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// A handle that was not used yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the render to stop; it does so within a square of at most eight by eight pixels, with adaptive antialiasing
    /// after a pixel or the corners of eight rows of the tile, and leaves its rows of the tile undrawn.
    pub fn stop(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the render was asked to stop.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Pixels drawn.
    pub done: u64,
    /// Pixels to draw.
    pub total: u64,
}

/// A finished tile: its place in the picture and its pixels, row by row.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Place in the whole picture.
    pub region: Region,
    /// Linear light.
    pub pixels: Vec<[f32; 3]>,
}

/// Told of every tile as it is finished, from the thread that drew it.
pub type OnTile<'a> = &'a (dyn Fn(&Tile, Progress) + Sync);

/// How to render; none of it but methods other than the default tests changes a bit of any pixel.
#[derive(Clone, Default)]
pub struct Options<'a> {
    /// Threads; by default those of the pool the call runs in.
    pub threads: Option<usize>,
    /// Part of the picture to draw; by default all of it. Clipped to the picture.
    pub region: Option<Region>,
    /// Edge of a tile in pixels; by default 32.
    pub tile: Option<u32>,
    /// How rays find what they meet.
    pub methods: Methods,
    /// Stops the render from elsewhere.
    pub stop: Stop,
    /// Told of every tile as it is finished.
    pub on_tile: Option<OnTile<'a>>,
}

/// A picture that was drawn, or as much of it as there was time for.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The region that was asked for; pixels not drawn are black.
    pub picture: Picture,
    /// Where the picture lies in the whole.
    pub region: Region,
    /// What it took.
    pub counts: Counts,
    /// Pixels drawn.
    pub done: u64,
}

impl Frame {
    /// Whether every pixel was drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.done == self.region.area() as u64
    }
}

const TILE: u32 = 32;

/// Draws a snapshot.
///
/// A render that is stopped returns what it has; a render in which a tile panics (an outside shape may) panics.
#[must_use]
pub fn render(snapshot: &Snapshot, options: &Options<'_>) -> Frame {
    let (width, height) = (snapshot.settings.width, snapshot.settings.height);
    let region = clipped(options.region.unwrap_or(Region::whole(width, height)), width, height);
    let tiles = tiles(region, options.tile.unwrap_or(TILE).max(1));
    let total = region.area() as u64;
    let done = AtomicU64::new(0);
    let draw = |tile: &Region| {
        let (tile, counts, rows) = draw(snapshot, *tile, options);
        if rows > 0 {
            let drawn = u64::from(rows) * u64::from(tile.region.width);
            let done = done.fetch_add(drawn, Ordering::Relaxed) + drawn;
            if let Some(on_tile) = options.on_tile {
                on_tile(&tile, Progress { done, total });
            }
        }
        (tile, counts)
    };
    let draw_all = || tiles.par_iter().with_max_len(1).map(draw).collect::<Vec<_>>();
    let pool = options.threads.and_then(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().ok());
    let drawn = match pool {
        Some(pool) => pool.install(draw_all),
        None => draw_all(),
    };

    let mut picture = Picture::black(region.width, region.height);
    let mut counts = Counts::default();
    for (tile, tile_counts) in drawn {
        let Region { x, y, width, height } = tile.region;
        picture.paste(&Picture { width, height, pixels: tile.pixels }, x - region.x, y - region.y);
        counts += tile_counts;
    }
    Frame { picture, region, counts, done: done.into_inner() }
}

/// The part of a region within the picture.
fn clipped(region: Region, width: u32, height: u32) -> Region {
    let (x, y) = (region.x.min(width), region.y.min(height));
    Region { x, y, width: region.width.min(width - x), height: region.height.min(height - y) }
}

/// Tiles that cover a region, row by row.
fn tiles(region: Region, edge: u32) -> Vec<Region> {
    let starts = |start: u32, len: u32| (start..start + len).step_by(edge as usize);
    let row = |y: u32| {
        starts(region.x, region.width).map(move |x| Region {
            x,
            y,
            width: edge.min(region.x + region.width - x),
            height: edge.min(region.y + region.height - y),
        })
    };
    starts(region.y, region.height).flat_map(row).collect()
}

/// Draws one tile; rows after a stop stay black. Returns how many rows were drawn.
fn draw(snapshot: &Snapshot, region: Region, options: &Options<'_>) -> (Tile, Counts, u32) {
    let mut pixels = vec![[0.0; 3]; region.area()];
    let mut counts = Counts::default();
    let observer = &mut ();
    let mut drawing = Pixels::new(snapshot, &options.methods, &mut counts, observer);
    drawing.ahead = Some(region);
    let (edge, width) = (drawing.edge(), region.width as usize);
    let mut lights = vec![];
    let mut rows = 0;
    'bands: for (band, pixels) in pixels.chunks_mut(width * edge as usize).enumerate() {
        let height = (pixels.len() / width) as u32;
        for x in (0..region.width).step_by(edge as usize) {
            // A pixel may take thousands of rays, so that a row would be long to wait for.
            if options.stop.is_stopped() {
                pixels.fill([0.0; 3]);
                break 'bands;
            }
            let part =
                Region { x: region.x + x, y: region.y + band as u32 * edge, width: edge.min(region.width - x), height };
            drawing.lights(part, &mut lights);
            for (i, light) in lights.iter().enumerate() {
                let light = light.as_vec3();
                if light.is_finite() {
                    let (row, column) = (i / part.width as usize, i % part.width as usize);
                    pixels[row * width + x as usize + column] = light.to_array();
                } else {
                    drawing.counts.not_finite += 1;
                }
            }
        }
        rows += height;
    }
    (Tile { region, pixels }, counts, rows)
}
