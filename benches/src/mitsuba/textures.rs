//! Images that programs read, as textures of Mitsuba.
//!
//! Files have the numbers that programs get, linear floats, however texels are stored here. Both renderers put the first row at
//! v = 0 and the centres of texels at half-integers.

use residual_render::domain::{Buffer, Buffers, Scalar, Uint};
use residual_render::math::Vec3;
use residual_render::program::ImageNode;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, Surface, SurfaceHit};
use residual_render::texture::{
    AnyFilter, AnyWrap, ColorSource, Image, ImageParam, ScalarSource, TransformParam, UvMap,
};
use residual_render::triangle::TriangleRecord;

use super::raster::{Raster, Rasters};
use super::xml::Element;

/// The images of a material, and the files that they become.
pub(super) struct Textures<'a> {
    d: Scalar<'a>,
    /// A point of the material, whose coordinates are those that are asked for.
    surface: Surface<Scalar<'a>>,
    /// The material's parameters.
    params: &'a [u32],
    rasters: &'a mut Rasters,
}

impl<'a> Textures<'a> {
    /// Those of the material that a triangle has.
    pub(super) fn new(
        data: &'a SceneData,
        buffers: &'a Buffers<'a>,
        triangle: usize,
        rasters: &'a mut Rasters,
    ) -> Self {
        let d = Scalar::new(buffers);
        let hit = SurfaceHit {
            u: 0.25,
            v: 0.25,
            prim: Uint(triangle as u32),
        };
        let first = data.record::<TriangleRecord>(triangle).params as usize;
        Self {
            d,
            surface: Surface::new(d, Attributes::NONE, &hit, Vec3::from([0.0, 0.0, 1.0])),
            params: &data.buffer(Buffer::Params)[first..],
            rasters,
        }
    }

    /// The texture that is `factor` times an image.
    ///
    /// # Errors
    /// What of it has no counterpart.
    pub(super) fn color(
        &mut self,
        name: &str,
        factor: [f32; 3],
        image: &ImageNode,
    ) -> Result<Element, String> {
        let texels = in_coordinates_of_image(image, AnyFilter::Nearest);
        let size = self.size(image);
        let raster = Raster::of_colors(size, |x, y| {
            let surface = self.at_pixel([x, y], size);
            let color = texels.color(self.d, &surface).to_array();
            [0, 1, 2].map(|k| factor[k] * color[k])
        });
        self.bitmap(name, raster, image, image.filter)
    }

    /// The texture that is `factor` times a channel of an image.
    ///
    /// # Errors
    /// As [`color`](Self::color).
    pub(super) fn number(
        &mut self,
        name: &str,
        factor: f32,
        image: &ImageNode,
    ) -> Result<Element, String> {
        let texels = in_coordinates_of_image(image, AnyFilter::Nearest);
        let size = self.size(image);
        let raster = Raster::of_numbers(size, |x, y| {
            let surface = self.at_pixel([x, y], size);
            factor * texels.scalar(self.d, &surface)
        });
        self.bitmap(name, raster, image, image.filter)
    }

    /// The texture that is 1 where `factor` times a channel of an image is at least `cutoff`, and 0 elsewhere. Texels are compared
    /// after they are filtered: so is the file, in which each texel is a square of many.
    ///
    /// # Errors
    /// As [`color`](Self::color).
    pub(super) fn at_least(
        &mut self,
        name: &str,
        (factor, cutoff): (f32, f32),
        image: &ImageNode,
    ) -> Result<Element, String> {
        /// Along the side of a texel.
        const PARTS: u32 = 8;
        let filtered = in_coordinates_of_image(image, image.filter);
        let parts = match image.filter {
            AnyFilter::Nearest => 1,
            AnyFilter::Bilinear | AnyFilter::Trilinear => PARTS,
        };
        let size = self.size(image).map(|texels| parts * texels);
        let raster = Raster::of_numbers(size, |x, y| {
            let surface = self.at_pixel([x, y], size);
            let is_there = cutoff <= factor * filtered.scalar(self.d, &surface);
            f32::from(u8::from(is_there))
        });
        self.bitmap(name, raster, image, AnyFilter::Nearest)
    }

    /// A point of the material.
    pub(super) fn point(&self) -> (Scalar<'a>, Surface<Scalar<'a>>) {
        (self.d, self.surface)
    }

    /// The point whose coordinates are the middle of a pixel of an image of that size.
    fn at_pixel(&self, pixel: [u32; 2], size: [u32; 2]) -> Surface<Scalar<'a>> {
        let uv = [0, 1].map(|axis| ((f64::from(pixel[axis]) + 0.5) / f64::from(size[axis])) as f32);
        Surface {
            uv: [uv; 2],
            ..self.surface
        }
    }

    fn size(&self, image: &ImageNode) -> [u32; 2] {
        let ImageParam { width, height, .. } =
            BufferRecord::from_words(&self.params[image.slot as usize..]);
        [width, height]
    }

    fn bitmap(
        &mut self,
        name: &str,
        raster: Raster,
        image: &ImageNode,
        filter: AnyFilter,
    ) -> Result<Element, String> {
        let wrap = match image.wrap {
            (AnyWrap::Repeat, AnyWrap::Repeat) => "repeat",
            (AnyWrap::MirroredRepeat, AnyWrap::MirroredRepeat) => "mirror",
            (AnyWrap::Clamp, AnyWrap::Clamp) => "clamp",
            _ => return Err("an image that ends in different ways, or in a border".to_owned()),
        };
        let filter = match (image.filter, filter) {
            (AnyFilter::Trilinear, _) => return Err("a filtered texture".to_owned()),
            (_, AnyFilter::Nearest) => "nearest",
            (_, AnyFilter::Bilinear | AnyFilter::Trilinear) => "bilinear",
        };
        let transform = image.uv.transform.map(|offset| {
            let transform: TransformParam =
                BufferRecord::from_words(&self.params[offset as usize..]);
            let rows = [transform.u, transform.v].map(|row| row.to_array());
            Element::matrix("to_uv", [rows[0], rows[1], [0.0, 0.0, 1.0]])
        });
        // Raw, so that numbers are left as they are.
        Ok(Element::plugin("texture", "bitmap")
            .attribute("name", name)
            .string("filename", &self.rasters.file(raster))
            .enabled("raw")
            .string("wrap_mode", wrap)
            .string("filter_type", filter)
            .children(transform))
    }
}

/// The image as it is over its own coordinates.
fn in_coordinates_of_image(image: &ImageNode, filter: AnyFilter) -> ImageNode {
    Image {
        uv: UvMap {
            set: 0,
            transform: None,
        },
        filter,
        ..*image
    }
}
