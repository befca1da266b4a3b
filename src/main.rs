//! The command line: see [`snell::cli`].

fn main() -> std::process::ExitCode {
    snell::cli::run(snell::Renderer::new(), std::env::args_os())
}
