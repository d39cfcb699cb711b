//! Light that is reflected, by contour images.

use super::leaves::Leaves;
use super::shader::{Desk, Place};
use super::{Indirect, RenderError, Shader};
use crate::brdf::{Emission, reflected_radiance};
use crate::contour::{Cell, ContourImage, Domain, ViewOptions, Viewpoint};
use crate::integral::Receiver;
use crate::scene::{PolygonId, Side};
use glam::DVec3;
use std::f64::consts::PI;

impl Shader {
    /// All that arrives and is not from a light without extent or in a mirror.
    pub(super) fn by_contour(
        &self,
        desk: &mut Desk,
        place: &Place<'_>,
        leaves: &Leaves<'_>,
    ) -> Result<DVec3, RenderError> {
        let mut sum = DVec3::ZERO;
        let patch = self.indirect.as_ref().and_then(|indirect| {
            let patch = indirect.patch_at(place.polygon, place.eye())?;
            Some((indirect, patch))
        });
        let Some((indirect, patch)) = patch else {
            return self.direct(desk, place, leaves, true);
        };
        let interpolated =
            if leaves.matt.is_empty() { None } else { indirect.irradiance(patch, place.spot.side, place.eye()) };
        if let Some(irradiance) = interpolated {
            sum += leaves.weight * irradiance + self.direct(desk, place, leaves, false)?;
        }
        let is_gathered = interpolated.is_none() && !leaves.matt.is_empty();
        if is_gathered || !leaves.glossy.is_empty() {
            sum += self.gathered(desk, place, leaves, indirect, patch, is_gathered)?;
        }
        Ok(sum)
    }

    /// Light straight from lamps and from the sky: of matt parts, and of glossy ones if they are asked for.
    fn direct(
        &self,
        desk: &mut Desk,
        place: &Place<'_>,
        leaves: &Leaves<'_>,
        glossy: bool,
    ) -> Result<DVec3, RenderError> {
        let Some(domain) = &self.lamps else { return Ok(DVec3::ZERO) };
        let Desk { space, ring, .. } = desk;
        let image = self.order.view_in(space, &place.viewpoint, domain, &ViewOptions::default());
        let image = image.map_err(|source| place.view_error(source))?;
        let parts = Parts { shader: self, place, leaves, matt: true, glossy };
        parts.reflected(image, ring, |cell| self.emission(cell))
    }

    /// The same with interreflection: from all patches that are seen.
    fn gathered(
        &self,
        desk: &mut Desk,
        place: &Place<'_>,
        leaves: &Leaves<'_>,
        indirect: &Indirect,
        patch: PolygonId,
        matt: bool,
    ) -> Result<DVec3, RenderError> {
        let viewpoint = Viewpoint::on_surface(&indirect.patches, patch, place.spot.side, place.eye())?;
        let Desk { space, ring, .. } = desk;
        let image = indirect.order.view_in(space, &viewpoint, &Domain::Above, &ViewOptions::default());
        let image = image.map_err(|source| place.view_error(source))?;
        let parts = Parts { shader: self, place, leaves, matt, glossy: true };
        parts.reflected(image, ring, |cell| self.sent(indirect, cell))
    }

    /// What a cell of an image of patches sends: all that it is known to reflect, too.
    fn sent(&self, indirect: &Indirect, cell: Cell<'_>) -> Emission<'_> {
        let Some(patch) = cell.polygon() else { return self.emission(cell) };
        let mut radiance = indirect.radiance(patch, cell.side());
        if self.lighting.is_two_sided && cell.side() == Some(Side::Back) {
            radiance += crate::brdf::emitted_by_both_sides(cell);
        }
        radiance.into()
    }
}

/// Which parts of a BRDF reflect.
struct Parts<'a> {
    shader: &'a Shader,
    place: &'a Place<'a>,
    leaves: &'a Leaves<'a>,
    matt: bool,
    glossy: bool,
}

impl Parts<'_> {
    /// What they reflect of what an image shows.
    fn reflected<'e>(
        &self,
        image: &ContourImage,
        ring: &mut Vec<DVec3>,
        emission: impl Fn(Cell<'_>) -> Emission<'e>,
    ) -> Result<DVec3, RenderError> {
        let mut sum = DVec3::ZERO;
        let mut general = Vec::new();
        if self.matt && !self.leaves.matt.is_empty() {
            match irradiance(image, self.place.normal, ring, &emission) {
                Some(irradiance) => sum += self.leaves.weight * irradiance,
                // Of a sky that is not the same all over.
                None => general.extend(&self.leaves.matt),
            }
        }
        if self.glossy {
            general.extend(&self.leaves.glossy);
        }
        let viewer = self.place.towards.to_scene(self.place.towards.outgoing);
        for brdf in general {
            let options = self.shader.options.cubature;
            let part = reflected_radiance(image, brdf, None, viewer, &emission, options);
            sum += part.map_err(|source| self.place.reflect_error(source))?.value;
        }
        Ok(sum)
    }
}

/// The irradiance from what an image shows; `None` if something of it is not the same all over a cell.
fn irradiance<'e>(
    image: &ContourImage,
    normal: DVec3,
    ring: &mut Vec<DVec3>,
    emission: &impl Fn(Cell<'_>) -> Emission<'e>,
) -> Option<DVec3> {
    let receiver = Receiver::new(normal);
    let mut sum = DVec3::ZERO;
    for cell in image.cells() {
        let radiance = match emission(cell) {
            Emission::Constant(radiance) => radiance,
            Emission::Sky(sky) => sky.as_constant()?,
            Emission::Vertices(_) => return None,
        };
        if radiance != DVec3::ZERO {
            sum += radiance * (PI * receiver.factor_of(cell.boundary(), ring));
        }
    }
    Some(sum)
}
