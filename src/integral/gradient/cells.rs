//! Which cells touch a stretch of a great circle, and whether they hide what lies behind it.

use crate::contour::ContourImage;
use crate::scene::PieceId;
use glam::DVec3;

/// A stretch of a great circle.
pub(super) struct Stretch {
    /// Unit normals of the great circle, and inward ones of the ends; none where it is half a circle or longer.
    normal: DVec3,
    ends: Option<[DVec3; 2]>,
}

/// Cells that are nearer than this touch a stretch: rounding errs towards touching, and a stretch that more cells touch is less often hidden.
const NEAR: f64 = 1e-9;

impl Stretch {
    /// Counter-clockwise about a unit normal, from one unit direction to another, less than half a circle.
    pub(super) fn between(normal: DVec3, from: DVec3, to: DVec3) -> Self {
        Self { normal, ends: Some([normal.cross(from), to.cross(normal)]) }
    }

    /// The shortest that holds all of those vectors, which are perpendicular to a unit normal.
    pub(super) fn around(normal: DVec3, vectors: impl Iterator<Item = DVec3> + Clone) -> Self {
        let units = vectors.map(DVec3::normalize_or_zero);
        let middle = units.clone().sum::<DVec3>().normalize_or_zero();
        let aside = normal.cross(middle);
        let mut range = [0.0_f64; 2];
        for unit in units {
            if unit.dot(middle) < 0.01 {
                return Self { normal, ends: None };
            }
            let angle = unit.dot(aside).atan2(unit.dot(middle));
            range = [range[0].min(angle), range[1].max(angle)];
        }
        let [from, to] = range.map(|angle| middle * angle.cos() + aside * angle.sin());
        Self::between(normal, from, to)
    }

    /// False only for convex polygons that are certainly away from it.
    fn may_touch(&self, corners: &[DVec3]) -> bool {
        let is_beyond = |inward: DVec3| corners.iter().all(|corner| corner.dot(inward) < -NEAR);
        let ends = self.ends.into_iter().flatten();
        !(ends.chain([self.normal, -self.normal]).any(is_beyond))
    }
}

/// The cells of an image, put together when they are asked for.
#[derive(Default)]
pub(super) struct Cells {
    all: Vec<(Vec<DVec3>, Option<PieceId>)>,
}

impl Cells {
    /// True if points are exactly behind whatever is seen along a stretch and on both sides of it: if the eye moves a little they stay hidden. O(corners of cells).
    pub(super) fn hide(&mut self, image: &ContourImage, points: &[DVec3], stretch: &Stretch) -> bool {
        if self.all.is_empty() {
            self.all = image.cells().map(|cell| (cell.boundary().collect(), cell.piece())).collect();
        }
        let mut touching = self.all.iter().filter(|(corners, _)| stretch.may_touch(corners));
        touching.all(|&(_, piece)| piece.is_some_and(|piece| points.iter().all(|&p| image.is_behind(piece, p))))
    }
}
