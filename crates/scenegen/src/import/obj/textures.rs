//! The textures that MTL materials name, collected with their images.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::find::Finder;
use super::map_statement::MapStatement;
use super::statements::Statements;
use crate::desc::{Filter, ImageDesc, Texels, TextureDesc, TextureUse, UvTransform};
use crate::import::files;
use crate::import::images::{self, Derived, ImageRequest, ImageRole};
use crate::import::warnings::Warnings;

/// Textures in use, with their images still encoded.
pub(super) struct Textures<'a> {
    folder: &'a Path,
    list: Vec<TextureDesc>,
    requests: Vec<ImageRequest<'static>>,
    /// From paths, or the names of missing files, and what is made of them to indices of `requests`.
    image_indices: BTreeMap<(PathBuf, Derived), usize>,
    /// By path, what has been looked at.
    looks: BTreeMap<PathBuf, Looks>,
    finder: Finder,
}

/// What the texels of an image look like.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Looks {
    /// Red and green are a half on average, and blue is more: directions in tangent space.
    pub(super) are_directions: bool,
    /// Some alpha is below 1.
    pub(super) has_alpha: bool,
}

impl<'a> Textures<'a> {
    /// None yet; files are looked for from `folder`, if the library's own has none.
    pub(super) fn new(folder: &'a Path) -> Self {
        Self {
            folder,
            list: Vec::new(),
            requests: Vec::new(),
            image_indices: BTreeMap::new(),
            looks: BTreeMap::new(),
            finder: Finder::new(),
        }
    }

    /// Registers a use of a texture.
    pub(super) fn add(
        &mut self,
        map: &MapStatement,
        role: ImageRole,
        user: &mut Statements<'_>,
    ) -> TextureUse {
        let texture = TextureDesc {
            image: self.image(&map.file, role, user),
            wrap: [map.wrap; 2],
            filter: Filter::Mipmapped,
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

    /// What an image looks like, for statements whose meaning depends on that.
    pub(super) fn look_at(&mut self, map: &MapStatement, user: &Statements<'_>) -> Looks {
        let Some(Location { path, .. }) = self.locate(&map.file, user) else {
            return Looks::default();
        };
        if let Some(&known) = self.looks.get(&path) {
            return known;
        }
        let decoded =
            files::read(&path).and_then(|bytes| images::decode_one(&bytes, extension(&path)));
        let looks = decoded.map_or(Looks::default(), |decoded| looks(&decoded.texels));
        self.looks.insert(path, looks);
        looks
    }

    fn image(&mut self, file: &str, role: ImageRole, user: &mut Statements<'_>) -> usize {
        let location = self.locate(file, user);
        if let Some(Location {
            path,
            is_guess: true,
        }) = &location
        {
            let shown = path.strip_prefix(self.folder).unwrap_or(path).display();
            user.warn(format!("\"{file}\" is not there; \"{shown}\" is used"));
        }
        let path = location.map(|location| location.path);
        let named = path.clone().unwrap_or_else(|| PathBuf::from(file));
        let extension = extension(&named).map(str::to_owned);
        let key = (named, role.derived());
        if let Some(&known) = self.image_indices.get(&key) {
            return known;
        }
        let bytes = match path {
            Some(path) => files::read(&path).map(Cow::Owned),
            None => Err("is not there".into()),
        };
        self.requests.push(ImageRequest {
            name: file.to_owned(),
            place: format!("{} \"{file}\"", user.place),
            bytes,
            extension,
            role,
        });
        self.image_indices.insert(key, self.requests.len() - 1);
        self.requests.len() - 1
    }

    fn locate(&mut self, file: &str, user: &Statements<'_>) -> Option<Location> {
        let folders = [&*user.material().folder, self.folder];
        let location = |is_guess| move |path| Location { path, is_guess };
        let found = self.finder.find(file, &folders).map(location(false));
        found.or_else(|| self.finder.guess(file, &folders).map(location(true)))
    }

    /// The textures, and the images decoded.
    pub(super) fn finish(self, warnings: &mut Warnings) -> (Vec<TextureDesc>, Vec<ImageDesc>) {
        (self.list, images::decode_all(self.requests, warnings))
    }
}

/// Where an image is.
struct Location {
    path: PathBuf,
    /// Whether its name says so only in part.
    is_guess: bool,
}

fn extension(path: &Path) -> Option<&str> {
    path.extension().and_then(|extension| extension.to_str())
}

fn looks(texels: &Texels) -> Looks {
    match texels {
        Texels::Rgba8(texels) => {
            let texels = texels.iter();
            looks_of(texels.map(|texel| texel.map(|code| f64::from(code) / 255.0)))
        }
        Texels::Rgba16(texels) => {
            let texels = texels.iter();
            looks_of(texels.map(|texel| texel.map(|code| f64::from(code) / 65535.0)))
        }
        Texels::RgbaF32(texels) => looks_of(texels.iter().map(|texel| texel.map(f64::from))),
    }
}

fn looks_of(texels: impl ExactSizeIterator<Item = [f64; 4]>) -> Looks {
    let count = texels.len() as f64;
    let (mut sums, mut has_alpha) = ([0.0; 3], false);
    for texel in texels {
        has_alpha |= texel[3] < 1.0;
        for (sum, value) in sums.iter_mut().zip(texel) {
            *sum += value;
        }
    }
    let [r, g, b] = sums.map(|sum| sum / count);
    let is_half = |mean: f64| (0.4..0.6).contains(&mean);
    Looks {
        are_directions: is_half(r) && is_half(g) && b > 0.75,
        has_alpha,
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
