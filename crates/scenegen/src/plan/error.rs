//! Why a scene has no plan.

/// What planning a scene can fail at.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The camera asked for is not there.
    #[error("there is no camera {wanted}; the scene has {available}")]
    NoSuchCamera {
        /// As the user wrote it.
        wanted: String,
        /// What there is.
        available: String,
    },
    /// The view given has no upright.
    #[error("the direction that is to be up, {up:?}, is the one of view, {dir:?}; give another")]
    UpAlongView {
        /// Of the view.
        dir: [f64; 3],
        /// Upwards.
        up: [f64; 3],
    },
    /// Parallel rays pass through no lens.
    #[error(
        "the camera {camera} sees by parallel rays, which no lens blurs; only perspective has depth of field"
    )]
    NoLens {
        /// Its name.
        camera: String,
    },
    /// Nothing says how far away it is sharp.
    #[error("nothing is in the middle of the image to focus on; give a distance of focus")]
    NothingInFocus,
    /// One renderer cannot show all moments.
    #[error(
        "other triangles are in the scene at other moments while the shutter is open; close it, or choose another time"
    )]
    OtherAtAnotherMoment,
    /// The scene needs more than 2³² words of something.
    #[error(
        "the scene is too large: its {what} do not fit 32-bit indices; split it or simplify it"
    )]
    TooLarge {
        /// What is too large.
        what: &'static str,
    },
}
