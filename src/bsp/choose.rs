//! Which plane splits a node.

use super::fragment::{Bounds, FragmentSide};
use super::skeleton::Skeleton;
use crate::scene::{Axis, PlaneId};

/// What the choice needs to know of a fragment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate<'a> {
    pub(super) bounds: Bounds,
    pub(super) own: PlaneId,
    pub(super) sides: &'a [FragmentSide],
}

/// Up to this many fragments only planes of polygons are tried.
const FEW: usize = 8;
/// How many coordinates an axis, and how many polygon planes, are tried.
const AXIS_CANDIDATES: usize = 48;
const PLANE_CANDIDATES: usize = 8;
/// How many fragments a polygon plane is scored against.
const SCORED: usize = 96;
/// What a cut costs in units of a fragment that is only visited.
const CUT: f64 = 1.5;

/// A chosen plane.
pub(super) enum Choice {
    /// The plane of a fragment in the node.
    Polygon(PlaneId),
    /// An axis-aligned plane through a coordinate of a vertex.
    Axis(Axis, f64),
}

/// Chooses a plane for a node with at least one fragment. Either some fragment lies in the plane,
/// or both sides get fewer fragments than there are: building always makes progress.
pub(super) fn choose(skeleton: &Skeleton, items: &[Candidate<'_>], grid: &dyn Fn(f64) -> bool) -> Choice {
    if items.len() > FEW
        && let Some((axis, value)) = best_axis_plane(items, grid)
    {
        return Choice::Axis(axis, value);
    }
    Choice::Polygon(best_polygon_plane(skeleton, items))
}

/// The surface-area cost (`MacDonald` and Booth 1990) of the best axis-aligned plane through a bound of
/// some fragment's box, if it separates anything.
fn best_axis_plane(items: &[Candidate<'_>], grid: &dyn Fn(f64) -> bool) -> Option<(Axis, f64)> {
    let whole = items.iter().fold(Bounds::EMPTY, |b, item| b.union(item.bounds));
    let total = items.len();
    // Areas relative to the node's size: right at any scale.
    let unit = whole.extent();
    if unit <= 0.0 || !unit.is_finite() {
        return None;
    }
    let mut best: Option<(f64, Axis, f64)> = None;
    let mut counts = Vec::new();
    for axis in Axis::ALL {
        let k = axis as usize;
        let stride = total.div_ceil(AXIS_CANDIDATES / 2);
        let mut values: Vec<f64> = items
            .iter()
            .step_by(stride)
            .flat_map(|item| [item.bounds.low[k], item.bounds.high[k]])
            .filter(|&x| grid(x))
            .collect();
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        // Per candidate: fragments that end at or below it first there, that begin at or above it
        // last there, and that lie in it.
        counts.clear();
        counts.resize(values.len() + 1, [0usize; 3]);
        for item in items {
            let (low, high) = (item.bounds.low[k], item.bounds.high[k]);
            let first_at_or_above = values.partition_point(|&c| c < high);
            let past_last_at_or_below = values.partition_point(|&c| c <= low);
            counts[first_at_or_above][0] += 1;
            counts[past_last_at_or_below][1] += 1;
            if low >= high && values.get(first_at_or_above).is_some_and(|&c| c <= low) {
                counts[first_at_or_above][2] += 1;
            }
        }
        let mut at_or_below = 0;
        let mut not_above = 0;
        for (i, &c) in values.iter().enumerate() {
            at_or_below += counts[i][0];
            not_above += counts[i][1];
            let inside = counts[i][2];
            let (back, front) = (at_or_below - inside, total - not_above - inside);
            let spanning = total - inside - back - front;
            if (back + spanning == total || front + spanning == total) && inside == 0 {
                continue;
            }
            let (mut below, mut above) = (whole, whole);
            below.high[k] = c;
            above.low[k] = c;
            let cost = below.half_area(unit) * (back + spanning) as f64
                + above.half_area(unit) * (front + spanning) as f64
                + CUT * whole.half_area(unit) * spanning as f64;
            if cost.is_finite() && best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, c));
            }
        }
    }
    best.map(|(_, axis, value)| (axis, value))
}

/// The polygon plane with the least cuts and the best balance among a few.
fn best_polygon_plane(skeleton: &Skeleton, items: &[Candidate<'_>]) -> PlaneId {
    let stride = items.len().div_ceil(PLANE_CANDIDATES);
    let scored = items.len().div_ceil(SCORED);
    let mut best = (f64::INFINITY, items[0].own);
    for candidate in items.iter().step_by(stride) {
        let plane = candidate.own;
        let (mut front, mut back, mut cut) = (0usize, 0usize, 0usize);
        for item in items.iter().step_by(scored) {
            if item.own == plane {
                continue;
            }
            let tolerance = 1e-9 * item.bounds.extent();
            let (mut low, mut high) = (0.0f64, 0.0f64);
            for side in item.sides {
                let h = skeleton.rounded_height(plane, side.point);
                low = low.min(h);
                high = high.max(h);
            }
            match (low < -tolerance, high > tolerance) {
                (true, true) => cut += 1,
                (true, false) => back += 1,
                (false, true) => front += 1,
                (false, false) => {}
            }
        }
        let score = front.abs_diff(back) as f64 + 4.0 * cut as f64;
        if score < best.0 {
            best = (score, plane);
        }
    }
    best.1
}
