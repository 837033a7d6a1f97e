//! MTL materials as descriptions.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::mtl::{MapStatement, MtlMaterial, parse_map};
use crate::desc::{
    AlphaMode, ColorInput, Filter, ImageDesc, MaterialDesc, NormalMap, Phong, ScalarInput,
    SurfaceDesc, TextureDesc, TextureUse, Wrap,
};
use crate::import::error::Warnings;
use crate::import::files;
use crate::import::images::{self, ImageRequest};

/// Reflectance where a file gives none.
const GREY: f32 = 0.8;

/// Materials in use, in order of first use, with their textures.
pub(super) struct ObjMaterials<'a> {
    library: &'a [MtlMaterial],
    folder: &'a Path,
    /// The materials.
    pub(super) list: Vec<MaterialDesc>,
    ids: BTreeMap<Option<usize>, usize>,
    textures: Vec<TextureDesc>,
    requests: Vec<ImageRequest<'static>>,
    /// Path (or the name of a missing file) → image.
    image_ids: BTreeMap<PathBuf, usize>,
}

impl<'a> ObjMaterials<'a> {
    /// None yet.
    pub(super) fn new(library: &'a [MtlMaterial], folder: &'a Path) -> Self {
        Self {
            library,
            folder,
            list: Vec::new(),
            ids: BTreeMap::new(),
            textures: Vec::new(),
            requests: Vec::new(),
            image_ids: BTreeMap::new(),
        }
    }

    /// The index in the scene of a material of the library; `None` is a grey default.
    pub(super) fn id(&mut self, index: Option<usize>, warnings: &mut Warnings) -> usize {
        let index = index.filter(|&index| index < self.library.len());
        if let Some(&id) = self.ids.get(&index) {
            return id;
        }
        let default = MtlMaterial {
            name: "default".into(),
            ..MtlMaterial::default()
        };
        let source = index.map_or(&default, |index| &self.library[index]);
        let place = format!("{} \"{}\"", source.place, source.name.escape_debug());
        let desc = Reader {
            materials: self,
            source,
            place,
            warnings,
        }
        .material();
        self.list.push(desc);
        self.ids.insert(index, self.list.len() - 1);
        self.list.len() - 1
    }

    /// Says which materials of the libraries are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, material) in self.library.iter().enumerate() {
            if !self.ids.contains_key(&Some(index)) {
                let place = format!("{} \"{}\"", material.place, material.name.escape_debug());
                warnings.dismiss(None, place, "no face uses it");
            }
        }
    }

    /// Decodes the images.
    pub(super) fn finish(
        self,
        warnings: &mut Warnings,
    ) -> (Vec<MaterialDesc>, Vec<TextureDesc>, Vec<ImageDesc>) {
        (
            self.list,
            self.textures,
            images::decode_all(self.requests, warnings),
        )
    }

    fn texture(&mut self, map: &MapStatement, is_normal_map: bool, place: &str) -> usize {
        let path = files::find_loosely(&map.file, self.folder);
        let key = path.clone().unwrap_or_else(|| PathBuf::from(&map.file));
        let image = match self.image_ids.get(&key) {
            Some(&image) => image,
            None => {
                let bytes = match path {
                    Some(path) => files::read(&path).map(Cow::Owned),
                    None => Err("is not there".into()),
                };
                self.requests.push(ImageRequest {
                    name: map.file.clone(),
                    place: format!("{place} \"{}\"", map.file),
                    bytes,
                    extension: key
                        .extension()
                        .and_then(|extension| extension.to_str())
                        .map(str::to_owned),
                    is_normal_map,
                });
                self.image_ids.insert(key, self.requests.len() - 1);
                self.requests.len() - 1
            }
        };
        let clamps = map
            .options
            .get("clamp")
            .and_then(|arguments| arguments.first())
            .is_some_and(|word| word == "on");
        let wrap = if clamps { Wrap::Clamp } else { Wrap::Repeat };
        let texture = TextureDesc {
            image,
            wrap: [wrap; 2],
            filter: Filter::Linear,
        };
        let known = self.textures.iter().position(|known| *known == texture);
        known.unwrap_or_else(|| {
            self.textures.push(texture);
            self.textures.len() - 1
        })
    }
}

