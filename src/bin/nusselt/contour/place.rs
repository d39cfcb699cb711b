//! From arguments to a viewpoint and a domain.

use super::Contour;
use crate::failure::Failure;
use crate::place::{camera, hemisphere, on_polygon};
use nusselt::contour::{Domain, Frustum, Viewpoint, Windows};
use nusselt::scene::{PolygonId, Scene};

impl Contour {
    /// What the camera sees, if there is one.
    pub(super) fn camera(&self) -> Result<Option<Frustum>, Failure> {
        let usage = |message: String| Err(Failure::Usage(message));
        let (Some(look_at), Some(fov)) = (self.look_at, self.fov) else {
            let given =
                [("--fov", self.fov.is_some()), ("--aspect", self.aspect.is_some()), ("--up", self.up.is_some())];
            return match given.into_iter().find(|(_, is_given)| *is_given) {
                Some((name, _)) => usage(format!("{name} is for a camera; give --look-at too")),
                None => Ok(None),
            };
        };
        camera(self.eye, look_at, fov, self.aspect, self.up).map(Some)
    }

    /// Where to stand and what to look at.
    pub(super) fn stand(&self, scene: &Scene, camera: Option<Frustum>) -> Result<(Viewpoint, Domain), Failure> {
        let (viewpoint, domain) = self.stand_without_windows(scene, camera)?;
        if self.window.is_empty() {
            return Ok((viewpoint, domain));
        }
        let count = scene.polygon_count();
        if let Some(k) = self.window.iter().find(|&&k| k as usize >= count) {
            let message = format!("--window: there is no polygon {k}: the scene has {count}, numbered from 0");
            return Err(Failure::Usage(message));
        }
        let windows = Windows::polygons(self.window.iter().copied().map(PolygonId));
        let windows = match domain {
            Domain::Hemisphere(normal) => windows.within_hemisphere(normal),
            Domain::Above => windows.above_surface(),
            _ => windows,
        };
        Ok((viewpoint, Domain::Window(windows)))
    }

    fn stand_without_windows(&self, scene: &Scene, camera: Option<Frustum>) -> Result<(Viewpoint, Domain), Failure> {
        if let Some((polygon, side)) = self.on {
            return Ok((on_polygon(&self.scene, scene, polygon, side, self.eye)?, Domain::Above));
        }
        let Some(normal) = self.normal else {
            return Ok((Viewpoint::free(self.eye), camera.map_or(Domain::Sphere, Domain::Frustum)));
        };
        hemisphere(scene, self.eye, normal, self.free).map_err(|error| Failure::about(&self.scene, &error))
    }
}
