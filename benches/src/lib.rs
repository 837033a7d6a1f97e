//! Benchmarks of ray queries, our kernels beside Embree and obvhs on the same rays; of whole renders ([`render`]); of
//! shading ([`shading`]); of compiling ([`compile`]). And the size of our code ([`code_size`]).
//!
//! ```text
//! scene file ─ scene ─ rays ─▶ one RaySet per kind ─┐
//!                   └─ builds ─▶ contenders ────────┴─ measure (rounds, all contenders in turn) ─ report
//! ```
//!
//! [`run::traversal`] is the whole of it: `cargo xtask bench traversal` prints what it returns ([`command`]). Times are CPU times of
//! one pinned thread. Every round runs all contenders once, so that a ratio is taken between neighbours in time.

pub mod code_size;
pub mod command;
pub mod compile;
pub mod contender;
pub mod coverage;
pub mod efficiency;
pub mod embree;
pub mod halstead;
pub mod isa;
pub mod measure;
pub mod mesh;
pub mod mitsuba;
pub mod ours;
pub mod peers;
pub mod rays;
pub mod recorded;
pub mod reference;
pub mod render;
pub mod report;
pub mod run;
pub mod scene;
pub mod shading;
