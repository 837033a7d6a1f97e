//! A renderer that could do more than its scene calls for gives the same bits (hard case N-07); and what a scene calls
//! for depends on whether it matters, not on how it is written down.

mod factors;
mod general;
