//! The predicates on definitions: each answers with the sign of a real expression, for any finite
//! coordinates.
//!
//! The stages: what is known by identity of definitions costs nothing; a filter in floating point with
//! a proven bound decides nearly all the rest; then integers on a common grid, of fixed width where they
//! fit, of any width where they do not.

mod ids;

pub use ids::{DirectionId, SplitterId};

use super::approx::{Approx3, U};
use super::approximate::{ApproxPlane, ApproxPoint};
use super::arena::{Arena, Kept3, Num3};
use super::construct::Constructor;
use super::definition::{Direction, Plane, Point, Splitter};
use super::frame::{BitRange, Frame};
use super::orient::{orient3d_expansions, orient3d_filter};
use super::zeros::{ZeroComponents, defined_on, have_common_end, point_in_plane};
use super::{PredicateStats, Sign};
use glam::DVec3;
use ids::Table;
use std::cmp::Ordering;

/// How two great circles, as oriented by their normals, lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CircleRelation {
    /// The same circle, the same side positive.
    Same,
    /// The same circle, opposite sides positive.
    Opposite,
    /// Different circles.
    Different,
}

impl CircleRelation {
    /// From the sign of the dot product of parallel normals; 0 for others.
    fn of(parallel: Sign) -> Self {
        match parallel {
            Sign::Positive => Self::Same,
            Sign::Negative => Self::Opposite,
            Sign::Zero => Self::Different,
        }
    }
}

/// Where a direction lies on a great circle, seen from another one on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Along {
    /// In the same place.
    Same,
    /// Less than half a turn counter-clockwise about the circle's normal.
    Ahead,
    /// Half a turn away.
    Opposite,
    /// Less than half a turn clockwise.
    Behind,
}

/// The predicates seen from one eye.
///
/// ```
/// use glam::DVec3;
/// use nusselt::exact::{Direction, Kernel, Point, Sign, Splitter};
///
/// let (a, b) = (DVec3::new(1.0, 0.1, 0.0), DVec3::new(1.0, 0.3, 0.7));
/// let mut kernel = Kernel::new([a, b], DVec3::ZERO);
/// let middle = Direction::Point(Point::Given((a + b) / 2.0));
/// // The middle of the edge is rounded, so that it lies off the edge's plane, or on it: exactly.
/// assert_ne!(kernel.side(&Direction::Given(DVec3::Z), &Splitter::Edge([a, b])), Sign::Zero);
/// assert_eq!(kernel.side(&Direction::Point(Point::Given(a)), &Splitter::Edge([a, b])), Sign::Zero);
/// let _ = kernel.side(&middle, &Splitter::Edge([a, b]));
/// ```
#[derive(Clone, Debug)]
pub struct Kernel {
    eye: DVec3,
    range: BitRange,
    frame: Frame,
    arena: Arena,
    splitters: Table<Splitter>,
    directions: Table<Direction>,
    stats: PredicateStats,
}

impl Kernel {
    /// Predicates seen from `eye`, on a grid that holds the given points. Other points are as right, but
    /// slower where integers must decide.
    ///
    /// # Panics
    /// If a coordinate is infinite or not a number. So does a predicate whose answer takes integers; what
    /// identity decides is not looked at.
    pub fn new(points: impl IntoIterator<Item = DVec3>, eye: DVec3) -> Self {
        let range = points.into_iter().fold(range_of_point(BitRange::EMPTY, eye), range_of_point);
        let frame = Frame::new(range, eye);
        Self {
            eye,
            range,
            frame,
            arena: Arena::default(),
            splitters: Table::EMPTY,
            directions: Table::EMPTY,
            stats: PredicateStats::default(),
        }
    }

    /// The eye.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// What the calls since the last [`Kernel::reset_stats`] took.
    pub fn stats(&self) -> PredicateStats {
        self.stats
    }

    /// Starts counting anew.
    pub fn reset_stats(&mut self) {
        self.stats = PredicateStats::default();
    }

    fn approx_splitter(&mut self, definition: &Splitter) -> Approx3 {
        let approx = Approx3::splitter(definition, self.eye);
        if !approx.is_poor() {
            return approx;
        }
        self.with_integers(range_of_splitter(self.range, definition), |exact| {
            let normal = exact.splitter(definition);
            Approx3::rounded(exact.arena, normal)
        })
    }

