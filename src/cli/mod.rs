//! The command line as a library function, so that a program with shapes of its own has all of it.
//!
//! ```no_run
//! use snell::{Renderer, cli};
//! use std::{env, process::ExitCode};
//!
//! fn main() -> ExitCode {
//!     // With shapes of your own: `Renderer::new().with_primitive::<Torus>()`.
//!     cli::run(Renderer::new(), env::args_os())
//! }
//! ```
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | done |
//! | 1 | a scene has faults, a file cannot be written, or what was compared is not alike |
//! | 2 | the command is not used as it is meant, or there is nothing to compare |
//! | 130 | stopped by Ctrl-C; the picture holds what was drawn by then |

mod args;
mod chart;
mod check;
mod diff;
mod draw;
mod edit;
mod fmt;
mod machine;
mod progress;
mod render;
mod repro;
mod stability;
mod stats;
mod watch;
mod why;

pub use stats::{Seconds, Stats};

use crate::Renderer;
use args::{Arguments, Command};
use clap::Parser;
use std::{
    ffi::OsString,
    io::{self, Write},
    process::ExitCode,
};

/// Runs the command line on a renderer, which may know shapes, lights and textures of its own.
///
/// The first of `args` is the name of the program, as in [`std::env::args_os`]. The process should end with the code
/// that is returned; the first Ctrl-C during a render stops the render, a second one ends the process.
#[must_use]
pub fn run(renderer: Renderer, args: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::from(run_with(renderer, args, &mut Console { out: &mut io::stdout(), err: &mut io::stderr() }))
}

/// [`run`] with a choice of where messages go.
fn run_with(mut renderer: Renderer, args: impl IntoIterator<Item = OsString>, console: &mut Console<'_>) -> u8 {
    let done = match Arguments::try_parse_from(args) {
        Ok(Arguments { command: Command::Render(args) }) => render::render(&mut renderer, &args, console),
        Ok(Arguments { command: Command::Edit(args) }) => edit::edit(&args, console),
        Ok(Arguments { command: Command::Hash(args) }) => render::hash(&mut renderer, &args, console),
        Ok(Arguments { command: Command::Check(args) }) => check::check(&mut renderer, &args, console),
        Ok(Arguments { command: Command::Why(args) }) => why::why(&mut renderer, &args, console),
        Ok(Arguments { command: Command::Diff(args) }) => diff::diff(&args, console),
        Ok(Arguments { command: Command::Fmt(args) }) => fmt::fmt(&args, console),
        Ok(Arguments { command: Command::Repro(args) }) => repro::repro(&mut renderer, &args, console),
        Ok(Arguments { command: Command::Stability(args) }) => stability::stability(&args, console),
        Ok(Arguments { command: Command::Chart(args) }) => chart::chart(renderer, &args, console),
        // Help and version arrive here, too; nothing can be told of them if the terminal is gone.
        Err(answer) => {
            let _ = answer.print();
            return answer.exit_code().try_into().unwrap_or(USAGE);
        }
    };
    match done {
        Ok(()) => 0,
        Err(failure) => failure.tell(console),
    }
}

const FAULT: u8 = 1;
const USAGE: u8 = 2;
const STOPPED: u8 = 130;

/// Where messages go. That nobody reads them any more is no reason to stop, so errors of writing them are dropped.
struct Console<'a> {
    /// What was asked for.
    out: &'a mut dyn Write,
    /// Everything else.
    err: &'a mut dyn Write,
}

impl Console<'_> {
    fn say(&mut self, line: impl core::fmt::Display) {
        let _ = writeln!(self.out, "{line}");
    }

    fn warn(&mut self, line: impl core::fmt::Display) {
        let _ = writeln!(self.err, "warning: {line}");
    }

    fn error(&mut self, line: impl core::fmt::Display) {
        let _ = writeln!(self.err, "error: {line}");
    }

    fn note(&mut self, line: impl core::fmt::Display) {
        let _ = writeln!(self.err, "{line}");
    }
}

/// Why a command did not do what it was asked for.
#[derive(Debug)]
enum Failure {
    /// Faults of scenes, a line each.
    Scene(Vec<String>),
    /// Something else that keeps the command from its work.
    Work(String),
    /// The command is not used as it is meant.
    Usage(String),
    /// Things that were compared are not alike, which was told.
    Different,
    /// The user stopped it; what was kept.
    Stopped(String),
}

impl Failure {
    /// Tells the user, and gives the exit code.
    fn tell(self, console: &mut Console<'_>) -> u8 {
        match self {
            Self::Scene(faults) => {
                faults.iter().for_each(|fault| console.error(fault));
                console.note(match faults.len() {
                    1 => "1 fault".into(),
                    count => format!("{count} faults"),
                });
                FAULT
            }
            Self::Work(why) => {
                console.error(why);
                FAULT
            }
            Self::Usage(why) => {
                console.error(why);
                USAGE
            }
            Self::Different => FAULT,
            Self::Stopped(kept) => {
                console.note(kept);
                STOPPED
            }
        }
    }
}

#[cfg(test)]
mod tests;