/// Reads one material.
struct Reader<'r, 'a> {
    materials: &'r mut ObjMaterials<'a>,
    source: &'r MtlMaterial,
    place: String,
    warnings: &'r mut Warnings,
}

impl Reader<'_, '_> {
    fn material(mut self) -> MaterialDesc {
        let illum = self.number("illum").unwrap_or(2.0);
        let diffuse = self.color("kd", "map_kd", GREY);
        let emission = self.color("ke", "map_ke", 0.0);
        let alpha_map = self.map("map_d", false);
        let opacity = self.opacity();
        let ior = self.number("ni");

        let is_see_through =
            opacity < 1.0 && ior.is_some_and(|ior| ior > 1.0) && alpha_map.is_none();
        let is_glass = [4.0, 6.0, 7.0, 9.0].contains(&illum) || is_see_through;
        // Maya and others write `illum 4`, `Ni 1` and `d 1` for every opaque material.
        let is_invisible = illum == 4.0 && opacity == 1.0 && ior.is_none_or(|ior| ior <= 1.0);
        let surface = if is_glass && !is_invisible {
            SurfaceDesc::Dielectric {
                ior: self.valid_ior(ior),
                transmittance: self.values("tf").unwrap_or([1.0; 3]),
            }
        } else {
            let specular = self.color("ks", "map_ks", 0.0);
            let black = ColorInput {
                factor: [0.0; 3],
                texture: None,
            };
            let exponent_map = self.map("map_ns", false);
            let exponent = self.number("ns").unwrap_or(1.0).max(0.0);
            SurfaceDesc::Phong(Phong {
                diffuse,
                specular: if illum < 2.0 { black } else { specular },
                exponent: ScalarInput {
                    factor: exponent,
                    texture: exponent_map.map(|map| (map.texture, map.channel)),
                },
            })
        };
        let is_glass = matches!(surface, SurfaceDesc::Dielectric { .. });
        let is_blended = !is_glass && (opacity < 1.0 || alpha_map.is_some());
        self.warn_about_the_rest();
        MaterialDesc {
            name: self.source.name.clone(),
            surface,
            emission,
            alpha_mode: if is_blended {
                AlphaMode::Blend
            } else {
                AlphaMode::Opaque
            },
            alpha: ScalarInput {
                factor: if is_glass { 1.0 } else { opacity },
                texture: alpha_map
                    .filter(|_| !is_glass)
                    .map(|map| (map.texture, self.alpha_channel(map.channel))),
            },
            normal_map: self.map("norm", true).map(|map| NormalMap {
                texture: map.texture,
                scale: map.bump_scale,
            }),
            double_sided: true,
        }
    }

    /// `d`, or 1 − `Tr` where there is only that.
    fn opacity(&mut self) -> f32 {
        let opacity = self
            .number("d")
            .or_else(|| self.number("tr").map(|transparency| 1.0 - transparency));
        opacity.unwrap_or(1.0).clamp(0.0, 1.0)
    }

    /// Masks are grey images, except where the colour's own alpha is meant.
    fn alpha_channel(&self, channel: usize) -> usize {
        let file = |key: &str| {
            self.source
                .entries
                .get(key)
                .map(|statement| parse_map(statement).file)
        };
        if file("map_d") == file("map_kd") {
            3
        } else {
            channel
        }
    }

    fn valid_ior(&mut self, ior: Option<f32>) -> f32 {
        match ior {
            Some(ior) if ior > 0.0 => ior,
            Some(ior) => {
                self.warnings.push(
                    &*self.place,
                    format!("Ni {ior} is not positive; 1.5 is used"),
                );
                1.5
            }
            None => 1.5,
        }
    }

    fn number(&mut self, key: &str) -> Option<f32> {
        self.values(key).map(|[value, _, _]| value)
    }

