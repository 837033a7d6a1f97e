//! Images of every kind, by the values that the scene gets of them.

use crate::common;
use crate::common::gltf_text::{Gltf, under, warns};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, Vec2, WritableImage, f16,
};
use residual_render::domain::Buffer;
use residual_render::texture::srgb_decoded;
use residual_scenegen::desc::{SceneDesc, Texels};
use residual_scenegen::plan::{PlanOptions, plan};
use serde_json::json;

fn floats(scene: &SceneDesc) -> &[[f32; 4]] {
    match &scene.images[0].texels {
        Texels::RgbaF32(texels) => texels,
        Texels::Rgba8(_) | Texels::Rgba16(_) => panic!("floats"),
    }
}

/// A square whose material reads a PNG as a colour and as a number.
fn with_png(png: &image::DynamicImage) -> SceneDesc {
    let mut bytes = std::io::Cursor::new(Vec::new());
    png.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let mut gltf = Gltf::square();
    gltf.attribute(
        "TEXCOORD_0",
        "VEC2",
        common::gltf_text::F32,
        &common::gltf_text::f32_bytes(&[0.0; 8]),
        4,
    );
    let view = gltf.view(bytes.get_ref());
    gltf.json["images"] = json!([{ "bufferView": view, "mimeType": "image/png" }]);
    gltf.json["textures"] = json!([{ "source": 0 }]);
    gltf.json["materials"] = json!([{
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0 },
            "metallicRoughnessTexture": { "index": 0 },
        },
    }]);
    gltf.primitive()["material"] = json!(0);
    gltf.import().unwrap()
}

#[test]
fn pngs_of_16_bits_keep_them() {
    let codes = [385_u16, 1, 65535, 32768];
    let texels = |pixels: image::DynamicImage| match with_png(&pixels).images.remove(0).texels {
        Texels::Rgba16(texels) => texels,
        other => panic!("{other:?}"),
    };
    let rgba = image::ImageBuffer::from_pixel(2, 1, image::Rgba(codes));
    assert_eq!(texels(rgba.into()), [codes; 2]);
    let rgb = image::ImageBuffer::from_pixel(1, 1, image::Rgb([385_u16, 1, 2]));
    assert_eq!(texels(rgb.into()), [[385, 1, 2, 65535]]);
    let gray = image::ImageBuffer::from_pixel(1, 1, image::LumaA([385_u16, 7]));
    assert_eq!(texels(gray.into()), [[385, 385, 385, 7]]);
    // Bytes written as 16 bits are bytes.
    let bytes = image::ImageBuffer::from_pixel(1, 1, image::Rgba([257_u16, 0, 65535, 32896]));
    let scene = with_png(&bytes.into());
    assert!(
        matches!(&scene.images[0].texels, Texels::Rgba8(texels) if texels[..] == [[1, 0, 255, 128]])
    );
}

/// Colours are decoded from sRGB, numbers are not, though both read the same image.
#[test]
fn codes_of_16_bits_are_read_by_their_use() {
    let pixels = [[385_u16, 2000, 40000, 65535], [65535, 300, 5, 30000]];
    let image = image::ImageBuffer::from_fn(2, 1, |x, _| image::Rgba(pixels[x as usize]));
    let scene = with_png(&image.into());
    let plan = plan(&scene, &PlanOptions::default()).unwrap();
    let texels: Vec<f32> = plan
        .data
        .buffer(Buffer::Texels)
        .iter()
        .map(|&word| f32::from_bits(word))
        .collect();
    let linear = pixels.map(|texel| texel.map(|code| f32::from(code) / 65535.0));
    let decoded = linear.map(|[r, g, b, a]| {
        let [r, g, b] = [r, g, b].map(|c| srgb_decoded(f64::from(c)) as f32);
        [r, g, b, a]
    });
    let (as_color, as_number) = texels.split_at(8);
    for (found, expected) in [(as_color, decoded), (as_number, linear)] {
        for (found, expected) in found.iter().zip(expected.as_flattened()) {
            assert!(
                (found - expected).abs() <= 1e-7 * expected,
                "{found} {expected}"
            );
        }
    }
}

