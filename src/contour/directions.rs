//! Great circles and directions of one view, by exact definition, and the one predicate of the
//! contour tree: on which side of a great circle a direction lies.

mod doubled;

use crate::bsp::{LineDef, LineId, PointId, Skeleton};
use crate::exact::{self, Approx3, Arena, BitRange, Constructor, Frame, Kept3, PredicateStats, Sign, ZeroComponents};
use crate::scene::{PlaneId, Splitter};
use glam::DVec3;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, Zero};
use rustc_hash::FxHashMap;

/// A great circle of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct CircleId(pub(crate) u32);

/// A direction of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DirectionId(pub(crate) u32);

/// A vector of a view that is not the scene's. There are few of them, and as many definitions as lines and corners are seen: so
/// those are kept small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct VectorId(u32);

#[derive(Clone, Copy, Debug, PartialEq)]
enum CircleDef {
    Line(LineId),
    /// Where two planes of the scene meet, in the order of their numbers.
    Crease([PlaneId; 2]),
    /// Through two points that are not the scene's.
    Points([VectorId; 2]),
    Given(VectorId),
    Parallel(PlaneId),
}

/// A direction by itself: its definition and its approximation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LooseDirection {
    definition: DirectionDef,
    approx: Approx3,
}

impl LooseDirection {
    /// As a unit vector.
    pub(crate) fn unit(&self) -> DVec3 {
        self.approx.v.normalize_or_zero()
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum DirectionDef {
    /// From the eye to a point.
    Point(PointId),
    /// From the eye to a point that is not the scene's.
    Towards(VectorId),
    /// `n_1 x n_2`, or its opposite.
    Crossing { circles: [CircleId; 2], reversed: bool },
}

/// The direction from the eye to any point.
#[derive(Clone, Debug)]
pub(crate) struct Towards {
    point: DVec3,
    frame: Frame,
    approx: Approx3,
}

impl Towards {
    /// Of a finite point that is not the eye.
    pub(crate) fn new(eye: DVec3, point: DVec3) -> Self {
        let frame = Frame::new(BitRange::of([point]), eye);
        Self { point, frame, approx: Approx3::direction(eye, point, 0.0) }
    }
}

/// All great circles and directions of one view.
#[derive(Clone, Debug)]
pub(crate) struct Directions {
    eye: DVec3,
    frame: Frame,
    circles: Vec<CircleDef>,
    normals: Vec<Approx3>,
    /// The components of the normals that are 0 by definition.
    zeros: Vec<ZeroComponents>,
    /// The directions that were kept: their definitions, and apart, as nearly all questions need only them, their approximations.
    definitions: Vec<DirectionDef>,
    approximations: Vec<Approx3>,
    vectors: Vec<DVec3>,
}

/// Integers that were needed once and may be needed again.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExactCache {
    arena: Arena,
    /// Of great circles, and which one of each is, from 1, if it was needed: 0 if not, as for those that are not there.
    normals: Vec<Kept3>,
    normal_of: Vec<u32>,
    points: FxHashMap<PointId, Kept3>,
    /// Of points that are not the scene's, by their bits.
    towards: FxHashMap<[u64; 3], Kept3>,
    /// What decided the sides asked for. Calls are counted where many are made at once, so `filter` is
    /// known only at the end: see [`ExactCache::predicates`].
    undecided: PredicateStats,
    calls: u64,
}

impl ExactCache {
    /// Counts calls of [`Directions::side`] and its like that are about to be made.
    #[inline]
    pub(crate) fn count_calls(&mut self, calls: usize) {
        self.calls += calls as u64;
    }

    /// Forgets everything but the memory.
    pub(crate) fn clear(&mut self) {
        let Self { arena, normals, normal_of, points, towards, undecided, calls } = self;
        arena.clear();
        normals.clear();
        normal_of.clear();
        points.clear();
        towards.clear();
        (*undecided, *calls) = (PredicateStats::default(), 0);
    }

    /// What all calls took.
    pub(crate) fn predicates(&self) -> PredicateStats {
        PredicateStats { filter: self.calls - self.undecided.undecided(), ..self.undecided }
    }

