//! The textures that MTL materials name, collected with their images.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::find::find_loosely;
use super::map_statement::MapStatement;
use crate::desc::{Filter, ImageDesc, TextureDesc, TextureUse, UvTransform};
use crate::import::files;
use crate::import::images::{self, ImageRequest, ImageRole};
use crate::import::warnings::Warnings;

/// Textures in use, with their images still encoded.
pub(super) struct Textures<'a> {
    folder: &'a Path,
    list: Vec<TextureDesc>,
    requests: Vec<ImageRequest<'static>>,
    /// From paths, or the names of missing files, to indices of `requests`.
    image_indices: BTreeMap<PathBuf, usize>,
}

impl<'a> Textures<'a> {
    /// None yet; files are looked for from `folder`.
    pub(super) fn new(folder: &'a Path) -> Self {
        Self {
            folder,
            list: Vec::new(),
            requests: Vec::new(),
            image_indices: BTreeMap::new(),
        }
    }

    /// Registers a use of a texture by the material at `place`.
    pub(super) fn add(&mut self, map: &MapStatement, role: ImageRole, place: &str) -> TextureUse {
        let texture = TextureDesc {
            image: self.image(&map.file, role, place),
            wrap: [map.wrap; 2],
            filter: Filter::Linear,
        };
        let known = self.list.iter().position(|known| *known == texture);
        let texture = known.unwrap_or_else(|| {
            self.list.push(texture);
            self.list.len() - 1
        });
        TextureUse {
            texture,
            uv_set: 0,
            transform: uv_transform(map),
        }
    }

    fn image(&mut self, file: &str, role: ImageRole, place: &str) -> usize {
        let path = find_loosely(file, self.folder);
        let key = path.clone().unwrap_or_else(|| PathBuf::from(file));
        if let Some(&known) = self.image_indices.get(&key) {
            return known;
        }
        let bytes = match path {
            Some(path) => files::read(&path).map(Cow::Owned),
            None => Err("is not there".into()),
        };
        let extension = key.extension().and_then(|extension| extension.to_str());
        self.requests.push(ImageRequest {
            name: file.to_owned(),
            place: format!("{place} \"{file}\""),
            bytes,
            extension: extension.map(str::to_owned),
            role,
        });
        self.image_indices.insert(key, self.requests.len() - 1);
        self.requests.len() - 1
    }

    /// The textures, and the images decoded.
    pub(super) fn finish(self, warnings: &mut Warnings) -> (Vec<TextureDesc>, Vec<ImageDesc>) {
        (self.list, images::decode_all(self.requests, warnings))
    }
}

/// `-s` and `-o`, which are for a v that grows upwards: v' = s·v + o with v = 1 − ours.
fn uv_transform(map: &MapStatement) -> Option<UvTransform> {
    let ([scale_u, scale_v], [offset_u, offset_v]) = (map.scale, map.offset);
    let is_identity = (map.scale, map.offset) == ([1.0; 2], [0.0; 2]);
    let transform = [
        [scale_u, 0.0, offset_u],
        [0.0, scale_v, 1.0 - scale_v - offset_v],
    ];
    let is_finite = transform.iter().flatten().all(|value| value.is_finite());
    (!is_identity && is_finite).then_some(transform)
}
