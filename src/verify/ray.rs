//! The ray oracle: what a ray sees, exactly, by trying every piece.

use super::filter::{Ball, Depth, Estimate};
use super::integers;
use crate::exact::Sign;
use crate::scene::{PieceId, PolygonId, Scene, Side};
use glam::DVec3;
use std::cmp::Ordering;
use std::ops::Range;
use std::sync::atomic::{self, AtomicU64};

/// What a ray sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayAnswer {
    /// The interior of a piece.
    Hit {
        /// The polygon.
        polygon: PolygonId,
        /// The piece of it.
        piece: PieceId,
        /// The side of the piece that the eye is on.
        side: Side,
    },
    /// Nothing: the background.
    Miss,
    /// No open cell of directions: the ray goes exactly through the boundary of a piece before or just
    /// where it meets the interior of another, or through the crossing of two pieces.
    Boundary,
}

/// How much work an oracle has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayStats {
    /// The rays cast.
    pub rays: u64,
    /// Those of them for which `f64` did not decide everything.
    pub exact: u64,
}

/// Tells what single rays see, exactly and by brute force: O(pieces) a ray.
///
/// The rules:
///
/// - a piece hides what lies behind it on a ray e + t d, t > 0. A piece whose plane holds the eye hides nothing;
/// - a ray that runs in the plane of a piece, or parallel to it, does not meet it;
/// - of several pieces in one and the same plane, one that shows its front is seen rather than one that shows its back, then the
///   one of the lowest polygon (then piece) id;
/// - pieces of different planes met at exactly the same depth, and the boundary of a piece (between
///   two pieces of one polygon too) met no farther than anything else, make the answer [`RayAnswer::Boundary`].
///
/// Signs are decided in `f64` where its proved error allows, else with integers of any length:
/// no answer is ever rounded, for any finite coordinates. Nothing here is shared with the engine
/// that it judges. Measured: 5 to 35 ns a ray and piece where `f64` decides, 1 to 4 microseconds
/// for each sign that takes integers.
#[derive(Debug)]
pub struct RayOracle {
    facets: Vec<Facet>,
    balls: Vec<Ball>,
    points: Vec<DVec3>,
    rays: AtomicU64,
    exact: AtomicU64,
}

/// A piece that has an area.
#[derive(Debug)]
struct Facet {
    polygon: PolygonId,
    piece: PieceId,
    /// Its vertices in `points`.
    range: Range<usize>,
    /// Three of them that are not collinear, in the order of the loop.
    plane: [DVec3; 3],
}

