//! Cutting out of the sphere what a view looks at: its domain.

use super::super::domain::Domain;
use super::super::frustum::Frustum;
use super::super::polygon::{HalfSphere, PolygonArc};
use super::super::viewpoint::Viewpoint;
use super::super::windows::{Horizon, Pane, Windows};
use super::space::Buffers;
use super::{Sight, ViewError};
use crate::bsp::{FragmentSide, Skeleton, whole_piece};
use crate::exact::{BitRange, SeenBox, Sign, orient3d};
use crate::scene::{PieceRef, Scene};
use glam::DVec3;

/// The range of the coordinates of a view but for those of its eye.
pub(super) fn range(skeleton: &Skeleton, domain: &Domain) -> BitRange {
    let Domain::Window(windows) = domain else { return skeleton.bits };
    let rings = windows.panes().iter().filter_map(|pane| match pane {
        Pane::Ring(ring) => Some(ring.as_slice()),
        Pane::Polygon(_) => None,
    });
    rings.fold(skeleton.bits, |range, ring| range.union(BitRange::of(ring.iter().copied())))
}

impl Sight<'_> {
    /// Leaves what is not in the domain outside. Gives the normal of a hemisphere that is all of it.
    pub(super) fn cut_out(
        &mut self,
        scene: &Scene,
        viewpoint: &Viewpoint,
        domain: &Domain,
        max_cells: usize,
    ) -> Result<Option<DVec3>, ViewError> {
        match domain {
            Domain::Sphere => Ok(None),
            Domain::Hemisphere(normal) => self.cut_at_horizon(scene, viewpoint, Horizon::Normal(*normal)).map(Some),
            Domain::Above => self.cut_at_horizon(scene, viewpoint, Horizon::Surface).map(Some),
            Domain::Frustum(frustum) => {
                self.claim_frustum(frustum);
                self.contour.keep_claimed();
                Ok(None)
            }
            Domain::Window(windows) => {
                self.claim_windows(scene, windows, max_cells)?;
                self.contour.keep_claimed();
                if let Some(horizon) = windows.horizon() {
                    self.cut_at_horizon(scene, viewpoint, horizon)?;
                }
                Ok(None)
            }
        }
    }

    /// Leaves what is below a horizon outside, and gives the normal above it.
    fn cut_at_horizon(&mut self, scene: &Scene, viewpoint: &Viewpoint, horizon: Horizon) -> Result<DVec3, ViewError> {
        let Self { skeleton, contour, buffers: Buffers { work, .. }, .. } = self;
        let cache = &mut work.knife.cache;
        let half = match horizon {
            Horizon::Normal(normal) => {
                if !normal.is_finite() || normal == DVec3::ZERO {
                    return Err(ViewError::BadNormal);
                }
                HalfSphere::new(contour.directions.push_given(skeleton, normal, cache), Sign::Positive)
            }
            Horizon::Surface => {
                let (piece, side) = viewpoint.surface_piece().ok_or(ViewError::NotOnSurface)?;
                let piece = scene.piece(piece);
                let circle = contour.directions.push_parallel(skeleton, piece.plane_id(), cache);
                let up = if piece.facing() == side { Sign::Positive } else { Sign::Negative };
                HalfSphere::new(circle, up)
            }
        };
        contour.clip(skeleton, half, work);
        let normal = contour.directions.normal(half.circle()).v;
        Ok(if half.inside().is_positive() { normal } else { -normal })
    }

    fn claim_frustum(&mut self, frustum: &Frustum) {
        let Self { skeleton, contour, buffers: Buffers { work, polygon, .. }, eye, .. } = self;
        let (directions, cache) = (&mut contour.directions, &mut work.knife.cache);
        let circles = frustum.normals().map(|normal| directions.push_given(skeleton, normal, cache));
        polygon.clear();
        polygon.extend((0..4).map(|k| {
            let from = directions.push_crossing(skeleton, [circles[(k + 3) % 4], circles[k]], false, cache);
            PolygonArc { from, along: HalfSphere::new(circles[k], Sign::Positive) }
        }));
        // A box around the eye itself is seen everywhere.
        contour.claim(skeleton, polygon, &SeenBox::new(*eye, *eye, *eye), work);
    }

    fn claim_windows(&mut self, scene: &Scene, windows: &Windows, max_cells: usize) -> Result<(), ViewError> {
        for pane in windows.panes() {
            self.check_size(max_cells)?;
            match pane {
                Pane::Polygon(polygon) => {
                    if polygon.index() >= scene.polygon_count() {
                        return Err(ViewError::UnknownWindow { polygon: *polygon, count: scene.polygon_count() });
                    }
                    for piece in scene.polygon(*polygon).pieces() {
                        self.claim_piece(piece);
                    }
                }
                Pane::Ring(ring) => self.claim_ring(ring),
            }
        }
        Ok(())
    }

    /// A piece of the scene: its sides and corners are those that it is seen with.
    fn claim_piece(&mut self, piece: PieceRef<'_>) {
        let Some(shown) = self.skeleton.shown_side(piece, self.eye) else { return };
        let sides: Vec<FragmentSide> = whole_piece(piece.scene(), piece.id()).collect();
        self.look_at(piece, &sides, shown);
        self.claim_polygon(piece.points());
    }

    fn claim_ring(&mut self, ring: &[DVec3]) {
        let Self { skeleton, contour, buffers: Buffers { work, polygon, .. }, eye, .. } = self;
        let (directions, cache) = (&mut contour.directions, &mut work.knife.cache);
        // Counter-clockwise around the side that is shown is clockwise on the sphere, seen from outside of it.
        let height = orient3d(ring[0], ring[1], ring[2], *eye);
        if height.is_zero() {
            return;
        }
        let len = ring.len();
        let corners: Vec<_> = ring.iter().map(|&point| directions.push_towards(skeleton, point, cache)).collect();
        polygon.clear();
        polygon.extend((0..len).map(|k| {
            // The side from corner `k` to the next one, in the ring's order.
            let k = if height.is_positive() { len - 1 - k } else { k };
            let next = (k + 1) % len;
            let circle = directions.push_points(skeleton, [ring[k], ring[next]], cache);
            let from = corners[if height.is_positive() { next } else { k }];
            PolygonArc { from, along: HalfSphere::new(circle, -height) }
        }));
        self.claim_polygon(ring.iter().copied());
    }

    /// Claims the inside of `polygon`, which has these corners in space.
    fn claim_polygon(&mut self, corners: impl Iterator<Item = DVec3>) {
        let (low, high) =
            corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let seen = SeenBox::new(self.eye, low, high);
        let Self { skeleton, contour, buffers: Buffers { work, polygon, .. }, .. } = self;
        contour.claim(skeleton, polygon, &seen, work);
    }
}
