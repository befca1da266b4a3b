//! `cargo bench`: how fast Snell builds, traces, draws and loads, here and now. `benches/README.md` tells more.

mod clock;
mod contestant;
mod frame;
mod growth;
mod kernel;
mod load;
mod measure;
mod rays;
mod record;
mod subject;

use clap::{Parser, Subcommand, ValueEnum};
use measure::show;
use std::{error::Error, path::PathBuf, process::ExitCode};
use subject::{Subject, chaotic, scanned, sparse, waves};

/// How fast Snell builds, traces, draws and loads, here and now.
#[derive(Parser)]
#[command(args_conflicts_with_subcommands = true)]
struct Arguments {
    /// What cargo says to every bench.
    #[arg(long, hide = true, global = true)]
    bench: bool,
    /// What to measure; by default everything.
    benches: Vec<Bench>,
    /// Measured rounds; medians are told.
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Write all figures to a file, with the machine and the commit.
    #[arg(long)]
    record: Option<PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Bench {
    /// Trees of meshes.
    Build,
    /// Rays by kind.
    Trace,
    /// Whole pictures.
    Frame,
    /// Models from their files.
    Load,
    /// Time against triangles and pixels.
    Growth,
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
        /// How much is to be found out for each ray.
        goal: contestant::Goal,
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
    let arguments = Arguments::parse();
    let done = match &arguments.command {
        Some(Command::Rays { mesh, rays }) => contestant::write_rays(mesh, rays),
        Some(Command::Contestant { mesh, rays, goal }) => contestant::answer(mesh, rays, *goal),
        Some(Command::Frame { scene, threads, picture }) => contestant::draw(scene, *threads, picture),
        None => measure(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Measures what is asked for, and tells of each part as it is done.
fn measure(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let wanted = |bench| arguments.benches.is_empty() || arguments.benches.contains(&bench);
    let rounds = arguments.rounds;
    let (mut rows, mut fits) = (vec![], vec![]);
    let mut add = |more: Vec<measure::Row>| {
        show(&more);
        rows.extend(more);
    };
    let mut subjects: Vec<Subject> = vec![waves(708), sparse(30_000), chaotic(30_000)];
    subjects.extend(scanned());
    if wanted(Bench::Build) {
        add(kernel::build(&subjects, rounds)?);
    }
    if wanted(Bench::Trace) {
        add(kernel::trace(&subjects, rounds));
    }
    if wanted(Bench::Frame) {
        add(frame::bench(&subjects, rounds));
    }
    if wanted(Bench::Load) {
        add(load::bench(&subjects, rounds)?);
    }
    if wanted(Bench::Growth) {
        for (more, fit) in [growth::with_triangles(rounds), growth::with_pixels(rounds)] {
            add(more);
            let growth::Fit { what, at_zero, per_unit, residual } = &fit;
            println!("{what}: {at_zero:.4} + {per_unit:.4} a unit; at most {:.1} % off", 100.0 * residual);
            fits.push(fit);
        }
    }
    if let Some(file) = &arguments.record {
        record::write(file, rounds, &rows, &fits)?;
    }
    Ok(())
}
