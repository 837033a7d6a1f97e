//! How exactly a ray meets a triangle, as a type: the tests, and what each starts from and returns.

pub(crate) mod ending;
pub(crate) mod exact;
mod expansion;
pub(crate) mod fast;
pub(crate) mod interval;
pub(crate) mod shear_bounds;
pub(crate) mod shearing;
pub(crate) mod triangle;
pub(crate) mod triangle_test;
pub(crate) mod watertight;
