//! Renders every scene below `tests/golden` and compares it with the picture beside it, to the last bit.
//!
//! `SNELL_BLESS=1 cargo test --test golden` replaces the pictures that fail, `SNELL_BLESS=all` all of them, and any
//! other value those whose name contains it or, with a `*` in it, matches it. Look at them before they are committed.

#[path = "support/golden.rs"]
mod golden;

use golden::{Bless, Golden, dead};
use libtest_mimic::{Arguments, Failed, Trial};
use snell::{Options, Renderer, render};
use std::{env, path::Path, process::ExitCode};

fn main() -> ExitCode {
    let args = Arguments::from_args();
    match trials() {
        Ok(trials) => libtest_mimic::run(&args, trials).exit_code(),
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}

fn trials() -> Result<Vec<Trial>, String> {
    let bless = Bless::from_env(env::var("SNELL_BLESS").ok().as_deref(), env::var_os("CI").is_some())?;
    let root = Path::new("tests/golden");
    let reports = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("golden");
    let goldens = Golden::all(root, &reports).map_err(|why| format!("{}: {why}", root.display()))?;
    if goldens.is_empty() {
        return Err(format!("there are no scenes below {}", root.display()));
    }
    let trial = |golden: Golden| {
        let bless = bless.clone();
        Trial::test(golden.name.clone(), move || run(&golden, &bless).map_err(Failed::from))
    };
    let mut trials: Vec<_> = goldens.into_iter().map(trial).collect();
    trials.push(Trial::test("every picture has its scene", move || {
        let dead = dead(root)?;
        if dead.is_empty() { Ok(()) } else { Err(format!("pictures without a scene: {dead:?}").into()) }
    }));
    Ok(trials)
}

fn run(golden: &Golden, bless: &Bless) -> Result<(), String> {
    let mut renderer = Renderer::new();
    renderer.load(&golden.scene).map_err(|faults| faults.to_string())?;
    let snapshot = renderer.snapshot().map_err(|why| why.to_string())?;
    golden.check(&render(&snapshot, &Options::default()).picture, bless)
}
