//! glTF images, collected as textures ask for them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use gltf::json::{Image, Index};

use super::document::Document;
use super::lookup::{find, place};
use super::uri::{self, Uri};
use crate::desc::ImageDesc;
use crate::import::folders::Folders;
use crate::import::images::{self, Derived, ImageRequest, ImageRole};
use crate::import::warnings::Warnings;

/// Images in use, still encoded.
pub(super) struct Images<'a> {
    document: &'a Document,
    folders: Folders,
    requests: Vec<ImageRequest<'a>>,
    /// From indices in the file, for each way to read them, to those in the scene.
    indices: BTreeMap<(usize, Derived), usize>,
}

impl<'a> Images<'a> {
    /// None yet.
    pub(super) fn new(document: &'a Document) -> Self {
        Self {
            document,
            folders: Folders::default(),
            requests: Vec::new(),
            indices: BTreeMap::new(),
        }
    }

    /// Says which images of the file are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, image) in self.document.root.images.iter().enumerate() {
            let mut used = self.indices.keys();
            if !used.any(|(used, _)| *used == index) {
                let at = place("images", index, image.name.as_deref());
                warnings.dismiss(None, at, "no material in use reads it");
            }
        }
    }

    /// The index in the scene; `None`, after a warning, where the file has no such image. An image that holds normals in one of its uses does so in all.
    pub(super) fn add(
        &mut self,
        index: Index<Image>,
        role: ImageRole,
        user: &str,
        warnings: &mut Warnings,
    ) -> Option<usize> {
        let document = self.document;
        let without = "the texture is left out";
        let image = find(
            &document.root.images,
            index,
            "images",
            user,
            without,
            warnings,
        )?;
        let index = index.value();
        let key = (index, role.derived());
        if let Some(&known) = self.indices.get(&key) {
            if role == ImageRole::Normals {
                self.requests[known].role = role;
            }
            return Some(known);
        }
        let at = place("images", index, image.name.as_deref());
        let uri = image.uri.as_deref();
        let bytes = match (image.buffer_view, uri) {
            (Some(view), _) => document
                .view(view, &at)
                .map(|(bytes, _)| Cow::Borrowed(bytes))
                .map_err(|fault| format!("cannot be read ({}: {})", fault.place, fault.problem)),
            (None, Some(uri)) => {
                let content = uri::read(uri, &document.folder, &mut self.folders);
                content.map(|content| {
                    if let Some(remark) = content.remark {
                        warnings.push(&*at, remark);
                    }
                    Cow::Owned(content.bytes)
                })
            }
            (None, None) => Err("has neither a uri nor a bufferView".into()),
        };
        let file_name = uri.filter(|uri| !matches!(Uri::new(uri), Uri::Data(_)));
        let extension = file_name
            .and_then(|uri| Path::new(uri).extension()?.to_str())
            .map(str::to_owned);
        let name = image
            .name
            .clone()
            .or(file_name.map(str::to_owned))
            .unwrap_or_else(|| format!("image {index}"));
        self.requests.push(ImageRequest {
            name,
            place: at,
            bytes,
            extension,
            role,
        });
        self.indices.insert(key, self.requests.len() - 1);
        Some(self.requests.len() - 1)
    }

    /// Decodes them.
    pub(super) fn finish(self, warnings: &mut Warnings) -> Vec<ImageDesc> {
        images::decode_all(self.requests, warnings)
    }
}
