//! Which directions are looked at.

use glam::DVec3;

/// The directions that a view resolves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Domain {
    /// All of them: 4 pi steradians.
    Sphere,
    /// Those with `normal . d >= 0`: 2 pi steradians. The normal, of any length, defines the horizon
    /// exactly.
    Hemisphere(DVec3),
    /// Those above the surface that the viewpoint is on: 2 pi steradians, with the surface's own plane
    /// for a horizon.
    Above,
}
