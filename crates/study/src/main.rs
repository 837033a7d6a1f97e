//! `cargo xtask accuracy` has cargo build and run this.

fn main() -> std::process::ExitCode {
    residual_study::main()
}
