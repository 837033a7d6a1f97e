//! glTF geometry, feature by feature, with exact expected values.

use crate::common::gltf_text::{
    F32, Gltf, I8, I16, SQUARE, U8, U16, U32, f32_bytes, u16_bytes, warns,
};
use glam::{Vec2, Vec3, Vec4};
use serde_json::json;

#[test]
fn every_index_type_gives_the_same_triangles() {
    let corners = [0_u16, 1, 2, 0, 2, 3];
    let u32_bytes: Vec<u8> = corners
        .iter()
        .flat_map(|&i| u32::from(i).to_le_bytes())
        .collect();
    let u8_bytes: Vec<u8> = corners.iter().map(|&i| i as u8).collect();
    for (component, bytes) in [(U8, u8_bytes), (U16, u16_bytes(&corners)), (U32, u32_bytes)] {
        let mut gltf = Gltf::square();
        gltf.floats("NORMAL", "VEC3", [[0., 0., 2.]; 4].as_flattened());
        gltf.indices(component, &bytes, 6);
        let mesh = gltf.mesh();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.normals, [Vec3::Z; 4], "normals are made unit");
    }
}

#[test]
fn strips_alternate_and_fans_turn_around_the_first_corner() {
    for (mode, expected) in [(5, [[0, 1, 2], [1, 3, 2]]), (6, [[1, 2, 0], [2, 3, 0]])] {
        let mut gltf = Gltf::square();
        gltf.floats("NORMAL", "VEC3", [[0., 0., 1.]; 4].as_flattened());
        gltf.primitive()["mode"] = json!(mode);
        assert_eq!(gltf.mesh().triangles, expected, "mode {mode}");
    }
}

#[test]
fn points_and_lines_are_skipped_with_a_warning() {
    for mode in 0..4 {
        let mut gltf = Gltf::square();
        gltf.primitive()["mode"] = json!(mode);
        let scene = gltf.import().unwrap();
        assert!(scene.meshes.is_empty());
        assert!(warns(
            &scene,
            "meshes/0 \"m\"/primitives/0",
            "points and lines"
        ));
    }
}

#[test]
fn missing_normals_are_flat_on_vertices_of_their_own() {
    let mut gltf = Gltf::square();
    gltf.floats("TEXCOORD_0", "VEC2", &[0., 0., 1., 0., 1., 1., 0., 1.]);
    gltf.indices(U16, &u16_bytes(&[0, 1, 2, 0, 3, 2]), 6);
    let mesh = gltf.mesh();
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(mesh.normals[..3], [Vec3::Z; 3]);
    assert_eq!(mesh.normals[3..], [-Vec3::Z; 3]);
    assert_eq!(mesh.positions[4], Vec3::from(SQUARE[3]));
    assert_eq!(mesh.uvs[0].as_ref().unwrap()[4], Vec2::new(0., 1.));
}

#[test]
fn sparse_elements_replace_those_of_the_buffer_or_zeros() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf.floats("NORMAL", "VEC3", [[0., 0., 1.]; 4].as_flattened());
    let (indices, values) = (gltf.view(&[2]), gltf.view(&f32_bytes(&[5., 6., 7.])));
    gltf.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": indices, "componentType": U8 },
        "values": { "bufferView": values },
    });
    let mesh = gltf.mesh();
    assert_eq!(mesh.positions[2], Vec3::new(5., 6., 7.));
    assert_eq!(mesh.positions[1], Vec3::X);
    gltf.json["accessors"][0]
        .as_object_mut()
        .unwrap()
        .remove("bufferView");
    assert_eq!(
        gltf.mesh().positions,
        [Vec3::ZERO, Vec3::ZERO, Vec3::new(5., 6., 7.), Vec3::ZERO]
    );

    gltf.json["accessors"][0]["sparse"]["count"] = json!(5);
    gltf.refused(&["accessors/0/sparse", "replaces 5 of 4"]);
}