impl RayOracle {
    /// An oracle for all pieces of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self::from_pieces(scene.pieces().map(|piece| (piece.polygon(), piece.points())))
    }

    /// An oracle for pieces without a scene: the k-th is piece k. Each is a polygon id and the vertices,
    /// finite, exactly in one plane, convex (collinear and repeated vertices allowed) and counter-clockwise seen
    /// from the front. Pieces without area hide nothing.
    pub fn from_pieces<P>(pieces: impl IntoIterator<Item = (PolygonId, P)>) -> Self
    where
        P: IntoIterator<Item = DVec3>,
    {
        let mut oracle =
            Self { facets: vec![], balls: vec![], points: vec![], rays: AtomicU64::new(0), exact: AtomicU64::new(0) };
        for (index, (polygon, vertices)) in pieces.into_iter().enumerate() {
            let start = oracle.points.len();
            oracle.points.extend(vertices);
            // A repeated vertex makes an edge without direction, which every ray would seem to go through.
            dedup_from(&mut oracle.points, start);
            let vertices = &oracle.points[start..];
            debug_assert!(vertices.iter().all(|p| p.is_finite()), "piece {index} is not finite");
            if let Some(plane) = plane_of(vertices) {
                oracle.balls.push(Ball::around(vertices));
                let range = start..oracle.points.len();
                oracle.facets.push(Facet { polygon, piece: PieceId(index as u32), range, plane });
            } else {
                oracle.points.truncate(start);
            }
        }
        oracle
    }

    /// What the ray from `eye` in a direction of any length sees. A direction that is zero or not
    /// finite names no ray: [`RayAnswer::Boundary`].
    pub fn cast(&self, eye: DVec3, direction: DVec3) -> RayAnswer {
        self.cast_in(eye, direction, Stage::Filtered)
    }

    /// The work done since the oracle was made.
    pub fn stats(&self) -> RayStats {
        RayStats { rays: self.rays.load(atomic::Ordering::Relaxed), exact: self.exact.load(atomic::Ordering::Relaxed) }
    }

    pub(super) fn cast_in(&self, eye: DVec3, direction: DVec3, stage: Stage) -> RayAnswer {
        self.rays.fetch_add(1, atomic::Ordering::Relaxed);
        if !eye.is_finite() || !direction.is_finite() || direction == DVec3::ZERO {
            return RayAnswer::Boundary;
        }
        let mut ray = Ray { eye, direction, stage, was_exact: false };
        let answer = self.look(&mut ray);
        if ray.was_exact {
            self.exact.fetch_add(1, atomic::Ordering::Relaxed);
        }
        answer
    }

    fn look(&self, ray: &mut Ray) -> RayAnswer {
        let square = ray.direction.length_squared();
        let mut nearest: Option<Candidate<'_>> = None;
        let mut crossing = false;
        let mut nearest_rim: Option<Candidate<'_>> = None;
        for (facet, ball) in self.facets.iter().zip(&self.balls) {
            let end = nearest.as_ref().map_or(f64::INFINITY, |best| best.depth.high());
            if ray.stage == Stage::Filtered && ball.is_missed(ray.eye, ray.direction, square, end) {
                continue;
            }
            let Some((place, side)) = ray.place(facet, &self.points[facet.range.clone()]) else { continue };
            let found = Candidate { facet, side, depth: ray.depth(facet.plane) };
            match place {
                Place::Rim => {
                    if nearest_rim.as_ref().is_none_or(|rim| ray.compare(&found, rim).is_lt()) {
                        nearest_rim = Some(found);
                    }
                }
                Place::Interior => match nearest.as_ref().map(|best| (best, ray.compare(&found, best))) {
                    None | Some((_, Ordering::Less)) => {
                        nearest = Some(found);
                        crossing = false;
                    }
                    Some((best, Ordering::Equal)) => {
                        if !integers::is_same_plane(best.facet.plane, facet.plane) {
                            crossing = true;
                        } else if found.rank() < best.rank() {
                            nearest = Some(found);
                        }
                    }
                    Some((_, Ordering::Greater)) => {}
                },
            }
        }
        match (nearest, nearest_rim) {
            (None, None) => RayAnswer::Miss,
            (None, Some(_)) => RayAnswer::Boundary,
            (Some(hit), Some(rim)) if ray.compare(&rim, &hit).is_le() => RayAnswer::Boundary,
            (Some(_), _) if crossing => RayAnswer::Boundary,
            (Some(hit), _) => RayAnswer::Hit { polygon: hit.facet.polygon, piece: hit.facet.piece, side: hit.side },
        }
    }
}

/// Which arithmetic a ray starts with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// `f64`, then integers where that does not decide.
    Filtered,
    /// Integers at once.
    Exact,
}

/// Where a ray goes through a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Interior,
    Rim,
}

/// A piece that the ray meets.
struct Candidate<'a> {
    facet: &'a Facet,
    side: Side,
    depth: Depth,
}

impl Candidate<'_> {
    /// Of pieces in one plane the one of least rank is seen.
    fn rank(&self) -> (Side, PolygonId, PieceId) {
        (self.side, self.facet.polygon, self.facet.piece)
    }
}

/// A ray while it is cast.
struct Ray {
    eye: DVec3,
    direction: DVec3,
    stage: Stage,
    was_exact: bool,
}

