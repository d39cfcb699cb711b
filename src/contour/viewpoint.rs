//! Where one stands.

use crate::bsp::Skeleton;
use crate::exact::{ApproxPlane, Sign, orient3d, power_of_two_at_most};
use crate::scene::{PieceId, PieceRef, PolygonId, Scene, Side, SupportingPlane};
use glam::DVec3;
use std::cmp::Ordering;

#[cfg(test)]
mod tests;

/// A viewpoint: a point in space, or a point on one side of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    eye: DVec3,
    surface: Option<(PieceId, PolygonId, Side)>,
}

/// Why there is no such viewpoint.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The polygon number is too large.
    #[error("there is no polygon {polygon}: the scene has {count}, numbered from 0")]
    UnknownPolygon {
        /// The number asked for.
        polygon: PolygonId,
        /// How many polygons there are.
        count: usize,
    },
    /// The polygon has no area, or was dropped.
    #[error("polygon {polygon} has no area, or was dropped: one cannot stand on it")]
    NoArea {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A normal that is to tell the side of a polygon lies in its plane.
    #[error(
        "the normal {normal} lies in the plane of polygon {polygon}, within 1e-6 rad, and shows neither of its sides; \
         turn it towards the side that is meant"
    )]
    NoSide {
        /// The polygon.
        polygon: PolygonId,
        /// The normal.
        normal: DVec3,
    },
    /// The position is infinite or not a number.
    #[error("the position has a coordinate that is not finite")]
    NotFinite,
}

impl Viewpoint {
    /// A point in space.
    pub fn free(eye: DVec3) -> Self {
        Self { eye, surface: None }
    }

    /// A point on one side of a polygon: the one nearest to `near`.
    ///
    /// The eye is an f64 point next to that one that does not lie behind the plane of the polygon's
    /// piece, seen from that side: its exact height over the plane is at least 0. So the piece, and all
    /// that is exactly coplanar with it, lies at or below the horizon of
    /// [`Domain::Above`](super::Domain::Above).
    ///
    /// # Errors
    /// If there is no such polygon, if it has no area, or if `near` is not finite.
    pub fn on_surface(scene: &Scene, polygon: PolygonId, side: Side, near: DVec3) -> Result<Self, SurfaceError> {
        if polygon.index() >= scene.polygon_count() {
            return Err(SurfaceError::UnknownPolygon { polygon, count: scene.polygon_count() });
        }
        if !near.is_finite() {
            return Err(SurfaceError::NotFinite);
        }
        let nearest = scene.polygon(polygon).pieces().map(|piece| Foot::on(piece, near)).min_by(Foot::compare);
        let foot = nearest.ok_or(SurfaceError::NoArea { polygon })?;
        Ok(Self::at(scene, &foot, side))
    }

    /// The same on the side of the polygon, at the piece nearest to `near`, that shows in the direction of `normal`, of any length.
    ///
    /// # Errors
    /// As [`Viewpoint::on_surface`]; [`SurfaceError::NoSide`] if the normal is within 1e-6 rad of the piece's plane, or no direction at all.
    pub fn on_surface_towards(
        scene: &Scene,
        polygon: PolygonId,
        normal: DVec3,
        near: DVec3,
    ) -> Result<Self, SurfaceError> {
        let front = Self::on_surface(scene, polygon, Side::Front, near)?;
        let unit = (normal / normal.abs().max_element()).try_normalize();
        let towards = |(piece, _, _)| unit.map(|unit| unit_normal(scene, scene.piece(piece)).dot(unit));
        let sine = front.surface.and_then(towards).filter(|sine| sine.abs() > 1e-6);
        let sine = sine.ok_or(SurfaceError::NoSide { polygon, normal })?;
        let side = if sine < 0.0 { Side::Back } else { Side::Front };
        if side == Side::Front { Ok(front) } else { Self::on_surface(scene, polygon, side, near) }
    }

    /// The same on one piece of a polygon.
    ///
    /// # Errors
    /// If `near` is not finite.
    ///
    /// # Panics
    /// If there is no such piece.
    pub fn on_piece(scene: &Scene, piece: PieceId, side: Side, near: DVec3) -> Result<Self, SurfaceError> {
        if !near.is_finite() {
            return Err(SurfaceError::NotFinite);
        }
        Ok(Self::at(scene, &Foot::on(scene.piece(piece), near), side))
    }

