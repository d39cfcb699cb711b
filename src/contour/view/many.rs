//! Many views, shared by threads.

use super::super::domain::Domain;
use super::super::image::ContourImage;
use super::super::order::SceneOrder;
use super::super::viewpoint::Viewpoint;
use super::{ViewError, ViewOptions, ViewSpace};
use crate::parallel;
use std::sync::{Mutex, PoisonError};

/// Which of many views there is none of, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("view {index}: {source}")]
pub struct ViewsError {
    /// The place in the list, from 0; the first one that fails.
    pub index: usize,
    /// Why.
    pub source: ViewError,
}

/// Memory for views that threads share: each takes a [`ViewSpace`] and puts it back. There are as many as threads have needed at a time.
#[derive(Debug, Default)]
pub struct ViewSpaces(Mutex<Vec<ViewSpace>>);

impl ViewSpaces {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Does something with a space that nothing else uses meanwhile.
    pub fn with<T>(&self, f: impl FnOnce(&mut ViewSpace) -> T) -> T {
        // A space is only ever taken or put back whole.
        let free = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = free().pop();
        let mut space = taken.unwrap_or_default();
        let result = f(&mut space);
        free().push(space);
        result
    }
}

impl SceneOrder {
    /// Takes a view from every viewpoint and gives, in their order, what `of_image` makes of each, which is passed the place in the
    /// list too. With the feature `parallel` the threads of the current `rayon` pool share the work; what comes out does not depend on
    /// how many there are.
    ///
    /// At any time there are as many images as threads, each in memory that the next view of that thread takes over
    /// ([`ViewSpace`]).
    ///
    /// ```
    /// use nusselt::contour::{Domain, SceneOrder, ViewOptions, Viewpoint};
    /// use nusselt::samples::{Kind, generate};
    ///
    /// let room = generate(Kind::Room, 200, 1)?;
    /// let order = SceneOrder::new(&room.to_builder().build()?);
    /// let up = Domain::Hemisphere(glam::DVec3::Z);
    /// let eyes: Vec<_> = room.free_points(10, 1).into_iter().map(|p| (Viewpoint::free(p.into()), up.clone())).collect();
    /// let sums = order.views(&eyes, &ViewOptions::default(), |_, image| image.form_factors().map(|f| f.total()))?;
    /// assert!(sums.iter().flatten().all(|sum| (sum - 1.0).abs() < 1e-14) && sums.len() == 10);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The first viewpoint in the list of which there is no view, as [`SceneOrder::view_with`] says.
    pub fn views<T: Send>(
        &self,
        viewpoints: &[(Viewpoint, Domain)],
        options: &ViewOptions,
        of_image: impl Fn(usize, &ContourImage) -> T + Sync + Send,
    ) -> Result<Vec<T>, ViewsError> {
        let spaces = ViewSpaces::new();
        let view = |index: usize| {
            let (viewpoint, domain) = &viewpoints[index];
            let result = spaces.with(|space| {
                let image = self.view_in(space, viewpoint, domain, options)?;
                Ok(of_image(index, image))
            });
            result.map_err(|source| ViewsError { index, source })
        };
        parallel::map((0..viewpoints.len()).collect(), view).into_iter().collect()
    }
}
