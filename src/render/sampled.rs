//! Light that is reflected, by the pixels of a hemicube or by random rays: what contour images are compared with.

use super::leaves::Leaves;
use super::shader::{Desk, Place, Shading};
use super::{RenderError, Shader};
use crate::contour::{SceneOrder, Viewpoint};
use crate::hemicube::Hemicube;
use crate::scene::{PieceId, Side};
use glam::DVec3;
use std::f64::consts::PI;

impl Shader {
    /// All that arrives and is not from a light without extent or in a mirror.
    pub(super) fn by_samples(
        &self,
        desk: &mut Desk,
        place: &Place<'_>,
        leaves: &Leaves<'_>,
        seed: u64,
    ) -> Result<DVec3, RenderError> {
        // From the patch that the point is on, so that it does not see itself.
        let on_patch = self.indirect.as_ref().and_then(|indirect| indirect.patch_at(place.polygon, place.eye()));
        let viewpoint = match (&self.indirect, on_patch) {
            (Some(indirect), Some(patch)) => {
                Viewpoint::on_surface(&indirect.patches, patch, place.spot.side, place.eye())?
            }
            (Some(_), None) => Viewpoint::free(place.eye()),
            (None, _) => place.viewpoint,
        };
        let order = self.indirect.as_ref().map_or(&self.order, |indirect| &indirect.order);
        let mut sum = Sum { shader: self, place, leaves, order, eye: viewpoint.eye(), last: None, value: DVec3::ZERO };
        match self.options.shading {
            Shading::Contour => {}
            Shading::Hemicube { resolution } => {
                let hemicube = match &mut desk.hemicube {
                    Some(hemicube) => hemicube,
                    none => none.insert(Hemicube::new(order.scene(), resolution)?),
                };
                let view = hemicube.view(&viewpoint, place.normal)?;
                view.for_each_pixel(|pixel| sum.add(pixel.piece, pixel.factor, || pixel.direction()));
            }
            #[cfg(feature = "rays")]
            Shading::Rays { rays } => {
                let factor = 1.0 / f64::from(rays);
                if let Some(tracer) = &self.rays {
                    tracer.for_each_ray(&viewpoint, place.normal, rays, seed, |direction, piece| {
                        sum.add(piece, factor, || direction);
                    })?;
                }
            }
        }
        #[cfg(not(feature = "rays"))]
        let _ = seed;
        Ok(sum.value)
    }
}

/// What is reflected, as it is summed up.
struct Sum<'a> {
    shader: &'a Shader,
    place: &'a Place<'a>,
    leaves: &'a Leaves<'a>,
    order: &'a SceneOrder,
    eye: DVec3,
    /// The last piece that was seen, and what it sends.
    last: Option<(PieceId, DVec3)>,
    value: DVec3,
}

impl Sum<'_> {
    /// Adds what comes from a direction, with the form factor of what it stands for.
    fn add(&mut self, piece: Option<PieceId>, factor: f64, direction: impl Fn() -> DVec3) {
        let radiance = match (piece, self.last) {
            (None, _) if self.shader.lighting.sky.is_none() => return,
            (None, _) => self.shader.background(direction()),
            (Some(piece), Some((last, radiance))) if last == piece => radiance,
            (Some(piece), _) => {
                let radiance = self.sent_by(piece);
                self.last = Some((piece, radiance));
                radiance
            }
        };
        if radiance == DVec3::ZERO {
            return;
        }
        let mut reflectance = self.leaves.weight;
        if !self.leaves.glossy.is_empty() {
            let incoming = self.place.towards.to_local(direction());
            for brdf in &self.leaves.glossy {
                reflectance += brdf.eval(incoming, self.place.towards.outgoing);
            }
        }
        self.value += reflectance * radiance * (PI * factor);
    }

    /// The radiance that comes from a piece.
    fn sent_by(&self, piece: PieceId) -> DVec3 {
        let piece = self.order.scene().piece(piece);
        let side = self.order.skeleton().shown_side(piece, self.eye);
        let emitted = DVec3::from(self.order.scene().polygon(piece.polygon()).material().emission);
        let is_emitting = side == Some(Side::Front) || self.shader.lighting.is_two_sided;
        match (&self.shader.indirect, is_emitting) {
            (Some(indirect), _) if side == Some(Side::Front) => indirect.radiance(piece.polygon(), side),
            (_, true) => emitted,
            (_, false) => DVec3::ZERO,
        }
    }
}
