//! `snell render --watch`.

use super::{Console, Failure, args::RenderArguments, check::entities, render::render_once};
use crate::Renderer;
use snell_systems::load::UsedFiles;
use std::{
    collections::BTreeSet,
    fs,
    path::PathBuf,
    process, thread,
    time::{Duration, SystemTime},
};

/// How often files are looked at. Polling works on every file system, network ones too, and needs no library.
const PAUSE: Duration = Duration::from_millis(150);

/// Draws again whenever the scene or a file that it uses changes, until Ctrl-C; faults are told and waited out.
pub(super) fn watch(renderer: &mut Renderer, args: &RenderArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    // A file that is being written is whole or as it was, so the process may end at any time.
    let _ = ctrlc::set_handler(|| process::exit(i32::from(super::STOPPED)));
    let before = entities(&mut renderer.world);
    let settings = renderer.settings().clone();
    let mut files = BTreeSet::from([args.drawing.scene.clone()]);
    loop {
        // Noted before they are read: a change meanwhile is seen afterwards.
        let seen = stamps(&files);
        match render_once(renderer, args, console) {
            Err(failure @ (Failure::Stopped(_) | Failure::Usage(_))) => return Err(failure),
            Err(failure) => {
                failure.tell(console);
            }
            Ok(()) => {}
        }
        let known = files.len();
        files.extend(renderer.world.get_resource::<UsedFiles>().iter().flat_map(|used| used.0.iter().cloned()));
        let mut last = if files.len() == known { seen } else { stamps(&files) };
        for entity in entities(&mut renderer.world).difference(&before) {
            // Others may be gone with one of them.
            let _ = renderer.world.try_despawn(*entity);
        }
        *renderer.settings() = settings.clone();
        console.note("waiting for a change; Ctrl-C ends");
        let drawn = last.clone();
        // Programs save in several steps: wait until nothing changes any more.
        loop {
            thread::sleep(PAUSE);
            let now = stamps(&files);
            if now == last && now != drawn {
                break;
            }
            last = now;
        }
    }
}

/// When each file was last changed, and its size; none for one that is not there.
fn stamps(files: &BTreeSet<PathBuf>) -> Vec<Option<(SystemTime, u64)>> {
    let stamp = |file: &PathBuf| fs::metadata(file).ok().and_then(|data| Some((data.modified().ok()?, data.len())));
    files.iter().map(stamp).collect()
}
