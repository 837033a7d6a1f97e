//! Small animated glTF files.

use residual_device_cpu::{CpuDevice, Interpreter, Width};
use residual_driver::poses::Poses;
use residual_render::film::Film;
use residual_render::passes::RenderOptions;
use residual_render::shutter::Moments;
use residual_render::tracer::TracerNode;
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use serde_json::{Value, json};

/// A turn about +Z by this many degrees.
pub(crate) fn turn(degrees: f32) -> [f32; 4] {
    let (sin, cos) = (0.5 * degrees.to_radians()).sin_cos();
    [0.0, 0.0, sin, cos]
}

/// A file in the making. Material 0 glows with radiance 1 from both sides and reflects nothing; material 1 is white.
pub(crate) struct File {
    json: Value,
    bytes: Vec<u8>,
}

impl File {
    /// Nothing, seen by an orthographic camera from z = 5, node 0: this far to the right and upwards.
    pub(crate) fn orthographic(xmag: f32, ymag: f32) -> Self {
        let lens = json!({ "xmag": xmag, "ymag": ymag, "znear": 0.01, "zfar": 100 });
        Self::new(json!({ "type": "orthographic", "orthographic": lens }))
    }

    /// Nothing, seen by a perspective camera from there.
    pub(crate) fn perspective(yfov: f32) -> Self {
        let lens = json!({ "yfov": yfov, "znear": 0.01 });
        Self::new(json!({ "type": "perspective", "perspective": lens }))
    }

