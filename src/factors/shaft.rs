//! What may be between two convex polygons: everything that meets their shaft, the convex hull of both (Haines and Wallace 1991).
//!
//! All decisions are exact signs of determinants of corners. What touches the shaft only from outside does not block; what cannot be told stays a
//! possible blocker, at the price of views.

use super::shape::{Frame, sides};
use crate::exact::{Sign, U, orient3d};
use glam::{DVec2, DVec3, Vec3Swizzles};

/// A plane through three points, for many signs.
struct Plane {
    points: [DVec3; 3],
    normal: DVec3,
    /// The sum of the absolute values of the products that each component of the normal is a difference of.
    permanent: DVec3,
}

impl Plane {
    fn through([a, b, c]: [DVec3; 3]) -> Self {
        let (p, q) = (b - a, c - a);
        let permanent = p.yzx().abs() * q.zxy().abs() + p.zxy().abs() * q.yzx().abs();
        Self { points: [a, b, c], normal: p.cross(q), permanent }
    }

    /// The sign of `orient3d` of the three points and another one, if a filter is sure of it.
    ///
    /// The filter is that of `orient3d` (docs/numerics.md): the determinant is off by less than 10 u times the permanent, of factors that
    /// neither over- nor underflow.
    #[inline]
    fn sure_side(&self, p: DVec3) -> Option<Sign> {
        let r = p - self.points[0];
        let (det, permanent) = (self.normal.dot(r), self.permanent.dot(r.abs()));
        let is_sure = permanent > 1e-180
            && permanent < 1e120
            && r.abs().max_element() < 1e120
            && det.abs() > 10.0 * U * permanent;
        is_sure.then_some(if det > 0.0 { Sign::Positive } else { Sign::Negative })
    }

    #[inline]
    fn side(&self, p: DVec3) -> Sign {
        self.sure_side(p).unwrap_or_else(|| exact_side(self.points, p))
    }
}

/// The sign of `orient3d`, where zero is likely.
fn exact_side([a, b, c]: [DVec3; 3], p: DVec3) -> Sign {
    if is_on_evidently([a, b, c], p) { Sign::Zero } else { orient3d(a, b, c, p) }
}

/// True if a point is on a plane for a reason that shows without arithmetic, as is the rule among things with axis-parallel sides: it is one of the three,
/// in a plane of equal coordinates with all of them, or beside one of them in a direction that two of them are apart in.
#[inline]
fn is_on_evidently([a, b, c]: [DVec3; 3], p: DVec3) -> bool {
    let same = |p: DVec3, q: DVec3| p.cmpeq(q).bitmask();
    let [ab, bc, ca] = [same(a, b), same(b, c), same(c, a)];
    let to_p = [same(a, p), same(b, p), same(c, p)];
    // For each axis, the bits of the others.
    to_p.contains(&0b111)
        || ab & bc & to_p[0] != 0
        || [0b110, 0b101, 0b011].iter().any(|&others| {
            let holds = |bits: &u32| bits & others == others;
            [ab, bc, ca].iter().any(holds) && to_p.iter().any(holds)
        })
}

/// On which side of a plane a polygon is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lies {
    /// In front of it, or on it with some corners.
    Front,
    /// Behind it, or on it with some corners.
    Behind,
    /// In it.
    On,
    /// On both sides.
    Across,
}

impl Lies {
    /// Of a ring, to the plane through three points.
    pub(super) fn of(ring: &[DVec3], plane: [DVec3; 3]) -> Self {
        let plane = Plane::through(plane);
        Self::of_signs(ring.iter().map(|&p| plane.side(p)))
    }

    fn of_signs(signs: impl Iterator<Item = Sign>) -> Self {
        let (mut front, mut behind) = (false, false);
        for sign in signs {
            front |= sign == Sign::Positive;
            behind |= sign == Sign::Negative;
        }
        match (front, behind) {
            (true, true) => Self::Across,
            (true, false) => Self::Front,
            (false, true) => Self::Behind,
            (false, false) => Self::On,
        }
    }

