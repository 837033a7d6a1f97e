//! Motion blur: what an open shutter shows of what moves, beside closed forms and beside pictures of its moments.

mod file;
mod moments;
mod ramps;
mod same_motion;
mod shared;