    fn at(scene: &Scene, foot: &Foot<'_>, side: Side) -> Self {
        let eye = not_behind(scene, foot.piece, side, foot.position);
        Self { eye, surface: Some((foot.piece.id(), foot.piece.polygon(), side)) }
    }

    /// The surface that a sensor at `eye` with that normal, of any length, is meant to be on: a piece
    /// within 1e-9 of the scene's diagonal whose normal is within 1e-6 rad of `normal` or its opposite, and
    /// its side there. Of several, one that shows its front, then the nearest, then the lowest number.
    pub fn surface_at(scene: &Scene, eye: DVec3, normal: DVec3) -> Option<(PieceId, Side)> {
        Self::surface_among(scene.pieces(), Self::reach(scene), eye, normal)
    }

    /// How near a sensor is to the surface that it is meant to be on.
    pub(super) fn reach(scene: &Scene) -> f64 {
        1e-9 * scene.diagonal()
    }

    /// True if a point is nearer than that to a box.
    pub(super) fn is_within(low: DVec3, high: DVec3, reach: f64, eye: DVec3) -> bool {
        ((low - reach).cmple(eye) & (high + reach).cmpge(eye)).all()
    }

    /// [`Viewpoint::surface_at`] for some pieces of a scene, in the order of their numbers.
    pub(super) fn surface_among<'a>(
        pieces: impl Iterator<Item = PieceRef<'a>>,
        reach: f64,
        eye: DVec3,
        normal: DVec3,
    ) -> Option<(PieceId, Side)> {
        let normal = (normal / normal.abs().max_element()).try_normalize()?;
        let candidates = pieces.filter_map(|piece| {
            let corners = piece.points();
            let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
            let facing = Self::is_within(low, high, reach, eye).then(|| unit_normal(piece.scene(), piece))?;
            if facing.cross(normal).length() > 1e-6 {
                return None;
            }
            let foot = Foot::on(piece, eye);
            let side = if facing.dot(normal) > 0.0 { Side::Front } else { Side::Back };
            (foot.distance <= reach).then_some((side, foot))
        });
        let best = candidates.min_by(|a, b| a.0.cmp(&b.0).then_with(|| a.1.compare(&b.1)));
        best.map(|(side, foot)| (foot.piece.id(), side))
    }

    /// The position.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// The polygon that the viewpoint is on, and the side of it.
    pub fn surface(&self) -> Option<(PolygonId, Side)> {
        self.surface.map(|(_, polygon, side)| (polygon, side))
    }

    /// The piece that the viewpoint is on, and the side of it.
    pub fn surface_piece(&self) -> Option<(PieceId, Side)> {
        self.surface.map(|(piece, _, side)| (piece, side))
    }

    /// The unit normal of the surface it is on, away from it.
    pub(crate) fn surface_normal(&self, scene: &Scene, skeleton: &Skeleton) -> Option<DVec3> {
        let (piece, _, side) = self.surface?;
        let piece = scene.piece(piece);
        let normal = skeleton.approx_normal(piece.plane_id()).v.normalize();
        Some(if side == piece.facing() { normal } else { -normal })
    }
}

/// The point of a piece that is nearest to another point, rounded.
struct Foot<'a> {
    piece: PieceRef<'a>,
    position: DVec3,
    distance: f64,
}

impl<'a> Foot<'a> {
    fn on(piece: PieceRef<'a>, near: DVec3) -> Self {
        // Scaled by a power of two, so that no square and no product under- or overflows.
        let most = piece.points().fold(near.abs(), |most, p| most.max(p.abs())).max_element();
        let scale = power_of_two_at_most(most);
        let corners: Vec<DVec3> = piece.points().map(|p| p / scale).collect();
        let near = near / scale;
        let position = nearest_point(&corners, unit_normal(piece.scene(), piece), near);
        let distance = position.distance(near) * scale;
        let mut position = position * scale;
        if let SupportingPlane::Axis { axis, value } = piece.plane() {
            position[axis as usize] = value;
        }
        Self { piece, position, distance }
    }