#[test]
fn skies_of_16_bits_are_decoded_from_srgb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.png");
    image::ImageBuffer::from_pixel(2, 1, image::Rgb([385_u16, 0, 65535]))
        .save(&path)
        .unwrap();
    let scene = under(&path);
    let [red, green, blue, alpha] = floats(&scene)[0];
    assert!((red / (385.0 / 65535.0 / 12.92) - 1.0).abs() < 1e-6);
    assert_eq!([green, blue, alpha], [0.0, 1.0, 1.0]);
}

const SIZE: Vec2<usize> = Vec2(2, 1);

fn channel(name: &str, values: [f32; 2]) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, FlatSamples::F32(values.to_vec()))
}

fn layer(name: &str, channels: Vec<AnyChannel<FlatSamples>>) -> Layer<AnyChannels<FlatSamples>> {
    let attributes = LayerAttributes::named(name);
    let channels = AnyChannels::sort(channels.into());
    Layer::new(SIZE, attributes, Encoding::FAST_LOSSLESS, channels)
}

fn import_exr(
    window: IntegerBounds,
    layers: Vec<Layer<AnyChannels<FlatSamples>>>,
) -> (Vec<[f32; 4]>, SceneDesc) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.exr");
    let image = Image::from_layers(ImageAttributes::new(window), layers);
    image.write().to_file(&path).unwrap();
    let scene = under(&path);
    (floats(&scene).to_vec(), scene)
}

fn whole() -> IntegerBounds {
    IntegerBounds::from_dimensions(SIZE)
}

#[test]
fn the_picture_is_found_among_layers_and_channels() {
    let rgb = |prefix: &str, red: f32| {
        ["R", "G", "B"]
            .map(|end| channel(&format!("{prefix}{end}"), [red, 2.0 * red]))
            .to_vec()
    };
    let depth = || channel("Z", [100.0; 2]);
    // Parts in order; the red of the first texel, its alpha, and what is said.
    let cases: Vec<(Vec<Vec<AnyChannel<FlatSamples>>>, f32, f32, &str)> = vec![
        (vec![rgb("", 3.0)], 3.0, 1.0, ""),
        (
            vec![[rgb("", 3.0), vec![channel("A", [0.25; 2]), depth()]].concat()],
            3.0,
            0.25,
            "",
        ),
        (vec![vec![channel("Y", [3.0, 6.0])]], 3.0, 1.0, ""),
        (
            vec![vec![
                channel("Y", [3.0, 6.0]),
                channel("A", [0.5; 2]),
                depth(),
            ]],
            3.0,
            0.5,
            "",
        ),
        (
            vec![rgb("diffuse.", 3.0)],
            3.0,
            1.0,
            "\"part0 diffuse\" is read",
        ),
        (
            vec![
                [
                    rgb("albedo.", 7.0),
                    rgb("View Layer.Combined.", 3.0),
                    vec![depth()],
                ]
                .concat(),
            ],
            3.0,
            1.0,
            "Combined\" is read",
        ),
        (
            vec![[rgb("albedo.", 7.0), rgb("", 3.0)].concat()],
            3.0,
            1.0,
            "",
        ),
        // Several parts.
        (vec![vec![depth()], rgb("", 3.0)], 3.0, 1.0, ""),
        (
            vec![rgb("", 3.0), rgb("", 7.0)],
            3.0,
            1.0,
            "\"part0\" is read",
        ),
        (
            vec![vec![channel("Y", [7.0; 2])], rgb("", 3.0)],
            3.0,
            1.0,
            "",
        ),
        (
            vec![vec![channel("R", [3.0, 6.0])]],
            3.0,
            1.0,
            "only channel, R, is taken as grey",
        ),
        (
            vec![vec![channel("mask", [3.0, 6.0])]],
            3.0,
            1.0,
            "only channel, mask",
        ),
        (
            vec![vec![
                channel("red", [3.0, 6.0]),
                channel("green", [3.0; 2]),
                channel("blue", [3.0; 2]),
            ]],
            3.0,
            1.0,
            "",
        ),
    ];
    for (k, (parts, red, alpha, message)) in cases.into_iter().enumerate() {
        let parts = (0..).zip(parts);
        let parts = parts.map(|(k, channels)| layer(&format!("part{k}"), channels));
        let (texels, scene) = import_exr(whole(), parts.collect());
        assert_eq!(texels[0], [red, red, red, alpha], "{k}");
        assert_eq!(texels[1][0], 2.0 * red, "{k}");
        assert_eq!(
            warns(&scene, "sky.exr", message),
            !message.is_empty(),
            "{k}: {:?}",
            scene.warnings
        );
    }
}

