//! The golden files, compiled and run: each renders its tiny scene with the same bits as the interpreter.
//! `golden_texts.rs` says how they are written.

use std::collections::BTreeSet;

use residual_device_cpu::TileRenderer;
use residual_tests::pictures::{first_difference, mean};
use residual_tests::tiny::{self, SIZE};
use residual_tests::{Look, Prepared};

/// A golden file as a module.
struct Golden {
    name: &'static str,
    structure: u64,
    renderer: &'static (dyn TileRenderer + Sync),
}

macro_rules! goldens {
    ($($name:ident)*) => {
        #[path = "../golden"]
        #[allow(dead_code, unreachable_pub, reason = "they are emitted for any use")]
        #[deny(unused_imports, reason = "what a scene does not need is not imported")]
        mod golden {
            $(pub mod $name;)*
        }

        const GOLDENS: &[Golden] = &[$(Golden {
            name: stringify!($name),
            structure: golden::$name::Scene::STRUCTURE,
            renderer: &golden::$name::Compiled,
        },)*];
    };
}

goldens! {
    alpha_blending
    alpha_mask
    border_wrap
    brushed_metal
    bumpy_coat
    car_paint
    checkerboard
    clamp_wrap
    coated_emission
    constants
    culling
    depth_of_field
    diffuse_and_mirror
    diffuse_and_phong
    directional_light
    drink
    emission
    environment
    film_thickness
    float_texels
    dielectric_coat
    frosted_glass
    frosted_pane
    half_texels
    independent_sampler
    light_by_solid_angle
    light_tree
    linear_texels
    masked_emission
    matte
    metal
    milk
    mirror
    mipmaps
    mirror_wrap
    mixed_metal
    motion_blur
    nearest_filter
    normal_map
    odd_names
    orthographic_camera
    panorama
    clay
    paper
    phong
    prism
    second_uv_set
    smooth_normals
    smooth_coat
    soap_film
    solid_glass
    specular_texture
    spherical_point
    spherical_spot
    spot_light
    sun
    texture
    texture_transform
    textured_emission
    thin_glass
    tinted_glass
    tinted_prism
    velvet
    vertex_colors
}

#[test]
fn golden_renderers_give_the_interpreters_bits() {
    let scenes = tiny::all();
    assert_eq!(scenes.len(), GOLDENS.len());
    let look = Look {
        max_depth: 5,
        ..Look::new(SIZE, 4)
    };
    let mut pictures = BTreeSet::new();
    for tiny in scenes {
        let golden = GOLDENS.iter().find(|golden| golden.name == tiny.name);
        let golden = golden.unwrap_or_else(|| panic!("add {} to the list", tiny.name));
        let plan = tiny.plan();
        plan.check_structure(golden.structure)
            .unwrap_or_else(|error| panic!("{}: {error}", tiny.name));
        let prepared = Prepared::new(&plan, residual_device_cpu::LaneCount::Eight);
        let expected = prepared.interpret(&look).image();
        let image = prepared.render(golden.renderer, &look).image();
        assert_eq!(first_difference(&expected, &image), None, "{}", tiny.name);

        let bits: Vec<_> = image.iter().map(|rgb| rgb.map(f32::to_bits)).collect();
        let shades: BTreeSet<_> = bits.iter().collect();
        assert!(shades.len() > 20, "{}: {} shades", tiny.name, shades.len());
        assert!(mean(&image).iter().all(|c| *c > 0.0), "{}", tiny.name);
        // Each scene looks different: what it is named after matters. Names of materials do not.
        let known = pictures.insert(bits);
        assert_eq!(known, tiny.name != "odd_names", "{}", tiny.name);
    }
}
