//! The environment as Mitsuba's `envmap`.
//!
//! There, the image's left edge is at −Z and u grows towards +X; here it is at −X and grows towards −Z, which is the same turned by
//! a quarter about +Y. There, the first and the last row are at the poles; here half a row lies beyond each. So the file has a row
//! in the middle and at the edges of each of ours, between which both are linear.

use residual_render::domain::{Scalar, Uint};
use residual_render::light::EnvironmentHeader;
use residual_render::scene_data::SceneData;
use residual_render::texture::{LinearFloat, TexelFormat};

use super::raster::{Raster, Rasters};
use super::xml::Element;

/// The environment that the data have.
pub(super) fn environment(data: &SceneData, rasters: &mut Rasters) -> Element {
    let header: EnvironmentHeader = data.record(0);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let texel = |x: u32, y: u32| {
        let word = header.first_texel + (y * header.width + x) * LinearFloat.words();
        LinearFloat.color(d, Uint(word)).to_array()
    };
    if [header.width, header.height] == [1, 1] {
        let radiance = texel(0, 0).map(|c| header.strength * c);
        return Element::plugin("emitter", "constant").rgb("radiance", radiance);
    }
    let raster = Raster::of_colors([header.width, 2 * header.height + 1], |x, row| {
        let above = texel(x, row.saturating_sub(1) / 2);
        let below = texel(x, (row / 2).min(header.height - 1));
        [0, 1, 2].map(|k| 0.5 * (above[k] + below[k]))
    });
    let turn = header.sin.atan2(header.cos).to_degrees() + 90.0;
    let rotation = Element::new("rotate")
        .attribute("y", 1)
        .attribute("angle", turn);
    let to_world = Element::new("transform")
        .attribute("name", "to_world")
        .child(rotation);
    Element::plugin("emitter", "envmap")
        .string("filename", &rasters.file(raster))
        .float("scale", header.strength)
        .child(to_world)
}
