//! Where several commands stand.

use glam::DVec3;
use nusselt::contour::{Domain, SurfaceError, Viewpoint};
use nusselt::scene::Scene;

/// The hemisphere about a normal: above the polygon that the eye is meant to be on, unless it is to be `free`.
pub(crate) fn hemisphere(
    scene: &Scene,
    eye: DVec3,
    normal: DVec3,
    free: bool,
) -> Result<(Viewpoint, Domain), SurfaceError> {
    let surface = if free { None } else { Viewpoint::surface_at(scene, eye, normal) };
    match surface {
        Some((piece, side)) => Ok((Viewpoint::on_piece(scene, piece, side, eye)?, Domain::Above)),
        None => Ok((Viewpoint::free(eye), Domain::Hemisphere(normal))),
    }
}
