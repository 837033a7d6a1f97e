//! What goes wrong is said in words that help.

use residual_device_wgpu::{Error, Gpu, list_adapters};

use crate::machine;

#[test]
fn unknown_adapters_are_answered_with_the_known_ones() {
    if machine().is_none() {
        return;
    }
    let error = Gpu::open(Some("no such card")).err().expect("a refusal");
    let message = error.to_string();
    assert!(matches!(error, Error::NoSuchAdapter { .. }), "{message}");
    assert!(message.contains("\"no such card\""), "{message}");
    for adapter in list_adapters() {
        assert!(message.contains(&adapter.name), "{message}");
    }
}

/// A part of the name will do, in any case.
#[test]
fn adapters_are_opened_by_parts_of_their_names() {
    for adapter in list_adapters() {
        let part: String = adapter.name.chars().take(5).collect();
        let gpu = Gpu::open(Some(&part.to_uppercase()));
        let gpu = gpu.unwrap_or_else(|error| panic!("{error}"));
        let name = gpu.adapter.name.to_lowercase();
        assert!(name.contains(&part.to_lowercase()), "{name} for {part}");
    }
}

/// Each message says what is wrong, with numbers, and what to do instead.
#[test]
fn messages_say_what_to_do() {
    let adapter = "Card".to_owned();
    let too_large = Error::TooLarge {
        adapter: adapter.clone(),
        what: "the scene's textures",
        bytes: (3 << 30) + 1,
        limit: 2 << 30,
    };
    let too_deep = Error::TooDeep {
        needed: 99,
        available: 64,
    };
    let unsuitable = Error::Unsuitable {
        adapter: adapter.clone(),
        reason: "it is too old".to_owned(),
    };
    let kernel = Error::Kernel {
        kernel: "shade".to_owned(),
        adapter,
        reason: "expected ;".to_owned(),
    };
    for (error, texts) in [
        (
            too_large,
            &[
                "textures",
                "3073 MiB",
                "2048 MiB",
                "smaller images",
                "--device cpu",
            ][..],
        ),
        (too_deep, &["99", "64", "--device cpu", "report"]),
        (
            unsuitable,
            &["Card", "too old", "--adapter", "--device cpu"],
        ),
        (
            kernel,
            &["shade", "Card", "expected ;", "report", "--device cpu"],
        ),
        (
            Error::NoAdapter,
            &["mesa-vulkan-drivers", "VK_DRIVER_FILES", "--device cpu"],
        ),
    ] {
        let message = error.to_string();
        for text in texts {
            assert!(message.contains(text), "{message:?} does not say {text:?}");
        }
    }
}