    /// Up to three numbers; a single one stands for all three, as the specification says.
    fn values(&mut self, key: &str) -> Option<[f32; 3]> {
        let text = self
            .source
            .entries
            .get(key)?
            .split('#')
            .next()
            .unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        // `-halo`, of `d -halo 0.5`, changes with the angle; the number is what remains.
        let words = words.strip_prefix(&["-halo"]).unwrap_or(&words);
        let numbers: Vec<f32> = words
            .iter()
            .take(3)
            .map_while(|word| word.parse().ok())
            .collect();
        let values = match numbers[..] {
            [r, g, b] => [r, g, b],
            [value, ..] => [value; 3],
            [] => {
                self.warnings.push(
                    &*self.place,
                    format!("{key} \"{text}\" is not a number and ignored"),
                );
                return None;
            }
        };
        if !values.iter().all(|value| value.is_finite()) {
            self.warnings.push(
                &*self.place,
                format!("{key} \"{text}\" is not finite and ignored"),
            );
            return None;
        }
        Some(values)
    }

    /// A colour and its texture; without a colour, 1 where there is a texture and `default` elsewhere.
    fn color(&mut self, key: &str, map_key: &str, default: f32) -> ColorInput {
        let texture = self.map(map_key, false).map(|map| map.texture);
        let given = self.values(key);
        if texture.is_some() && given == Some([0.0; 3]) {
            self.warnings.push(
                &*self.place,
                format!("{map_key} has no effect, as {key} is 0"),
            );
        }
        let factor = given.unwrap_or(if texture.is_some() {
            [1.0; 3]
        } else {
            [default; 3]
        });
        if factor.iter().any(|&value| value < 0.0) {
            self.warnings.push(
                &*self.place,
                format!("{key} has negative values; 0 is used"),
            );
        }
        ColorInput {
            factor: factor.map(|value| value.max(0.0)),
            texture,
        }
    }

    fn map(&mut self, key: &str, is_normal_map: bool) -> Option<Map> {
        let map = parse_map(self.source.entries.get(key)?);
        if map.file.is_empty() {
            self.warnings
                .push(&*self.place, format!("{key} names no file"));
            return None;
        }
        for option in map.options.keys() {
            let is_known = matches!(option.as_str(), "s" | "o" | "clamp" | "imfchan" | "bm");
            if !is_known || (option == "bm" && !is_normal_map) {
                self.warnings
                    .push(&*self.place, format!("-{option} of {key} is ignored"));
            }
        }
        let texture = self.materials.texture(&map, is_normal_map, &self.place);
        let channel = match map
            .options
            .get("imfchan")
            .and_then(|arguments| arguments.first())
            .map(String::as_str)
        {
            Some("g") => 1,
            Some("b") => 2,
            Some("m") => 3,
            _ => 0,
        };
        let number = |option: &str, index: usize, default: f32| {
            let argument = map
                .options
                .get(option)
                .and_then(|arguments| arguments.get(index));
            argument
                .and_then(|text| text.parse().ok())
                .filter(|value: &f32| value.is_finite())
                .unwrap_or(default)
        };
        let (scale_u, scale_v) = (number("s", 0, 1.0), number("s", 1, 1.0));
        let (offset_u, offset_v) = (number("o", 0, 0.0), number("o", 1, 0.0));
        // The options are for a v that grows upwards: v' = s·v + o with v = 1 − ours.
        let transform = [
            [scale_u, 0.0, offset_u],
            [0.0, scale_v, 1.0 - scale_v - offset_v],
        ];
        let is_identity = (scale_u, scale_v, offset_u, offset_v) == (1.0, 1.0, 0.0, 0.0);
        let transform = (!is_identity && transform.iter().flatten().all(|value| value.is_finite()))
            .then_some(transform);
        Some(Map {
            texture: TextureUse {
                texture,
                uv_set: 0,
                transform,
            },
            channel,
            bump_scale: number("bm", 0, 1.0),
        })
    }

    fn warn_about_the_rest(&mut self) {
        for key in self.source.entries.keys() {
            match key.as_str() {
                "map_bump" | "bump" => {
                    self.warnings.push(
                        &*self.place,
                        format!("{key}: height maps are not supported and ignored"),
                    );
                }
                "disp" | "decal" | "refl" | "pr" | "pm" | "ps" | "pc" | "pcr" | "aniso"
                | "map_pr" | "map_pm" | "map_ps" | "map_tr" => self
                    .warnings
                    .push(&*self.place, format!("{key} is not supported and ignored")),
                _ => {}
            }
        }
    }
}

/// A texture statement, understood.
struct Map {
    texture: TextureUse,
    /// Channel of a scalar map.
    channel: usize,
    /// `-bm`.
    bump_scale: f32,
}
