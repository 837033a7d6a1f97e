//! OBJ files of a few lines, in folders of their own.

use std::path::Path;

use residual_scenegen::desc::{
    ColorInput, MaterialDesc, PhongSurface, SceneDesc, SurfaceDesc, Texels,
};
use residual_scenegen::import::{ImportError, ImportOptions, import};
use tempfile::TempDir;

pub(crate) const TRIANGLE: &str =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 0.75\nusemtl m\nf 1/1 2/2 3/3\n";

/// Images of one texel.
const IMAGES: [(&str, [u8; 4]); 6] = [
    ("kd.png", [0, 0, 0, 255]),
    ("ks.png", [1, 0, 0, 255]),
    ("tex/Deep One.PNG", [2, 0, 0, 255]),
    ("white.png", [255, 255, 255, 255]),
    ("directions.png", [128, 127, 255, 255]),
    ("leaf.png", [9, 9, 9, 0]),
];

/// A folder with files, among them `a.obj`, and [`IMAGES`].
pub(crate) fn folder<B: AsRef<[u8]>>(files: &[(&str, B)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, color) in IMAGES {
        write(folder.path(), name, &png(color));
    }
    for (name, content) in files {
        write(folder.path(), name, content.as_ref());
    }
    folder
}

/// An image of one texel.
pub(crate) fn png(color: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(1, 1, image::Rgba(color))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

/// Writes a file, whose folder may not be there yet.
pub(crate) fn write(folder: &Path, name: impl AsRef<Path>, bytes: &[u8]) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, bytes).unwrap();
}

/// Imports `a.obj` of a folder with the given files.
pub(crate) fn try_import<B: AsRef<[u8]>>(files: &[(&str, B)]) -> Result<SceneDesc, ImportError> {
    import(
        &folder(files).path().join("a.obj"),
        &ImportOptions::default(),
    )
}

/// Imports an OBJ file with the given text.
pub(crate) fn geometry(text: &str) -> SceneDesc {
    try_import(&[("a.obj", text)]).unwrap()
}

/// The material of a triangle with the given MTL statements.
pub(crate) fn material(statements: &str) -> (MaterialDesc, SceneDesc) {
    let scene = try_import(&[
        ("a.obj", TRIANGLE),
        ("a.mtl", &format!("newmtl m\n{statements}\n")),
    ])
    .unwrap();
    (scene.materials[0].clone(), scene)
}

pub(crate) fn phong(material: &MaterialDesc) -> &PhongSurface {
    match &material.surface {
        SurfaceDesc::Phong(phong) => phong,
        other => panic!("{other:?}"),
    }
}

/// Diffuse colour and reflectance of a mirror.
pub(crate) fn mirror(material: &MaterialDesc) -> [&ColorInput; 2] {
    match &material.surface {
        SurfaceDesc::Mirror {
            diffuse,
            reflectance,
        } => [diffuse, reflectance],
        other => panic!("{other:?}"),
    }
}

/// The red byte of a texture's only texel, which says which file it is.
pub(crate) fn red(scene: &SceneDesc, texture: usize) -> u8 {
    match &scene.images[scene.textures[texture].image].texels {
        Texels::Rgba8(texels) => texels[0][0],
        Texels::Rgba16(_) | Texels::RgbaF32(_) => panic!("8 bits"),
    }
}
