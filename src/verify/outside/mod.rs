//! A second opinion on a contour image, with a triangulation that others wrote.
//!
//! On each face of the cube around the eye, the edges of all pieces, hidden ones too, and the lines where
//! pieces pass through each other are projected and rounded to a grid; `spade` triangulates what
//! they divide the face into. One polygon is seen in all of a triangle, but for a margin that rounding
//! explains. So a ray through its middle, tried on every piece, tells what the image should say there; and the areas
//! of the triangles tell how much of every polygon should be seen.

mod cube;
mod judge;
mod lines;
mod snap;

pub use cube::CubeFace;
pub use judge::second_opinion;

use super::RayAnswer;
use crate::scene::{PieceId, PolygonId};
use glam::DVec3;
use std::collections::BTreeMap;

/// A cell of an image as plain data.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// What is seen in it; `None` for background.
    pub polygon: Option<PolygonId>,
    /// Its corners in order, as directions of any length; it is convex and smaller than a half sphere.
    pub corners: Vec<DVec3>,
}

/// What an image says of a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Claim {
    /// A polygon is seen, or background.
    Shows(Option<PolygonId>),
    /// The direction lies exactly between cells.
    Boundary,
    /// The image does not cover it.
    Outside,
}

/// The opinion on one face of the cube.
#[derive(Clone, Debug, PartialEq)]
pub enum FaceOpinion {
    /// All labels and all areas agree.
    Agreement(Agreement),
    /// Some label or area differs: the first that was found.
    Disagreement(Disagreement),
    /// It could not be told.
    NoVerdict(NoVerdict),
}

/// What an agreement rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// The triangles in whose middle the labels were compared.
    pub triangles: usize,
    /// The triangles that were skipped: slivers, and those whose middle lies exactly on some boundary.
    pub skipped: usize,
    /// The largest difference of a polygon's area on the face, which is 4 in all.
    pub difference: f64,
    /// How large it may be.
    pub tolerance: f64,
    /// The solid angles of the polygons, and of the background, on the face, by triangles.
    pub solid_angles: BTreeMap<Option<PolygonId>, f64>,
}

/// How an image differs from the opinion on a face.
#[derive(Clone, Debug, PartialEq)]
pub enum Disagreement {
    /// In some direction.
    Label {
        /// The direction, exactly.
        direction: DVec3,
        /// What the ray says.
        ray: RayAnswer,
        /// What the image says.
        claim: Claim,
    },
    /// In the area of some polygon, or of the background.
    Area {
        /// The polygon.
        polygon: Option<PolygonId>,
        /// Its area by triangles.
        triangles: f64,
        /// Its area by cells.
        cells: f64,
        /// By how much they may differ.
        tolerance: f64,
    },
}

/// Why there is no opinion on a face.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoVerdict {
    /// A coordinate cannot be projected to the precision of the grid: the piece is too close to the eye for
    /// its size, or the numbers are too large or too small.
    #[error("piece {} cannot be projected with the precision that is needed", piece.0)]
    Imprecise {
        /// The piece.
        piece: PieceId,
    },
    /// The line where two pieces meet, which overlap in the face and are not coplanar, is too uncertain.
    #[error("pieces {} and {} lie in nearly the same plane", pieces[0].0, pieces[1].0)]
    NearlyCoplanar {
        /// The pieces.
        pieces: [PieceId; 2],
    },
    /// The edges have too many crossings.
    #[error("there are more than {limit} crossings")]
    TooManyCrossings {
        /// How many are allowed.
        limit: usize,
    },
    /// `spade` refused a vertex, or edges that it takes to cross.
    #[error("the triangulation refused {count} vertices or edges")]
    Refused {
        /// How many.
        count: usize,
    },
    /// Rounding, and triangles that were skipped, would excuse too large a difference.
    #[error("areas could only be compared to {tolerance:e}, which tells nothing")]
    TooVague {
        /// The tolerance that it would take.
        tolerance: f64,
    },
    /// `spade` panicked.
    #[error("the triangulation panicked")]
    Panicked,
}
