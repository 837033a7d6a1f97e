//! The library: loading it, and building scenes with it.

use std::ffi::{CString, c_void};
use std::fmt;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use libloading::Library;

use super::ffi::{self, Api, Handle};
use crate::isa::Isa;
use crate::mesh::Mesh;

/// Names the library's file.
pub const PATH_VARIABLE: &str = "RESIDUAL_EMBREE_LIB";

/// There is no Embree; its text says how to get one.
#[derive(Debug)]
pub struct Missing(String);

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no Embree 4 ({}): `pip download --no-deps embreex==4.4.0.post1`, unzip it, and set {PATH_VARIABLE} to the \
             libembree4 in embreex.libs/",
            self.0
        )
    }
}

/// How well Embree builds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Binned surface area heuristic.
    Medium,
    /// With spatial splits.
    High,
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Quality::Medium => "MEDIUM",
            Quality::High => "HIGH",
        })
    }
}

/// A device with one thread.
pub struct Embree {
    pub(super) api: Api,
    device: Handle,
    /// As in `4.4.0`.
    pub version: String,
}

impl Embree {
    /// Loads the library named by [`PATH_VARIABLE`], or else from the usual places, and limits it to an instruction set.
    pub fn load(isa: Isa) -> Result<Rc<Embree>, Missing> {
        let named = std::env::var_os(PATH_VARIABLE).map(PathBuf::from);
        Embree::load_from(named.map_or_else(usual_paths, |path| vec![path]), isa)
    }

    fn load_from(paths: Vec<PathBuf>, isa: Isa) -> Result<Rc<Embree>, Missing> {
        let mut problem = String::new();
        let library = paths.iter().find_map(|path| match open(path) {
            Ok(library) => Some(library),
            Err(error) => {
                problem = error.to_string();
                None
            }
        });
        let library = library.ok_or(Missing(problem))?;
        // SAFETY: the file is an Embree 4, whose functions have the declared signatures; one that lacks any of them is
        // refused here.
        let api = unsafe { Api::of(library) }.map_err(|error| Missing(error.to_string()))?;
        let isa = isa.embree_name().map(|name| format!(",isa={name}"));
        let config = format!("threads=1,verbose=0{}", isa.unwrap_or_default());
        let config = CString::new(config).expect("no zero bytes");
        // SAFETY: the string ends in a zero and outlives the call.
        let device = unsafe { (api.rtcNewDevice)(config.as_ptr()) };
        if device.is_null() {
            return Err(Missing("it makes no device".to_owned()));
        }
        // SAFETY: the device is alive.
        let number = unsafe { (api.rtcGetDeviceProperty)(device, ffi::DEVICE_PROPERTY_VERSION) };
        Ok(Rc::new(Embree {
            api,
            device,
            version: format!("{}.{}.{}", number / 10000, number / 100 % 100, number % 100),
        }))
    }

    /// Builds a scene over a mesh.
    pub fn build(
        self: &Rc<Embree>,
        mesh: &Mesh,
        quality: Quality,
        robust: bool,
    ) -> Rc<EmbreeScene> {
        let (api, device) = (&self.api, self.device);
        // SAFETY: the handles are alive until released; the buffers that Embree makes have room for as many vertices and
        // triangles as were asked for, and vertex indices are in range.
        unsafe {
            let scene = (api.rtcNewScene)(device);
            (api.rtcSetSceneFlags)(scene, if robust { ffi::SCENE_FLAG_ROBUST } else { 0 });
            (api.rtcSetSceneBuildQuality)(
                scene,
                match quality {
                    Quality::Medium => ffi::BUILD_QUALITY_MEDIUM,
                    Quality::High => ffi::BUILD_QUALITY_HIGH,
                },
            );
            let geometry = (api.rtcNewGeometry)(device, ffi::GEOMETRY_TYPE_TRIANGLE);
            self.fill(
                geometry,
                ffi::BUFFER_TYPE_VERTEX,
                ffi::FORMAT_FLOAT3,
                &mesh.positions,
            );
            self.fill(
                geometry,
                ffi::BUFFER_TYPE_INDEX,
                ffi::FORMAT_UINT3,
                &mesh.triangles,
            );
            let start = residual_frontend::process_time();
            (api.rtcCommitGeometry)(geometry);
            (api.rtcAttachGeometry)(scene, geometry);
            (api.rtcCommitScene)(scene);
            let seconds = (residual_frontend::process_time() - start).as_secs_f64();
            (api.rtcReleaseGeometry)(geometry);
            let error = (api.rtcGetDeviceError)(device);
            assert_eq!(error, 0, "Embree reports an error");
            Rc::new(EmbreeScene {
                embree: self.clone(),
                scene,
                quality,
                robust,
                seconds,
            })
        }
    }

