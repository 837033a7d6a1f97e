//! Time to error: what a renderer's images of so many samples cost in CPU seconds, and how wrong they are; ours and a peer's.
//!
//! ```text
//! Contender (ours | a peer's sampler) ─ rounds: all in turn ─▶ Series ─┬─ Pool: error of each image ─▶ Row ─▶ table, JSON
//!                                                                      └─ Agreement: converged means
//! ```
//!
//! A renderer's images are compared with its own converged image, so that what two renderers make of a material does not count.
//! Efficiency is 1 ÷ (relative mean squared error × CPU seconds) (Pharr et al., *Physically Based Rendering*, 2.2): it does
//! not depend on the number of samples as long as the error falls with it.

mod agreement;
mod contender;
mod ours;
mod peer;
mod pool;
mod row;

pub use agreement::Agreement;
pub use contender::{Contender, Label, Rendered, Run, Series, rounds};
pub use ours::Residual;
pub use peer::{Hello, Peer, PeerSampler, Started};
pub use pool::Pool;
pub use row::{Row, rows, table};
