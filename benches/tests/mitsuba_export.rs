//! Scenes exported to Mitsuba: what is in the files, and what is refused.

use std::fs;
use std::path::{Path, PathBuf};

use residual_benches::mitsuba::{Exported, SCENE_FILE, SENSOR_FILE, export};
use residual_scenegen::desc::{LightDesc, PunctualKind, SceneDesc, SurfaceDesc};
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{CullingRule, PlanOptions, plan};

fn cornell() -> SceneDesc {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/cornell-box.gltf");
    import(&path, &ImportOptions::default()).unwrap()
}

fn options() -> PlanOptions {
    PlanOptions {
        size: [64, 48],
        culling: CullingRule::None,
        ..PlanOptions::default()
    }
}

/// Exports, and reads both files.
fn exported(scene: &SceneDesc) -> (Exported, Node, Node, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let exported = export(scene, &options(), 8, folder.path()).unwrap();
    let read = |file: &str| parse(&fs::read_to_string(folder.path().join(file)).unwrap());
    let (scene, sensor) = (read(SCENE_FILE), read(SENSOR_FILE));
    (exported, scene, sensor, folder)
}

fn refusal(scene: &SceneDesc) -> String {
    let folder = tempfile::tempdir().unwrap();
    let error = export(scene, &options(), 8, folder.path()).unwrap_err();
    format!("{error:#}")
}

/// An element of a parsed file.
#[derive(Debug, Default)]
struct Node {
    tag: String,
    attributes: Vec<(String, String)>,
    children: Vec<Node>,
}

impl Node {
    fn attribute(&self, name: &str) -> &str {
        let found = self.attributes.iter().find(|(key, _)| key == name);
        &found
            .unwrap_or_else(|| panic!("{} has no {name}", self.tag))
            .1
    }

    /// This one and all below it.
    fn all(&self) -> Vec<&Node> {
        let below = self.children.iter().flat_map(Node::all);
        std::iter::once(self).chain(below).collect()
    }

    /// Plugins of a kind and type.
    fn plugins(&self, kind: &str, plugin_type: &str) -> Vec<&Node> {
        let mut all = self.all();
        all.retain(|node| node.tag == kind && node.attribute("type") == plugin_type);
        all
    }

    /// The value of a property of this plugin.
    fn property(&self, name: &str) -> &str {
        let mut properties = self.children.iter();
        let has_name = |node: &&Node| {
            let mut attributes = node.attributes.iter();
            attributes.any(|(key, value)| key == "name" && value == name)
        };
        let found = properties.find(has_name);
        let found = found.unwrap_or_else(|| panic!("{self:?} has no {name}"));
        found.attribute("value")
    }
}

/// Reads the XML that we write: elements with attributes, and nothing between them. Panics if it is not well formed.
fn parse(text: &str) -> Node {
    let mut open = vec![Node::default()];
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (inside, after) = rest
            .strip_prefix('<')
            .and_then(|rest| rest.split_once('>'))
            .unwrap_or_else(|| panic!("no element at {rest}"));
        rest = after.trim_start();
        if let Some(tag) = inside.strip_prefix('/') {
            let node = open.pop().unwrap();
            assert_eq!(node.tag, tag);
            open.last_mut().unwrap().children.push(node);
            continue;
        }
        let (inside, is_empty) = match inside.strip_suffix('/') {
            Some(inside) => (inside, true),
            None => (inside, false),
        };
        let (tag, mut attributes) = inside.split_once(' ').unwrap_or((inside, ""));
        let mut node = Node {
            tag: tag.to_owned(),
            ..Node::default()
        };
        while !attributes.is_empty() {
            let (name, after) = attributes.trim_start().split_once("=\"").unwrap();
            let (value, after) = after.split_once('"').unwrap();
            assert!(!value.contains(['<', '&']), "{value}");
            node.attributes.push((name.to_owned(), value.to_owned()));
            attributes = after;
        }
        if is_empty {
            open.last_mut().unwrap().children.push(node);
        } else {
            open.push(node);
        }
    }
    assert_eq!(open.len(), 1, "{} is not closed", open.last().unwrap().tag);
    let mut root = open.pop().unwrap();
    assert_eq!(root.children.len(), 1);
    root.children.pop().unwrap()
}

