//! How bodies lie to each other: which medium a path is in, and what it meets where it crosses the surface of a body.

use super::{Crossing, MediumRecord, PathState};
use crate::domain::Domain;

/// How bodies lie to each other.
pub trait Nesting<D: Domain> {
    /// Index of the medium that a path with this state is in.
    fn medium(&self, d: D, state: PathState<D::U>) -> D::U;

    /// What a path in these media meets at the surface of a body that is filled with medium `interior`, on its front or its back.
    fn crossing(&self, d: D, media: D::U, front: D::M, interior: D::U) -> Crossing<D>;
}

/// Bodies lie beside each other: whoever leaves one is outside.
#[derive(Clone, Copy, Debug)]
pub struct Beside;

impl<D: Domain> Nesting<D> for Beside {
    #[inline(always)]
    fn medium(&self, d: D, state: PathState<D::U>) -> D::U {
        state.media(d)
    }

    #[inline(always)]
    fn crossing(&self, d: D, _: D::U, front: D::M, interior: D::U) -> Crossing<D> {
        Crossing {
            beyond: d.select_u(front, interior, d.uint(0)),
            around: None,
            hidden: None,
        }
    }
}

/// Bodies lie within each other (Schmidt and Budge 2002, "Simple nested dielectrics in ray traced images"). Where several
/// overlap, the one of the highest priority is there; among those of the same, the one that the path entered last.
///
/// A path remembers up to [`Nested::BODIES`] of the bodies that it is in, in that order. What it cannot remember, the one of
/// the lowest priority, is as if it were not there.
#[derive(Clone, Copy, Debug)]
pub struct Nested;

impl Nested {
    /// Bits of an index.
    const BITS: u32 = 5;
    /// How many bodies a path remembers.
    pub const BODIES: u32 = 4;
    /// The highest index of a medium.
    pub const MAX_MEDIUM: u32 = (1 << Self::BITS) - 1;

    /// The bodies from `from` on.
    fn mask(from: u32) -> u32 {
        let all = (1 << (Self::BITS * Self::BODIES)) - 1;
        all & !((1_u32 << (Self::BITS * from)) - 1)
    }

    #[inline(always)]
    fn body<D: Domain>(d: D, media: D::U, body: u32) -> D::U {
        (media >> (Self::BITS * body)) & d.uint(Self::MAX_MEDIUM)
    }

    /// The media with another body before the `at`th.
    #[inline(always)]
    fn with<D: Domain>(d: D, media: D::U, at: u32, medium: D::U) -> D::U {
        let before = media & d.uint(!Self::mask(at));
        let after = ((media & d.uint(Self::mask(at))) << Self::BITS) & d.uint(Self::mask(0));
        before | (medium << (Self::BITS * at)) | after
    }

    /// The media without the `at`th body.
    #[inline(always)]
    fn without<D: Domain>(d: D, media: D::U, at: u32) -> D::U {
        let before = media & d.uint(!Self::mask(at));
        let after = (media & d.uint(Self::mask(at + 1))) >> Self::BITS;
        before | after
    }
}

impl<D: Domain> Nesting<D> for Nested {
    #[inline(always)]
    fn medium(&self, d: D, state: PathState<D::U>) -> D::U {
        Self::body(d, state.media(d), 0)
    }

    #[inline(always)]
    fn crossing(&self, d: D, media: D::U, front: D::M, interior: D::U) -> Crossing<D> {
        let above = MediumRecord::load(d, interior).above;
        // Whoever enters is put behind the bodies that go before; those stand first. Whoever leaves is taken out where it is
        // found first. A body that a path leaves and was never in, as one around the camera, is left as if it had been.
        let is_within = !d.lt_u(Self::body(d, media, 0), above);
        let mut entered = media;
        let mut left = media;
        let mut left_is_hidden = is_within;
        for at in (0..Self::BODIES).rev() {
            let body = Self::body(d, media, at);
            let goes_before = match at {
                0 => d.truth(true),
                at => !d.lt_u(Self::body(d, media, at - 1), above),
            };
            // The one place before which all bodies go before, and from which on none does.
            let here = goes_before & d.lt_u(body, above);
            entered = d.select_u(here, Self::with(d, media, at, interior), entered);
            let found = d.eq_u(body, interior);
            left = d.select_u(found, Self::without(d, media, at), left);
            left_is_hidden = d.select_mask(found, d.truth(at > 0), left_is_hidden);
        }
        let beyond = d.select_u(front, entered, left);
        let outer = Self::body(d, d.select_u(front, media, left), 0);
        Crossing {
            beyond,
            around: Some(MediumRecord::load(d, outer).ior),
            hidden: Some(d.select_mask(front, is_within, left_is_hidden)),
        }
    }
}

/// [`Nesting`] chosen at run time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AnyNesting {
    /// [`Beside`].
    #[default]
    Beside,
    /// [`Nested`].
    Nested,
}

impl<D: Domain> Nesting<D> for AnyNesting {
    #[inline(always)]
    fn medium(&self, d: D, state: PathState<D::U>) -> D::U {
        match self {
            Self::Beside => Beside.medium(d, state),
            Self::Nested => Nested.medium(d, state),
        }
    }

    #[inline(always)]
    fn crossing(&self, d: D, media: D::U, front: D::M, interior: D::U) -> Crossing<D> {
        match self {
            Self::Beside => Beside.crossing(d, media, front, interior),
            Self::Nested => Nested.crossing(d, media, front, interior),
        }
    }
}
