//! `snell edit`: starts the editor, which is a program of its own, as a window needs far more code than a render.

use super::{Console, Failure};
use clap::Args;
use std::{
    env::{self, consts::EXE_SUFFIX},
    io::ErrorKind,
    path::{Path, PathBuf},
    process::Command,
};

/// Build, light, look and render a scene in a window
///
/// Runs the program `snell-edit`, which is made by `cargo build --release --workspace`.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  snell edit              begin with a ready scene
  snell edit scene.ron    open a scene")]
pub(super) struct EditArguments {
    /// Scene file [default: shows scenes to begin with]
    pub(super) scene: Option<PathBuf>,
}

/// The editor's program.
const PROGRAM: &str = "snell-edit";

/// Runs the editor and waits until its window is closed.
pub(super) fn edit(args: &EditArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    // Beside this program if it is there, else wherever programs are found.
    let beside = env::current_exe().ok().and_then(|this| Some(this.parent()?.join(format!("{PROGRAM}{EXE_SUFFIX}"))));
    let program = beside.filter(|program| program.is_file()).unwrap_or_else(|| PROGRAM.into());
    run(&program, args, console)
}

fn run(program: &Path, args: &EditArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    match Command::new(program).args(&args.scene).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::Work(format!("the editor ended with {status}"))),
        Err(why) if why.kind() == ErrorKind::NotFound => {
            console.note("in a checkout: cargo build --release --workspace, then again");
            Err(Failure::Work(format!("the editor is a program of its own, `{PROGRAM}`, and is not here")))
        }
        Err(why) => Err(Failure::Work(format!("{}: {why}", program.display()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_editor_that_is_not_there_is_told_with_what_makes_it() {
        let (mut out, mut err) = (vec![], vec![]);
        let mut console = Console { out: &mut out, err: &mut err };
        let told = run(Path::new("no-such-editor"), &EditArguments { scene: None }, &mut console);
        let Err(Failure::Work(told)) = told else { panic!("{told:?}") };
        assert!(told.contains("snell-edit"), "{told}");
        assert!(String::from_utf8_lossy(&err).contains("cargo build --release --workspace"));
    }
}