/// Vertices and faces, as the header of a PLY file says.
fn counts(path: PathBuf) -> [usize; 2] {
    let bytes = fs::read(path).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    ["vertex", "face"].map(|element| {
        let prefix = format!("element {element} ");
        let line = text.lines().find_map(|line| line.strip_prefix(&prefix));
        line.unwrap().parse().unwrap()
    })
}

#[test]
fn a_scene_of_matte_surfaces_is_exported_whole() {
    let cornell = cornell();
    let (exported, scene, sensor, folder) = exported(&cornell);
    assert_eq!(
        exported,
        Exported {
            shapes: 4,
            lights: 1
        }
    );
    assert_eq!(scene.tag, "scene");
    let shapes = scene.plugins("shape", "ply");
    assert_eq!(shapes.len(), 4);
    assert_eq!(scene.plugins("bsdf", "diffuse").len(), 4);
    assert_eq!(scene.plugins("bsdf", "twosided").len(), 4);
    let emitters = scene.plugins("emitter", "area");
    assert_eq!(emitters.len(), 1);
    assert_eq!(emitters[0].property("radiance"), "30, 23.4, 15");
    let integrator = &scene.plugins("integrator", "path")[0];
    assert_eq!(integrator.property("max_depth"), "8");
    assert_eq!(integrator.property("rr_depth"), "5");

    let files = shapes.iter().map(|shape| shape.property("filename"));
    let counts: Vec<_> = files.map(|file| counts(folder.path().join(file))).collect();
    let triangles: usize = counts.iter().map(|[_, faces]| faces).sum();
    let planned = plan(&cornell, &options()).unwrap();
    assert_eq!(triangles, planned.data.triangle_count());
    // A quadrangle has four corners, not six.
    assert!(counts.contains(&[4, 2]), "{counts:?}");

    assert_eq!(sensor.attribute("type"), "perspective");
    assert_eq!(sensor.property("fov_axis"), "y");
    let fov: f64 = sensor.property("fov").parse().unwrap();
    assert!((fov.to_radians() - 0.685914).abs() < 1e-6);
    let look = sensor.all().into_iter().find(|node| node.tag == "lookat");
    assert_eq!(look.unwrap().attribute("origin"), "0, 0.2744, 0.76");
    assert_eq!(sensor.plugins("sampler", "$sampler").len(), 1);
    let film = &sensor.plugins("film", "hdrfilm")[0];
    assert_eq!(
        [film.property("width"), film.property("height")],
        ["64", "48"]
    );
    assert_eq!(sensor.plugins("rfilter", "box").len(), 1);
}