    /// True if no point of the two is on opposite sides.
    pub(super) fn is_beside(self, other: Self) -> bool {
        match (self, other) {
            (Self::Across, _) | (_, Self::Across) => false,
            (Self::On, _) | (_, Self::On) => true,
            (a, b) => a == b,
        }
    }
}

/// What a polygon does to light between two others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blocks {
    Nothing,
    Everything,
    Unknown,
}

/// The shaft between two convex polygons.
pub(super) struct Shaft {
    /// Planes that have both polygons on one side of them or on them, and that side.
    planes: Vec<(Plane, Sign)>,
    bounds: Vec<Bound>,
    low: DVec3,
    high: DVec3,
}

/// A plane of a shaft, for boxes: heights over it are positive on the shaft's side.
struct Bound {
    normal: DVec3,
    offset: f64,
    /// The error of a height is below this times the largest coordinates of the box and of the plane together.
    error: f64,
    coordinate: f64,
}

impl Bound {
    /// The filter of [`Plane`], with as much again for each of rounding of the offset, of the box's centre and of what it reaches out.
    fn of(plane: &Plane, side: Sign) -> Self {
        let normal = if side == Sign::Positive { plane.normal } else { -plane.normal };
        let error = 40.0 * U * plane.permanent.element_sum();
        Self { normal, offset: -normal.dot(plane.points[0]), error, coordinate: plane.points[0].abs().max_element() }
    }

    /// True if all of a box is certainly on the other side; `coordinate` is its largest.
    #[inline]
    fn excludes(&self, centre: DVec3, half: DVec3, coordinate: f64) -> bool {
        let highest = self.normal.dot(centre) + self.offset + self.normal.abs().dot(half);
        let bound = self.error * (coordinate + self.coordinate);
        bound > 1e-180 && bound < 1e120 && highest < -bound
    }
}

impl Shaft {
    /// Between two rings.
    pub(super) fn between(i: &[DVec3], j: &[DVec3]) -> Self {
        let all = || i.iter().chain(j).copied();
        let mut planes = Vec::new();
        for (ring, other) in [(i, j), (j, i)] {
            for (k, [a, b]) in sides(ring).enumerate() {
                let next = if k + 1 == ring.len() { 0 } else { k + 1 };
                // A plane along this side that touches the other polygon.
                for (m, &c) in other.iter().enumerate() {
                    let plane = Plane::through([a, b, c]);
                    // The points that it is through are on it; next to the last of them is what is most often on both sides.
                    let (before, after) = other.split_at(m);
                    let others = after[1..].iter().chain(before.iter().rev());
                    let own = ring.iter().enumerate().filter(|&(n, _)| n != k && n != next).map(|(_, p)| p);
                    if let Some(side) = common_side(others.chain(own.clone()).copied(), &plane) {
                        // There is one more only if this is the plane of the ring itself.
                        let is_last = own.copied().any(|p| plane.side(p) == side);
                        planes.push((plane, side));
                        if is_last {
                            break;
                        }
                    }
                }
            }
        }
        let low = all().fold(DVec3::INFINITY, DVec3::min);
        let high = all().fold(DVec3::NEG_INFINITY, DVec3::max);
        let bounds = planes.iter().map(|(plane, side)| Bound::of(plane, *side)).collect();
        Self { planes, bounds, low, high }
    }

    /// False if a box is certainly outside of the shaft's own box, or of one of its planes.
    pub(super) fn may_meet(&self, low: DVec3, high: DVec3) -> bool {
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let coordinate = low.abs().max(high.abs()).max_element();
        self.low.cmple(high).all()
            && self.high.cmpge(low).all()
            && !self.bounds.iter().any(|bound| bound.excludes(centre, half, coordinate))
    }

