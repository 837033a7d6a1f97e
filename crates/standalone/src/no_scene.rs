// Stands in for emitted code: a program without a scene.

pub(crate) const SCENE: Option<crate::StandaloneScene> = None;
