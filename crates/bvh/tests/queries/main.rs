//! Tests of the queries and of the hierarchies they run on. Names such as I-01 are those of the
//! catalogue of hard numerical cases.

mod agreement;
mod integers;
mod kernels;
mod mesh;
mod oracle;
mod robustness;
mod runner;
mod structure;
mod watertight;