    /// True if a polygon is certainly outside, though it may touch.
    pub(super) fn excludes(&self, ring: &[DVec3]) -> bool {
        // Mostly some corner is surely inside, and one beside it on the plane.
        let is_outside = |(plane, side): &(Plane, Sign)| {
            !ring.iter().any(|&p| plane.sure_side(p) == Some(*side)) && ring.iter().all(|&p| plane.side(p) != *side)
        };
        let beyond = |axis: usize| {
            ring.iter().all(|p| p[axis] <= self.low[axis]) || ring.iter().all(|p| p[axis] >= self.high[axis])
        };
        // A polygon may lie in a face of a box that is no more than that face.
        let is_flat = |axis: usize| self.high[axis] <= self.low[axis];
        (0..3).any(|axis| !is_flat(axis) && beyond(axis)) || self.planes.iter().any(is_outside)
    }
}

/// The one side that all points are on that are not on the plane.
fn common_side(points: impl Iterator<Item = DVec3> + Clone, plane: &Plane) -> Option<Sign> {
    let mut common = Sign::Zero;
    // Mostly some are surely on both sides.
    for side in points.clone().filter_map(|p| plane.sure_side(p)) {
        if common.is_zero() {
            common = side;
        } else if side != common {
            return None;
        }
    }
    for p in points.filter(|&p| plane.sure_side(p).is_none()) {
        let side = plane.side(p);
        if common.is_zero() {
            common = side;
        } else if side == -common {
            return None;
        }
    }
    (!common.is_zero()).then_some(common)
}

/// A point of a plane, and where it is in a frame of that plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: DVec3,
    pub(super) flat: DVec2,
}

/// The sides that a plane through three points has in another plane, in a frame of that.
struct Line {
    points: [DVec3; 3],
    along: DVec2,
    offset: f64,
    /// The filter's bound is this times the sum of the lengths.
    bound: f64,
    length: f64,
}

impl Line {
    /// Where the plane through three points meets that of the frame.
    ///
    /// The normal is off by at most 3 u times the sums of its products, its components along the frame by 4 u times those sums more, the
    /// coordinates of a corner by 6 u times its distance from the origin of the frame, which may itself be off by as much; so that the sign is sure from 32 u
    /// times all that on.
    fn through(points: [DVec3; 3], frame: &Frame) -> Self {
        let Plane { normal, permanent, .. } = Plane::through(points);
        let to = frame.origin - points[0];
        let (u, v) = frame.axes();
        let along = DVec2::new(normal.dot(u), normal.dot(v));
        let bound = 32.0 * U * permanent.element_sum();
        let length = to.abs().element_sum() + frame.origin.abs().max_element() + points[0].abs().max_element();
        Self { points, along, offset: normal.dot(to), bound, length }
    }

    /// The side of a corner if the filter is sure of it, or, if the corner is itself rounded, of all that is within rounding of it.
    #[inline]
    fn sure_side(&self, corner: &Corner, is_exact: bool) -> Option<Sign> {
        let value = self.along.dot(corner.flat) + self.offset;
        // A point is off by 10 u times the coordinates at most: a third of what the bound is for.
        let bound = if is_exact { self.bound } else { 8.0 * self.bound };
        let bound = bound * (self.length + corner.flat.abs().element_sum());
        // Not below what may have underflowed.
        let is_sure = value.abs() > bound && bound > 1e-180;
        is_sure.then_some(if value > 0.0 { Sign::Positive } else { Sign::Negative })
    }

    fn side(&self, corner: &Corner) -> Sign {
        self.sure_side(corner, true).unwrap_or_else(|| exact_side(self.points, corner.at))
    }
}

/// A convex polygon that may be between an element and a facet.
pub(super) struct Blocker<'a> {
    pub(super) facet: u32,
    ring: &'a [DVec3],
    from: &'a [DVec3],
    frame: &'a Frame,
    /// Of the element to its plane, and of the facet.
    lies: [Lies; 2],
    /// Its own plane.
    spanning: [DVec3; 3],
    plane: Option<Line>,
    /// Planes through its sides and the corners of the element, side by side, as far as they have been asked for.
    lines: Vec<Option<Line>>,
}

