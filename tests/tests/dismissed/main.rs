//! What changes nothing is recognised, named, and not in the renderer nor among its data; and the picture is the one
//! that a renderer with it would make.

mod cases;
mod files;
mod sheets;
mod textures;
