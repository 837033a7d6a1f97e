//! A scene's renderer as a shared library. A member of the workspace, so that its builds of the other crates are used;
//! nothing but emitted code is in it, and nothing at all without `RESIDUAL_SCENE`.

include!(env!("RESIDUAL_EMITTED_CODE"));
