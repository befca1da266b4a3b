//! Renders every scene below `tests/golden` and compares it with the picture beside it, to the last bit. What scenes are
//! made of lies in folders named `models`, `parts` and `textures`.
//!
//! `SNELL_BLESS=1 cargo test --test golden` replaces the pictures that fail, `SNELL_BLESS=all` all of them, and any
//! other value those whose name contains it or, with a `*` in it, matches it. Look at them before they are committed.

#[path = "support/cases.rs"]
#[expect(dead_code, reason = "golden pictures read themselves")]
mod cases;
#[path = "support/dead.rs"]
mod dead;

use cases::Case;
use dead::dead;

use libtest_mimic::{Arguments, Failed, Trial};
use snell::{
    Renderer,
    golden::{Bless, Golden},
};
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
    let cases = Case::all(root).map_err(|why| format!("{}: {why}", root.display()))?;
    if cases.is_empty() {
        return Err(format!("there are no scenes below {}", root.display()));
    }
    let trial = |case: Case| {
        let (bless, reports) = (bless.clone(), reports.clone());
        Trial::test(case.name.clone(), move || run(&case, &reports, &bless).map_err(Failed::from))
    };
    let mut trials: Vec<_> = cases.into_iter().map(trial).collect();
    trials.push(Trial::test("every picture has its scene", move || {
        let dead = dead(root)?;
        if dead.is_empty() { Ok(()) } else { Err(format!("pictures without a scene: {dead:?}").into()) }
    }));
    Ok(trials)
}

fn run(case: &Case, reports: &Path, bless: &Bless) -> Result<(), String> {
    let mut renderer = Renderer::new();
    renderer.load(&case.scene).map_err(|faults| faults.to_string())?;
    let golden = Golden::at(&case.name, &case.expected, reports).scene(&case.scene);
    golden.command("cargo test --test golden").check(&mut renderer, bless)
}