    /// Decides with integers and counts which kind.
    fn decide(&mut self, decide: impl FnOnce(&mut Arena) -> Sign) -> Sign {
        let arbitrary = self.arena.arbitrary_signs();
        let sign = decide(&mut self.arena);
        if self.arena.arbitrary_signs() == arbitrary {
            self.undecided.fixed += 1;
        } else {
            self.undecided.arbitrary += 1;
        }
        sign
    }
}

impl Directions {
    /// None yet, on a grid that holds points in that range. The memory of other ones is used again.
    pub(crate) fn new(range: BitRange, eye: DVec3, former: Option<Self>) -> Self {
        let frame = Frame::new(range, eye);
        let Some(former) = former else {
            return Self {
                eye,
                frame,
                circles: Vec::new(),
                normals: Vec::new(),
                zeros: Vec::new(),
                definitions: Vec::new(),
                approximations: Vec::new(),
                vectors: Vec::new(),
            };
        };
        let Self { mut circles, mut normals, mut zeros, mut definitions, mut approximations, mut vectors, .. } = former;
        circles.clear();
        normals.clear();
        zeros.clear();
        definitions.clear();
        approximations.clear();
        vectors.clear();
        Self { eye, frame, circles, normals, zeros, definitions, approximations, vectors }
    }

    fn push_vector(&mut self, vector: DVec3) -> VectorId {
        self.vectors.push(vector);
        VectorId(self.vectors.len() as u32 - 1)
    }

    fn vector(&self, vector: VectorId) -> DVec3 {
        self.vectors[vector.0 as usize]
    }

    fn push_circle(
        &mut self,
        skeleton: &Skeleton,
        def: CircleDef,
        normal: Approx3,
        cache: &mut ExactCache,
    ) -> CircleId {
        let id = CircleId(self.circles.len() as u32);
        self.circles.push(def);
        self.zeros.push(ZeroComponents::of_splitter(&self.resolved(skeleton, id), self.eye));
        let refined = normal.is_poor().then(|| self.exact_normal(skeleton, id, cache));
        self.normals.push(refined.map_or(normal, |exact| cache.arena.kept_rounded(&exact)));
        id
    }

    pub(crate) fn push_line(&mut self, skeleton: &Skeleton, line: LineId, cache: &mut ExactCache) -> CircleId {
        self.push_circle(skeleton, CircleDef::Line(line), skeleton.approx_line_normal(self.eye, line), cache)
    }

    /// The great circle through the line where two planes meet, in the order of their numbers.
    pub(crate) fn push_crease(
        &mut self,
        skeleton: &Skeleton,
        planes: [PlaneId; 2],
        cache: &mut ExactCache,
    ) -> CircleId {
        self.push_circle(skeleton, CircleDef::Crease(planes), skeleton.approx_crease_normal(self.eye, planes), cache)
    }

    /// The great circle through two points that are not the scene's, but on the grid.
    pub(crate) fn push_points(&mut self, skeleton: &Skeleton, ends: [DVec3; 2], cache: &mut ExactCache) -> CircleId {
        let normal = Approx3::edge_normal(self.eye, ends[0], ends[1]);
        let ends = ends.map(|end| self.push_vector(end));
        self.push_circle(skeleton, CircleDef::Points(ends), normal, cache)
    }

    pub(crate) fn push_given(&mut self, skeleton: &Skeleton, normal: DVec3, cache: &mut ExactCache) -> CircleId {
        let vector = self.push_vector(normal);
        self.push_circle(skeleton, CircleDef::Given(vector), Approx3::given(normal), cache)
    }

    pub(crate) fn push_parallel(&mut self, skeleton: &Skeleton, plane: PlaneId, cache: &mut ExactCache) -> CircleId {
        self.push_circle(skeleton, CircleDef::Parallel(plane), skeleton.approx_normal(plane), cache)
    }

    /// The approximation of a direction, made good with integers if it is poor.
    #[inline]
    fn refined(
        &self,
        skeleton: &Skeleton,
        definition: DirectionDef,
        approx: Approx3,
        cache: &mut ExactCache,
    ) -> Approx3 {
        if approx.is_poor() { self.rounded(skeleton, definition, cache) } else { approx }
    }

