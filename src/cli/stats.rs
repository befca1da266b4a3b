//! What a render did, for people and for programs.

use crate::{Counts, Region};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The contents of a `--stats` file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stats {
    /// Version of this layout, [`Stats::VERSION`]; it grows when a field goes away or changes its meaning.
    pub version: u32,
    /// Name and version of the program.
    pub software: String,
    /// The scene file as it was given.
    pub scene: String,
    /// The picture file; `None` if none was written.
    pub picture: Option<String>,
    /// Columns of the whole picture.
    pub width: u32,
    /// Rows of the whole picture.
    pub height: u32,
    /// The part that was to be drawn.
    pub region: Region,
    /// Pixels that were drawn; fewer than the region has after a stop.
    pub drawn: u64,
    /// SHA-256 of the linear picture, see [`crate::Picture::hash`].
    pub hash: String,
    /// Objects in the picture.
    pub objects: usize,
    /// Lights other than ambient ones.
    pub lights: usize,
    /// All rays.
    pub rays: u64,
    /// Rays by kind, and tests.
    pub counts: Counts,
    /// Threads.
    pub threads: usize,
    /// What the time that was given allowed for, if one was.
    #[serde(default)]
    pub time: Option<String>,
    /// Time of the stages.
    pub seconds: Seconds,
    /// Rays in a second of the trace.
    pub rays_per_second: f64,
    /// The most memory the process had at one time, where the system tells.
    pub peak_memory_bytes: Option<u64>,
}

/// Wall time of the stages, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seconds {
    /// Scene text and the files it uses → world.
    pub load: f64,
    /// World → snapshot with its trees.
    pub build: f64,
    /// Snapshot → picture.
    pub trace: f64,
}

impl Stats {
    /// The version of the layout.
    pub const VERSION: u32 = 1;
}

/// One screen for people.
impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Region { x, y, width, height } = self.region;
        let picture = self.picture.as_deref().unwrap_or("not written");
        write!(f, "picture  {picture}, {width}x{height}")?;
        if self.region != Region::whole(self.width, self.height) {
            write!(f, " at {x},{y} of {}x{}", self.width, self.height)?;
        }
        let c = &self.counts;
        let [rays, primary, mirror, transmitted, shadow, nodes, primitives] =
            [self.rays, c.primary, c.mirror, c.transmitted, c.shadow, c.nodes, c.primitives].map(grouped);
        let per_ray = |count: u64| count as f64 / self.rays.max(1) as f64;
        let (nodes_per_ray, primitives_per_ray) = (per_ray(c.nodes), per_ray(c.primitives));
        let Seconds { load, build, trace } = self.seconds;
        let threads = if self.threads == 1 { "1 thread".into() } else { format!("{} threads", self.threads) };
        write!(
            f,
            "
rays     {rays}: {primary} primary, {mirror} mirror, {transmitted} transmitted, {shadow} shadow
tests    {nodes} nodes, {primitives} shapes and triangles; {nodes_per_ray:.1} and {primitives_per_ray:.1} a ray
time     {load:.3} s load, {build:.3} s build, {trace:.3} s trace on {threads}
speed    {:.2} million rays a second",
            self.rays_per_second / 1e6,
        )?;
        if let Some(time) = &self.time {
            write!(f, "\nlimit    {time}")?;
        }
        if c.cut + c.too_deep > 0 {
            let [cut, too_deep] = [c.cut, c.too_deep].map(grouped);
            write!(f, "\nskipped  {cut} rays cut")?;
            if c.cut_bound > 0.0 {
                write!(
                    f,
                    ", which change no channel by more than {:.6} = {:.2}/255",
                    c.cut_bound,
                    255.0 * c.cut_bound
                )?;
            }
            write!(f, "; {too_deep} beyond the depth")?;
        }
        if c.refined + c.unresolved + c.undersampled > 0 {
            let [refined, unresolved, undersampled] = [c.refined, c.unresolved, c.undersampled].map(grouped);
            write!(f, "\nsampled  {refined} pixels halved")?;
            if c.unresolved > 0 {
                write!(f, "; {unresolved} as often as `subdivisions` allows, short of the error")?;
            }
            if c.undersampled > 0 {
                write!(f, "; {undersampled} times a light as often as its `samples` allow, short of its error")?;
            }
        }
        if let Some(bytes) = self.peak_memory_bytes {
            write!(f, "\nmemory   {} MB at most", grouped(bytes.div_ceil(1_000_000)))?;
        }
        Ok(())
    }
}

/// A number with its digits in groups of three.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
    }
}