impl<'a> Blocker<'a> {
    /// Between an element, all of which lies so to the plane of the blocker, and the facet with that frame, which lies so.
    pub(super) fn between(
        from: &'a [DVec3],
        lies: [Lies; 2],
        frame: &'a Frame,
        (facet, ring, spanning): (u32, &'a [DVec3], [DVec3; 3]),
    ) -> Self {
        Self { facet, ring, from, frame, lies, spanning, plane: None, lines: Vec::new() }
    }

    /// What it does to light from the element to a convex part of the facet: lines between corners pass its sides all inside, or one all outside, or
    /// it cannot be told. If corners are not exact nothing is told that would not be of any part within them.
    pub(super) fn blocks(&mut self, part: &[Corner], is_exact: bool) -> Blocks {
        let Self { ring, from, frame, spanning, .. } = *self;
        let [own, whole] = self.lies;
        let other = match whole {
            Lies::Across => {
                let plane = self.plane.get_or_insert_with(|| Line::through(spanning, frame));
                if !is_exact && part.iter().any(|corner| plane.sure_side(corner, false).is_none()) {
                    return Blocks::Unknown;
                }
                Lies::of_signs(part.iter().map(|corner| plane.side(corner)))
            }
            whole => whole,
        };
        if own.is_beside(other) {
            return Blocks::Nothing;
        }
        // Lines of sight are told apart only if all of them pass its plane one way.
        // Seen from its front, with the lines of sight going in, a side that runs counter-clockwise has its inside to the left.
        let inside = match (own, other) {
            (Lies::Front, Lies::Behind) => Sign::Negative,
            (Lies::Behind, Lies::Front) => Sign::Positive,
            _ => return Blocks::Unknown,
        };
        if self.lines.is_empty() {
            self.lines.resize_with(ring.len() * from.len(), || None);
        }
        let mut hides = true;
        for ([a, b], lines) in sides(ring).zip(self.lines.chunks_exact_mut(from.len())) {
            let mut passes = Passes::default();
            let mut is_sure = true;
            'lines: for (line, &p) in lines.iter_mut().zip(from) {
                let line = line.get_or_insert_with(|| Line::through([a, b, p], frame));
                for corner in part {
                    match line.sure_side(corner, is_exact) {
                        Some(side) => passes.note(side == inside),
                        None => is_sure = false,
                    }
                    if passes.are_told(hides) {
                        break 'lines;
                    }
                }
            }
            if !is_sure && !passes.are_told(hides) {
                if !is_exact {
                    hides = false;
                    continue;
                }
                // Those on the plane pass either way.
                let unsure = lines.iter().flatten().flat_map(|line| part.iter().map(move |corner| (line, corner)));
                for (line, corner) in unsure.filter(|(line, corner)| line.sure_side(corner, true).is_none()) {
                    let side = exact_side(line.points, corner.at);
                    if !side.is_zero() {
                        passes.note(side == inside);
                    }
                    if passes.are_told(hides) {
                        break;
                    }
                }
            }
            if !passes.inside {
                return Blocks::Nothing;
            }
            hides &= !passes.outside;
        }
        if hides { Blocks::Everything } else { Blocks::Unknown }
    }
}

/// Where lines between corners pass a side of a blocker.
#[derive(Default)]
struct Passes {
    inside: bool,
    outside: bool,
}

impl Passes {
    #[inline]
    fn note(&mut self, is_inside: bool) {
        self.inside |= is_inside;
        self.outside |= !is_inside;
    }