    /// The approximation of a direction by integers.
    #[cold]
    fn rounded(&self, skeleton: &Skeleton, definition: DirectionDef, cache: &mut ExactCache) -> Approx3 {
        match definition {
            DirectionDef::Point(point) => {
                let exact = self.exact_point(skeleton, point, cache);
                cache.arena.kept_rounded(&exact)
            }
            DirectionDef::Towards(point) => {
                let exact = self.exact_towards(self.vector(point), cache);
                cache.arena.kept_rounded(&exact)
            }
            DirectionDef::Crossing { circles, reversed } => {
                let [m, n] = circles.map(|c| self.exact_normal(skeleton, c, cache));
                if reversed { cache.arena.kept_cross(&n, &m) } else { cache.arena.kept_cross(&m, &n) }
            }
        }
    }

    pub(crate) fn push_point(&mut self, skeleton: &Skeleton, point: PointId, cache: &mut ExactCache) -> DirectionId {
        let approx = skeleton.approx_point(point);
        let approx = Approx3::direction(self.eye, approx.position, approx.err.max_element());
        let definition = DirectionDef::Point(point);
        let approx = self.refined(skeleton, definition, approx, cache);
        self.push(definition, approx)
    }

    /// From the eye to a point that is not the scene's, but on the grid.
    pub(crate) fn push_towards(&mut self, skeleton: &Skeleton, point: DVec3, cache: &mut ExactCache) -> DirectionId {
        let approx = Approx3::direction(self.eye, point, 0.0);
        let definition = DirectionDef::Towards(self.push_vector(point));
        let approx = self.refined(skeleton, definition, approx, cache);
        self.push(definition, approx)
    }

    /// How many directions there are.
    pub(crate) fn count(&self) -> usize {
        self.definitions.len()
    }

    /// Forgets all directions but the first ones, so many.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.definitions.truncate(count);
        self.approximations.truncate(count);
    }

    #[inline]
    fn push(&mut self, definition: DirectionDef, approx: Approx3) -> DirectionId {
        self.definitions.push(definition);
        self.approximations.push(approx);
        DirectionId(self.definitions.len() as u32 - 1)
    }

    /// The direction `n_1 x n_2`, or the opposite one.
    #[inline]
    pub(crate) fn push_crossing(
        &mut self,
        skeleton: &Skeleton,
        circles: [CircleId; 2],
        reversed: bool,
        cache: &mut ExactCache,
    ) -> DirectionId {
        let LooseDirection { definition, approx } = self.crossing(skeleton, circles, reversed, cache);
        self.push(definition, approx)
    }

    /// The same without keeping it.
    #[inline]
    pub(crate) fn crossing(
        &self,
        skeleton: &Skeleton,
        circles: [CircleId; 2],
        reversed: bool,
        cache: &mut ExactCache,
    ) -> LooseDirection {
        let [first, second] = if reversed { [circles[1], circles[0]] } else { circles };
        let approx = self.normals[first.0 as usize].cross(self.normals[second.0 as usize]);
        let definition = DirectionDef::Crossing { circles, reversed };
        LooseDirection { definition, approx: self.refined(skeleton, definition, approx, cache) }
    }

    pub(crate) fn direction(&self, d: DirectionId) -> LooseDirection {
        LooseDirection { definition: self.definitions[d.0 as usize], approx: self.approximations[d.0 as usize] }
    }

    /// On which side of the great circle the direction lies, exactly.
    #[inline]
    pub(crate) fn side(&self, skeleton: &Skeleton, d: DirectionId, c: CircleId, cache: &mut ExactCache) -> Sign {
        match self.approximations[d.0 as usize].dot_sign(&self.normals[c.0 as usize]) {
            Some(sign) => sign,
            None => self.undecided_side(skeleton, self.definitions[d.0 as usize], c, cache),
        }
    }

    /// The same for a direction that was not kept.
    #[inline]
    pub(crate) fn side_of(&self, skeleton: &Skeleton, d: &LooseDirection, c: CircleId, cache: &mut ExactCache) -> Sign {
        match d.approx.dot_sign(&self.normals[c.0 as usize]) {
            Some(sign) => sign,
            None => self.undecided_side(skeleton, d.definition, c, cache),
        }
    }

