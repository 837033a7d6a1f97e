//! See the library.

fn main() -> std::process::ExitCode {
    residual_check::main()
}