    fn new(camera: Value) -> Self {
        let material = |name: &str, base: [f32; 4], emission: [f32; 3]| {
            json!({
                "name": name,
                "pbrMetallicRoughness": { "baseColorFactor": base, "metallicFactor": 0 },
                "emissiveFactor": emission,
                "doubleSided": true,
            })
        };
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "name": "camera", "camera": 0, "translation": [0, 0, 5] }],
            "cameras": [camera],
            "materials": [
                material("glow", [0.0, 0.0, 0.0, 1.0], [1.0; 3]),
                material("white", [0.8, 0.8, 0.8, 1.0], [0.0; 3]),
            ],
            "meshes": [],
            "accessors": [],
            "bufferViews": [],
            "animations": [{ "channels": [], "samplers": [] }],
        });
        Self {
            json,
            bytes: Vec::new(),
        }
    }

    fn push(&mut self, array: &str, value: Value) -> usize {
        if self.json[array].is_null() {
            self.json[array] = json!([]);
        }
        let array = self.json[array].as_array_mut().expect("an array");
        array.push(value);
        array.len() - 1
    }

    /// An accessor of floats.
    pub(crate) fn floats(&mut self, kind: &str, count: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(kind, 5126, count, &bytes)
    }

    /// An accessor of bytes.
    pub(crate) fn accessor(
        &mut self,
        kind: &str,
        component: u32,
        count: usize,
        bytes: &[u8],
    ) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let view = json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() });
        let view = self.push("bufferViews", view);
        self.push(
            "accessors",
            json!({ "bufferView": view, "type": kind, "componentType": component, "count": count }),
        )
    }

    /// The mesh of an upright rectangle, of one of the materials.
    pub(crate) fn rectangle(
        &mut self,
        [x0, x1]: [f32; 2],
        [y0, y1]: [f32; 2],
        material: u32,
    ) -> usize {
        let corners = [
            [x0, y0, 0.0],
            [x1, y0, 0.0],
            [x1, y1, 0.0],
            [x0, y0, 0.0],
            [x1, y1, 0.0],
            [x0, y1, 0.0],
        ];
        let positions = self.floats("VEC3", 6, corners.as_flattened());
        let primitive = json!({ "attributes": { "POSITION": positions }, "material": material });
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    /// The first primitive of a mesh.
    pub(crate) fn primitive(&mut self, mesh: usize) -> &mut Value {
        &mut self.json["meshes"][mesh]["primitives"][0]
    }

    /// Adds a node to the scene.
    pub(crate) fn node(&mut self, node: Value) -> usize {
        let node = self.push("nodes", node);
        let roots = self.json["scenes"][0]["nodes"].as_array_mut();
        roots.expect("nodes").push(json!(node));
        node
    }

    /// Adds a skin.
    pub(crate) fn skin(&mut self, skin: Value) -> usize {
        self.push("skins", skin)
    }

    /// Adds a point light of intensity 20.
    pub(crate) fn point_light(&mut self, at: [f32; 3]) -> usize {
        self.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
            { "type": "point", "name": "lamp", "intensity": 20 }
        ] } });
        self.node(json!({
            "name": "lamp",
            "translation": at,
            "extensions": { "KHR_lights_punctual": { "light": 0 } },
        }))
    }

    /// Animates a property of a node, with keys at the seconds 0, 1, ….
    pub(crate) fn animate(&mut self, node: usize, path: &str, how: &str, keys: &[&[f32]]) {
        let times: Vec<f32> = (0..keys.len()).map(|k| k as f32).collect();
        let input = self.floats("SCALAR", times.len(), &times);
        let values = keys.concat();
        let (kind, count) = match path {
            "rotation" => ("VEC4", keys.len()),
            "weights" => ("SCALAR", values.len()),
            _ => ("VEC3", keys.len()),
        };
        let output = self.floats(kind, count, &values);
        let animation = &mut self.json["animations"][0];
        let samplers = animation["samplers"].as_array_mut().expect("samplers");
        samplers.push(json!({ "input": input, "output": output, "interpolation": how }));
        let sampler = samplers.len() - 1;
        let channels = animation["channels"].as_array_mut().expect("channels");
        channels.push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }

    /// The scene at a moment, or while the shutter is open.
    pub(crate) fn at(&self, time_code: Option<f64>, moments: Vec<f64>) -> SceneDesc {
        let folder = tempfile::tempdir().unwrap();
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "uri": "scene.bin", "byteLength": self.bytes.len() }]);
        std::fs::write(folder.path().join("scene.bin"), &self.bytes).unwrap();
        let path = folder.path().join("scene.gltf");
        std::fs::write(&path, json.to_string()).unwrap();
        let options = ImportOptions {
            time_code,
            moments,
            ..ImportOptions::default()
        };
        import(&path, &options).unwrap()
    }

    /// The scene while the shutter is open from second 0 to second 1.
    pub(crate) fn open(&self, moments: &Moments) -> SceneDesc {
        self.at(None, moments.times().collect())
    }

    /// Renders it, with the shutter open from second 0 to second 1.
    pub(crate) fn film(&self, moments: u32, options: &RenderOptions) -> Film {
        let moments = Moments::new(moments, options.seed).unwrap();
        let planned = planned(&self.open(&moments), options.size);
        assert!(planned.motion.is_some());
        interpret(&planned, options)
    }
}

/// Plans a scene.
pub(crate) fn planned(scene: &SceneDesc, size: [u32; 2]) -> Plan {
    planned_for(TracerNode::default(), scene, size)
}

/// Plans a scene for a tracer.
pub(crate) fn planned_for(tracer: TracerNode, scene: &SceneDesc, size: [u32; 2]) -> Plan {
    let options = PlanOptions {
        size,
        tracer,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

/// Renders a plan by interpretation, on two threads.
pub(crate) fn interpret(plan: &Plan, options: &RenderOptions) -> Film {
    let device = CpuDevice::new(2).unwrap();
    let interpreter = Interpreter::new(plan.structure.clone());
    Poses::new(plan, Width::Native, options.seed).render(&device, &interpreter, options)
}

/// So many samples of an image of this size.
pub(crate) fn options(size: [u32; 2], samples: u32, seed: u32) -> RenderOptions {
    RenderOptions {
        size,
        samples: Some(samples),
        seed,
        ..RenderOptions::default()
    }
}