    fn approx_direction(&mut self, definition: &Direction) -> Approx3 {
        let approx = match definition {
            Direction::Given(d) => Approx3::given(*d),
            Direction::Point(point) => {
                let ApproxPoint { position, err } = ApproxPoint::of(point);
                Approx3::direction(self.eye, position, err.max_element())
            }
            Direction::Crossing(splitters) => {
                let [m, n] = splitters.map(|s| Approx3::splitter(&s, self.eye));
                m.cross(n)
            }
        };
        if !approx.is_poor() {
            return approx;
        }
        self.with_integers(range_of_direction(self.range, definition), |exact| {
            let direction = exact.direction(definition);
            Approx3::rounded(exact.arena, direction)
        })
    }

    /// On which side of a splitter a direction lies: the sign of `n . d`.
    pub fn side(&mut self, direction: &Direction, splitter: &Splitter) -> Sign {
        let zeros = ZeroComponents::of_direction(direction, self.eye);
        if defined_on(direction, splitter) || zeros.cover(ZeroComponents::of_splitter(splitter, self.eye)) {
            self.stats.identity += 1;
            return Sign::Zero;
        }
        if let Some(sign) = self.approx_direction(direction).dot_sign(&self.approx_splitter(splitter)) {
            self.stats.filter += 1;
            return sign;
        }
        if let Direction::Crossing([m, n]) = direction {
            return self.undecided_orientation([splitter, m, n]);
        }
        let range = range_of_direction(range_of_splitter(self.range, splitter), direction);
        self.decide(range, |exact| {
            let normal = exact.splitter(splitter);
            let direction = exact.direction(direction);
            exact.arena.dot_sign(normal, direction)
        })
    }

    /// The orientation of three splitters: the sign of `n_1 . (n_2 x n_3)`.
    pub fn orientation(&mut self, splitters: [&Splitter; 3]) -> Sign {
        let [a, b, c] = splitters;
        if a == b || b == c || c == a {
            self.stats.identity += 1;
            return Sign::Zero;
        }
        let [p, q, r] = splitters.map(|s| self.approx_splitter(s));
        if let Some(sign) = p.det_sign(&q, &r) {
            self.stats.filter += 1;
            return sign;
        }
        let zeros = splitters.map(|s| ZeroComponents::of_splitter(s, self.eye));
        if ZeroComponents::shared(zeros) || have_common_end(splitters) {
            self.stats.identity += 1;
            return Sign::Zero;
        }
        self.undecided_orientation(splitters)
    }

    #[cold]
    fn undecided_orientation(&mut self, splitters: [&Splitter; 3]) -> Sign {
        let range = splitters.iter().fold(self.range, |range, s| range_of_splitter(range, s));
        self.decide(range, |exact| {
            let [a, b, c] = splitters.map(|s| exact.splitter(s));
            exact.arena.det_sign(a, b, c)
        })
    }

    /// Whether two splitters are one great circle.
    pub fn compare_circles(&mut self, a: &Splitter, b: &Splitter) -> CircleRelation {
        if a == b {
            self.stats.identity += 1;
            return CircleRelation::Same;
        }
        let (p, q) = (self.approx_splitter(a), self.approx_splitter(b));
        if p.not_parallel(&q) {
            self.stats.filter += 1;
            return CircleRelation::Different;
        }
        let range = range_of_splitter(range_of_splitter(self.range, a), b);
        CircleRelation::of(self.decide(range, |exact| {
            let (m, n) = (exact.splitter(a), exact.splitter(b));
            exact.arena.parallel(m, n)
        }))
    }

    /// Where `other` lies on a great circle, seen from `from`; both must lie on it.
    pub fn order_along(&mut self, circle: &Splitter, from: &Direction, other: &Direction) -> Along {
        if from == other {
            self.stats.identity += 1;
            return Along::Same;
        }
        let (n, p, q) = (self.approx_splitter(circle), self.approx_direction(from), self.approx_direction(other));
        let ahead = if let Some(sign) = n.det_sign(&p, &q) {
            self.stats.filter += 1;
            sign
        } else {
            let range = range_of_splitter(range_of_direction(range_of_direction(self.range, from), other), circle);
            self.decide(range, |exact| {
                let (n, p, q) = (exact.splitter(circle), exact.direction(from), exact.direction(other));
                exact.arena.det_sign(n, p, q)
            })
        };
        match ahead {
            Sign::Positive => Along::Ahead,
            Sign::Negative => Along::Behind,
            // Parallel: a dot product of their size has the right sign in floating point.
            Sign::Zero if p.v.dot(q.v) > 0.0 => Along::Same,
            Sign::Zero => Along::Opposite,
        }
    }

