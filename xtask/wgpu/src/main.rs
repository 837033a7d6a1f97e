//! The command line once more, with the GPU device: those who do without it need not build it.

fn main() -> std::process::ExitCode {
    xtask::main()
}
