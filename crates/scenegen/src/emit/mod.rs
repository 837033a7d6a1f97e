//! Printing of programs. The plan has decided everything; an emitter only writes it down.

pub mod wgsl;

pub use wgsl::wgsl_module;
