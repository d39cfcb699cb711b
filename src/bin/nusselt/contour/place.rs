//! From arguments to a viewpoint and a domain.

use super::Contour;
use crate::failure::Failure;
use crate::place::hemisphere;
use nusselt::contour::{Domain, SurfaceError, Viewpoint};
use nusselt::scene::{PolygonId, Scene, Side};

impl Contour {
    /// Where to stand and what to look at.
    pub(super) fn stand(&self, scene: &Scene) -> Result<(Viewpoint, Domain), Failure> {
        if let Some((polygon, side)) = self.on {
            return Ok((self.on_polygon(scene, polygon, side)?, Domain::Above));
        }
        let Some(normal) = self.normal else {
            return Ok((Viewpoint::free(self.eye), Domain::Sphere));
        };
        hemisphere(scene, self.eye, normal, self.free).map_err(|error| Failure::about(&self.scene, &error))
    }

    fn on_polygon(&self, scene: &Scene, polygon: PolygonId, side: Side) -> Result<Viewpoint, Failure> {
        Viewpoint::on_surface(scene, polygon, side, self.eye).map_err(|error| match error {
            SurfaceError::UnknownPolygon { .. } => Failure::Usage(format!("--on: {error}")),
            _ => Failure::about(&self.scene, &error),
        })
    }
}
