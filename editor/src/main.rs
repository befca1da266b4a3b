//! `snell-edit [SCENE.ron]`: the editor's window.

use clap::Parser;
use snell::Renderer;
use std::{path::PathBuf, process::ExitCode, sync::Arc};

/// Build, light, look and render a scene
#[derive(Parser)]
#[command(name = "snell-edit", version)]
struct Arguments {
    /// Scene to open
    scene: Option<PathBuf>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match snell_editor::window::run(Arc::new(Renderer::new), arguments.scene.as_deref()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}