    fn compare(&self, other: &Self) -> Ordering {
        self.distance.total_cmp(&other.distance)
    }
}

/// The unit normal of a piece, to its front.
fn unit_normal(scene: &Scene, piece: PieceRef<'_>) -> DVec3 {
    let normal = ApproxPlane::refined(&scene.resolve_plane(piece.plane())).normal.v.normalize();
    if piece.facing() == Side::Front { normal } else { -normal }
}

/// The point of a convex piece with that unit normal that is nearest to `near`.
fn nearest_point(corners: &[DVec3], normal: DVec3, near: DVec3) -> DVec3 {
    let onto_plane = |p: DVec3| p - normal * normal.dot(p - corners[0]);
    // From afar the first projection is off in proportion to the distance; the second mends that.
    let foot = onto_plane(onto_plane(near));
    let segments = || corners.iter().zip(corners.iter().cycle().skip(1));
    if segments().all(|(&a, &b)| normal.cross(b - a).dot(foot - a) >= 0.0) {
        return foot;
    }
    let on_segments = segments().map(|(&a, &b)| {
        let ab = b - a;
        // Seen from afar a segment may be so short that its square underflows.
        let most = ab.abs().max_element();
        if most == 0.0 {
            return a;
        }
        let unit = ab / most;
        a + ab * ((foot - a).dot(unit) / unit.length_squared() / most).clamp(0.0, 1.0)
    });
    on_segments.min_by(|p, q| p.distance_squared(foot).total_cmp(&q.distance_squared(foot))).unwrap_or(foot)
}

/// An f64 point that is not behind the piece's plane: that nearest to `foot`, which lies close to the plane,
/// among those up to two places away in two coordinates and any number of places in the third.
fn not_behind(scene: &Scene, piece: PieceRef<'_>, side: Side, foot: DVec3) -> DVec3 {
    // A foot in an axis-aligned plane is exactly in it.
    let SupportingPlane::Points(points) = piece.plane() else { return foot };
    let [a, b, c] = points.map(|v| scene.vertex(v));
    let towards = if piece.facing() == side { Sign::Positive } else { Sign::Negative };
    let allowed = |p: DVec3| orient3d(a, b, c, p) * towards != Sign::Negative;
    if allowed(foot) {
        return foot;
    }
    // The height grows along the normal's largest component: for every neighbour in the other two,
    // the least step along that axis is found by doubling and halving.
    let normal = unit_normal(scene, piece) * if side == Side::Front { 1.0 } else { -1.0 };
    let axis = normal.abs().max_position();
    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
    let up = if normal[axis] > 0.0 { 1 } else { -1 };
    let neighbours = (-2..=2).flat_map(|i| (-2..=2).map(move |j| (i, j)));
    let candidates = neighbours.filter_map(|(i, j)| {
        let mut p = foot;
        p[second] = step(foot[second], i);
        p[third] = step(foot[third], j);
        if allowed(p) {
            return Some(p);
        }
        let moved = |steps: i64| {
            let mut q = p;
            q[axis] = step(foot[axis], up * steps);
            q
        };
        let mut high = 1i64;
        while !allowed(moved(high)) {
            high = high.checked_mul(2).filter(|&h| h < 1 << 62 && moved(h).is_finite())?;
        }
        let mut low = high / 2;
        while high - low > 1 {
            let middle = i64::midpoint(low, high);
            *(if allowed(moved(middle)) { &mut high } else { &mut low }) = middle;
        }
        Some(moved(high))
    });
    // Some step is always enough; the plane's own vertex is there for the type's sake.
    candidates.min_by(|p, q| p.distance_squared(foot).total_cmp(&q.distance_squared(foot))).unwrap_or(a)
}

/// The f64 that many places further up in the order of all f64.
fn step(x: f64, steps: i64) -> f64 {
    let order = |bits: i64| if bits < 0 { i64::MIN - bits } else { bits };
    f64::from_bits(order(order(x.to_bits() as i64).saturating_add(steps)) as u64)
}
