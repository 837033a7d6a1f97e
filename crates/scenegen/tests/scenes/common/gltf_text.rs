//! Small glTF files, written from text and arrays.

use std::path::{Path, PathBuf};

use residual_scenegen::desc::{MeshDesc, SceneDesc};
use residual_scenegen::import::{EnvironmentOptions, ImportError, ImportOptions, import};
use serde_json::{Value, json};

/// A file in the making: one buffer, filled by accessors.
pub(crate) struct Gltf {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

pub(crate) const F32: u64 = 5126;
pub(crate) const U8: u64 = 5121;
pub(crate) const I8: u64 = 5120;
pub(crate) const U16: u64 = 5123;
pub(crate) const I16: u64 = 5122;
pub(crate) const U32: u64 = 5125;

/// Four corners of a unit square in the plane z = 0, counter-clockwise.
pub(crate) const SQUARE: [[f32; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];

pub(crate) fn f32_bytes(values: &[f32]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

pub(crate) fn u16_bytes(values: &[u16]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

impl Gltf {
    /// One node with one mesh of one primitive without attributes.
    pub(crate) fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "name": "m", "primitives": [{ "attributes": {} }] }],
            "accessors": [],
            "bufferViews": [],
        });
        Self {
            json,
            bytes: Vec::new(),
        }
    }

    /// The square as four vertices, without indices.
    pub(crate) fn square() -> Self {
        let mut gltf = Self::new();
        gltf.floats("POSITION", "VEC3", SQUARE.as_flattened());
        gltf
    }

    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }),
        );
        self.bytes.extend(bytes);
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        views.len() - 1
    }

    pub(crate) fn accessor(
        &mut self,
        kind: &str,
        component: u64,
        bytes: &[u8],
        count: usize,
    ) -> usize {
        let view = self.view(bytes);
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(
            json!({ "bufferView": view, "type": kind, "componentType": component, "count": count }),
        );
        accessors.len() - 1
    }

    pub(crate) fn attribute(
        &mut self,
        name: &str,
        kind: &str,
        component: u64,
        bytes: &[u8],
        count: usize,
    ) -> usize {
        let accessor = self.accessor(kind, component, bytes, count);
        self.primitive()["attributes"][name] = json!(accessor);
        accessor
    }

    /// An attribute of floats, as many as its kind has for each vertex.
    pub(crate) fn floats(&mut self, name: &str, kind: &str, values: &[f32]) -> usize {
        let components = match kind {
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            other => panic!("{other}: no kind of an attribute"),
        };
        assert!(values.len().is_multiple_of(components), "{name}");
        let count = values.len() / components;
        self.attribute(name, kind, F32, &f32_bytes(values), count)
    }

    pub(crate) fn indices(&mut self, component: u64, bytes: &[u8], count: usize) {
        let accessor = self.accessor("SCALAR", component, bytes, count);
        self.primitive()["indices"] = json!(accessor);
    }

    pub(crate) fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// Writes `scene.gltf` and `scene.bin` and imports them.
    pub(crate) fn import(&self) -> Result<SceneDesc, ImportError> {
        self.import_with(&ImportOptions::default())
    }

    pub(crate) fn import_with(&self, options: &ImportOptions) -> Result<SceneDesc, ImportError> {
        let folder = tempfile::tempdir().unwrap();
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "uri": "scene.bin", "byteLength": self.bytes.len() }]);
        std::fs::write(folder.path().join("scene.bin"), &self.bytes).unwrap();
        let path: PathBuf = folder.path().join("scene.gltf");
        std::fs::write(&path, json.to_string()).unwrap();
        import(&path, options)
    }

    /// Imports and expects one mesh.
    pub(crate) fn mesh(&self) -> MeshDesc {
        let mut scene = self.import().unwrap();
        assert_eq!(scene.meshes.len(), 1, "{:?}", scene.warnings);
        scene.meshes.remove(0)
    }

    /// Imports and expects an error with both texts.
    pub(crate) fn refused(&self, texts: &[&str]) {
        let message = self.import().expect_err("an error").to_string();
        for text in texts {
            assert!(message.contains(text), "{message:?} does not say {text:?}");
        }
    }
}

/// A square under an environment.
pub(crate) fn under(path: &Path) -> SceneDesc {
    let environment = EnvironmentOptions {
        path: path.to_owned(),
        strength: 1.0,
        rotation_degrees: 0.0,
    };
    let options = ImportOptions {
        environment: Some(environment),
        ..ImportOptions::default()
    };
    Gltf::square().import_with(&options).unwrap()
}

/// Whether some warning has both texts.
pub(crate) fn warns(scene: &SceneDesc, place: &str, message: &str) -> bool {
    scene
        .warnings
        .iter()
        .any(|warning| warning.place.contains(place) && warning.message.contains(message))
}
