//! `cargo xtask bench`: see the library.

fn main() -> std::process::ExitCode {
    residual_benches::command::main()
}
