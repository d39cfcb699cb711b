//! What can be wrong with what baselines are asked for.

use super::view::Hemicube;
use crate::contour::Viewpoint;
use crate::scene::{PieceId, PlaneId, Scene};

/// Why there is no baseline or no view.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// A resolution that is odd, 0 or too large.
    #[error("a hemicube's resolution is an even number from 2 to {}, not {resolution}", Hemicube::MAX_RESOLUTION)]
    BadResolution {
        /// The resolution asked for.
        resolution: usize,
    },
    /// No rays.
    #[error("at least one ray is needed")]
    NoRays,
    /// The eye has a coordinate that is infinite or not a number.
    #[error("the eye has a coordinate that is not finite")]
    EyeNotFinite,
    /// The normal is zero, or not finite.
    #[error("the normal is zero or not finite")]
    BadNormal,
    /// The viewpoint is on a piece that the scene does not have.
    #[error("the viewpoint is on piece {piece}, which is not in this scene")]
    NotInScene {
        /// That piece.
        piece: PieceId,
    },
}

impl BaselineError {
    /// The plane of the piece that a viewpoint is on, if it is on one.
    pub(super) fn check_viewpoint(viewpoint: &Viewpoint, scene: &Scene) -> Result<Option<PlaneId>, Self> {
        if !viewpoint.eye().is_finite() {
            return Err(Self::EyeNotFinite);
        }
        match viewpoint.surface_piece() {
            Some((piece, _)) if piece.index() >= scene.piece_count() => Err(Self::NotInScene { piece }),
            Some((piece, _)) => Ok(Some(scene.piece(piece).plane_id())),
            None => Ok(None),
        }
    }
}
