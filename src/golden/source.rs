//! What golden pictures are drawn from.

use crate::{Options, Picture, Region, Renderer, Snapshot, render, why};
use std::sync::Arc;

/// Something that gives a picture.
pub trait Source {
    /// The picture, or a part of it.
    ///
    /// # Errors
    /// Why there is no picture.
    fn picture(&mut self, region: Option<Region>) -> Result<Picture, String>;

    /// How the pixel in a column and row of the whole comes about, as text, if that is known.
    fn why(&mut self, x: u32, y: u32) -> Option<String>;
}

impl Source for Snapshot {
    fn picture(&mut self, region: Option<Region>) -> Result<Picture, String> {
        fits(region, self.settings.width, self.settings.height)?;
        Ok(render(self, &Options { region, ..Options::default() }).picture)
    }

    fn why(&mut self, x: u32, y: u32) -> Option<String> {
        Some(why(self, x, y).to_string())
    }
}

impl Source for Arc<Snapshot> {
    fn picture(&mut self, region: Option<Region>) -> Result<Picture, String> {
        Snapshot::clone(self).picture(region)
    }

    fn why(&mut self, x: u32, y: u32) -> Option<String> {
        Snapshot::clone(self).why(x, y)
    }
}

impl Source for Renderer {
    fn picture(&mut self, region: Option<Region>) -> Result<Picture, String> {
        self.snapshot().map_err(|why| why.to_string())?.picture(region)
    }

    fn why(&mut self, x: u32, y: u32) -> Option<String> {
        let mut tree = why(&*self.snapshot().ok()?, x, y);
        tree.locate(&mut self.world);
        Some(tree.to_string())
    }
}

impl Source for Picture {
    fn picture(&mut self, region: Option<Region>) -> Result<Picture, String> {
        fits(region, self.width, self.height)?;
        Ok(region.and_then(|region| self.crop(region)).unwrap_or_else(|| self.clone()))
    }

    fn why(&mut self, _: u32, _: u32) -> Option<String> {
        None
    }
}

fn fits(region: Option<Region>, width: u32, height: u32) -> Result<(), String> {
    match region.filter(|region| !region.fits(width, height)) {
        Some(region) => {
            Err(format!("the region {region:?} does not lie within the {width}x{height} pixels of the picture"))
        }
        None => Ok(()),
    }
}
