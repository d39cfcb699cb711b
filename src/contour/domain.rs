//! Which directions are looked at.

use super::frustum::Frustum;
use super::windows::{Horizon, Windows};
use glam::DVec3;

/// The directions that a view resolves. Clones are cheap.
#[derive(Clone, Debug, PartialEq)]
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
    /// Those that a camera sees.
    Frustum(Frustum),
    /// Those inside of windows.
    Window(Windows),
}

impl Domain {
    /// The horizon that it ends at, if it has one.
    pub fn horizon(&self) -> Option<Horizon> {
        match self {
            Self::Sphere | Self::Frustum(_) => None,
            Self::Hemisphere(normal) => Some(Horizon::Normal(*normal)),
            Self::Above => Some(Horizon::Surface),
            Self::Window(windows) => windows.horizon(),
        }
    }
}
