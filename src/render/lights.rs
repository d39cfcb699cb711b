//! What hides lights without extent, and what is seen in one direction.

use super::shader::Place;
use super::{RenderError, Shader, Spot};
use crate::brdf::Light;
use crate::contour::{ContourImage, Domain, Region, SceneOrder, ViewOptions, ViewSpace, Viewpoint, Windows};
use crate::scene::Side;
use glam::DVec3;

/// What the light of each point light falls on; nothing for lights in a direction, of which there is no view.
pub(super) fn views(order: &SceneOrder, lights: &[Light]) -> Result<Vec<Option<ContourImage>>, RenderError> {
    let view = |light: &Light| match *light {
        Light::Point { position, .. } => order
            .view(&Viewpoint::free(position), &Domain::Sphere)
            .map(Some)
            .map_err(|source| RenderError::View { from: "a point light", source }),
        Light::Directional { .. } => Ok(None),
    };
    lights.iter().map(|light| light.check().map_err(RenderError::Light).and_then(|()| view(light))).collect()
}

impl Shader {
    /// What a point reflects of lights without extent; without a point light that is exactly there.
    pub(super) fn of_lights(&self, space: &mut ViewSpace, place: &Place<'_>) -> Result<DVec3, RenderError> {
        let mut sum = DVec3::ZERO;
        for (light, image) in self.lighting.lights.iter().zip(&self.light_views) {
            // All lights are fit for use, but not where they are themselves: there the irradiance of a point light is infinite, on a part of the surface without area.
            let Ok(unhidden) = light.unhidden(place.eye(), place.brdf, &place.towards) else { continue };
            if unhidden == DVec3::ZERO {
                continue;
            }
            let is_lit = match (light, image) {
                (Light::Point { .. }, Some(image)) => reaches(image, place),
                (Light::Directional { towards, .. }, _) => {
                    let unit = (*towards / towards.abs().max_element()).normalize_or_zero();
                    self.first_seen(space, place, unit)?.is_none()
                }
                (Light::Point { .. }, None) => unreachable!("every point light has a view"),
            };
            if is_lit {
                sum += unhidden;
            }
        }
        Ok(sum)
    }

    /// What is seen from a point in a unit direction above its surface, exactly as it is rounded: a point on a side of a piece; `None` for background. Of a direction between two
    /// cells it is one of them.
    pub(super) fn first_seen(
        &self,
        space: &mut ViewSpace,
        place: &Place<'_>,
        direction: DVec3,
    ) -> Result<Option<Spot>, RenderError> {
        // So far away that rounding its corners turns the window by much less than its width.
        let distance = self.order.scene().diagonal().max(place.eye().abs().max_element());
        let Some(window) = Windows::about(place.eye(), direction, distance) else { return Ok(None) };
        let domain = Domain::Window(window.above_surface());
        let image = self.order.view_in(space, &place.viewpoint, &domain, &ViewOptions::default());
        let image = image.map_err(|source| place.view_error(source))?;
        let seen = image.locate(direction).regions().into_iter().find_map(|region| match region {
            Region::Cell(id) => Some(image.cell(id)),
            Region::Outside => None,
        });
        let spot = seen
            .and_then(|cell| Some(Spot { piece: cell.piece()?, side: cell.side()?, near: cell.point_at(direction)? }));
        Ok(spot)
    }
}

/// True if nothing is between a light and a point of a surface, of which it is in front.
fn reaches(image: &ContourImage, place: &Place<'_>) -> bool {
    let Some(Region::Cell(cell)) = image.locate_point(place.eye()).regions().into_iter().next() else { return false };
    let cell = image.cell(cell);
    let Some(piece) = cell.piece() else { return true };
    // Rounding puts points of one triangle of a polygon on another one's side of their common edge.
    let is_own = cell.polygon() == Some(place.polygon) && cell.side().unwrap_or(Side::Front) == place.spot.side;
    is_own || !image.is_behind(piece, place.eye())
}
