//! Where one stands.

use crate::bsp::SceneBsp;
use crate::exact::{Sign, orient3d};
use crate::scene::{PieceId, PieceRef, PolygonId, Scene, Side, SupportingPlane};
use glam::DVec3;

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
    /// The polygon has no area.
    #[error("polygon {polygon} has no area: one cannot stand on it")]
    NoArea {
        /// The polygon.
        polygon: PolygonId,
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
    /// The eye is the nearest f64 point that does not lie behind the plane of the polygon's piece,
    /// seen from that side: its exact height over the plane is at least 0. So the piece, and all
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
        let (_, foot, piece) =
            nearest_piece(scene.polygon(polygon).pieces(), near).ok_or(SurfaceError::NoArea { polygon })?;
        let eye = not_behind(scene, piece, side, foot);
        Ok(Self { eye, surface: Some((piece.id(), polygon, side)) })
    }

    /// The surface that a sensor at `eye` with that normal is meant to be on: the nearest piece within
    /// 1e-9 of the scene's diagonal whose normal is within 1e-6 rad of `normal` or its opposite.
    pub fn surface_at(scene: &Scene, eye: DVec3, normal: DVec3) -> Option<(PolygonId, Side)> {
        let reach = 1e-9 * scene.diagonal();
        let normal = normal.try_normalize()?;
        let parallel = scene.pieces().filter(|&piece| {
            let corners = piece.points();
            let near = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
            let inside = (near.0 - reach).cmple(eye) & (near.1 + reach).cmpge(eye);
            inside.all() && unit_normal(scene, piece).cross(normal).length() <= 1e-6
        });
        let (distance, _, piece) = nearest_piece(parallel, eye)?;
        let side = if unit_normal(scene, piece).dot(normal) > 0.0 { Side::Front } else { Side::Back };
        (distance <= reach).then_some((piece.polygon(), side))
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
    pub(crate) fn surface_normal(&self, bsp: &SceneBsp) -> Option<DVec3> {
        let (piece, _, side) = self.surface?;
        let normal = unit_normal(bsp.scene(), bsp.scene().piece(piece));
        Some(if side == Side::Front { normal } else { -normal })
    }
}

/// The distance to the nearest of some pieces, the nearest point on it, and the piece.
fn nearest_piece<'a>(pieces: impl Iterator<Item = PieceRef<'a>>, near: DVec3) -> Option<(f64, DVec3, PieceRef<'a>)> {
    let with_feet = pieces.map(|piece| {
        let foot = nearest_point(piece, near);
        (foot.distance(near), foot, piece)
    });
    with_feet.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The unit normal of a piece, to its front.
fn unit_normal(scene: &Scene, piece: PieceRef<'_>) -> DVec3 {
    let normal = match piece.plane() {
        SupportingPlane::Axis { axis, .. } => DVec3::AXES[axis as usize],
        SupportingPlane::Points(points) => {
            let [a, b, c] = points.map(|v| scene.vertex(v));
            let (p, q) = (b - a, c - a);
            // Scaled, so that neither the product nor the square of its length under- or overflows.
            let scale = |v: DVec3| v / v.abs().max_element();
            scale(p).cross(scale(q)).normalize_or_zero()
        }
    };
    if piece.facing() == Side::Front { normal } else { -normal }
}

/// The point of a convex piece that is nearest to `near`, rounded.
fn nearest_point(piece: PieceRef<'_>, near: DVec3) -> DVec3 {
    let corners: Vec<DVec3> = piece.points().collect();
    let normal = unit_normal(piece.scene(), piece);
    let mut foot = near - normal * normal.dot(near - corners[0]);
    if let SupportingPlane::Axis { axis, value } = piece.plane() {
        foot[axis as usize] = value;
    }
    let segments = || corners.iter().zip(corners.iter().cycle().skip(1));
    if segments().all(|(&a, &b)| normal.cross(b - a).dot(foot - a) >= 0.0) {
        return foot;
    }
    let on_segments = segments().map(|(&a, &b)| {
        let ab = b - a;
        a + ab * ((near - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0)
    });
    on_segments.min_by(|p, q| p.distance_squared(near).total_cmp(&q.distance_squared(near))).unwrap_or(foot)
}

/// The f64 point nearest to `foot`, which lies near the piece's plane, that is not behind it.
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