#[test]
fn metals_coats_and_glass_have_counterparts() {
    let mut scene = cornell();
    for (material, index) in scene.materials.iter_mut().zip(0..) {
        let SurfaceDesc::MetallicRoughness(surface) = &mut material.surface else {
            panic!("{:?}", material.surface);
        };
        match index {
            0 => {
                surface.metallic.factor = 1.0;
                surface.roughness.factor = 0.25;
            }
            1 => surface.specular.factor = 1.0,
            2 => {
                surface.transmission.factor = 1.0;
                surface.roughness.factor = 0.0;
                surface.solid = true;
                surface.ior = 1.25;
            }
            _ => (),
        }
    }
    let mut frosted = scene.clone();
    if let SurfaceDesc::MetallicRoughness(surface) = &mut frosted.materials[2].surface {
        surface.roughness.factor = 0.5;
    }
    let (_, scene, _, _) = exported(&scene);
    let [metal] = scene.plugins("bsdf", "principled")[..] else {
        panic!("{scene:?}");
    };
    let [coat] = scene.plugins("bsdf", "coat")[..] else {
        panic!("{scene:?}");
    };
    assert_eq!(metal.property("metallic"), "1");
    assert_eq!(metal.property("roughness"), "0.25");
    assert_eq!(coat.property("base_color"), "0.61, 0.06, 0.05");
    let normal: f32 = coat.property("normal").parse().unwrap();
    assert!((normal - 0.04).abs() < 1e-6, "{normal}");
    // A coat as rough as can be reflects less than polished glass, most of it at grazing angles.
    let albedos = coat.property("albedo").split(' ');
    let albedos: Vec<f32> = albedos.map(|albedo| albedo.parse().unwrap()).collect();
    assert!(albedos.is_sorted_by(|a, b| a >= b), "{albedos:?}");
    let [grazing, .., normal] = albedos[..] else {
        panic!("{albedos:?}");
    };
    assert!(grazing > 0.08 && grazing < 0.5, "{grazing}");
    assert!(normal > 0.01 && normal < 0.04, "{normal}");
    let [glass] = scene.plugins("bsdf", "dielectric")[..] else {
        panic!("{scene:?}");
    };
    assert_eq!(glass.property("int_ior"), "1.25");
    // Light goes through it from either side by itself.
    assert_eq!(scene.plugins("bsdf", "twosided").len(), 3);

    let (_, frosted, _, _) = exported(&frosted);
    let [glass] = frosted.plugins("bsdf", "roughdielectric")[..] else {
        panic!("{frosted:?}");
    };
    let properties = ["alpha", "int_ior", "distribution"].map(|name| glass.property(name));
    assert_eq!(properties, ["0.25", "1.25", "ggx"]);
}

#[test]
fn what_has_no_counterpart_is_refused_by_its_name() {
    let with = |change: &dyn Fn(&mut SceneDesc)| {
        let mut scene = cornell();
        change(&mut scene);
        refusal(&scene)
    };
    let text = with(&|scene| {
        let SurfaceDesc::MetallicRoughness(surface) = &mut scene.materials[1].surface else {
            panic!();
        };
        surface.metallic.factor = 0.5;
    });
    assert!(
        text.contains("material \"red\" has a mix of lobes"),
        "{text}"
    );
    let text = with(&|scene| {
        scene.lights.push(LightDesc {
            name: "lamp".to_owned(),
            kind: PunctualKind::Spot {
                position: glam::Vec3::ONE,
                direction: glam::Vec3::NEG_Y,
                inner: 0.1,
                outer: 0.5,
            },
            intensity: [1.0; 3],
            size: 0.0,
        });
    });
    assert!(text.contains("light \"lamp\" is a spot"), "{text}");
}

#[test]
fn what_emits_from_both_sides_is_two_surfaces() {
    let mut scene = cornell();
    let faces = |scene: &SceneDesc| {
        let (_, scene, _, folder) = exported(scene);
        let shapes = scene.plugins("shape", "ply");
        let files = shapes.iter().map(|shape| shape.property("filename"));
        let faces = files.map(|file| counts(folder.path().join(file))[1]);
        faces.collect::<Vec<_>>()
    };
    let one_sided = faces(&scene);
    scene.materials[3].double_sided = true;
    let mut expected = one_sided;
    expected[3] *= 2;
    assert_eq!(faces(&scene), expected);
}

#[test]
fn a_scene_without_lights_has_the_sky_that_we_give_it() {
    let mut scene = cornell();
    scene.materials[3].emission.factor = [0.0; 3];
    let (exported, scene, _, _) = exported(&scene);
    assert_eq!(exported.lights, 1);
    let [sky] = scene.plugins("emitter", "constant")[..] else {
        panic!("{scene:?}");
    };
    assert_eq!(sky.property("radiance"), "1, 1, 1");
}
