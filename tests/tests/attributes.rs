//! Vertices are stored for those materials only that read them, and each triangle finds its own.

use glam::{Affine3A, Mat3, Vec3, Vec4};
use residual_render::cryptomatte;
use residual_render::domain::Buffer;
use residual_render::layer::{Layer, Layers};
use residual_render::record::IndexedRecord;
use residual_render::surface::{ColorRecord, NormalRecord, TangentRecord, UvRecord};
use residual_render::triangle::{ObjectRecord, TriangleRecord};
use residual_scenegen::desc::{
    AlphaMode, Filter, InstanceDesc, MaterialDesc, MeshDesc, NormalMap, PhongSurface, ScalarInput,
    SceneDesc, SurfaceDesc, TextureUse, Wrap,
};
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use residual_tests::fixtures::{Builder, color, material, matte, scalar, sheet, sphere};

/// What a mesh's material reads.
#[derive(Clone, Copy, Default)]
struct Reads {
    tangents: bool,
    colors: bool,
    uvs: bool,
    normals: bool,
}

/// By the number of the mesh: none, normals, all but colours, colours, and normals with texture coordinates.
const READS: [Reads; 5] = [
    Reads {
        tangents: false,
        colors: false,
        uvs: false,
        normals: false,
    },
    Reads {
        tangents: false,
        colors: false,
        uvs: false,
        normals: true,
    },
    Reads {
        tangents: true,
        colors: false,
        uvs: true,
        normals: true,
    },
    Reads {
        tangents: false,
        colors: true,
        uvs: false,
        normals: false,
    },
    Reads {
        tangents: false,
        colors: false,
        uvs: true,
        normals: true,
    },
];

/// Meshes in the order in which they are placed; the one with tangents neither first nor last.
const PLACED: [usize; 8] = [0, 1, 3, 2, 1, 4, 2, 0];
/// Vertices of the sheets and the spheres.
const VERTICES: [usize; 5] = [4, 325, 325, 4, 325];
/// The one that lets light through, and the one that is seen from its front only.
const BLENDED: usize = 4;
const SINGLE_SIDED: usize = 1;

/// Every other instance is mirrored.
fn transform(number: usize) -> Affine3A {
    let turn = Mat3::from_rotation_y(0.3 * number as f32);
    let mirror = if number % 2 == 1 { -1.0 } else { 1.0 };
    let linear = turn * Mat3::from_diagonal(Vec3::new(mirror, 1.0, 1.0));
    Affine3A::from_mat3_translation(linear, Vec3::new(number as f32, 0.0, -1.0))
}

fn printed(texture: TextureUse) -> SurfaceDesc {
    let mut diffuse = color([0.9; 3]);
    diffuse.texture = Some(texture);
    SurfaceDesc::Phong(PhongSurface {
        diffuse,
        specular: color([0.0; 3]),
        exponent: scalar(0.0),
    })
}

