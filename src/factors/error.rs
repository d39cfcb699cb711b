//! Why there are no form factors.

use crate::scene::{PolygonId, SceneError};
use glam::DVec3;

/// Why there are no form factors between patches.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExchangeError {
    /// The tolerance is not a positive number.
    #[error("the tolerance has to be a positive number, not {tolerance}")]
    BadTolerance {
        /// What was asked for.
        tolerance: f64,
    },
    /// The longest edge is not a positive number.
    #[error("the longest edge of a mesh has to be a positive number, not {longest_edge}")]
    BadEdge {
        /// What was asked for.
        longest_edge: f64,
    },
    /// A polygon would fall into too many patches.
    #[error("polygon {polygon} would fall into more than 4 million patches; take a longer edge")]
    TooFine {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A patch is too small for the scene that it is in.
    #[error(
        "polygon {polygon}, or a part of it, has less than 1e-140 of the area that the scene has across, beyond the range of numbers; remove it, or compute the parts of the \
         scene by themselves"
    )]
    TooSmall {
        /// The polygon.
        polygon: PolygonId,
    },
    /// There are more patches than can be numbered.
    #[error("there are more than 4 billion patches; take a longer edge")]
    TooManyPatches,
    /// There is no patch of that number.
    #[error("there is no patch {patch}: there are {count}, numbered from 0")]
    UnknownPatch {
        /// The number asked for.
        patch: usize,
        /// How many there are.
        count: usize,
    },
    /// The pieces of the scene cannot be joined to facets.
    #[error("the scene's polygons cannot be joined: {0}")]
    Facets(SceneError),
    /// A view cannot be taken.
    #[error("no view from {point}: {problem}")]
    NoView {
        /// From where.
        point: DVec3,
        /// Why.
        problem: String,
    },
    /// Views show too many pairs of patches.
    #[error(
        "views show more than {limit} factors between patches; take a longer edge, or a tolerance, to which rows are computed one by one"
    )]
    TooManyFactors {
        /// How many are allowed.
        limit: usize,
    },
    /// What a row lacks is more than the estimates of its errors.
    #[error(
        "row {patch} sums to 1 only up to {residue:e}, and estimates of its errors explain {estimates:e}; {}", advice(*.overlap)
    )]
    NotClosed {
        /// The row.
        patch: usize,
        /// 1 less the sum.
        residue: f64,
        /// The sum of the estimates.
        estimates: f64,
        /// Two polygons of the scene that show the same way and lie on each other, but not in one plane exactly: which of them is seen there is for rounding to say, and no row may close.
        overlap: Option<[PolygonId; 2]>,
    },
}

fn advice(overlap: Option<[PolygonId; 2]>) -> String {
    match overlap {
        Some([a, b]) => format!(
            "polygons {a} and {b} lie on each other within rounding, which tells which of them is seen: cut off one of them where the other one is"
        ),
        None => "ask for a smaller tolerance, or for smaller patches (`--patch SIZE`, a mesh)".to_string(),
    }
}
