//! What must hold of every contour image and every 3D BSP, as functions that tell what is wrong.

mod agreement;
mod fragments;
mod labels;
mod order;
mod regions;
mod tiling;

pub use agreement::{check_same_bits, check_same_view};
pub use fragments::check_fragments;
pub use labels::{check_labels, inner_directions};
pub use order::{check_mirror, check_order};
pub use regions::{check_regions, check_same_regions};
pub use tiling::{angle_tolerance, check_closed, check_sums, check_tiling, telling_directions};

use super::RayOracle;
use crate::bsp::{FragmentId, SceneBsp};
use crate::contour::{CellId, ContourImage};
use crate::scene::{PieceId, PolygonId, Side};
use crate::verify::RayAnswer;
use glam::DVec3;

/// What a check found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Defect {
    /// The proof of an image fails.
    #[error("the proof fails: {0}")]
    Proof(#[from] crate::verify::Defect),
    /// The two arithmetics do not agree on evidence.
    #[error("the kernel says {kernel}, rational numbers say {rational}")]
    Verdicts {
        /// The kernel's verdict.
        kernel: String,
        /// That of rational numbers.
        rational: String,
    },
    /// Evidence was accepted that claims something else than what is seen.
    #[error("evidence was accepted that claims {claims:?} in direction {direction}, where {shown:?} is seen")]
    Accepted {
        /// The direction.
        direction: DVec3,
        /// What the cells claim that have the direction inside.
        claims: Vec<Option<PieceId>>,
        /// What is seen there.
        shown: Option<PieceId>,
    },
    /// The sum of all cells' solid angles is not that of the domain.
    #[error("the cells cover {total} sr instead of {expected} sr, more than {tolerance:e} off")]
    SolidAngles {
        /// The sum.
        total: f64,
        /// The domain's.
        expected: f64,
        /// What rounding may amount to.
        tolerance: f64,
    },
    /// The form factors do not sum to 1.
    #[error("the form factors sum to {total}, more than {tolerance:e} off 1")]
    FormFactors {
        /// The sum.
        total: f64,
        /// What rounding may amount to.
        tolerance: f64,
    },
    /// A direction strictly inside of more than one cell, or of the domain but of no cell, or of a cell
    /// outside of the domain.
    #[error("direction {direction} lies strictly inside of the cells {cells:?}, and on the boundary of {touched}")]
    NotTiled {
        /// The direction.
        direction: DVec3,
        /// The cells that have it strictly inside.
        cells: Vec<CellId>,
        /// How many have it on their boundary.
        touched: usize,
    },
    /// Point location names another cell than the one that has the direction inside.
    #[error("direction {direction} lies in {inside:?} but is located in {located:?}")]
    Location {
        /// The direction.
        direction: DVec3,
        /// The cell that has it strictly inside; none if it is on a boundary or outside of the domain.
        inside: Option<CellId>,
        /// The cell that [`ContourImage::locate`] names.
        located: Option<CellId>,
    },
    /// A cell does not show what a ray meets.
    #[error("cell {cell:?} shows {shown:?}, but the ray in direction {direction} sees {ray:?}")]
    Label {
        /// The cell.
        cell: CellId,
        /// A direction strictly inside of it.
        direction: DVec3,
        /// What it shows.
        shown: Option<(PolygonId, PieceId, Side)>,
        /// What the oracle says.
        ray: RayAnswer,
    },
    /// A cell of a closed scene shows the background.
    #[error("cell {cell:?} shows the background of a closed scene")]
    Background {
        /// The cell.
        cell: CellId,
    },
    /// The fragments of a piece do not tile it.
    #[error("the fragments of piece {piece:?} do not tile it: {what}")]
    Fragments {
        /// The piece.
        piece: PieceId,
        /// What is wrong.
        what: FragmentFault,
    },
    /// A fragment that hides an earlier one somewhere; no uncut sliver excuses it.
    #[error("fragment {later:?} comes after fragment {earlier:?} and hides it somewhere")]
    Order {
        /// The earlier one.
        earlier: FragmentId,
        /// The later one.
        later: FragmentId,
    },
    /// Back to front is not front to back in reverse.
    #[error("the two traversals differ at place {place} from the nearest")]
    Mirror {
        /// The place, from 0.
        place: usize,
    },
    /// Two images that must agree show something different in one direction.
    #[error("in direction {direction} one image shows {first:?} and the other {second:?}")]
    Disagreement {
        /// The direction in the first image.
        direction: DVec3,
        /// What the first shows.
        first: Option<(PolygonId, Side)>,
        /// What the second shows.
        second: Option<(PolygonId, Side)>,
    },
    /// Two images that must agree show something under different solid angles.
    #[error("{what:?} is seen under {first} sr and under {second} sr, more than {tolerance:e} apart")]
    Angles {
        /// A polygon and its side, or the background.
        what: Option<(PolygonId, Side)>,
        /// Its solid angle in the first image.
        first: f64,
        /// Its solid angle in the second.
        second: f64,
        /// What rounding may amount to.
        tolerance: f64,
    },
    /// The visible regions of an image are not its cells merged, or those of two images differ.
    #[error("the visible regions are wrong: {what}")]
    Regions {
        /// In what.
        what: String,
    },
    /// Two images that must be the same differ.
    #[error("the two images differ: {what}")]
    Bits {
        /// In what.
        what: String,
    },
}

/// What can be wrong with the fragments of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FragmentFault {
    /// A corner is not in the piece's plane.
    #[error("a corner of fragment {0:?} is not in the plane")]
    OffPlane(FragmentId),
    /// A fragment is not convex and counter-clockwise.
    #[error("fragment {0:?} is not convex and counter-clockwise")]
    NotConvex(FragmentId),
    /// There is a gap or an overlap: the boundaries do not cancel.
    #[error("the fragments leave a gap or overlap")]
    Boundary,
}

/// All that must hold of a contour image of a small scene: it is proved ([`ContourImage::certify`]), solid angles sum to the domain's and form factors to
/// 1 ([`check_sums`]), directions inside of cells and through the scene's vertices and between them lie in exactly
/// one cell ([`check_tiling`]), and cells show what rays meet ([`check_labels`]).
///
/// Cost: up to 34 directions, each against all cells in exact integers, and a ray over all pieces for
/// up to three directions a cell.
///
/// # Errors
/// The first thing that does not hold.
pub fn check_image(image: &ContourImage) -> Result<(), Defect> {
    image.certify()?;
    check_sums(image)?;
    check_tiling(image, &telling_directions(image))?;
    check_labels(image, &RayOracle::new(image.scene()))?;
    Ok(())
}

/// All that must hold of a 3D BSP of a small scene: the fragments of each piece tile it
/// ([`check_fragments`]), and from the eye they come front to back ([`check_order`]), with the reverse order the exact mirror
/// ([`check_mirror`]).
///
/// Cost: all pairs of fragments, in exact integers.
///
/// # Errors
/// The first thing that does not hold.
pub fn check_bsp(bsp: &SceneBsp, eye: DVec3) -> Result<(), Defect> {
    check_fragments(bsp)?;
    check_mirror(bsp, eye)?;
    check_order(bsp, eye)
}