impl Ray {
    /// Whether the ray goes through a piece, and on which side of it the eye is.
    ///
    /// For an eye off the piece's plane the directions that meet the piece are a convex cone, the
    /// intersection of the half-spaces of its edges: with h the eye's height over the plane, d is inside if det[p - e, q - e, d] has
    /// the sign of -h for every edge pq, and on the rim if some are zero instead. (det[a - e, b - e, c - e]
    /// = -h for vertices of the loop in order, so that is the sign inside.) This covers t > 0, and excludes N . d = 0.
    fn place(&mut self, facet: &Facet, vertices: &[DVec3]) -> Option<(Place, Side)> {
        let mut inner = None;
        let mut undecided = self.stage == Stage::Exact;
        if self.stage == Stage::Filtered {
            let mut previous = *vertices.last()? - self.eye;
            for &vertex in vertices {
                let current = vertex - self.eye;
                match Estimate::determinant(previous, current, self.direction).sign() {
                    None => undecided = true,
                    Some(sign) if inner.is_some_and(|inner| inner != sign) => return None,
                    sign => inner = sign,
                }
                previous = current;
            }
        }
        let height = self.height_sign(facet.plane);
        if height.is_zero() || inner.is_some_and(|inner| inner != -height) {
            return None;
        }
        let mut place = Place::Interior;
        if undecided {
            let mut previous = *vertices.last()?;
            for &vertex in vertices {
                let sign = self.edge_sign(previous, vertex);
                if sign.is_zero() {
                    place = Place::Rim;
                } else if sign == height {
                    return None;
                }
                previous = vertex;
            }
        }
        Some((place, if height.is_positive() { Side::Front } else { Side::Back }))
    }

    fn edge_sign(&mut self, p: DVec3, q: DVec3) -> Sign {
        let estimate = || Estimate::determinant(p - self.eye, q - self.eye, self.direction).sign();
        if let Some(sign) = self.filtered(estimate) {
            return sign;
        }
        self.was_exact = true;
        integers::edge_sign(p, q, self.eye, self.direction)
    }

    fn height_sign(&mut self, plane: [DVec3; 3]) -> Sign {
        if let Some(sign) = self.filtered(|| self.height(plane).sign()) {
            return sign;
        }
        self.was_exact = true;
        integers::height_sign(plane, self.eye)
    }

    /// N . (e - a).
    fn height(&self, [a, b, c]: [DVec3; 3]) -> Estimate {
        Estimate::determinant(b - a, c - a, self.eye - a)
    }

    fn depth(&self, plane: [DVec3; 3]) -> Depth {
        if self.stage == Stage::Exact {
            return Depth::UNKNOWN;
        }
        let [a, b, c] = plane;
        Depth::new(self.height(plane), Estimate::determinant(b - a, c - a, self.direction))
    }

    fn compare(&mut self, one: &Candidate<'_>, other: &Candidate<'_>) -> Ordering {
        one.depth.compare(other.depth).unwrap_or_else(|| {
            self.was_exact = true;
            integers::compare_depth([one.facet.plane, other.facet.plane], self.eye, self.direction)
        })
    }

    fn filtered(&self, estimate: impl FnOnce() -> Option<Sign>) -> Option<Sign> {
        match self.stage {
            Stage::Filtered => estimate(),
            Stage::Exact => None,
        }
    }
}

/// Removes repeated vertices of a loop that starts at `start`, the last one if it repeats the first.
fn dedup_from(points: &mut Vec<DVec3>, start: usize) {
    let mut kept = start;
    for k in start..points.len() {
        if k == start || points[k] != points[kept - 1] {
            points[kept] = points[k];
            kept += 1;
        }
    }
    while kept > start + 1 && points[kept - 1] == points[start] {
        kept -= 1;
    }
    points.truncate(kept);
}

/// Three vertices of a loop, in its order, that are not collinear; spread out, if `f64` can tell.
fn plane_of(vertices: &[DVec3]) -> Option<[DVec3; 3]> {
    let first = *vertices.first()?;
    let farthest = index_of_largest(vertices.iter().map(|p| p.distance_squared(first)));
    let base = vertices[farthest] - first;
    let third = index_of_largest(vertices.iter().map(|p| (*p - first).cross(base).length_squared()));
    let wide = [first, vertices[farthest.min(third)], vertices[farthest.max(third)]];
    let around = (0..vertices.len()).map(|k| [k, k + 1, k + 2].map(|k| vertices[k % vertices.len()]));
    std::iter::once(wide).chain(around).find(|&[a, b, c]| {
        let is_certain = |axis| Estimate::determinant(axis, b - a, c - a).sign().is_some();
        DVec3::AXES.into_iter().any(is_certain) || !integers::are_collinear([a, b, c])
    })
}

fn index_of_largest(values: impl Iterator<Item = f64>) -> usize {
    values.enumerate().fold((0, 0.0), |best, (k, value)| if value > best.1 { (k, value) } else { best }).0
}
