//! What an EXR says of a Cryptomatte layer, so that compositors find objects by their names (specification 1.2.0).

use residual_render::cryptomatte;
use residual_render::layer::Layer;
use serde_json::{Map, Value};

/// The names behind the ids of a Cryptomatte layer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Manifest {
    /// The layer.
    pub layer: Layer,
    /// The names, each once.
    pub names: Vec<String>,
}

impl Manifest {
    /// Names and values of the file's attributes.
    pub(crate) fn attributes(&self) -> [(String, String); 4] {
        let layer = self.layer.name();
        // The specification suggests seven digits of the hash of the layer's name.
        let key = &cryptomatte::digits(layer)[..7];
        let ids = self.names.iter();
        let ids = ids.map(|name| (name.clone(), Value::from(cryptomatte::digits(name))));
        let manifest = Value::Object(ids.collect::<Map<_, _>>());
        [
            ("name", layer.to_owned()),
            ("hash", "MurmurHash3_32".to_owned()),
            ("conversion", "uint32_to_float32".to_owned()),
            ("manifest", manifest.to_string()),
        ]
        .map(|(name, value)| (format!("cryptomatte/{key}/{name}"), value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As in a sample image of the specification's authors, whose layer has the same name.
    #[test]
    fn attributes_are_those_of_the_specification() {
        let manifest = Manifest {
            layer: Layer::CryptoObject,
            names: ["bunny", "name containing a \"quote\"  ", "равнина"]
                .map(str::to_owned)
                .to_vec(),
        };
        let expected = [
            ("cryptomatte/f834d0a/name", "crypto_object"),
            ("cryptomatte/f834d0a/hash", "MurmurHash3_32"),
            ("cryptomatte/f834d0a/conversion", "uint32_to_float32"),
            (
                "cryptomatte/f834d0a/manifest",
                r#"{"bunny":"13851a76","name containing a \"quote\"  ":"af8bfa09","равнина":"9623511e"}"#,
            ),
        ];
        let expected = expected.map(|(name, value)| (name.to_owned(), value.to_owned()));
        assert_eq!(manifest.attributes(), expected);
        let of_materials = Manifest {
            layer: Layer::CryptoMaterial,
            names: Vec::new(),
        };
        let [_, _, _, (name, value)] = of_materials.attributes();
        assert_eq!((&*name, &*value), ("cryptomatte/bda530a/manifest", "{}"));
    }
}
