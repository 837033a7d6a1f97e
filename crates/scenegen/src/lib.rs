//! From a scene file to a renderer: import, effects, plan, emission.

pub mod desc;
