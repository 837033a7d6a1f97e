//! What can go wrong on the way to a GPU, and what to do about it.

/// An error of the device.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is no adapter.
    #[error(
        "no graphics adapter was found; install a Vulkan driver (mesa-vulkan-drivers has one that needs no GPU), or set \
         VK_DRIVER_FILES to the driver's JSON file, as in containers with an NVIDIA card; --device cpu needs none"
    )]
    NoAdapter,
    /// There is no adapter of this name.
    #[error("no graphics adapter is called {name:?}; there are: {}", known.join("; "))]
    NoSuchAdapter {
        /// What was asked for.
        name: String,
        /// The names of the adapters that there are.
        known: Vec<String>,
    },
    /// The adapter cannot do what is needed.
    #[error("{adapter} cannot render: {reason}; choose another with --adapter, or --device cpu")]
    Unsuitable {
        /// Its name.
        adapter: String,
        /// What it lacks.
        reason: String,
    },
    /// The scene does not fit the adapter.
    #[error(
        "{what} takes {} MiB, and {adapter} allows {} MiB; use fewer triangles or smaller images, or --device cpu",
        bytes.div_ceil(1 << 20), limit >> 20
    )]
    TooLarge {
        /// Its name.
        adapter: String,
        /// What does not fit.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// What would fit.
        limit: u64,
    },
    /// The hierarchy is deeper than the kernel's stack.
    #[error(
        "the hierarchy needs a stack of {needed} entries, and kernels have {available}; render with --device cpu, and please report this scene"
    )]
    TooDeep {
        /// Entries that it may need.
        needed: usize,
        /// Entries that there are.
        available: usize,
    },
    /// A set of kernels lacks one.
    #[error("the kernels of the scene lack {name}; emit them anew")]
    NoKernel {
        /// Which.
        name: &'static str,
    },
    /// A kernel was refused.
    #[error(
        "the kernel {kernel} was refused by {adapter}: {reason}; please report this, and render with --device cpu"
    )]
    Kernel {
        /// Which.
        kernel: String,
        /// Whose driver it was.
        adapter: String,
        /// What it or wgpu said.
        reason: String,
    },
    /// The device was lost, or ran out of memory, or something else failed on it.
    #[error("{adapter} failed: {reason}")]
    Failed {
        /// Its name.
        adapter: String,
        /// What wgpu said.
        reason: String,
    },
}
