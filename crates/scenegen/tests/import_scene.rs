//! glTF materials, lights, cameras and nodes, feature by feature.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use common::gltf_text::{F32, Gltf, U8, f32_bytes, warns};
use glam::{Vec3, Vec3A};
use residual_scenegen::desc::{
    AlphaMode, Filter, LightKind, MaterialDesc, MetallicRoughness, Projection, SurfaceDesc, Texels,
    Wrap,
};
use residual_scenegen::import::{ImportError, ImportOptions};
use serde_json::{Value, json};

mod common;

fn square_with(material: Value) -> Gltf {
    let mut gltf = Gltf::square();
    gltf.attribute("TEXCOORD_0", "VEC2", F32, &f32_bytes(&[0.; 8]), 4);
    gltf.attribute("TEXCOORD_1", "VEC2", F32, &f32_bytes(&[0.; 8]), 4);
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
        SurfaceDesc::Phong(_) | SurfaceDesc::Dielectric { .. } => panic!("{material:?}"),
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
    assert!(warns(&scene, "materials/0 \"all\"", "attenuation"));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);

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
            "KHR_materials_clearcoat": { "clearcoatFactor": 1 },
            "KHR_materials_sheen": { "sheenColorFactor": [0, 0, 0] },
            "KHR_materials_iridescence": {},
            "ACME_glitter": {},
        },
    }))
    .import()
    .unwrap();
    assert!(warns(
        &scene,
        "materials/0 \"paint\"",
        "KHR_materials_clearcoat"
    ));
    assert!(warns(&scene, "materials/0 \"paint\"", "ACME_glitter"));
    assert_eq!(
        scene.warnings.len(),
        2,
        "those without effect are not mentioned: {:?}",
        scene.warnings
    );

    let gltf = square_with(json!({ "name": "flat", "extensions": { "KHR_materials_unlit": {} } }));
    let scene = gltf.import().unwrap();
    assert!(warns(&scene, "materials/0 \"flat\"", "KHR_materials_unlit"));
    let flat = surface(&scene.materials[0]);
    assert_eq!((flat.metallic.factor, flat.specular.factor), (0.0, 0.0));
    match gltf.import_with(&ImportOptions {
        strict: true,
        ..ImportOptions::default()
    }) {
        Err(ImportError::Strict { warnings, .. }) => assert_eq!(warnings.len(), 1),
        other => panic!("{other:?}"),
    }
}

#[test]
fn required_extensions_that_we_lack_are_named() {
    for extension in [
        "KHR_draco_mesh_compression",
        "KHR_materials_pbrSpecularGlossiness",
        "ACME_x",
    ] {
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
        Texels::RgbaF32(_) => panic!("8 bits"),
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

#[test]
fn lights_stand_in_the_world() {
    let mut gltf = Gltf::square();
    gltf.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "point", "color": [1, 0.5, 0], "intensity": 10 },
        { "type": "spot", "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.1 } },
        { "type": "directional", "intensity": -1 },
    ] } });
    let light = |i: usize| json!({ "KHR_lights_punctual": { "light": i } });
    gltf.json["nodes"] = json!([
        { "children": [1, 2, 3], "translation": [1, 2, 3], "scale": [2, 2, 2] },
        { "extensions": light(0), "translation": [1, 0, 0] },
        // Turned about +Y by 90°: −Z becomes −X.
        { "extensions": light(1), "rotation": [0, 0.707_106_77, 0, 0.707_106_77] },
        { "extensions": light(2), "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1] },
    ]);
    let scene = gltf.import().unwrap();
    assert_eq!(
        scene.lights[0].kind,
        LightKind::Point {
            position: Vec3::new(3., 2., 3.)
        }
    );
    assert_eq!(scene.lights[0].intensity, [10., 5., 0.]);
    let LightKind::Spot {
        position,
        direction,
        inner,
        outer,
    } = scene.lights[1].kind
    else {
        panic!("spot")
    };
    assert_eq!(position, Vec3::new(1., 2., 3.));
    assert!((direction + Vec3::X).length() < 1e-6);
    assert!(inner < outer && outer == 0.1);
    assert!(warns(&scene, "lights/1", "innerConeAngle"));
    assert_eq!(
        scene.lights[2].kind,
        LightKind::Directional { direction: Vec3::Z }
    );
    assert_eq!(scene.lights[2].intensity, [0.0; 3]);
    assert!(warns(&scene, "lights/2", "negative"));
}

