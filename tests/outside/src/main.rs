//! The whole of Snell's command line, with one more shape.

mod torus;

fn main() -> std::process::ExitCode {
    snell::cli::run(snell::Renderer::new().with_primitive::<torus::Torus>(), std::env::args_os())
}
