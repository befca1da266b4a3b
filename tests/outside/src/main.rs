//! The whole of Snell's command line, with what this crate adds.

fn main() -> std::process::ExitCode {
    snell::cli::run(outside::renderer(), std::env::args_os())
}