    /// Copies `values` to a new buffer of the geometry.
    ///
    /// # Safety
    /// The geometry must be alive, and the format that of `T`.
    unsafe fn fill<T: Copy>(&self, geometry: Handle, kind: u32, format: u32, values: &[T]) {
        // SAFETY: the buffer has room for all values, and is not used by anyone else yet.
        unsafe {
            let buffer: *mut c_void = (self.api.rtcSetNewGeometryBuffer)(
                geometry,
                kind,
                0,
                format,
                size_of::<T>(),
                values.len(),
            );
            assert!(!buffer.is_null(), "Embree is out of memory");
            std::ptr::copy_nonoverlapping(values.as_ptr(), buffer.cast::<T>(), values.len());
        }
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: alive until here; scenes hold on to the device.
        unsafe { (self.api.rtcReleaseDevice)(self.device) }
    }
}

/// A built scene.
pub struct EmbreeScene {
    pub(super) embree: Rc<Embree>,
    pub(super) scene: Handle,
    /// How it was built.
    pub quality: Quality,
    /// Whether traversal is watertight (RTC_SCENE_FLAG_ROBUST).
    pub robust: bool,
    /// CPU seconds of the build, which has one thread.
    pub seconds: f64,
}

impl Drop for EmbreeScene {
    fn drop(&mut self) {
        // SAFETY: alive until here.
        unsafe { (self.embree.api.rtcReleaseScene)(self.scene) }
    }
}

fn usual_paths() -> Vec<PathBuf> {
    let names = if cfg!(target_os = "macos") {
        ["libembree4.dylib", "libembree4.4.dylib"]
    } else if cfg!(windows) {
        ["embree4.dll", "embree4"]
    } else {
        ["libembree4.so.4", "libembree4.so"]
    };
    let folders = [
        "",
        "/usr/lib/x86_64-linux-gnu",
        "/usr/local/lib",
        "/opt/homebrew/lib",
    ];
    folders
        .iter()
        .flat_map(|folder| names.map(|name| Path::new(folder).join(name)))
        .collect()
}

/// Opens the library; where its TBB lies beside it and the linker does not look there, that first.
fn open(path: &Path) -> Result<Library, libloading::Error> {
    // SAFETY: the initialisers of Embree and TBB set up their own state only.
    unsafe { Library::new(path) }.or_else(|error| {
        let folder = path.parent().and_then(|folder| folder.read_dir().ok());
        let mut siblings = folder.into_iter().flatten().flatten();
        let tbb = siblings.find(|file| file.file_name().to_string_lossy().starts_with("libtbb"));
        let tbb = tbb.ok_or(error)?;
        // SAFETY: as above.
        let tbb = unsafe { Library::new(tbb.path()) }?;
        // SAFETY: as above.
        let library = unsafe { Library::new(path) };
        // It stays for as long as the program runs.
        std::mem::forget(tbb);
        library
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_library_says_how_to_get_one() {
        let missing =
            Embree::load_from(vec![PathBuf::from("/no/such/libembree4.so")], Isa::native());
        let text = missing.err().expect("there is no such file").to_string();
        assert!(text.contains("pip download --no-deps embreex==4.4.0.post1"));
        assert!(text.contains(PATH_VARIABLE) && !text.contains('\n'));
    }
}