fn scene() -> SceneDesc {
    let mut b = Builder::new("attributes");
    let image = b.bytes(5, 3);
    let texture = b.texture(image, [Wrap::Repeat; 2], Filter::Linear);
    let flat = |z| sheet([0.0, 0.0, z], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let round = |x| sphere([x, 0.0, 0.0], 0.5);
    let all_different = |mesh: MeshDesc| {
        let numbers = 0..mesh.positions.len();
        let color = |i| Vec4::new(i as f32 / 500.0, 0.5, 0.25, 1.0);
        let tangent = |n: &Vec3| n.any_orthonormal_vector().extend(1.0);
        MeshDesc {
            colors: Some(numbers.map(color).collect()),
            tangents: Some(mesh.normals.iter().map(tangent).collect()),
            ..mesh
        }
    };
    b.add(
        material("nothing", matte([0.0; 3])),
        [all_different(flat(0.0))],
    );
    b.add(
        MaterialDesc {
            double_sided: false,
            // Black: the colours of its vertices are read by nobody.
            ..material("normals", matte([0.0; 3]))
        },
        [all_different(round(1.0))],
    );
    let relief = NormalMap {
        texture: texture.clone(),
        scale: 1.0,
    };
    b.add(
        MaterialDesc {
            normal_map: Some(relief),
            ..material("tangents", printed(texture.clone()))
        },
        [MeshDesc {
            colors: None,
            ..all_different(round(2.0))
        }],
    );
    b.add(
        material("colours", matte([0.5; 3])),
        [all_different(flat(3.0))],
    );
    b.add(
        MaterialDesc {
            alpha_mode: AlphaMode::Blend,
            alpha: ScalarInput {
                factor: 0.5,
                texture: Some((texture.clone(), 0)),
            },
            ..material("coordinates", printed(texture))
        },
        [round(4.0)],
    );
    let mut scene = b.finish();
    let instance = |(number, &mesh)| InstanceDesc {
        name: format!("node {number}"),
        mesh,
        transform: transform(number),
    };
    scene.instances = PLACED.iter().enumerate().map(instance).collect();
    scene.validate().unwrap();
    scene
}

/// Vertices of the placed meshes of which something is true.
fn vertices(is: impl Fn(Reads) -> bool) -> usize {
    let counted = PLACED.iter().filter(|&&mesh| is(READS[mesh]));
    counted.map(|&mesh| VERTICES[mesh]).sum()
}

fn planned(scene: &SceneDesc) -> Plan {
    plan(scene, &PlanOptions::default()).unwrap()
}

/// Those with tangents come first, then those with colours, with coordinates, with normals; buffers end with the last
/// that reads them.
#[test]
fn buffers_end_with_the_last_vertex_that_is_read() {
    let plan = planned(&scene());
    fn length<R: IndexedRecord>(plan: &Plan) -> usize {
        plan.data.records::<R>().len()
    }
    let tangents = vertices(|reads| reads.tangents);
    let colors = vertices(|reads| reads.tangents || reads.colors);
    let coordinates = vertices(|reads| reads.tangents || reads.colors || reads.uvs);
    assert_eq!(length::<TangentRecord>(&plan), tangents);
    assert_eq!(length::<ColorRecord>(&plan), colors);
    assert_eq!(length::<UvRecord>(&plan), coordinates);
    assert_eq!(
        length::<NormalRecord>(&plan),
        coordinates + vertices(|r| r.normals && !r.uvs)
    );
    // By hand.
    assert_eq!([tangents, colors, coordinates], [650, 654, 979]);
    assert_eq!(length::<NormalRecord>(&plan), 1629);
    assert_eq!(plan.data.triangle_count(), 5 * 576 + 3 * 2);
}

#[test]
fn triangles_find_their_own_vertices() {
    let scene = scene();
    let plan = planned(&scene);
    let positions = plan.data.positions();
    let row = |[x, y, z]: [f32; 3], w: f32| Vec4::new(x, y, z, w);
    let same = |a: Vec4, b: Vec4, what: &str| {
        assert!((a - b).abs().max_element() < 1e-5, "{what}: {a} {b}")
    };
    let mut triangle = 0;
    for (number, &of) in PLACED.iter().enumerate() {
        let (mesh, reads) = (&scene.meshes[of], READS[of]);
        let placed = transform(number);
        // Rotations and mirrors leave normals as they leave directions.
        let linear = Mat3::from(placed.matrix3);
        let mirror = linear.determinant();
        for corners in &mesh.triangles {
            let mut corners = corners.map(|corner| corner as usize);
            if mirror < 0.0 {
                corners.swap(1, 2);
            }
            for (k, corner) in corners.into_iter().enumerate() {
                let position = placed.transform_point3(mesh.positions[corner]);
                same(
                    Vec3::from(positions[3 * triangle + k]).extend(0.0),
                    position.extend(0.0),
                    "position",
                );
                let [a, b, c] = plan.data.record::<TriangleRecord>(triangle).vertices();
                let vertex = [a, b, c][k] as usize;
                if reads.normals {
                    let normal = linear * mesh.normals[corner];
                    let NormalRecord { normal: stored } = plan.data.record(vertex);
                    same(row(stored.to_array(), 0.0), normal.extend(0.0), "normal");
                }
                if reads.tangents {
                    let tangent = mesh.tangents.as_ref().unwrap()[corner];
                    let turned = linear * tangent.truncate();
                    let stored: TangentRecord = plan.data.record(vertex);
                    same(
                        row(stored.tangent.to_array(), stored.sign),
                        turned.extend(tangent.w * mirror),
                        "tangent",
                    );
                }
                if reads.uvs {
                    let uv = mesh.uvs[0].as_ref().unwrap()[corner];
                    let UvRecord { u0, v0, u1, v1 } = plan.data.record(vertex);
                    same(
                        Vec4::new(u0, v0, u1, v1),
                        Vec4::new(uv.x, uv.y, 0.0, 0.0),
                        "coordinates",
                    );
                }
                if reads.colors {
                    let stored: ColorRecord = plan.data.record(vertex);
                    same(
                        row(stored.color.to_array(), stored.alpha),
                        mesh.colors.as_ref().unwrap()[corner],
                        "colour",
                    );
                }
            }
            assert_eq!(plan.data.alpha_tested[triangle], of == BLENDED);
            assert_eq!(plan.data.single_sided[triangle], of == SINGLE_SIDED);
            triangle += 1;
        }
    }
    assert_eq!(triangle, plan.data.triangle_count());
}

/// Transparent instances are no objects, and the materials of objects are stored when they are asked for.
#[test]
fn triangles_know_their_objects() {
    let mut scene = scene();
    let clear = scene.materials.len();
    scene.materials.push(MaterialDesc {
        alpha_mode: AlphaMode::Blend,
        alpha: scalar(0.0),
        ..material("clear", matte([0.5; 3]))
    });
    scene.meshes.push(MeshDesc {
        material: clear,
        ..scene.meshes[0].clone()
    });
    let invisible = InstanceDesc {
        name: "clear".to_owned(),
        mesh: scene.meshes.len() - 1,
        transform: transform(0),
    };
    scene.instances.insert(2, invisible);
    let plan = planned(&scene);
    let expected = PLACED.iter().enumerate().flat_map(|(object, &mesh)| {
        let triangles = scene.meshes[mesh].triangles.len();
        std::iter::repeat_n(object as u32, triangles)
    });
    let expected: Vec<u32> = expected.collect();
    let objects = |plan: &Plan| -> Vec<u32> {
        let triangles = plan.data.records::<TriangleRecord>();
        triangles.map(|triangle| triangle.object).collect()
    };
    assert_eq!(objects(&plan), expected);
    for (index, object) in plan.objects.iter().enumerate() {
        assert_eq!(object.name, format!("node {index}"));
    }

    assert!(plan.data.buffer(Buffer::Objects).is_empty());
    let options = PlanOptions {
        layers: Layers::NONE.with(Layer::MaterialIndex),
        ..PlanOptions::default()
    };
    let asked_for = residual_scenegen::plan::plan(&scene, &options).unwrap();
    let stored: Vec<ObjectRecord> = asked_for.data.records().collect();
    let material = |mesh: usize| scene.meshes[mesh].material as u32;
    let record = |(index, &mesh): (usize, &usize)| ObjectRecord {
        material: material(mesh),
        name_id: cryptomatte::id(&format!("node {index}")),
        material_name_id: cryptomatte::id(&scene.materials[scene.meshes[mesh].material].name),
    };
    assert_eq!(
        stored,
        PLACED.iter().enumerate().map(record).collect::<Vec<_>>()
    );
}

/// Where nobody reads anything there are no vertices, not even their numbers.
#[test]
fn without_readers_there_are_no_vertices() {
    let mut scene = scene();
    scene.instances.retain(|instance| instance.mesh == 0);
    let plan = planned(&scene);
    assert_eq!(plan.data.triangle_count(), 4);
    for buffer in [
        Buffer::Normals,
        Buffer::Tangents,
        Buffer::Uvs,
        Buffer::Colors,
    ] {
        assert!(plan.data.buffer(buffer).is_empty(), "{buffer:?}");
    }
    let mut triangles = plan.data.records::<TriangleRecord>();
    assert!(triangles.all(|triangle| triangle.vertices() == [0; 3]));
}
