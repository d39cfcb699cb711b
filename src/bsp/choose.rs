//! Which plane splits a node.

use super::fragment::{Bounds, FragmentSide};
use super::skeleton::Skeleton;
use crate::exact::ApproxPlane;
use crate::scene::{Axis, PlaneId, VertexId};

/// What the choice needs to know of a fragment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate<'a> {
    pub(super) bounds: Bounds,
    pub(super) own: PlaneId,
    pub(super) sides: &'a [FragmentSide],
}

/// How the planes that split a [`SceneBsp`](super::SceneBsp) are chosen. Every choice gives a right order; they differ in
/// splits, depth and time (docs/bsp.md has figures).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PlaneChoice {
    /// With more than eight fragments, the axis-aligned plane of least surface-area cost if it cuts few of them and no side gets nearly
    /// all; otherwise the plane of a polygon that does so; otherwise the best of those and of planes through three vertices, by the
    /// expected work below.
    #[default]
    Balanced,
    /// Always the axis-aligned plane of least surface-area cost (`MacDonald` and Booth 1990) with more than eight fragments, if one
    /// separates anything; planes of polygons otherwise.
    SurfaceArea,
    /// Planes of polygons only (Fuchs, Kedem and Naylor 1980). A convex mesh becomes a list: time quadratic in its size.
    Polygons,
}

/// Up to this many fragments only planes of polygons are tried.
const FEW: usize = 8;
/// How many coordinates an axis, and how many fragments for planes of their own, are tried.
const AXIS_CANDIDATES: usize = 48;
const PLANE_CANDIDATES: usize = 8;
/// How many fragments a plane that is not axis-aligned is scored against.
const SCORED: usize = 96;
/// What a cut costs in units of a fragment that is only visited, in the surface-area cost.
const CUT: f64 = 1.5;
/// A plane is clean if it cuts at most this share of the fragments, and no side gets more than a certain share.
const FEW_CUTS: f64 = 1.0 / 16.0;
/// That share for axis-aligned planes, which may cut off empty space ...
const NOT_ALL: f64 = 0.95;
/// ... and for planes of polygons.
const BALANCED: f64 = 0.8;

/// A chosen plane.
pub(super) enum Choice {
    /// The plane of a fragment in the node.
    Polygon(PlaneId),
    /// An axis-aligned plane through a coordinate of a vertex; both sides get fewer fragments than there are.
    Axis(Axis, f64),
    /// A plane through three vertices that are not on a line. That it divides the fragments is only an estimate; else take the plane of
    /// a fragment in the node.
    Vertices { vertices: [VertexId; 3], or: PlaneId },
}

/// How a plane divides fragments.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    back: f64,
    front: f64,
    cut: f64,
}

impl Tally {
    /// The expected work below: every fragment goes down a tree of logarithmic depth, and a cut makes one more.
    fn work(self) -> f64 {
        let side = |n: f64| n * (n + 1.0).log2();
        side(self.back + self.cut) + side(self.front + self.cut)
    }

    /// True if few fragments are cut, and no side gets more than `share` of them.
    fn is_clean(self, total: usize, share: f64) -> bool {
        let total = total as f64;
        self.cut <= FEW_CUTS * total && self.back.max(self.front) + self.cut <= share * total
    }
}

