//! The whole of Snell's command line, with one more shape.

fn main() -> std::process::ExitCode {
    snell::cli::run(snell::Renderer::new().with_primitive::<outside::Torus>(), std::env::args_os())
}
