//! `cargo bench`: how fast Snell builds, traces, draws and loads, here and now. `benches/README.md` tells more.

mod clock;
mod contestant;
mod random;
mod rays;
mod subject;

use clap::{Parser, Subcommand};
use std::{path::PathBuf, process::ExitCode};

/// How fast Snell builds, traces, draws and loads, here and now.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write four sets of rays about a mesh, for `benches/peers`.
    Rays {
        /// A `.tri` file.
        mesh: PathBuf,
        /// Where to: the beginning of the files' names.
        rays: PathBuf,
    },
    /// Answer commands from the standard input, for `benches/peers`.
    Contestant {
        /// A `.tri` file.
        mesh: PathBuf,
        /// The beginning of the names of the files of rays.
        rays: PathBuf,
    },
    /// Load and draw one scene, for `benches/peers`.
    Frame {
        /// A scene file.
        scene: PathBuf,
        /// Threads.
        threads: usize,
        /// Where to write the picture, as PPM.
        picture: PathBuf,
    },
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Rays { mesh, rays } => contestant::write_rays(&mesh, &rays),
        Command::Contestant { mesh, rays } => contestant::answer(&mesh, &rays),
        Command::Frame { scene, threads, picture } => contestant::draw(&scene, threads, &picture),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}
