//! What the rays of a packet have in common, so that the kernels know it for all of them.

use crate::ray::Ray;

/// Which planes of a box a ray enters through: whether its direction is negative along each axis.
pub(crate) type Octant = [bool; 3];

#[inline(always)]
pub(crate) fn octant(ray: &Ray) -> Octant {
    ray.dir.map(|x| x < 0.0)
}

/// The order of the axes in which a ray runs mostly along the last one, with the winding kept.
pub(crate) type Axes = [usize; 3];

/// All orders. Two axes swap for negative directions.
pub(crate) const AXES: [Axes; 6] = [
    [1, 2, 0],
    [2, 1, 0],
    [2, 0, 1],
    [0, 2, 1],
    [0, 1, 2],
    [1, 0, 2],
];

#[inline(always)]
pub(crate) fn axes(ray: &Ray) -> Axes {
    // From a table, because mispredicted branches would cost more than the test of a packet.
    AXES[axes_index(ray) % AXES.len()]
}

/// The index of the ray's order among [`AXES`].
#[inline(always)]
pub(crate) fn axes_index(ray: &Ray) -> usize {
    let [x, y, z] = ray.dir.map(f32::abs);
    let greatest = if (z >= x) & (z >= y) {
        2
    } else {
        usize::from(y >= x)
    };
    2 * greatest + usize::from(ray.dir[greatest] < 0.0)
}

/// The order in which the axis `greatest` comes last.
#[inline(always)]
pub(crate) fn ordered(greatest: usize, negative: bool) -> Axes {
    AXES[2 * greatest + usize::from(negative)]
}

/// What the rays of a packet have in common.
#[derive(Clone, Copy)]
pub(crate) struct Class {
    pub(crate) octant: Octant,
    pub(crate) axes: Axes,
}

impl Class {
    /// The index of the class of invalid rays, the greatest.
    pub(crate) const INVALID: usize = 24;

    #[inline(always)]
    pub(crate) fn of(ray: &Ray) -> Class {
        Class {
            octant: octant(ray),
            axes: axes(ray),
        }
    }

    #[inline(always)]
    pub(crate) fn index(ray: &Ray) -> usize {
        let Class { octant, axes } = Class::of(ray);
        let octant = octant.map(usize::from);
        let index = 8 * axes[2] + 4 * octant[2] + 2 * octant[1] + octant[0];
        if ray.is_valid() {
            index
        } else {
            Class::INVALID
        }
    }
}
