//! glTF materials, textures and images, feature by feature.
//!
//! Longer than 400 lines: one test for each feature, which read as a table.

use std::f32::consts::FRAC_PI_2;

use crate::common::gltf_text::{Gltf, U8, warns};
use residual_scenegen::desc::{
    AlphaMode, Filter, MaterialDesc, MetallicRoughness, ScalarInput, Scattering, SurfaceDesc,
    Texels, Wrap,
};
use residual_scenegen::effects::Effect;
use residual_scenegen::import::{ImportError, ImportOptions};
use serde_json::{Value, json};

fn square_with(material: Value) -> Gltf {
    let mut gltf = Gltf::square();
    gltf.floats("TEXCOORD_0", "VEC2", &[0.; 8]);
    gltf.floats("TEXCOORD_1", "VEC2", &[0.; 8]);
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf.json["materials"] = json!([material]);
    gltf.primitive()["material"] = json!(0);
    gltf.json["textures"] = json!([{ "source": 0 }, { "source": 0, "sampler": 0 }]);
    gltf.json["samplers"] = json!([{ "magFilter": 9728, "wrapS": 33071, "wrapT": 33648 }]);
    let mut png = Vec::new();
    let pixel = image::RgbaImage::from_pixel(1, 1, image::Rgba([10, 20, 30, 40]));
    pixel
        .write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png)
        .unwrap();
    let view = gltf.view(&png);
    gltf.json["images"] = json!([{ "bufferView": view, "mimeType": "image/png" }]);
    gltf
}

fn surface(material: &MaterialDesc) -> &MetallicRoughness {
    match &material.surface {
        SurfaceDesc::MetallicRoughness(surface) => surface,
        other => panic!("{other:?}"),
    }
}

#[test]
fn defaults_are_those_of_the_specification() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    let scene = gltf.import().unwrap();
    let material = &scene.materials[0];
    let surface = surface(material);
    assert_eq!(surface.base_color.factor, [1.0; 3]);
    assert_eq!(
        (
            surface.metallic.factor,
            surface.roughness.factor,
            surface.ior
        ),
        (1.0, 1.0, 1.5)
    );
    assert_eq!(
        (surface.specular.factor, surface.specular_color.factor),
        (1.0, [1.0; 3])
    );
    assert_eq!((surface.transmission.factor, surface.solid), (0.0, false));
    assert_eq!(
        (material.alpha_mode, material.double_sided),
        (AlphaMode::Opaque, false)
    );
    assert_eq!(material.emission.factor, [0.0; 3]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn material_extensions_and_textures_are_read() {
    let scene = square_with(json!({
        "name": "all",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.1, 0.2, 0.3, 0.4],
            "baseColorTexture": { "index": 1 },
            "metallicFactor": 0.5,
            "metallicRoughnessTexture": { "index": 0, "texCoord": 1 },
        },
        "emissiveFactor": [0.5, 0, 0],
        "alphaMode": "MASK",
        "alphaCutoff": 0.25,
        "doubleSided": true,
        "extensions": {
            "KHR_materials_emissive_strength": { "emissiveStrength": 8 },
            "KHR_materials_ior": { "ior": 0 },
            "KHR_materials_specular": {
                "specularFactor": 0.5, "specularTexture": { "index": 0 },
                "specularColorFactor": [1, 2, 3], "specularColorTexture": { "index": 0 },
            },
            "KHR_materials_transmission": { "transmissionFactor": 0.75, "transmissionTexture": { "index": 0 } },
            "KHR_materials_volume": {
                "thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 1],
            },
        },
    }))
    .import()
    .unwrap();
    let material = &scene.materials[0];
    let surface = surface(material);
    assert_eq!(surface.base_color.factor, [0.1, 0.2, 0.3]);
    assert_eq!(material.alpha.factor, 0.4);
    assert_eq!(
        material.alpha.texture.as_ref().map(|(_, channel)| *channel),
        Some(3)
    );
    assert_eq!(
        material.alpha.texture.as_ref().map(|(texture, _)| texture),
        surface.base_color.texture.as_ref()
    );
    let channels = [
        &surface.metallic,
        &surface.roughness,
        &surface.specular,
        &surface.transmission,
    ]
    .map(|input| input.texture.as_ref().unwrap().1);
    assert_eq!(channels, [2, 1, 3, 0]);
    assert_eq!(surface.metallic.texture.as_ref().unwrap().0.uv_set, 1);
    assert_eq!(
        (
            surface.ior,
            surface.specular.factor,
            surface.transmission.factor
        ),
        (0.0, 0.5, 0.75)
    );
    assert_eq!(surface.specular_color.factor, [1., 2., 3.]);
    assert!(surface.solid && material.double_sided);
    assert_eq!(material.emission.factor, [4., 0., 0.]);
    assert_eq!(material.alpha_mode, AlphaMode::Mask(0.25));
    assert!(surface.attenuation.is_some());
    assert_eq!(scene.warnings, []);

    assert_eq!(scene.images.len(), 1, "decoded once");
    let Texels::Rgba8(texels) = &scene.images[0].texels else {
        panic!("8 bits")
    };
    assert_eq!(texels, &[[10, 20, 30, 40]]);
    let base = &scene.textures[surface.base_color.texture.as_ref().unwrap().texture];
    assert_eq!(
        (base.wrap, base.filter),
        ([Wrap::Clamp, Wrap::Mirror], Filter::Nearest)
    );
}

