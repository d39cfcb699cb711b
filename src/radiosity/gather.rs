//! Radiosities of points.

use super::RadiosityError;
use crate::contour::{Domain, SceneOrder, ViewError, ViewOptions, ViewSpaces, Viewpoint};
use crate::parallel;
use crate::scene::{PolygonId, Side};
use glam::DVec3;

/// Computes radiosities of points on surfaces from those of the patches that they see: the irradiance is the sum over all visible cells of the form
/// factor times the radiosity, exactly for patches of constant radiosity.
pub struct Gather<'a> {
    order: SceneOrder,
    emission: &'a [DVec3],
    reflectance: &'a [DVec3],
    radiosity: &'a [DVec3],
    spaces: ViewSpaces,
}

impl<'a> Gather<'a> {
    /// For the scene of patches, polygon k being patch k, with what each emits, reflects, and its radiosity.
    ///
    /// # Panics
    /// If there are not as many of each as polygons.
    pub fn new(order: SceneOrder, emission: &'a [DVec3], reflectance: &'a [DVec3], radiosity: &'a [DVec3]) -> Self {
        let count = order.scene().polygon_count();
        assert!([emission, reflectance, radiosity].iter().all(|list| list.len() == count), "one for every polygon");
        Self { order, emission, reflectance, radiosity, spaces: ViewSpaces::new() }
    }

    /// What a patch emits.
    pub(super) fn emission(&self, patch: PolygonId) -> DVec3 {
        self.emission[patch.index()]
    }

    /// The radiosity of the front of a polygon at the point of it that is nearest to a given one.
    ///
    /// A point on the boundary does not see what stands on it there; take one a little inside.
    ///
    /// # Errors
    /// If there is no view.
    pub fn at(&self, polygon: PolygonId, near: DVec3) -> Result<DVec3, RadiosityError> {
        Ok(self.uncovered(polygon, near)?.unwrap_or(self.emission[polygon.index()]))
    }

    /// The same, but `None` where nothing but backs is seen: below what stands on a surface.
    fn uncovered(&self, polygon: PolygonId, near: DVec3) -> Result<Option<DVec3>, RadiosityError> {
        let [emission, reflectance] = [self.emission, self.reflectance].map(|list| list[polygon.index()]);
        if reflectance == DVec3::ZERO {
            return Ok(Some(emission));
        }
        let irradiance = self.irradiance(polygon, near).map_err(|source| RadiosityError::View { polygon, source })?;
        Ok(irradiance.map(|irradiance| emission + reflectance * irradiance))
    }

    fn irradiance(&self, polygon: PolygonId, near: DVec3) -> Result<Option<DVec3>, ViewError> {
        let Ok(viewpoint) = Viewpoint::on_surface(self.order.scene(), polygon, Side::Front, near) else {
            // It has no area.
            return Ok(Some(DVec3::ZERO));
        };
        self.spaces.with(|space| {
            let image = self.order.view_in(space, &viewpoint, &Domain::Above, &ViewOptions::default())?;
            if image.cells().all(|cell| cell.side() == Some(Side::Back)) {
                return Ok(None);
            }
            let factors = image.form_factors();
            let seen = factors.iter().flat_map(|factors| &factors.polygons);
            Ok(Some(seen.map(|seen| self.radiosity[seen.polygon.index()] * seen.front).sum()))
        })
    }

    /// [`Gather::at`] for many points, in their order, by all threads; `None` where nothing but backs is seen. `done` is told of each.
    pub(super) fn uncovered_at_all(
        &self,
        points: Vec<(PolygonId, DVec3)>,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<Option<DVec3>>, RadiosityError> {
        let found = parallel::map(points, |(polygon, near)| {
            let found = self.uncovered(polygon, near);
            done(1);
            found
        });
        found.into_iter().collect()
    }

    /// [`Gather::at`] for many points, in their order, by all threads.
    ///
    /// # Errors
    /// The first one that there is no view from.
    pub fn at_all(&self, points: Vec<(PolygonId, DVec3)>) -> Result<Vec<DVec3>, RadiosityError> {
        parallel::map(points, |(polygon, near)| self.at(polygon, near)).into_iter().collect()
    }
}