#[test]
fn strided_attributes_are_read_from_one_view() {
    let mut gltf = Gltf::new();
    // Position and normal by turns.
    let vertices: Vec<f32> = SQUARE
        .iter()
        .flat_map(|p| [p[0], p[1], p[2], 0., 1., 0.])
        .collect();
    let view = gltf.view(&f32_bytes(&vertices));
    gltf.json["bufferViews"][view]["byteStride"] = json!(24);
    gltf.json["accessors"] = json!([
        { "bufferView": view, "type": "VEC3", "componentType": F32, "count": 4 },
        { "bufferView": view, "byteOffset": 12, "type": "VEC3", "componentType": F32, "count": 4 },
    ]);
    gltf.primitive()["attributes"] = json!({ "POSITION": 0, "NORMAL": 1 });
    gltf.indices(U8, &[0, 2, 3], 3);
    let mesh = gltf.mesh();
    assert_eq!(mesh.positions, SQUARE.map(Vec3::from));
    assert_eq!(mesh.normals, [Vec3::Y; 4]);
    gltf.json["accessors"][1]["byteOffset"] = json!(16);
    let scene = gltf.import().unwrap();
    assert!(warns(&scene, "accessors/1", "reach beyond the 96 bytes"));
    assert_eq!(scene.meshes[0].normals, [Vec3::Z; 3], "computed");

    gltf.json["accessors"][0]["byteOffset"] = json!(16);
    gltf.refused(&["accessors/0", "reach beyond the 96 bytes"]);
}

#[test]
fn quantised_attributes_follow_the_specification() {
    let mut gltf = Gltf::new();
    gltf.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let i16s = |values: &[i16]| -> Vec<u8> {
        values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect()
    };
    gltf.attribute(
        "POSITION",
        "VEC3",
        I16,
        &i16s(&[0, 0, 0, 32767, 0, 0, -32768, 16384, 0]),
        3,
    );
    gltf.json["accessors"][0]["normalized"] = json!(true);
    let normals = gltf.attribute("NORMAL", "VEC3", I8, &[0, 0, 127, 0, 127, 0, 0x81, 0, 0], 3);
    gltf.json["accessors"][normals]["normalized"] = json!(true);
    gltf.attribute(
        "TEXCOORD_0",
        "VEC2",
        U16,
        &u16_bytes(&[0, 1, 2, 3, 400, 500]),
        3,
    );
    let uvs = gltf.attribute("TEXCOORD_1", "VEC2", U8, &[0, 255, 51, 0, 0, 0], 3);
    gltf.json["accessors"][uvs]["normalized"] = json!(true);
    let mesh = gltf.mesh();
    assert_eq!(mesh.positions[1], Vec3::X);
    assert_eq!(mesh.positions[2], Vec3::new(-1., 16384. / 32767., 0.));
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::Y, -Vec3::X]);
    assert_eq!(mesh.uvs[0].as_ref().unwrap()[2], Vec2::new(400., 500.));
    assert_eq!(
        mesh.uvs[1].as_ref().unwrap()[..2],
        [Vec2::new(0., 1.), Vec2::new(51. / 255., 0.)]
    );
}

#[test]
fn colours_are_read_with_and_without_alpha() {
    let mut gltf = Gltf::square();
    let colors = gltf.attribute(
        "COLOR_0",
        "VEC4",
        U16,
        &u16_bytes(&[65535, 0, 0, 32768].repeat(4)),
        4,
    );
    gltf.json["accessors"][colors]["normalized"] = json!(true);
    gltf.primitive()["mode"] = json!(5);
    let mesh = gltf.mesh();
    assert_eq!(
        mesh.colors.unwrap()[0],
        Vec4::new(1., 0., 0., 32768. / 65535.)
    );
    gltf.floats("COLOR_0", "VEC3", &[0.25, 0.5, 1.].repeat(4));
    assert_eq!(gltf.mesh().colors.unwrap()[0], Vec4::new(0.25, 0.5, 1., 1.));
}

