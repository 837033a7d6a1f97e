//! From a file to a scene and its plan, one topic a file: what formats say, what exporters write, and what is wrong with files.

mod common;

mod area_lights;
mod compressed;
mod environment;
mod geometry;
mod gltf_faults;
mod images;
mod jpeg;
mod malformed;
mod materials;
mod models;
mod moments;
mod mtl;
mod mtl_energy;
mod mtl_extremes;
mod mtl_maps;
mod mtl_transparency;
mod obj;
mod obj_code_pages;
mod obj_faults;
mod obj_files;
mod obj_writers;
mod openexr_colors;
mod plan_camera;
mod poses;
mod scene;
mod uris;
mod validate;
