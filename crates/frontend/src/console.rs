//! Lines for the terminal, the log, or the pipe behind it. Whoever reads may go away first, as in `… | head`, which is no reason
//! to lose an image: lines that nobody reads any more are dropped, where `println!` panics.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write, stderr, stdout};
use std::process;

/// Prints a line of results to standard output.
#[macro_export]
macro_rules! out {
    ($($arguments:tt)*) => { $crate::console::result(format_args!($($arguments)*)) };
}

/// Prints a line about the work to standard error.
#[macro_export]
macro_rules! note {
    ($($arguments:tt)*) => { $crate::console::remark(format_args!($($arguments)*)) };
}

/// [`out!`]. Ends the process with status 1 where the line cannot be written though somebody waits for it, as on a full disk.
pub fn result(line: Arguments<'_>) {
    // In one piece, or lines of several threads would mix.
    match stdout().lock().write_all(format!("{line}\n").as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            remark(format_args!("error: standard output: {error}"));
            process::exit(1);
        }
        _ => {}
    }
}

/// [`note!`].
pub fn remark(line: Arguments<'_>) {
    // There is no place left to complain to.
    let _ = stderr().lock().write_all(format!("{line}\n").as_bytes());
}