#[test]
fn vertex_colours_are_forced_into_their_range_component_by_component() {
    let colors = |kind: &str, component: u64, bytes: &[u8]| {
        let mut gltf = Gltf::square();
        gltf.attribute("COLOR_0", kind, component, bytes, 4);
        let mut scene = gltf.import().unwrap();
        (scene.meshes.remove(0).colors.unwrap()[0], scene)
    };
    let floats = |values: [f32; 4]| colors("VEC4", F32, &f32_bytes(&values.repeat(4)));
    let outside = "outside of 0 to 1 and clamped";
    let at = "meshes/0 \"m\"/primitives/0";
    let (color, scene) = floats([4.0, 0.5, 0.25, 1.0]);
    assert_eq!(color, Vec4::new(1.0, 0.5, 0.25, 1.0));
    assert!(warns(
        &scene,
        at,
        &format!("4 vertex colours are {outside}")
    ));
    let (color, scene) = floats([-0.001, 0.5, 0.5, 1.5]);
    assert_eq!(color, Vec4::new(0.0, 0.5, 0.5, 1.0));
    assert!(warns(&scene, at, outside));
    let (color, _) = floats([f32::INFINITY, f32::NEG_INFINITY, 0.5, 1.0]);
    assert_eq!(color, Vec4::new(1.0, 0.0, 0.5, 1.0));
    let (color, scene) = floats([f32::NAN, 0.5, 2.0, 0.25]);
    assert_eq!(color, Vec4::new(1.0, 0.5, 1.0, 0.25));
    assert!(warns(&scene, at, "4 vertex colours are NaN; 1 is used"));
    let (color, scene) = floats([0.0, 0.5, 1.0, 0.25]);
    assert_eq!(color, Vec4::new(0.0, 0.5, 1.0, 0.25));
    assert_eq!(scene.warnings.len(), 1, "the strip's: {:?}", scene.warnings);

    // Bytes whose accessor forgets that they are fractions.
    let (color, scene) = colors("VEC4", U8, &[255, 51, 0, 255].repeat(4));
    assert_eq!(color, Vec4::new(1.0, 0.2, 0.0, 1.0));
    assert!(warns(&scene, "COLOR_0", "not normalized"));
    let (color, _) = colors("VEC3", U16, &u16_bytes(&[0, 65535, 13107].repeat(4)));
    assert_eq!(color, Vec4::new(0.0, 1.0, 0.2, 1.0));
}

#[test]
fn non_finite_vertices_drop_their_triangles() {
    let mut gltf = Gltf::new();
    let positions = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [f32::NAN, 1., 0.]];
    gltf.floats("POSITION", "VEC3", positions.as_flattened());
    gltf.floats(
        "NORMAL",
        "VEC3",
        &[0., 0., 0., 0., 0., f32::NAN, 0., 0., 9., 0., 1., 0.],
    );
    gltf.indices(U8, &[0, 1, 2, 0, 2, 3], 6);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.meshes[0].triangles, [[0, 1, 2]]);
    assert_eq!(
        scene.meshes[0].normals[..3],
        [Vec3::Z; 3],
        "the face's normal stands in"
    );
    assert!(warns(&scene, "primitives/0", "1 of 2 triangles"));
    assert!(warns(&scene, "primitives/0", "2 normals"));
    assert!(scene.meshes[0].positions[3].is_finite());
}

