//! Tests of the queries and of the hierarchies they run on. Names such as I-01 are those of the
//! catalogue of hard numerical cases.

mod agreement;
mod compact;
mod cost;
mod dispatched;
mod instanced_scene;
mod instances;
mod integers;
mod kernels;
mod mesh;
mod oracle;
mod quantized;
mod random;
mod refit;
mod robustness;
mod runner;
mod serial;
mod streams;
mod structure;
mod tally;
mod watertight;