#[test]
fn texture_transforms_turn_scale_and_shift() {
    let transform =
        json!({ "offset": [0.5, 0.25], "rotation": FRAC_PI_2, "scale": [2, 3], "texCoord": 1 });
    let extensions = json!({ "KHR_texture_transform": transform });
    let scene = square_with(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "extensions": extensions } },
        "normalTexture": { "index": 0, "scale": 0.5, "extensions": extensions },
    }))
    .import()
    .unwrap();
    let material = &scene.materials[0];
    let normal_map = material.normal_map.as_ref().unwrap();
    assert_eq!(normal_map.scale, 0.5);
    for texture in [
        surface(material).base_color.texture.as_ref().unwrap(),
        &normal_map.texture,
    ] {
        assert_eq!(texture.uv_set, 1);
        let expected = [[0., 3., 0.5], [-2., 0., 0.25]];
        for (row, expected) in texture.transform.unwrap().iter().zip(expected) {
            for (value, expected) in row.iter().zip(expected) {
                assert!((value - expected).abs() < 1e-6, "{:?}", texture.transform);
            }
        }
    }
}

#[test]
fn extensions_that_are_not_rendered_are_named_with_their_material() {
    let scene = square_with(json!({
        "name": "paint",
        "extensions": {
            "KHR_materials_volume_scatter": { "multiscatterColor": [1, 1, 1] },
            "KHR_materials_sheen": { "sheenColorFactor": [0, 0, 0] },
            "KHR_materials_iridescence": {},
            "ACME_glitter": {},
        },
    }))
    .import()
    .unwrap();
    assert!(warns(&scene, "materials/0 \"paint\"", "ACME_glitter"));
    assert_eq!(
        scene.warnings.len(),
        1,
        "those without effect are not mentioned: {:?}",
        scene.warnings
    );

    let gltf = square_with(json!({ "extensions": { "ACME_glitter": {} } }));
    match gltf.import_with(&ImportOptions {
        strict: true,
        ..ImportOptions::default()
    }) {
        Err(ImportError::Strict { warnings, .. }) => assert_eq!(warnings.len(), 1),
        other => panic!("{other:?}"),
    }
}