#[test]
fn cameras_forget_scale_and_impossible_lenses() {
    let mut gltf = Gltf::square();
    gltf.json["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 2, "znear": 0, "zfar": 1 } },
        { "type": "perspective", "perspective": { "yfov": 4, "znear": 0.1 } },
    ]);
    gltf.json["nodes"] = json!([
        { "camera": 0, "name": "eye", "translation": [0, 0, 5], "scale": [3, 1, 2] },
        { "camera": 1, "rotation": [0, 1, 0, 0] },
        { "camera": 2 },
        { "camera": 0, "scale": [0, 0, 0] },
    ]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.cameras.len(), 3);
    assert_eq!(
        (scene.cameras[0].name.as_str(), scene.cameras[0].position),
        ("eye", Vec3::new(0., 0., 5.))
    );
    assert_eq!(
        scene.cameras[0].projection,
        Projection::Perspective { yfov: 0.5 }
    );
    assert!((scene.cameras[0].rotation * Vec3::NEG_Z - Vec3::NEG_Z).length() < 1e-6);
    assert_eq!(
        scene.cameras[1].projection,
        Projection::Orthographic { ymag: 2.0 }
    );
    assert!((scene.cameras[1].rotation * Vec3::NEG_Z - Vec3::Z).length() < 1e-6);
    assert_eq!(
        scene.cameras[2].projection,
        Projection::Perspective { yfov: FRAC_PI_4 }
    );
    assert!(warns(&scene, "cameras/2", "yfov"));
    assert!(warns(&scene, "nodes/3", "orientation"));
}

#[test]
fn chains_of_a_thousand_nodes_compose_exactly_and_cycles_are_refused() {
    let mut gltf = Gltf::square();
    let mut nodes: Vec<Value> = (1..5000)
        .map(|child| json!({ "children": [child], "translation": [0.1, 0, 0] }))
        .collect();
    nodes.push(json!({ "mesh": 0 }));
    gltf.json["nodes"] = json!(nodes);
    let scene = gltf.import().unwrap();
    let expected = (0.1_f32 as f64 * 4999.0) as f32;
    assert_eq!(
        scene.instances[0].transform.translation,
        Vec3A::new(expected, 0., 0.)
    );

    gltf.json["nodes"] = json!([{ "children": [1] }, { "children": [0], "name": "loop" }]);
    gltf.refused(&["nodes/0", "reached twice"]);
    gltf.json["nodes"] =
        json!([{ "children": [1, 2] }, { "children": [3] }, { "children": [3] }, { "mesh": 0 }]);
    gltf.refused(&["nodes/3", "reached twice"]);
}

#[test]
fn mirrored_transforms_stay_and_collapsed_ones_go() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf.json["nodes"] = json!([
        { "mesh": 0, "scale": [-1, 1, 1] },
        { "mesh": 0, "scale": [1, 1, 0] },
        { "mesh": 0, "scale": [1, 0, 1] },
        { "mesh": 0, "scale": [1e38, 1e38, 1e38], "children": [4] },
        { "mesh": 0, "scale": [1e38, 1e38, 1e38] },
    ]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.instances.len(), 3, "{:?}", scene.warnings);
    assert!(scene.instances[0].transform.matrix3.determinant() < 0.0);
    assert!(warns(&scene, "nodes/1", "flat"));
    assert!(warns(&scene, "nodes/2", "no area"));
    assert!(warns(&scene, "nodes/4", "not finite"));
}

#[test]
fn gpu_instances_are_placed_one_by_one() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    let translations = gltf.accessor("VEC3", F32, &f32_bytes(&[1., 0., 0., 0., 2., 0.]), 2);
    let scales = gltf.accessor("VEC3", F32, &f32_bytes(&[1., 1., 1., 3., 3., 3.]), 2);
    gltf.json["nodes"] = json!([{ "mesh": 0, "translation": [10, 0, 0], "extensions": {
        "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations, "SCALE": scales } },
    } }]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.instances.len(), 2);
    assert_eq!(
        scene.instances[0].transform.translation,
        Vec3A::new(11., 0., 0.)
    );
    assert_eq!(
        scene.instances[1].transform.transform_point3(Vec3::ONE),
        Vec3::new(13., 5., 3.)
    );
}

#[test]
fn without_a_scene_all_roots_are_shown() {
    let mut gltf = Gltf::square();
    gltf.json["nodes"] = json!([{ "mesh": 0, "children": [2] }, { "mesh": 0 }, { "mesh": 0 }]);
    gltf.json
        .as_object_mut()
        .unwrap()
        .retain(|key, _| !key.starts_with("scene"));
    assert_eq!(gltf.import().unwrap().instances.len(), 3);
}