/// Chooses a plane for a node with at least one fragment.
pub(super) fn choose(
    skeleton: &Skeleton,
    items: &[Candidate<'_>],
    how: PlaneChoice,
    grid: &dyn Fn(f64) -> bool,
) -> Choice {
    if let [only] = items {
        return Choice::Polygon(only.own);
    }
    let axis = match how {
        PlaneChoice::Polygons => None,
        _ if items.len() <= FEW => None,
        PlaneChoice::Balanced | PlaneChoice::SurfaceArea => best_axis_plane(items, grid),
    };
    if let Some((tally, axis, value)) = axis
        && (how == PlaneChoice::SurfaceArea || tally.is_clean(items.len(), NOT_ALL))
    {
        return Choice::Axis(axis, value);
    }
    let (polygons, plane) = best_polygon_plane(skeleton, items);
    let (mut least, mut choice) = (polygons.work(), Choice::Polygon(plane));
    if how != PlaneChoice::Balanced || polygons.is_clean(items.len(), BALANCED) {
        return choice;
    }
    if let Some((tally, axis, value)) = axis
        && tally.work() < least
    {
        (least, choice) = (tally.work(), Choice::Axis(axis, value));
    }
    // Where an axis-aligned plane cuts much and a polygon's leaves nearly all on one side.
    if let Some((work, vertices)) = best_vertex_plane(skeleton, items)
        && work < least
    {
        choice = Choice::Vertices { vertices, or: plane };
    }
    choice
}

/// The surface-area cost (`MacDonald` and Booth 1990) of the best axis-aligned plane through a bound of
/// some fragment's box, if it separates anything.
fn best_axis_plane(items: &[Candidate<'_>], grid: &dyn Fn(f64) -> bool) -> Option<(Tally, Axis, f64)> {
    let whole = items.iter().fold(Bounds::EMPTY, |b, item| b.union(item.bounds));
    let total = items.len();
    // Areas relative to the node's size: right at any scale.
    let unit = whole.extent();
    if unit <= 0.0 || !unit.is_finite() {
        return None;
    }
    let mut best: Option<(f64, Tally, Axis, f64)> = None;
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
                let tally = Tally { back: back as f64, front: front as f64, cut: spanning as f64 };
                best = Some((cost, tally, axis, c));
            }
        }
    }
    best.map(|(_, tally, axis, value)| (tally, axis, value))
}

/// How a plane divides the fragments, estimated from rounded heights of a sample. Those in the plane `own` are in it.
fn tally(skeleton: &Skeleton, items: &[Candidate<'_>], plane: &ApproxPlane, own: Option<PlaneId>) -> Tally {
    let stride = items.len().div_ceil(SCORED);
    let weight = items.len() as f64 / items.len().div_ceil(stride) as f64;
    let mut tally = Tally::default();
    for item in items.iter().step_by(stride).filter(|item| Some(item.own) != own) {
        let tolerance = 1e-9 * item.bounds.extent();
        let (mut low, mut high) = (0.0f64, 0.0f64);
        for side in item.sides {
            let h = plane.rounded_height(skeleton.approx_point(side.point).position);
            low = low.min(h);
            high = high.max(h);
        }
        match (low < -tolerance, high > tolerance) {
            (true, true) => tally.cut += weight,
            (true, false) => tally.back += weight,
            (false, true) => tally.front += weight,
            (false, false) => {}
        }
    }
    tally
}

/// The best plane among those of a few fragments.
fn best_polygon_plane(skeleton: &Skeleton, items: &[Candidate<'_>]) -> (Tally, PlaneId) {
    let planes = items.iter().step_by(items.len().div_ceil(PLANE_CANDIDATES)).map(|candidate| candidate.own);
    let tallies = planes.map(|plane| (tally(skeleton, items, skeleton.approx_plane(plane), Some(plane)), plane));
    let best = tallies.min_by(|(a, _), (b, _)| a.work().total_cmp(&b.work()));
    best.unwrap_or((Tally::default(), items[0].own))
}

/// The best plane among some through an edge of one fragment and a vertex of another one, with the work it leaves. Around the tip of a
/// cone, or along the meridians of a ball, such a plane cuts nothing and halves the rest.
fn best_vertex_plane(skeleton: &Skeleton, items: &[Candidate<'_>]) -> Option<(f64, [VertexId; 3])> {
    let total = items.len();
    let mut best: Option<(f64, [VertexId; 3])> = None;
    let (mut here, mut there) = (Vec::new(), Vec::new());
    let collect = |item: &Candidate<'_>, vertices: &mut Vec<VertexId>| {
        vertices.clear();
        vertices.extend(item.sides.iter().filter_map(|side| skeleton.scene_vertex(side.point)));
    };
    for k in (0..total).step_by(total.div_ceil(PLANE_CANDIDATES)) {
        collect(&items[k], &mut here);
        for far in [total / 2, total / 3] {
            collect(&items[(k + far) % total], &mut there);
            for (&a, &b) in here.iter().zip(here.iter().cycle().skip(1)) {
                let Some(&c) = there.iter().find(|&&c| c != a && c != b) else { continue };
                let mut vertices = [a, b, c];
                vertices.sort_unstable();
                let Some(plane) = skeleton.plane_through(vertices) else { continue };
                let work = tally(skeleton, items, &plane, None).work();
                if best.is_none_or(|(least, _)| work < least) {
                    best = Some((work, vertices));
                }
            }
        }
    }
    best
}