    /// The same where the approximations have been asked already and could not tell.
    #[cold]
    #[inline(never)]
    pub(crate) fn undecided_side_of(
        &self,
        skeleton: &Skeleton,
        d: DirectionId,
        c: CircleId,
        cache: &mut ExactCache,
    ) -> Sign {
        self.undecided_side(skeleton, self.definitions[d.0 as usize], c, cache)
    }

    #[cold]
    #[inline(never)]
    fn undecided_side(&self, skeleton: &Skeleton, d: DirectionDef, c: CircleId, cache: &mut ExactCache) -> Sign {
        if self.known_zero(skeleton, d, c) {
            cache.undecided.identity += 1;
            return Sign::Zero;
        }
        let normal = self.exact_normal(skeleton, c, cache);
        match d {
            DirectionDef::Crossing { circles, reversed } => {
                let [m, n] = circles.map(|circle| self.exact_normal(skeleton, circle, cache));
                let [m, n] = if reversed { [n, m] } else { [m, n] };
                cache.decide(|arena| arena.kept_det_sign(&normal, &m, &n))
            }
            DirectionDef::Point(point) => {
                let direction = self.exact_point(skeleton, point, cache);
                cache.decide(|arena| arena.kept_dot_sign(&normal, &direction))
            }
            DirectionDef::Towards(point) => {
                let direction = self.exact_towards(self.vector(point), cache);
                cache.decide(|arena| arena.kept_dot_sign(&normal, &direction))
            }
        }
    }

    /// True if the side is known without arithmetic to be 0; false says nothing.
    fn known_zero(&self, skeleton: &Skeleton, d: DirectionDef, c: CircleId) -> bool {
        match (d, self.circles[c.0 as usize]) {
            (DirectionDef::Crossing { circles, .. }, _) if circles.contains(&c) => true,
            (DirectionDef::Point(point), CircleDef::Line(line)) if skeleton.known_on_line(point, line) => true,
            (DirectionDef::Towards(point), CircleDef::Points(ends))
                if ends.iter().any(|&end| self.vector(end) == self.vector(point)) =>
            {
                true
            }
            (DirectionDef::Crossing { circles: [m, n], .. }, _) => {
                ZeroComponents::shared([c, m, n].map(|circle| self.zeros[circle.0 as usize]))
            }
            (DirectionDef::Point(point), _) => {
                let point = skeleton.resolved_point(skeleton.point(point));
                ZeroComponents::of_point(&point, self.eye).cover(self.zeros[c.0 as usize])
            }
            (DirectionDef::Towards(point), _) => {
                ZeroComponents::of_point(&exact::Point::Given(self.vector(point)), self.eye)
                    .cover(self.zeros[c.0 as usize])
            }
        }
    }

    /// A great circle by its coordinates.
    fn resolved(&self, skeleton: &Skeleton, c: CircleId) -> exact::Splitter {
        match self.circles[c.0 as usize] {
            CircleDef::Line(line) => skeleton.resolved_line(line),
            CircleDef::Crease(planes) => exact::Splitter::Crease(planes.map(|p| skeleton.resolved_plane(p))),
            CircleDef::Points(ends) => exact::Splitter::Edge(ends.map(|end| self.vector(end))),
            CircleDef::Given(normal) => exact::Splitter::Given(self.vector(normal)),
            CircleDef::Parallel(plane) => exact::Splitter::Parallel(skeleton.resolved_plane(plane)),
        }
    }

    #[inline]
    fn exact_normal(&self, skeleton: &Skeleton, c: CircleId, cache: &mut ExactCache) -> Kept3 {
        match cache.normal_of.get(c.0 as usize) {
            Some(&place) if place != 0 => cache.normals[place as usize - 1],
            _ => self.new_exact_normal(skeleton, c, cache),
        }
    }

    #[cold]
    #[inline(never)]
    fn new_exact_normal(&self, skeleton: &Skeleton, c: CircleId, cache: &mut ExactCache) -> Kept3 {
        let definition = self.resolved(skeleton, c);
        let normal = Constructor { frame: &self.frame, arena: &mut cache.arena }.keep_splitter(&definition);
        cache.normals.push(normal);
        let circle = c.0 as usize;
        if cache.normal_of.len() <= circle {
            cache.normal_of.resize(circle + 1, 0);
        }
        cache.normal_of[circle] = cache.normals.len() as u32;
        normal
    }

