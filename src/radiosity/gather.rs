//! Radiosities of points.

use super::RadiosityError;
use crate::factors::{Exchange, Receivers};
use crate::parallel;
use crate::scene::PolygonId;
use glam::DVec3;

/// Computes radiosities of points on surfaces from those of the patches that they see: the irradiance is the sum over all visible cells of the form
/// factor times the radiosity, exactly for patches of constant radiosity.
pub struct Gather<'a> {
    receivers: Receivers<'a>,
    emission: &'a [DVec3],
    reflectance: &'a [DVec3],
    radiosity: &'a [DVec3],
}

impl<'a> Gather<'a> {
    /// For patches, with what each emits, reflects, and its radiosity.
    ///
    /// # Panics
    /// If there are not as many of each as patches.
    pub fn new(
        exchange: &'a Exchange,
        emission: &'a [DVec3],
        reflectance: &'a [DVec3],
        radiosity: &'a [DVec3],
    ) -> Self {
        let count = exchange.patches().len();
        assert!([emission, reflectance, radiosity].iter().all(|list| list.len() == count), "one for every patch");
        Self { receivers: Receivers::new(exchange), emission, reflectance, radiosity }
    }

    /// The patches.
    pub(super) fn exchange(&self) -> &'a Exchange {
        self.receivers.exchange()
    }

    /// What a patch emits.
    pub(super) fn emission(&self, patch: PolygonId) -> DVec3 {
        self.emission[patch.index()]
    }

    /// What of the radiosity of a patch is reflected, and whether it reflects at all.
    pub(super) fn reflected(&self, patch: usize) -> Option<DVec3> {
        let reflects = self.reflectance[patch] != DVec3::ZERO;
        reflects.then(|| self.radiosity[patch] - self.emission[patch])
    }

    /// The radiosity of the front of a patch at the point of its polygon that is nearest to a given one.
    ///
    /// A point on the boundary does not see what stands on it there; take one a little inside.
    ///
    /// # Errors
    /// If there is no view.
    pub fn at(&self, patch: PolygonId, near: DVec3) -> Result<DVec3, RadiosityError> {
        Ok(self.uncovered(patch, near)?.unwrap_or(self.emission[patch.index()]))
    }

    /// The same, but `None` where nothing but backs is seen: below what stands on a surface.
    fn uncovered(&self, patch: PolygonId, near: DVec3) -> Result<Option<DVec3>, RadiosityError> {
        let [emission, reflectance] = [self.emission, self.reflectance].map(|list| list[patch.index()]);
        if reflectance == DVec3::ZERO {
            return Ok(Some(emission));
        }
        let irradiance = self.receivers.irradiance(patch.index(), near, self.radiosity)?;
        Ok(irradiance.map(|irradiance| emission + reflectance * irradiance))
    }

    /// [`Gather::at`] for many points, in their order, by all threads; `None` where nothing but backs is seen. `done` is told of each.
    pub(super) fn uncovered_at_all(
        &self,
        points: Vec<(PolygonId, DVec3)>,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<Option<DVec3>>, RadiosityError> {
        let found = parallel::map(points, |(patch, near)| {
            let found = self.uncovered(patch, near);
            done(1);
            found
        });
        found.into_iter().collect()
    }
}