#[test]
fn indices_and_accessors_out_of_range_are_refused() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 4, 0, 1, 2], 6);
    let scene = gltf.import().unwrap();
    let message = "1 of 2 triangles have a vertex beyond the 4";
    assert!(warns(
        &scene,
        "meshes/0 \"m\"/primitives/0/indices",
        message
    ));
    assert_eq!(scene.meshes[0].triangles, [[0, 1, 2]]);
    gltf.primitive()["indices"] = json!(77);
    gltf.refused(&["primitives/0/indices", "accessors/77", "there are 2"]);

    let mut gltf = Gltf::square();
    gltf.json["accessors"][0]["count"] = json!(u64::MAX);
    gltf.refused(&["accessors/0", "1 GiB"]);
    gltf.json["accessors"][0]["count"] = json!(5);
    gltf.refused(&["accessors/0", "5 elements reach beyond the 48 bytes"]);
    gltf.json["accessors"][0]["byteOffset"] = json!(u64::MAX);
    gltf.refused(&["accessors/0", "reach beyond"]);
    gltf.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX);
    gltf.refused(&["bufferViews/0", "beyond the 48 bytes"]);
    gltf.json["accessors"][0] =
        json!({ "type": "VEC3", "componentType": F32, "count": 4_000_000_000_u64 });
    gltf.refused(&["accessors/0", "1 GiB", "split the scene"]);
}

#[test]
fn attributes_of_other_lengths_are_left_out() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf.floats("NORMAL", "VEC3", &[0., 1., 0.]);
    gltf.primitive()["attributes"]["TEXCOORD_0"] = json!(9);
    let scene = gltf.import().unwrap();
    let problem = "has 1 elements, but POSITION has 4; the attribute is left out";
    assert!(warns(&scene, "attributes/NORMAL", problem));
    assert_eq!(scene.meshes[0].normals, [Vec3::Z; 3], "computed");
}

fn with_normal_map(gltf: &mut Gltf) {
    gltf.json["materials"] = json!([{ "normalTexture": { "index": 0 } }]);
    gltf.json["textures"] = json!([{ "source": 0 }]);
    gltf.json["images"] = json!([{ "uri": "missing.png" }]);
    gltf.primitive()["material"] = json!(0);
}

#[test]
fn tangents_are_computed_where_a_normal_map_needs_them() {
    let mut gltf = Gltf::square();
    gltf.floats("NORMAL", "VEC3", [[0., 0., 1.]; 4].as_flattened());
    // v grows downwards, so that the picture stands upright.
    gltf.floats("TEXCOORD_0", "VEC2", &[0., 1., 1., 1., 1., 0., 0., 0.]);
    gltf.indices(U8, &[0, 1, 2, 0, 2, 3], 6);
    assert_eq!(gltf.mesh().tangents, None);
    with_normal_map(&mut gltf);
    assert_eq!(
        gltf.mesh().tangents.unwrap(),
        [Vec4::new(1., 0., 0., 1.); 4]
    );

    gltf.floats("TANGENT", "VEC4", &[0., 3., 0., -1.].repeat(4));
    assert_eq!(
        gltf.mesh().tangents.unwrap(),
        [Vec4::new(0., 1., 0., -1.); 4],
        "given ones are kept"
    );
    gltf.floats("TANGENT", "VEC4", &[0., 0., 0., -1.].repeat(4));
    assert_eq!(
        gltf.mesh().tangents.unwrap(),
        [Vec4::new(1., 0., 0., 1.); 4],
        "zero ones are not"
    );
}

#[test]
fn vertices_are_split_where_the_texture_is_mirrored() {
    let mut gltf = Gltf::new();
    let positions = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [2., 0., 0.]];
    gltf.floats("POSITION", "VEC3", positions.as_flattened());
    gltf.floats("NORMAL", "VEC3", [[0., 0., 1.]; 4].as_flattened());
    gltf.floats("TEXCOORD_0", "VEC2", &[0., 1., 1., 1., 1., 0., 0., 1.]);
    gltf.indices(U8, &[0, 1, 2, 1, 3, 2], 6);
    with_normal_map(&mut gltf);
    let mesh = gltf.mesh();
    assert_eq!(mesh.positions.len(), 6);
    let tangents = mesh.tangents.unwrap();
    for corner in mesh.triangles[0] {
        assert_eq!(tangents[corner as usize], Vec4::new(1., 0., 0., 1.));
    }
    for corner in mesh.triangles[1] {
        assert_eq!(tangents[corner as usize], Vec4::new(-1., 0., 0., -1.));
    }
}