#[test]
fn layers_are_read() {
    let texture = |index| json!({ "index": 0, "texCoord": index });
    let scene = square_with(json!({ "extensions": {
        "KHR_materials_clearcoat": {
            "clearcoatFactor": 0.5,
            "clearcoatTexture": texture(1),
            "clearcoatRoughnessFactor": 0.25,
            "clearcoatRoughnessTexture": texture(0),
        },
        "KHR_materials_sheen": {
            "sheenColorFactor": [0.1, 0.2, 0.3],
            "sheenColorTexture": texture(0),
            "sheenRoughnessFactor": 0.7,
        },
        "KHR_materials_anisotropy": {
            "anisotropyStrength": 0.6,
            "anisotropyRotation": 0.5,
            "anisotropyTexture": texture(0),
        },
        "KHR_materials_iridescence": {
            "iridescenceFactor": 0.9,
            "iridescenceIor": 1.4,
            "iridescenceThicknessMinimum": 120,
            "iridescenceThicknessMaximum": 380,
            "iridescenceThicknessTexture": texture(0),
        },
        "KHR_materials_diffuse_roughness": {
            "diffuseRoughnessFactor": 0.8,
            "diffuseRoughnessTexture": texture(0),
        },
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.3,
            "diffuseTransmissionTexture": texture(0),
            "diffuseTransmissionColorFactor": [0.9, 0.8, 0.7],
        },
    }}))
    .import()
    .unwrap();
    let surface = surface(&scene.materials[0]);
    let channel = |input: &ScalarInput| input.texture.as_ref().map(|(_, channel)| *channel);
    assert_eq!(
        [
            &surface.clearcoat,
            &surface.clearcoat_roughness,
            &surface.sheen_roughness,
            &surface.anisotropy,
            &surface.iridescence,
            &surface.iridescence_thickness,
            &surface.diffuse_transmission,
            &surface.diffuse_roughness,
        ]
        .map(|input| (input.factor, channel(input))),
        [
            (0.5, Some(0)),
            (0.25, Some(1)),
            (0.7, None),
            (0.6, Some(2)),
            (0.9, None),
            (380.0, Some(1)),
            (0.3, Some(3)),
            (0.8, Some(0)),
        ]
    );
    assert_eq!(surface.clearcoat.texture.as_ref().unwrap().0.uv_set, 1);
    assert_eq!(
        (surface.anisotropy_rotation, surface.iridescence_ior),
        (0.5, 1.4)
    );
    assert_eq!(surface.iridescence_minimum, 120.0);
    assert_eq!(surface.sheen_color.factor, [0.1, 0.2, 0.3]);
    assert!(surface.sheen_color.texture.is_some());
    assert_eq!(surface.diffuse_transmission_color.factor, [0.9, 0.8, 0.7]);
    // An anisotropic surface needs tangents.
    assert!(scene.meshes[0].tangents.is_some());
    // One of them is a draft.
    let warnings: Vec<_> = scene
        .warnings
        .iter()
        .map(|warning| &warning.message)
        .collect();
    assert!(
        warnings.len() == 1 && warnings[0].starts_with("KHR_materials_diffuse_roughness"),
        "{warnings:?}"
    );
}

#[test]
fn layers_that_make_no_sense_cost_themselves_alone() {
    let scene = square_with(json!({ "extensions": {
        "KHR_materials_clearcoat": { "clearcoatFactor": "much", "clearcoatRoughnessFactor": -1 },
        "KHR_materials_sheen": { "sheenColorFactor": [1, 2] },
        "KHR_materials_iridescence": { "iridescenceFactor": 1e30, "iridescenceIor": 0.5 },
    }}))
    .import()
    .unwrap();
    let surface = surface(&scene.materials[0]);
    assert_eq!(
        (
            surface.clearcoat.factor,
            surface.clearcoat_roughness.factor,
            surface.iridescence.factor,
            surface.iridescence_ior,
        ),
        (0.0, 0.0, 1.0, 1.0)
    );
    for message in [
        "clearcoatFactor is no number",
        "clearcoatRoughnessFactor -1 is out of range",
        "sheenColorFactor is no colour",
        "iridescenceFactor",
        "iridescenceIor 0.5 is out of range",
    ] {
        assert!(
            warns(&scene, "materials/0", message),
            "{message}: {:?}",
            scene.warnings
        );
    }
}

