//! What a contour image claims, by exact definition: all that a proof needs beside the scene.

use crate::exact::Sign;
use crate::scene::{PieceId, PolygonId, Side, Splitter, SupportingPlane};
use glam::DVec3;

/// The claim that the cells tile the domain and that each shows its piece.
///
/// Nothing in it is rounded and nothing is derived: cells are named by the great circles that bound them,
/// great circles by the vertices, planes and numbers that define them. It says nothing about how the
/// image was made, and can be kept, sent and checked elsewhere: see [`Evidence::check`].
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// Where it was seen from.
    pub eye: DVec3,
    /// The directions that the cells are to tile.
    pub domain: EvidenceDomain,
    /// The epsilon of the 3D splitter, in scene units; 0 for exact order.
    pub epsilon: f64,
    /// What was left uncut because of epsilon.
    pub slivers: Vec<EvidenceSliver>,
    /// The great circles, each once.
    pub splitters: Vec<Splitter>,
    /// The cells.
    pub cells: Vec<EvidenceCell>,
}

/// The directions that the cells are to tile.
#[derive(Clone, Debug, PartialEq)]
pub enum EvidenceDomain {
    /// All of them.
    Sphere,
    /// Those with `normal . d >= 0`.
    Hemisphere(DVec3),
    /// Those above the supporting plane of a piece, moved to the eye; the eye is not behind that plane.
    Above(PieceId, Side),
    /// Those inside of four half-spaces, by the normals to the inside, counter-clockwise seen from outside of the sphere.
    Frustum([DVec3; 4]),
    /// Those in which a window lies: the union of all of them.
    Window {
        /// The windows.
        panes: Vec<EvidencePane>,
        /// What they are cut off at.
        horizon: Option<EvidenceHorizon>,
    },
}

/// A window.
#[derive(Clone, Debug, PartialEq)]
pub enum EvidencePane {
    /// A polygon of the scene.
    Polygon(PolygonId),
    /// A convex ring of at least three points, in either direction, no three neighbours in line. Seen edge-on it has no inside.
    Ring(Vec<DVec3>),
}

/// What a domain ends at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EvidenceHorizon {
    /// In it is what has `normal . d >= 0`.
    Normal(DVec3),
    /// In it is what is above the supporting plane of a piece, moved to the eye; the eye is not behind that plane.
    Above(PieceId, Side),
}

impl EvidenceDomain {
    /// What it ends at, if it has a horizon.
    pub fn horizon(&self) -> Option<EvidenceHorizon> {
        match *self {
            Self::Sphere | Self::Frustum(_) => None,
            Self::Hemisphere(normal) => Some(EvidenceHorizon::Normal(normal)),
            Self::Above(piece, side) => Some(EvidenceHorizon::Above(piece, side)),
            Self::Window { horizon, .. } => horizon,
        }
    }
}

/// A piece that may be in wrong order with others, in the part of it that lies beyond a plane by less than
/// epsilon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvidenceSliver {
    /// The piece.
    pub piece: PieceId,
    /// The plane.
    pub plane: SupportingPlane,
    /// The side of the plane on which that part lies; `None` if it is both, as the piece was taken to lie in it.
    pub beyond: Option<Side>,
}

/// A cell: a cyclic list of half spheres, whose intersection it is, and what is seen in it.
#[derive(Clone, Debug, PartialEq)]
pub struct EvidenceCell {
    /// The piece; `None` for background.
    pub piece: Option<PieceId>,
    /// Its sides, counter-clockwise seen from outside of the sphere. Neighbours may be on one great circle.
    pub sides: Vec<HalfSphere>,
}

/// One side of a great circle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct HalfSphere {
    /// The great circle, as an index into [`Evidence::splitters`].
    pub splitter: u32,
    /// The sign that directions inside have; never 0.
    pub inside: Sign,
}