    /// True if more of them change nothing: it hides nothing only if all pass outside, and everything only if all pass all sides inside.
    #[inline]
    fn are_told(&self, may_hide_everything: bool) -> bool {
        self.inside && (self.outside || !may_hide_everything)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(z: f64, half: f64, centre: [f64; 2]) -> Vec<DVec3> {
        let [x, y] = centre;
        [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|[u, v]| DVec3::new(x + half * u, y + half * v, z)).to_vec()
    }

    #[test]
    fn lines_pass_inside_outside_or_both() {
        let (front, behind) = (square(1.0, 1.0, [0.0; 2]), square(-1.0, 1.0, [0.0; 2]));
        let blocks = |front: &[DVec3], ring: &[DVec3], behind: &[DVec3]| {
            let frame = Frame::through([behind[0], behind[1], behind[2]]);
            let spanning = [ring[0], ring[1], ring[2]];
            let lies = [Lies::of(front, spanning), Lies::of(behind, spanning)];
            let mut blocker = Blocker::between(front, lies, &frame, (0, ring, spanning));
            let corners: Vec<Corner> = behind.iter().map(|&at| Corner { at, flat: frame.flat(at) }).collect();
            blocker.blocks(&corners, true)
        };
        // From either side.
        for turned in [false, true] {
            let blocks = |ring: &[DVec3]| {
                let ring: Vec<DVec3> = if turned { ring.iter().rev().copied().collect() } else { ring.to_vec() };
                blocks(&front, &ring, &behind)
            };
            assert_eq!(blocks(&square(0.0, 1.0, [0.0; 2])), Blocks::Everything);
            assert_eq!(blocks(&square(0.0, 1.0_f64.next_down(), [0.0; 2])), Blocks::Unknown);
            assert_eq!(blocks(&square(0.0, 0.5, [1.5, 0.0])), Blocks::Nothing);
            assert_eq!(blocks(&square(0.0, 0.5, [1.5_f64.next_down(), 0.0])), Blocks::Unknown);
        }
        // A small source seen past a large receiver: the shaft is narrower in the middle.
        let point = square(1.0, 0.0, [0.0; 2]);
        assert_eq!(blocks(&point, &square(0.0, 0.5, [0.0; 2]), &behind), Blocks::Everything);
        assert_eq!(blocks(&point, &square(0.0, 0.5, [1.0, 0.0]), &behind), Blocks::Nothing);
    }

    #[test]
    fn a_shaft_excludes_what_touches_it_from_outside() {
        let shaft = Shaft::between(&square(1.0, 1.0, [0.0; 2]), &square(-1.0, 2.0, [0.0; 2]));
        assert!(shaft.excludes(&square(0.0, 0.5, [2.0, 0.0])));
        assert!(!shaft.excludes(&square(0.0, 0.5, [1.999, 0.0])));
        assert!(shaft.excludes(&square(1.0, 5.0, [0.0; 2])));
        assert!(!shaft.excludes(&square(0.999, 5.0, [0.0; 2])));
    }

    #[test]
    fn points_are_evidently_on_planes_that_hold_them() {
        let on = |points: [[i32; 3]; 3], p: [i32; 3]| {
            let [a, b, c, p] = [points[0], points[1], points[2], p].map(|p| DVec3::from(p.map(f64::from)));
            let evident = is_on_evidently([a, b, c], p);
            assert!(!evident || orient3d(a, b, c, p).is_zero(), "{points:?} {p}");
            evident
        };
        assert!(on([[1, 2, 3], [4, 6, 5], [7, 7, 8]], [4, 6, 5]));
        assert!(on([[1, 2, 3], [4, 6, 3], [7, 7, 3]], [9, 1, 3]));
        assert!(on([[1, 2, 3], [1, 2, 5], [7, 7, 8]], [7, 7, 1]));
        assert!(!on([[1, 2, 3], [1, 3, 5], [7, 7, 8]], [7, 7, 1]));
        // All of a small grid: whatever is evident is so.
        let point = |k: i32| [k % 2, k / 2 % 2, k / 4 % 3];
        let places = || 0..12;
        for a in places() {
            for b in places() {
                for c in places() {
                    places().for_each(|p| _ = on([point(a), point(b), point(c)], point(p)));
                }
            }
        }
    }

    #[test]
    fn sides_of_planes_are_exact() {
        let plane = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert_eq!(Lies::of(&square(0.0, 1.0, [0.0; 2]), plane), Lies::On);
        assert_eq!(Lies::of(&square(1e-300, 1.0, [0.0; 2]), plane), Lies::Front);
        assert_eq!(Lies::of(&square(-1e-300, 1.0, [0.0; 2]), plane), Lies::Behind);
        assert_eq!(Lies::of(&[DVec3::ZERO, DVec3::Z, DVec3::NEG_Z], plane), Lies::Across);
        assert!(
            Lies::On.is_beside(Lies::Front)
                && !Lies::Front.is_beside(Lies::Behind)
                && !Lies::On.is_beside(Lies::Across)
        );
    }
}