    /// On which side of a plane a point lies: in front, on it or behind.
    pub fn plane_side(&mut self, point: &Point, plane: &Plane) -> Sign {
        if point_in_plane(point, plane) {
            self.stats.identity += 1;
            return Sign::Zero;
        }
        let known = match (point, plane) {
            (Point::Given(p), Plane::Axis { axis, value }) => compare(p[*axis], *value),
            (Point::Given(p), Plane::Points([a, b, c])) => orient3d_filter(*a, *b, *c, *p),
            _ => {
                let height = ApproxPlane::new(plane).height(&ApproxPoint::of(point));
                (height.mid.abs() > height.rad).then(|| Sign::of(height.mid))
            }
        };
        if let Some(sign) = known {
            self.stats.filter += 1;
            return sign;
        }
        if let (Point::Given(p), Plane::Points([a, b, c])) = (point, plane)
            && let Some(sign) = orient3d_expansions(*a, *b, *c, *p)
        {
            self.stats.fixed += 1;
            return sign;
        }
        let range = range_of_point_definition(range_of_plane(self.range, plane), point);
        self.decide(range, |exact| {
            let (x, w) = exact.point(point);
            let (normal, height) = exact.plane(plane);
            exact.arena.height_sign(normal, height, x, w)
        })
    }

    /// Which of two planes a ray from the eye meets first: `Less` for the first plane. Neither plane may
    /// hold the eye, and the ray must meet both.
    pub fn depth_order(&mut self, planes: [&Plane; 2], direction: &Direction) -> Ordering {
        // 1/t_Q - 1/t_P = (N_P . d) / h_P - (N_Q . d) / h_Q, the sign of which is that of the crease
        // h_Q N_P - h_P N_Q along d, times those of the heights.
        let eye = Point::Given(self.eye);
        let heights = self.plane_side(&eye, planes[0]) * self.plane_side(&eye, planes[1]);
        debug_assert!(!heights.is_zero(), "the eye lies in neither plane");
        if planes[0] == planes[1] {
            return Ordering::Equal;
        }
        let crease = Splitter::Crease(planes.map(|p| *p));
        match self.side(direction, &crease) * heights {
            Sign::Positive => Ordering::Greater,
            Sign::Zero => Ordering::Equal,
            Sign::Negative => Ordering::Less,
        }
    }

