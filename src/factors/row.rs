//! A row of the matrix: where what leaves one patch goes.

use crate::scene::PolygonId;
use glam::DVec3;

/// What is told of a patch.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchInfo {
    /// Its name: that of the polygon's object.
    pub name: String,
    /// The polygon that it is, or is part of; of an object the first one.
    pub polygon: PolygonId,
    /// Its area, in square scene units; 0 for a degenerate face. Where numbers do not hold it, with sides above 1e154 or below 1e-162, it is infinite or 0,
    /// and factors are what they are all the same.
    pub area: f64,
    /// Where it is; `None` if it has no area.
    pub shape: Option<PatchShape>,
}

/// Where a patch is, in scene units.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchShape {
    /// Its centre of mass. That of a patch that is not convex, or not flat, may lie beside it.
    pub center: DVec3,
    /// The unit normal of its front; of a patch that is not flat the direction of its vector area, the integral of its normals. `None` if that
    /// is 0, as of a closed surface: shorter than 1e-9 of the area.
    pub normal: Option<DVec3>,
    /// The convex pieces that it consists of, each counter-clockwise seen from its front: one for a convex polygon, or a part of a mesh. Corners of
    /// polygons are exactly those of the scene.
    pub pieces: Vec<Vec<DVec3>>,
}

impl PatchShape {
    /// The corners of a patch that is one convex piece, counter-clockwise seen from its front.
    pub fn boundary(&self) -> Option<&[DVec3]> {
        match &self.pieces[..] {
            [only] => Some(only),
            _ => None,
        }
    }
}

/// A form factor with an estimate of its absolute error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Share {
    /// The part of what leaves the row's patch, diffusely, that arrives: 0 to 1.
    pub factor: f64,
    /// An estimate of its absolute error, not below it in all but rare cases.
    pub error: f64,
}

/// An entry that is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The patch whose front it arrives at.
    pub column: u32,
    /// How much.
    pub share: Share,
}

/// The form factors `F[i][j]` from the front of patch i to the fronts of all patches j, to backs, and to the background.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The number i of the patch.
    pub patch: u32,
    /// The entries that are not zero, by ascending column.
    pub entries: Vec<Entry>,
    /// What arrives at backs, of whatever polygon.
    pub backs: Share,
    /// What leaves the scene.
    pub background: Share,
    /// The sum of all of these before any residue was placed: 1 plus the residue. 0 for a patch without area.
    pub closure_raw: f64,
}

impl Row {
    /// The sum of all entries, backs and background: 1 up to rounding, or 0 for a patch without area.
    pub fn sum(&self) -> f64 {
        let entries: f64 = self.entries.iter().map(|entry| entry.share.factor).sum();
        entries + self.backs.factor + self.background.factor
    }
}
