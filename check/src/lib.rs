//! What continuous integration checks of the workspace, but for its tests: `cargo xtask check`.
//!
//! Cargo and Python check formatting, lints, documentation and generated files. The rest is checked here: which crate may
//! depend on which ([`crates`]), that files of a crate do not depend on each other in a circle ([`files`]), how long they are
//! ([`sizes`]), where unsafe code may be ([`unsafe_code`]), and that no test is where cargo runs none ([`idle_tests`]). Every
//! check answers with [`problem::Problem`]s.

mod command;
pub mod crates;
mod external;
mod figures;
pub mod files;
pub mod idle_tests;
pub mod problem;
pub mod sizes;
mod sources;
mod step;
pub mod unsafe_code;
pub mod workspace;

pub use command::main;