    /// Decides with integers and counts which kind.
    fn decide(&mut self, range: BitRange, decide: impl FnOnce(&mut Constructor<'_>) -> Sign) -> Sign {
        let arbitrary = self.arena.arbitrary_signs();
        let sign = self.with_integers(range, decide);
        self.count_stage(arbitrary);
        sign
    }

    fn count_stage(&mut self, arbitrary_before: u64) {
        if self.arena.arbitrary_signs() == arbitrary_before {
            self.stats.fixed += 1;
        } else {
            self.stats.arbitrary += 1;
        }
    }

    /// Makes an integer vector that stays.
    fn keep(&mut self, range: BitRange, make: impl FnOnce(&mut Constructor<'_>) -> Kept3) -> Kept3 {
        let wider = (range != self.range).then(|| Frame::new(range, self.eye));
        let frame = wider.as_ref().unwrap_or(&self.frame);
        make(&mut Constructor { frame, arena: &mut self.arena })
    }

    /// Works with integers on a grid that holds `range`.
    fn with_integers<T>(&mut self, range: BitRange, work: impl FnOnce(&mut Constructor<'_>) -> T) -> T {
        let wider = (range != self.range).then(|| Frame::new(range, self.eye));
        let frame = wider.as_ref().unwrap_or(&self.frame);
        let mark = self.arena.mark();
        let result = work(&mut Constructor { frame, arena: &mut self.arena });
        self.arena.release(mark);
        result
    }
}

impl Approx3 {
    /// An integer vector rounded: each component is off by `2 u` relatively.
    pub(crate) fn rounded(arena: &Arena, exact: Num3) -> Self {
        Self::known(arena.direction(exact), 4.0 * U)
    }
}

impl ApproxPoint {
    /// A point by its definition.
    fn of(point: &Point) -> Self {
        match point {
            Point::Given(p) => Self::exact(*p),
            Point::EdgePlane(ends, plane) => {
                let [a, b] = ends.map(Self::exact);
                let plane = ApproxPlane::new(plane);
                Self::between(a, b, plane.height(&a), plane.height(&b))
            }
            // No cheap approximation is good enough to be worth it: integers round it.
            Point::Planes(_) => Self { position: DVec3::ZERO, err: DVec3::INFINITY },
        }
    }
}

/// The sign of a difference, which comparing finds without rounding.
fn compare(a: f64, b: f64) -> Option<Sign> {
    if a.is_finite() && b.is_finite() { a.partial_cmp(&b).map(Sign::from) } else { None }
}

fn range_of_point(range: BitRange, point: DVec3) -> BitRange {
    assert!(point.is_finite(), "exact predicates take finite coordinates, not {point}");
    point.to_array().into_iter().fold(range, BitRange::with)
}

fn range_of_plane(range: BitRange, plane: &Plane) -> BitRange {
    plane.coordinates().into_iter().fold(range, range_of_point)
}

fn range_of_point_definition(range: BitRange, point: &Point) -> BitRange {
    match point {
        Point::Given(p) => range_of_point(range, *p),
        Point::EdgePlane(ends, plane) => ends.iter().copied().fold(range_of_plane(range, plane), range_of_point),
        Point::Planes(planes) => planes.iter().fold(range, range_of_plane),
    }
}

fn range_of_splitter(range: BitRange, splitter: &Splitter) -> BitRange {
    match splitter {
        Splitter::Edge(ends) => ends.iter().copied().fold(range, range_of_point),
        Splitter::Crease(planes) => planes.iter().fold(range, range_of_plane),
        // A given normal is a vector in units of its own.
        Splitter::Given(normal) => {
            assert!(normal.is_finite(), "exact predicates take finite coordinates, not {normal}");
            range
        }
        Splitter::Parallel(plane) => range_of_plane(range, plane),
    }
}

fn range_of_direction(range: BitRange, direction: &Direction) -> BitRange {
    match direction {
        Direction::Given(d) => {
            assert!(d.is_finite(), "exact predicates take finite coordinates, not {d}");
            range
        }
        Direction::Point(point) => range_of_point_definition(range, point),
        Direction::Crossing(splitters) => splitters.iter().fold(range, range_of_splitter),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    fn to(p: DVec3) -> Direction {
        Direction::Point(Point::Given(p))
    }

    const FILTER: PredicateStats = PredicateStats { filter: 1, identity: 0, fixed: 0, arbitrary: 0 };
    const IDENTITY: PredicateStats = PredicateStats { filter: 0, identity: 1, fixed: 0, arbitrary: 0 };
    const FIXED: PredicateStats = PredicateStats { filter: 0, identity: 0, fixed: 1, arbitrary: 0 };
    const ARBITRARY: PredicateStats = PredicateStats { filter: 0, identity: 0, fixed: 0, arbitrary: 1 };

    /// Three points in one plane with the eye, of which no two coordinates are alike; all times `factor`.
    fn in_one_plane(factor: f64) -> [DVec3; 3] {
        let (p, q) = (v(1.0, 2.0, 5.0) * factor, v(3.0, -1.0, 4.0) * factor);
        [p, q, p + q]
    }

    #[test]
    fn every_call_is_counted_once_where_it_was_decided() {
        let [a, b, between] = in_one_plane(1.0);
        let off = v(0.5, 7.0, -3.0);
        let mut kernel = Kernel::new([a, b, between, off], DVec3::ZERO);
        let (edge, other) = (Splitter::Edge([a, b]), Splitter::Edge([b, off]));
        let (along, third) = (Splitter::Edge([between, b]), Splitter::Edge([a, off]));
        let plane = Plane::Points([a, b, off]);
        let level = Plane::Axis { axis: 2, value: 4.5 };
        let [edge_id, other_id, third_id, along_id, again_id] =
            [edge, other, third, along, edge].map(|s| kernel.add_splitter(&s));
        let [a_id, between_id, off_id] = [a, between, off].map(|p| kernel.add_direction(&to(p)));
        let crossing = Direction::Crossing([edge, third]);
        let mut counted = |what: &str, stats: PredicateStats, work: &dyn Fn(&mut Kernel) -> bool| {
            kernel.reset_stats();
            assert!(work(&mut kernel), "{what}: a wrong answer");
            assert_eq!(kernel.stats(), stats, "{what}");
        };
        counted("side", IDENTITY, &|k| k.side(&to(a), &edge).is_zero());
        counted("side", FIXED, &|k| k.side(&to(between), &edge).is_zero());
        counted("side", FILTER, &|k| !k.side(&to(off), &edge).is_zero());
        counted("side", FIXED, &|k| k.side(&crossing, &along).is_zero());
        counted("side_of", IDENTITY, &|k| k.side_of(a_id, edge_id).is_zero());
        counted("side_of", FIXED, &|k| k.side_of(between_id, edge_id).is_zero());
        counted("side_of", FILTER, &|k| k.side_of(off_id, edge_id) == k.clone().side(&to(off), &edge));
        counted("orientation", IDENTITY, &|k| k.orientation([&edge, &other, &edge]).is_zero());
        counted("orientation", IDENTITY, &|k| k.orientation([&edge, &edge, &other]).is_zero());
        counted("orientation", IDENTITY, &|k| k.orientation([&other, &edge, &edge]).is_zero());
        counted("orientation", IDENTITY, &|k| k.orientation([&edge, &along, &other]).is_zero());
        counted("orientation", FIXED, &|k| k.orientation([&edge, &along, &third]).is_zero());
        counted("orientation", FILTER, &|k| !k.orientation([&edge, &other, &third]).is_zero());
        counted("orientation_of", IDENTITY, &|k| k.orientation_of([edge_id, other_id, edge_id]).is_zero());
        counted("orientation_of", IDENTITY, &|k| k.orientation_of([edge_id, edge_id, other_id]).is_zero());
        counted("orientation_of", IDENTITY, &|k| k.orientation_of([other_id, edge_id, edge_id]).is_zero());
        counted("orientation_of", IDENTITY, &|k| k.orientation_of([edge_id, along_id, other_id]).is_zero());
        counted("orientation_of", FIXED, &|k| k.orientation_of([edge_id, along_id, third_id]).is_zero());
        counted("orientation_of", FILTER, &|k| !k.orientation_of([edge_id, other_id, third_id]).is_zero());
        counted("compare_circles", IDENTITY, &|k| k.compare_circles(&edge, &edge) == CircleRelation::Same);
        counted("compare_circles", FIXED, &|k| k.compare_circles(&edge, &along) == CircleRelation::Same);
        counted("compare_circles", FILTER, &|k| k.compare_circles(&edge, &other) == CircleRelation::Different);
        counted("compare_circles_of", IDENTITY, &|k| k.compare_circles_of(edge_id, edge_id) == CircleRelation::Same);
        counted("compare_circles_of", FIXED, &|k| k.compare_circles_of(edge_id, again_id) == CircleRelation::Same);
        counted("compare_circles_of", FIXED, &|k| k.compare_circles_of(edge_id, along_id) == CircleRelation::Same);
        counted("compare_circles_of", FILTER, &|k| {
            k.compare_circles_of(edge_id, other_id) == CircleRelation::Different
        });
        counted("order_along", IDENTITY, &|k| k.order_along(&edge, &to(a), &to(a)) == Along::Same);
        counted("order_along", FILTER, &|k| k.order_along(&edge, &to(a), &to(b)) == Along::Ahead);
        counted("order_along", FILTER, &|k| k.order_along(&edge, &to(b), &to(a)) == Along::Behind);
        counted("order_along", FIXED, &|k| k.order_along(&edge, &to(a), &to(a * 2.0)) == Along::Same);
        counted("order_along", FIXED, &|k| k.order_along(&edge, &to(a), &to(-a)) == Along::Opposite);
        counted("plane_side", IDENTITY, &|k| k.plane_side(&Point::Given(a), &plane).is_zero());
        counted("plane_side", FILTER, &|k| k.plane_side(&Point::Given(a), &level).is_positive());
        counted("plane_side", FILTER, &|k| k.plane_side(&Point::Given(v(0.0, 0.0, 4.5)), &level).is_zero());
        counted("plane_side", FIXED, &|k| k.plane_side(&Point::Given(a + (b - off)), &plane).is_zero());
        // Where an edge of the plane crosses another plane, the edge given by other points.
        let cut = Point::EdgePlane([a + (a - b), b + (b - a)], Plane::Axis { axis: 0, value: 1.3 });
        counted("plane_side", FIXED, &|k| k.plane_side(&cut, &plane).is_zero());
        counted("plane_side", FILTER, &|k| k.plane_side(&cut, &level).is_positive());
        counted("plane_side", FILTER, &|k| k.plane_side(&cut, &Plane::Axis { axis: 2, value: 5.0 }).is_negative());
    }

    #[test]
    fn coordinates_that_are_not_finite_are_refused() {
        let plane = |value| Plane::Axis { axis: 2, value };
        for (z, value) in [(f64::INFINITY, 1.0), (1.0, f64::INFINITY), (f64::NAN, 1.0), (1.0, f64::NEG_INFINITY)] {
            let side = std::panic::catch_unwind(|| {
                Kernel::new([], DVec3::ONE).plane_side(&Point::Given(v(0.0, 0.0, z)), &plane(value))
            });
            assert!(side.is_err(), "{z} {value}");
        }
        assert!(std::panic::catch_unwind(|| Kernel::new([v(f64::NAN, 0.0, 0.0)], DVec3::ONE)).is_err());
        assert_eq!(Kernel::new([], DVec3::ONE).eye(), DVec3::ONE);
    }

    #[test]
    fn signs_that_need_more_than_the_fixed_widths_are_counted_as_arbitrary() {
        let [a, b, between] = in_one_plane(1.0);
        // On one grid with these, each coordinate takes 1,900 bits.
        let (least, most) = (v(f64::from_bits(1), 0.0, 0.0), v(0.0, 2f64.powi(800), 0.0));
        let mut kernel = Kernel::new([a, b, least, most], DVec3::ZERO);
        let edge = Splitter::Edge([a, b]);
        assert_eq!(kernel.side(&to(between), &edge), Sign::Zero);
        assert_eq!(kernel.stats(), ARBITRARY);
        let (edge, between) = (kernel.add_splitter(&edge), kernel.add_direction(&to(between)));
        kernel.reset_stats();
        assert_eq!(kernel.side_of(between, edge), Sign::Zero);
        assert_eq!(kernel.stats(), ARBITRARY);
    }

    #[test]
    fn a_cleared_kernel_starts_anew() {
        let [a, b, between] = in_one_plane(1.0);
        let mut kernel = Kernel::new([a, b, between], DVec3::ZERO);
        let first = (kernel.add_splitter(&Splitter::Edge([a, b])), kernel.add_direction(&to(between)));
        assert_eq!(kernel.side_of(first.1, first.0), Sign::Zero);
        kernel.clear();
        // The same ids, other meanings: nothing that was made for the first ones is left.
        let second = (kernel.add_splitter(&Splitter::Edge([b, v(9.0, 1.0, 0.5)])), kernel.add_direction(&to(b * 3.0)));
        assert_eq!(first, second);
        assert_eq!(kernel.side_of(second.1, second.0), Sign::Zero);
        let other = kernel.add_direction(&to(between));
        assert_ne!(kernel.side_of(other, second.0), Sign::Zero);
    }

    #[test]
    fn the_nearer_of_two_planes_is_found() {
        let level = |value| Plane::Axis { axis: 2, value };
        let mut kernel = Kernel::new([], v(0.0, 0.0, 1.0));
        for (planes, down, order) in [
            ([4.0, 5.0], 1.0, Ordering::Less),
            ([5.0, 4.0], 1.0, Ordering::Greater),
            ([4.0, 4.0], 1.0, Ordering::Equal),
            ([0.0, -1.0], -1.0, Ordering::Less),
            ([-1.0, 0.0], -1.0, Ordering::Greater),
        ] {
            let direction = Direction::Given(v(0.25, -0.5, down));
            let [near, far] = planes.map(level);
            assert_eq!(kernel.depth_order([&near, &far], &direction), order, "{planes:?}");
        }
    }
}
