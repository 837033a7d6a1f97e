//! The recording domain computes what the scalar domain computes, bit for bit, and leaves out what it should.

mod check;
mod common;
mod functions;
mod lights;
mod materials;
mod nodes;
mod rules;
mod tracers;
