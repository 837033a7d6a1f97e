//! What accuracy costs in time: `cargo xtask accuracy`.
//!
//! A scene is rendered in many [`configuration`]s, round by round, each round with one seed that all configurations share. What each
//! run has reached after 1, 2, 4, … samples is compared with a [`reference`](mod@reference) of other seeds, and written to a [`journal`]
//! at once, so that a study that was stopped goes on where it was. [`findings`] are what the measurements say, and the [`report`]
//! shows them.
//!
//! ```text
//! configurations ─ prepared ─ measure ─ journal ─ findings ─ report.html, .csv, .svg
//!                  reference ┘  probe ┘
//! ```

mod command;
pub mod configuration;
pub mod findings;
pub mod journal;
pub mod measure;
pub mod prepared;
pub mod probe;
pub mod provenance;
pub mod reference;
pub mod report;
pub mod study;

pub use command::main;
