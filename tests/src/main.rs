//! The command line once more, so that cargo builds it for the tests that run it.

fn main() -> std::process::ExitCode {
    xtask::main()
}
