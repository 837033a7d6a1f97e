//! From a plan to a running renderer: compile, keep, choose the tier, and what effects cost.
//!
//! ```text
//! Plan ─┬─ compile ─ cargo ─▶ library ─ cache ─▶ LoadedRenderer ─┬─ tiers ─▶ device
//!       ├─ interpreted ──────────────────────────────────────────┤
//!       ├─ gpu (with the feature wgpu)
//!       ├─ poses: the data and the hierarchy of each moment while the shutter is open
//!       └─ standalone ─ cargo ─▶ program                         └─ price (with and without each effect)
//! ```
//!
//! It works in the workspace that it was built from ([`workspace`]): cargo builds emitted code as a member of it. The command
//! line, the benchmarks and the tests of the whole system are its users.

pub mod cache;
pub mod cargo;
pub mod compile;
mod fingerprint;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod poses;
pub mod price;
pub mod standalone;
pub mod tiers;
pub mod workspace;

pub use compile::{compile, compile_with_line_tables};