#[test]
fn unlit_materials_emit_their_base_colour() {
    let scene = square_with(json!({
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.5, 0.25, 1, 0.75],
            "baseColorTexture": { "index": 0 },
            "metallicRoughnessTexture": { "index": 1 },
        },
        "normalTexture": { "index": 1 },
        "emissiveFactor": [1, 1, 1],
        "alphaMode": "BLEND",
        "extensions": { "KHR_materials_unlit": {} },
    }))
    .import()
    .unwrap();
    let material = &scene.materials[0];
    assert_eq!(material.surface, SurfaceDesc::Unlit);
    assert_eq!(material.emission.factor, [0.5, 0.25, 1.0]);
    assert_eq!(material.emission.texture.as_ref().unwrap().texture, 0);
    assert_eq!(
        (material.alpha_mode, material.alpha.factor),
        (AlphaMode::Blend, 0.75)
    );
    assert!(material.normal_map.is_none() && scene.textures.len() == 1);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn specular_and_glossiness_are_metallic_roughness_with_extensions() {
    let extension = json!({ "KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.5, 0.25, 0.125, 0.75],
        "diffuseTexture": { "index": 1 },
        "specularFactor": [0.75, 0.5, 0.25],
        "glossinessFactor": 0.5,
        "specularGlossinessTexture": { "index": 0, "texCoord": 1 },
    } });
    let mut gltf = square_with(json!({
        "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1], "metallicFactor": 1 },
        "extensions": extension,
    }));
    // Whether or not the file says that it cannot do without.
    for required in [json!([]), json!(["KHR_materials_pbrSpecularGlossiness"])] {
        gltf.json["extensionsRequired"] = required;
        let scene = gltf.import().unwrap();
        let material = &scene.materials[0];
        let surface = surface(material);
        assert_eq!(surface.base_color.factor, [0.5, 0.25, 0.125]);
        assert_eq!(material.alpha.factor, 0.75);
        assert_eq!((surface.metallic.factor, surface.ior), (0.0, 0.0));
        assert_eq!(surface.specular_color.factor, [0.75, 0.5, 0.25]);
        let specular = surface.specular_color.texture.as_ref().unwrap();
        let (roughness, channel) = surface.roughness.texture.as_ref().unwrap();
        assert_eq!((specular.uv_set, roughness.uv_set), (1, 1));
        let texels = |texture: usize| match &scene.images[scene.textures[texture].image].texels {
            Texels::Rgba8(texels) => texels[0],
            other => panic!("{other:?}"),
        };
        assert_eq!(texels(specular.texture), [10, 20, 30, 40]);
        // 1 − 0.5 · 40/255.
        assert_eq!(
            (
                texels(roughness.texture)[*channel],
                surface.roughness.factor
            ),
            (235, 1.0)
        );
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
    let plain = square_with(
        json!({ "extensions": { "KHR_materials_pbrSpecularGlossiness": {
        "glossinessFactor": 0.25 } } }),
    );
    let scene = plain.import().unwrap();
    let surface = surface(&scene.materials[0]);
    assert_eq!(
        (surface.roughness.factor, surface.specular_color.factor),
        (0.75, [1.0; 3])
    );
    assert!(surface.roughness.texture.is_none());
}

#[test]
fn variants_are_shown_by_name() {
    let mut gltf = square_with(json!({ "name": "own" }));
    gltf.json["materials"] = json!([{ "name": "own" }, { "name": "red" }, { "name": "blue" }]);
    gltf.json["extensions"] = json!({ "KHR_materials_variants": { "variants": [
        { "name": "Red" }, { "name": "Deep Blue" }, { "name": "Other" },
    ] } });
    gltf.primitive()["extensions"] = json!({ "KHR_materials_variants": { "mappings": [
        { "material": 1, "variants": [0] }, { "material": 2, "variants": [1] },
    ] } });
    let import = |variant: Option<&str>| {
        gltf.import_with(&ImportOptions {
            variant: variant.map(str::to_owned),
            ..ImportOptions::default()
        })
    };
    for (variant, expected) in [
        (None, "own"),
        (Some("Red"), "red"),
        (Some("deep blue"), "blue"),
        (Some("Other"), "own"),
    ] {
        let scene = import(variant).unwrap();
        let names: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, [expected]);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
    let scene = import(None).unwrap();
    let says = |text: &str| scene.dismissed.iter().any(|d| d.reason.contains(text));
    assert!(says("\"Deep Blue\""), "{:?}", scene.dismissed);
    let message = import(Some("Green")).unwrap_err().to_string();
    assert!(message.contains("no \"Green\", but \"Red\""), "{message}");
}

#[test]
fn any_set_of_texture_coordinates_may_be_read() {
    let mut gltf = square_with(json!({
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0, "texCoord": 3 },
            "metallicRoughnessTexture": { "index": 0, "texCoord": 0 },
        },
        "emissiveFactor": [1, 1, 1],
        "emissiveTexture": { "index": 0, "texCoord": 1 },
    }));
    gltf.floats("TEXCOORD_3", "VEC2", &[0.25; 8]);
    let scene = gltf.import().unwrap();
    let material = &scene.materials[0];
    let surface = surface(material);
    let mesh = &scene.meshes[0];
    let read = |uv_set: usize| mesh.uvs[uv_set].as_ref().unwrap()[0].x;
    assert_eq!(
        read(surface.base_color.texture.as_ref().unwrap().uv_set),
        0.25
    );
    assert_eq!(
        read(surface.roughness.texture.as_ref().unwrap().0.uv_set),
        0.0
    );
    assert!(material.emission.texture.is_none());
    assert!(
        warns(&scene, "emissiveTexture", "third set"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn required_extensions_that_we_lack_are_named() {
    for extension in ["MSFT_texture_dds", "ACME_x"] {
        let mut gltf = Gltf::square();
        gltf.json["extensionsRequired"] = json!([extension]);
        gltf.refused(&[extension, "extensionsRequired"]);
    }
}

#[test]
fn missing_and_broken_images_have_stand_ins() {
    let mut gltf = square_with(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
        "normalTexture": { "index": 1 },
    }));
    gltf.json["images"] =
        json!([{ "uri": "missing.png" }, { "uri": "data:image/png;base64,AAAA", "name": "bad" }]);
    gltf.json["textures"] = json!([{ "source": 0 }, { "source": 1 }]);
    let scene = gltf.import().unwrap();
    let texel = |i: usize| match &scene.images[i].texels {
        Texels::Rgba8(texels) => texels[0],
        Texels::Rgba16(_) | Texels::RgbaF32(_) => panic!("8 bits"),
    };
    assert_eq!((texel(0), texel(1)), ([255; 4], [128, 128, 255, 255]));
    assert!(warns(&scene, "images/0", "missing.png"));
    assert!(warns(&scene, "images/1 \"bad\"", "unknown format"));
}

