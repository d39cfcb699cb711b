//! What a crate built on nusselt might compute: how much of the sky a place sees.

use glam::DVec3;
use nusselt::bsp::SceneBsp;
use nusselt::contour::{Domain, ViewError, Viewpoint};

/// The sky view factor of a point on horizontal ground: the form factor of the background above it, 1 under an open sky
/// and 0 indoors.
///
/// # Errors
/// If the point is not finite.
pub fn sky_view_factor(bsp: &SceneBsp, point: DVec3) -> Result<f64, ViewError> {
    let image = bsp.view(&Viewpoint::free(point), &Domain::Hemisphere(DVec3::Z))?;
    Ok(image.form_factors().map_or(0.0, |factors| factors.background))
}
