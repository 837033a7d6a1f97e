//! OpenEXR pictures of other primaries than those of displays.

use crate::common::gltf_text::{under, warns};
use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, Vec2, WritableImage,
};
use residual_scenegen::desc::{SceneDesc, Texels};

/// CIE xy of red, green, blue and white.
fn chromaticities([red, green, blue, white]: [[f32; 2]; 4]) -> Chromaticities {
    let [red, green, blue, white] = [red, green, blue, white].map(|[x, y]| Vec2(x, y));
    Chromaticities {
        red,
        green,
        blue,
        white,
    }
}

/// The only texel of a picture with these channels and chromaticities.
fn read(channels: &[(&str, f32)], given: Option<[[f32; 2]; 4]>) -> ([f32; 4], SceneDesc) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.exr");
    let channels = channels
        .iter()
        .map(|&(name, value)| AnyChannel::new(name, FlatSamples::F32(vec![value])));
    let channels = AnyChannels::sort(channels.collect());
    let attributes = LayerAttributes::named("part");
    let layer = Layer::new((1, 1), attributes, Encoding::UNCOMPRESSED, channels);
    let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions((1, 1)));
    attributes.chromaticities = given.map(chromaticities);
    Image::from_layers(attributes, vec![layer])
        .write()
        .to_file(&path)
        .unwrap();
    let scene = under(&path);
    match &scene.images[0].texels {
        Texels::RgbaF32(texels) => (texels[0], scene),
        other => panic!("{other:?}"),
    }
}

const D65: [f32; 2] = [0.3127, 0.329];
const REC_709: [[f32; 2]; 4] = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], D65];
const REC_2020: [[f32; 2]; 4] = [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], D65];
const ACES: [[f32; 2]; 4] = [
    [0.7347, 0.2653],
    [0.0, 1.0],
    [0.0001, -0.077],
    [0.32168, 0.33767],
];
const XYZ: [[f32; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]];

fn rgb([r, g, b]: [f32; 3]) -> [(&'static str, f32); 3] {
    [("R", r), ("G", g), ("B", b)]
}

#[test]
fn colours_are_converted_to_the_primaries_of_displays() {
    let color = [0.25, 0.5, 0.3];
    for (given, expected) in [
        (None, color),
        // As other programs round them.
        (Some(REC_709), color),
        (
            Some([[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.31271, 0.32902]]),
            color,
        ),
        // ITU-R BT.2087, inverse.
        (Some(REC_2020), [0.09949, 0.53283, 0.28076]),
        // CIE XYZ under D65 as it is.
        (Some(XYZ), [-0.10805, 0.70817, 0.22899]),
    ] {
        let (texel, scene) = read(&rgb(color), given);
        for (found, expected) in texel.iter().zip(expected) {
            assert!(
                (found - expected.max(0.0)).abs() < 3e-4,
                "{given:?}: {texel:?}"
            );
        }
        let is_outside = expected.iter().any(|&value| value < 0.0);
        assert_eq!(
            warns(&scene, "sky.exr", "negative"),
            is_outside,
            "{:?}",
            scene.warnings
        );
    }
    // To the bit, where nothing is converted.
    assert_eq!(read(&rgb(color), Some(REC_709)).0[..3], color);
}

#[test]
fn white_stays_white() {
    for given in [REC_709, REC_2020, ACES] {
        let (texel, _) = read(&rgb([2.0; 3]), Some(given));
        assert!(
            texel[..3].iter().all(|value| (value - 2.0).abs() < 1e-5),
            "{texel:?}"
        );
    }
}

#[test]
fn luminance_and_alpha_have_no_primaries() {
    assert_eq!(
        read(&[("Y", 0.5), ("A", 0.25)], Some(REC_2020)).0,
        [0.5, 0.5, 0.5, 0.25]
    );
    let color = [("R", 0.5), ("G", 0.5), ("B", 0.5), ("A", 0.25)];
    assert_eq!(read(&color, Some(REC_2020)).0[3], 0.25);
}

#[test]
fn luminance_is_that_of_the_primaries() {
    // Y and chroma of (0.25, 0.5, 0.3), which is CIE XYZ.
    let channels = [("RY", -0.5), ("Y", 0.5), ("BY", -0.4)];
    let (texel, _) = read(&channels, Some(XYZ));
    // There is no green beside Y.
    assert!(
        (texel[1] - 0.70817).abs() < 3e-4 && (texel[2] - 0.22899).abs() < 3e-4,
        "{texel:?}"
    );
    let (texel, _) = read(&channels, None);
    let green = (0.5 - 0.212_639 * 0.25 - 0.072_192_3 * 0.3) / 0.715_168_7;
    for (found, expected) in texel.iter().zip([0.25, green, 0.3, 1.0]) {
        assert!((found - expected).abs() < 1e-5, "{texel:?}");
    }
}

#[test]
fn chromaticities_without_sense_are_said_to_be_ignored() {
    for given in [
        [[0.0; 2]; 4],
        [[0.64, 0.33], [0.64, 0.33], [0.15, 0.06], D65],
        [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.0, 0.0]],
        [[f32::NAN; 2], [0.3, 0.6], [0.15, 0.06], D65],
    ] {
        let (texel, scene) = read(&rgb([0.25, 0.5, 0.3]), Some(given));
        assert_eq!(texel[..3], [0.25, 0.5, 0.3]);
        let message = "has chromaticities that no primaries have; those of Rec. 709 are used";
        assert!(warns(&scene, "sky.exr", message), "{:?}", scene.warnings);
    }
}

/// The sun stays bright in a picture of other primaries.
#[test]
fn infinities_are_converted_as_the_largest_numbers() {
    let (texel, _) = read(&rgb([f32::INFINITY, 0.5, 0.5]), Some(REC_2020));
    assert_eq!(texel[0], 1e30);
}