#[test]
fn enormous_images_are_not_decoded() {
    // A PNG header of 2³¹ − 1 squared texels, which a decoder would try to allocate.
    let mut header =
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\x06\0\0\0".to_vec();
    header.extend([0; 64]);
    let mut gltf =
        square_with(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    let view = gltf.view(&header);
    gltf.json["images"] = json!([{ "bufferView": view }]);
    let scene = gltf.import().unwrap();
    assert_eq!((scene.images[0].width, scene.images[0].height), (1, 1));
    assert!(warns(&scene, "images/0", "image"), "{:?}", scene.warnings);
}

#[test]
fn numbers_out_of_range_are_clamped_with_a_warning() {
    let scene = square_with(json!({
        "pbrMetallicRoughness": { "metallicFactor": 2, "roughnessFactor": -1 },
        "emissiveFactor": [-1, 0, 0],
        "extensions": { "KHR_materials_ior": { "ior": 0.5 } },
    }))
    .import()
    .unwrap();
    let surface = surface(&scene.materials[0]);
    assert_eq!(
        (
            surface.metallic.factor,
            surface.roughness.factor,
            surface.ior
        ),
        (1.0, 0.0, 1.5)
    );
    assert_eq!(scene.materials[0].emission.factor, [0.0; 3]);
    assert_eq!(scene.warnings.len(), 4, "{:?}", scene.warnings);
}

/// Both drafts of KHR_materials_volume_scatter, which name the colour differently; and what needs a volume and has none.
#[test]
fn bodies_that_scatter() {
    for member in ["multiscatterColor", "multiscatterColorFactor"] {
        let with = |volume: serde_json::Value| {
            let mut extensions = json!({
                "KHR_materials_transmission": { "transmissionFactor": 1 },
                "KHR_materials_volume_scatter": { "scatterAnisotropy": 0.25 },
            });
            extensions["KHR_materials_volume_scatter"][member] = json!([0.5, 0.25, 0.75]);
            extensions["KHR_materials_volume"] = volume;
            square_with(json!({ "name": "wax", "extensions": extensions }))
                .import()
                .unwrap()
        };
        let scene = with(json!({
            "thicknessFactor": 1,
            "attenuationColor": [0.5, 0.5, 0.5],
            "attenuationDistance": 0.1,
        }));
        assert_eq!(
            surface(&scene.materials[0]).scattering,
            Some(Scattering {
                multiscatter_color: [0.5, 0.25, 0.75],
                anisotropy: 0.25,
            })
        );
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        // Nothing is lost of light that goes straight on, so nothing is scattered.
        let scene = with(json!({ "thicknessFactor": 1 }));
        let effect = Some(Effect::ScatteringMedia);
        assert!(scene.dismissed.iter().any(|out| out.effect == effect));
    }
}

#[test]
fn priorities_of_bodies_are_whole_numbers_of_extras() {
    let with = |extras: serde_json::Value| {
        square_with(json!({ "name": "glass", "extras": extras }))
            .import()
            .unwrap()
    };
    for (extras, priority) in [
        (json!({ "priority": 3 }), 3),
        (json!({ "priority": -2.0 }), -2),
        (json!({ "author": "nobody" }), 0),
        (json!([1, 2]), 0),
    ] {
        let scene = with(extras);
        assert_eq!(surface(&scene.materials[0]).priority, priority);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
    for extras in [json!({ "priority": 0.5 }), json!({ "priority": "first" })] {
        let scene = with(extras);
        assert_eq!(surface(&scene.materials[0]).priority, 0);
        assert!(warns(&scene, "materials/0 \"glass\"", "priority"));
    }
}