    /// What all normals of one great circle have in common: the multiple that is whole, has no common divisor and starts
    /// with a positive number; and the sign of the normal's own multiple of that.
    pub(crate) fn primitive_normal(
        &self,
        skeleton: &Skeleton,
        c: CircleId,
        cache: &mut ExactCache,
    ) -> ([BigInt; 3], Sign) {
        let normal = self.exact_normal(skeleton, c, cache);
        let mark = cache.arena.mark();
        let numbers = cache.arena.numbers(&normal);
        let whole = numbers.map(|n| cache.arena.big(n));
        cache.arena.release(mark);
        let divisor = whole.iter().fold(BigInt::zero(), |all, x| all.gcd(x));
        let is_negative = whole.iter().find(|x| !x.is_zero()).is_some_and(Signed::is_negative);
        let (divisor, sign) = if is_negative { (-divisor, Sign::Negative) } else { (divisor, Sign::Positive) };
        (if divisor.is_zero() { whole } else { whole.map(|x| x / &divisor) }, sign)
    }

    fn exact_point(&self, skeleton: &Skeleton, point: PointId, cache: &mut ExactCache) -> Kept3 {
        if let Some(&known) = cache.points.get(&point) {
            return known;
        }
        let direction = exact::Direction::Point(skeleton.resolved_point(skeleton.point(point)));
        let x = Constructor { frame: &self.frame, arena: &mut cache.arena }.keep_direction(&direction);
        cache.points.insert(point, x);
        x
    }

    fn exact_towards(&self, point: DVec3, cache: &mut ExactCache) -> Kept3 {
        let key = point.to_array().map(f64::to_bits);
        if let Some(&known) = cache.towards.get(&key) {
            return known;
        }
        let direction = exact::Direction::Point(exact::Point::Given(point));
        let x = Constructor { frame: &self.frame, arena: &mut cache.arena }.keep_direction(&direction);
        cache.towards.insert(key, x);
        x
    }

    /// Whether the normals of two names of one great circle point the same way.
    pub(crate) fn same_way(&self, skeleton: &Skeleton, a: CircleId, b: CircleId, cache: &mut ExactCache) -> Sign {
        if a == b {
            return Sign::Positive;
        }
        let [a, b] = [a, b].map(|circle| self.exact_normal(skeleton, circle, cache));
        cache.arena.kept_dot_sign(&a, &b)
    }

    /// The point of the scene, or one that the 3D BSP made, that a direction leads to, if it was made for one.
    pub(crate) fn point(&self, d: DirectionId) -> Option<PointId> {
        match self.definitions[d.0 as usize] {
            DirectionDef::Point(point) => Some(point),
            DirectionDef::Towards(_) | DirectionDef::Crossing { .. } => None,
        }
    }

    /// Where the ray in a direction meets a plane that it does meet, rounded.
    pub(crate) fn point_on_plane(
        &self,
        skeleton: &Skeleton,
        d: DirectionId,
        plane: PlaneId,
        cache: &mut ExactCache,
    ) -> DVec3 {
        let [x, m, n] = match self.definitions[d.0 as usize] {
            DirectionDef::Point(point) => [Some(self.exact_point(skeleton, point, cache)), None, None],
            DirectionDef::Towards(point) => [Some(self.exact_towards(self.vector(point), cache)), None, None],
            DirectionDef::Crossing { circles: [m, n], reversed } => {
                let [m, n] = if reversed { [n, m] } else { [m, n] };
                [None, Some(self.exact_normal(skeleton, m, cache)), Some(self.exact_normal(skeleton, n, cache))]
            }
        };
        let arena = &mut cache.arena;
        let mark = arena.mark();
        let direction = match (x, m, n) {
            (None, Some(m), Some(n)) => {
                let [m, n] = [m, n].map(|normal| arena.numbers(&normal));
                arena.cross(m, n)
            }
            (Some(x), ..) => arena.numbers(&x),
            _ => unreachable!("a direction is a point or a crossing"),
        };
        let (normal, height) = Constructor { frame: &self.frame, arena }.plane(&skeleton.resolved_plane(plane));
        // normal . (s x) = -height.
        let along = arena.dot(normal, direction);
        let sign = along.sign();
        let point = arena.scale3(height.negated().times_sign(sign), direction);
        let (position, _) = self.frame.position(arena, point, along.times_sign(sign));
        arena.release(mark);
        position
    }

