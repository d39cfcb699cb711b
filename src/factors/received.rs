//! What a point of a patch receives from all patches that it sees.

use super::seen::{Columns, LookSpace, Looker};
use super::{Exchange, ExchangeError};
use glam::DVec3;
use std::sync::{Mutex, PoisonError};

/// Takes views from points of patches. Views are of whole polygons, and of joined ones, not of patches: what is seen of each is divided among its patches in
/// its plane.
pub(crate) struct Receivers<'a> {
    exchange: &'a Exchange,
    spaces: Mutex<Vec<LookSpace>>,
}

impl<'a> Receivers<'a> {
    pub(crate) fn new(exchange: &'a Exchange) -> Self {
        Self { exchange, spaces: Mutex::default() }
    }

    pub(crate) fn exchange(&self) -> &'a Exchange {
        self.exchange
    }

    /// The irradiance of the front of a patch at the point of its polygon nearest to `near`: the sum over all fronts that are seen of form factor times radiosity.
    /// `None` where nothing but backs is seen, and for patches without area.
    pub(crate) fn irradiance(
        &self,
        patch: usize,
        near: DVec3,
        radiosity: &[DVec3],
    ) -> Result<Option<DVec3>, ExchangeError> {
        let Exchange { facets, elements, trees, shut, options, .. } = self.exchange;
        let Some(&element) = elements.of_patch[patch].first() else { return Ok(None) };
        let near = facets.placement.local(near);
        // Of a patch in several planes, that of the part nearest to it.
        let distance = |element: &u32| elements.all[*element as usize].centre.distance_squared(near);
        let nearest = elements.of_patch[patch].iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let facet = elements.all[*nearest.unwrap_or(&element) as usize].facet;
        let free = || self.spaces.lock().unwrap_or_else(PoisonError::into_inner);
        let mut space = free().pop().unwrap_or_default();
        let columns = Columns { patches: elements.patches.len() as u32 };
        let (mut sum, mut sees_out) = (DVec3::ZERO, false);
        let looker = Looker { facets, elements, trees, shut, sides: options.sides };
        let looked = looker.look(
            &mut space,
            facet,
            near,
            |_| true,
            |column, share| {
                sees_out |= column != columns.backs() && share > 0.0;
                if let Some(&radiosity) = radiosity.get(column as usize) {
                    sum += radiosity * share;
                }
            },
        );
        free().push(space);
        looked.map(|()| sees_out.then_some(sum))
    }
}
