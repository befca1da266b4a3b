//! A folder in which the program runs as a user would run it.

use std::{
    fs,
    path::PathBuf,
    process::{Command, Output},
};
use tempfile::TempDir;

/// A scene of one ball.
pub(crate) const BALL: &str = r#"Scene(version: 1, settings: (width: 64, height: 48), entities: {
    "eye": [Camera(position: (0, 1, 5))],
    "sun": [DirectionalLight(direction: (-1, -2, -1))],
    "ball": [Sphere(radius: 1), Color(0.8, 0.2, 0.1), Diffuse(1)],
})"#;

/// The folder; `ball.ron` in it is [`BALL`].
pub(crate) struct Desk(TempDir);

impl Desk {
    /// A new folder.
    pub(crate) fn new() -> Self {
        let desk = Self(tempfile::tempdir().expect("a folder"));
        desk.put("ball.ron", BALL);
        desk
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file.
    pub(crate) fn put(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    /// The program with arguments.
    pub(crate) fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_snell"));
        command.args(words.split_whitespace()).current_dir(self.0.path());
        command
    }

    /// Runs the program: exit code, output and error output.
    pub(crate) fn run(&self, words: &str) -> (i32, String, String) {
        ended(self.command(words).output().expect("started"))
    }
}

/// Exit code, output and error output.
pub(crate) fn ended(output: Output) -> (i32, String, String) {
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("not killed"), text(output.stdout), text(output.stderr))
}
