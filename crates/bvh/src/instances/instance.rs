//! An object placed in the world, and why that may be impossible.

use std::fmt;

use glam::Affine3A;

/// An object placed in the world.
///
/// The transform may mirror and shear. Fronts are the object's: the front of a triangle is the side
/// from which its vertices appear counter-clockwise in the object's space, and a mirror takes it
/// along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index of the object's hierarchy.
    pub bvh: usize,
    /// From the object's space to the world's.
    pub object_to_world: Affine3A,
}

/// An instance that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InvalidInstance {
    /// Index of the instance.
    pub instance: usize,
    /// What is wrong with it.
    pub fault: InstanceFault,
}

/// What is wrong with an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstanceFault {
    /// There is no hierarchy of this index.
    NoSuchObject {
        /// The index.
        bvh: usize,
    },
    /// The transform, or its inverse, has components that are not finite.
    NotFinite,
    /// The transform's determinant is zero, as far as `f64` can tell.
    NotInvertible,
}

impl fmt::Display for InvalidInstance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let InvalidInstance { instance, fault } = self;
        write!(f, "instance {instance}: ")?;
        match fault {
            InstanceFault::NoSuchObject { bvh } => write!(f, "there is no object {bvh}"),
            InstanceFault::NotFinite => write!(f, "the transform or its inverse is not finite"),
            InstanceFault::NotInvertible => write!(f, "the transform has no inverse"),
        }
    }
}

impl std::error::Error for InvalidInstance {}