    /// On which side of the great circle a direction given by three numbers lies, exactly.
    pub(crate) fn given_side(&self, skeleton: &Skeleton, d: DVec3, c: CircleId, cache: &mut ExactCache) -> Sign {
        if let Some(sign) = Approx3::given(d).dot_sign(&self.normals[c.0 as usize]) {
            return sign;
        }
        let normal = self.exact_normal(skeleton, c, cache);
        let mark = cache.arena.mark();
        let mut exact = Constructor { frame: &self.frame, arena: &mut cache.arena };
        let direction = exact.direction(&exact::Direction::Given(d));
        let normal = cache.arena.numbers(&normal);
        let sign = cache.arena.dot_sign(normal, direction);
        cache.arena.release(mark);
        sign
    }

    /// The same for the direction from the eye to a point that is neither the scene's nor on the grid.
    pub(crate) fn towards_side(
        &self,
        skeleton: &Skeleton,
        towards: &Towards,
        c: CircleId,
        cache: &mut ExactCache,
    ) -> Sign {
        if let Some(sign) = towards.approx.dot_sign(&self.normals[c.0 as usize]) {
            return sign;
        }
        let normal = self.exact_normal(skeleton, c, cache);
        let mark = cache.arena.mark();
        // On a grid of its own: a multiple of the direction is as good.
        let mut exact = Constructor { frame: &towards.frame, arena: &mut cache.arena };
        let direction = exact.direction(&exact::Direction::Point(exact::Point::Given(towards.point)));
        let normal = cache.arena.numbers(&normal);
        let sign = cache.arena.dot_sign(normal, direction);
        cache.arena.release(mark);
        sign
    }

    /// The direction in floating point.
    pub(crate) fn approximation(&self, d: DirectionId) -> &Approx3 {
        &self.approximations[d.0 as usize]
    }

    /// All directions in floating point.
    pub(crate) fn approximations(&self) -> &[Approx3] {
        &self.approximations
    }

    /// The direction as a unit vector.
    pub(crate) fn unit(&self, d: DirectionId) -> DVec3 {
        self.approximations[d.0 as usize].v.normalize_or_zero()
    }

    pub(crate) fn circle_count(&self) -> usize {
        self.circles.len()
    }

    /// The line of the scene that a great circle goes through, if it was made for one.
    #[inline]
    pub(crate) fn line(&self, c: CircleId) -> Option<LineId> {
        match self.circles[c.0 as usize] {
            CircleDef::Line(line) => Some(line),
            CircleDef::Crease(_) | CircleDef::Points(_) | CircleDef::Given(_) | CircleDef::Parallel(_) => None,
        }
    }

    /// The normal of a great circle in floating point: `n . d > 0` is its positive side.
    pub(crate) fn normal(&self, c: CircleId) -> &Approx3 {
        &self.normals[c.0 as usize]
    }

    pub(crate) fn splitter(&self, skeleton: &Skeleton, c: CircleId) -> Splitter {
        match self.circles[c.0 as usize] {
            CircleDef::Line(line) => match skeleton.line(line) {
                LineDef::Edge(ends) => Splitter::Edge(ends),
                LineDef::Crease(planes) => Splitter::Crease(planes.map(|p| skeleton.plane(p))),
            },
            CircleDef::Crease(planes) => Splitter::Crease(planes.map(|p| skeleton.plane(p))),
            CircleDef::Points(ends) => Splitter::Points(ends.map(|end| self.vector(end))),
            CircleDef::Given(normal) => Splitter::Given(self.vector(normal)),
            CircleDef::Parallel(plane) => Splitter::Parallel(skeleton.plane(plane)),
        }
    }
}