#[test]
fn pixels_lie_where_the_data_window_says() {
    let of_red = |window: IntegerBounds, position: Vec2<i32>| {
        let mut part = layer(
            "part",
            ["R", "G", "B"]
                .map(|name| channel(name, [1.0, 2.0]))
                .to_vec(),
        );
        part.attributes.layer_position = position;
        let (texels, scene) = import_exr(window, vec![part]);
        let size = (scene.images[0].width, scene.images[0].height);
        let reds: Vec<f32> = texels.iter().map(|texel| texel[0]).collect();
        assert!(texels.iter().all(|texel| texel[3] == 1.0));
        (size, reds, warns(&scene, "sky.exr", "display window"))
    };
    let window = |x, y, width, height| IntegerBounds::new((x, y), (width, height));
    // A crop of four by two.
    let cropped = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0].to_vec();
    assert_eq!(
        of_red(window(0, 0, 4, 2), Vec2(1, 1)),
        ((4, 2), cropped.clone(), false)
    );
    assert_eq!(
        of_red(window(-10, 20, 4, 2), Vec2(-9, 21)),
        ((4, 2), cropped, false)
    );
    // Overscan is cut off.
    assert_eq!(
        of_red(window(0, 0, 1, 1), Vec2(-1, 0)),
        ((1, 1), vec![2.0], false)
    );
    assert_eq!(
        of_red(window(0, 0, 2, 1), Vec2(1, 0)),
        ((2, 1), vec![0.0, 1.0], false)
    );
    // A window that shows nothing is a mistake.
    assert_eq!(
        of_red(window(0, 0, 4, 2), Vec2(50, 0)),
        ((2, 1), vec![1.0, 2.0], true)
    );
}

#[test]
fn halves_integers_and_infinities() {
    let rgb = |samples: FlatSamples| {
        let channels = ["R", "G", "B"].map(|name| AnyChannel::new(name, samples.clone()));
        import_exr(whole(), vec![layer("part", channels.to_vec())])
    };
    let half = |values: [f32; 2]| FlatSamples::F16(values.map(f16::from_f32).to_vec());
    let (texels, scene) = rgb(half([0.5, 7.25]));
    assert_eq!((texels[0][0], texels[1][0]), (0.5, 7.25));
    assert!(!warns(&scene, "sky.exr", ""));
    let (texels, _) = rgb(FlatSamples::U32(vec![3, 70_000]));
    assert_eq!((texels[0][0], texels[1][0]), (3.0, 70_000.0));
    // The sun in a picture of halves.
    let (texels, scene) = rgb(half([f32::INFINITY, -1.0]));
    assert_eq!((texels[0][0], texels[1][0]), (65504.0, 0.0));
    assert!(warns(
        &scene,
        "sky.exr",
        "1 texels have infinite or too large values; 65504 is used"
    ));
    assert!(warns(
        &scene,
        "sky.exr",
        "1 texels have NaN or negative values; 0 is used"
    ));
    let (texels, _) = rgb(FlatSamples::F32(vec![f32::INFINITY, f32::NAN]));
    assert_eq!((texels[0][0], texels[1][0]), (1e30, 0.0));
}

#[test]
fn radiance_pictures_are_read_whoever_wrote_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.hdr");
    for (header, expected) in [
        ("#?RADIANCE\n\n-Y 1 +X 2\n", [64.0, 128.0]),
        ("#?RGBE\nGAMMA=2.2\nEXPOSURE=4\n\n-Y 1 +X 2\n", [16.0, 32.0]),
        ("#?RGBE\n\n-Y 1 -X 2\n", [128.0, 64.0]),
        ("FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n", [64.0, 128.0]),
    ] {
        let mut bytes = header.as_bytes().to_vec();
        bytes.extend([64, 0, 0, 136, 128, 0, 0, 136]);
        std::fs::write(&path, bytes).unwrap();
        let scene = under(&path);
        assert_eq!(
            floats(&scene).iter().map(|t| t[0]).collect::<Vec<_>>(),
            expected
        );
        assert_eq!(warns(&scene, "sky.hdr", "GAMMA"), header.contains("GAMMA"));
        assert_eq!(
            warns(&scene, "sky.hdr", "lacks its first line"),
            !header.starts_with("#?")
        );
    }
}
