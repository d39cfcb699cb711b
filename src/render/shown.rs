//! What cameras show of the patches of interreflection.

use super::leaves::{ASLANT, Leaves};
use super::{Indirect, RenderError, Shader};
use crate::brdf::Brdf;
use crate::contour::{Domain, Frustum, Viewpoint};
use glam::DVec3;

impl Shader {
    /// For each patch of interreflection whether a camera at `eye` sees its front, or it is beside one that it sees; true for all if some material is a mirror, in which any may be seen. What is gathered at corners is wanted there alone
    /// ([`Indirect::interpolated_on`]). The cost is that of a view.
    ///
    /// # Errors
    /// If the patches are those of a scene with more polygons, or if there is no view of the camera.
    pub fn shown(&self, indirect: &Indirect, eye: DVec3, camera: &Frustum) -> Result<Vec<bool>, RenderError> {
        indirect.check(self.scene())?;
        let count = indirect.patch_count();
        let has_mirror = |brdf: &dyn Brdf| !Leaves::new(brdf, ASLANT).mirrors.is_empty();
        if self.options.mirrors > 0 && self.brdfs.iter().any(|brdf| has_mirror(&**brdf)) {
            return Ok(vec![true; count]);
        }
        let image = self.order.view(&Viewpoint::free(eye), &Domain::Frustum(*camera));
        let image = image.map_err(|source| RenderError::View { from: "the camera", source })?;
        let mut is_shown = vec![false; count];
        indirect.patches_in(&image).for_each(|patch| is_shown[patch.index()] = true);
        Ok(is_shown)
    }
}

#[cfg(test)]
mod tests;
