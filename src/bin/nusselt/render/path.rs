//! Cameras, one or many.

use crate::failure::Failure;
use crate::place::camera;
use glam::{DVec3, UVec2};
use nusselt::contour::Frustum;
use nusselt::io::read_frames;
use std::path::Path;

/// Where a picture is taken.
pub(super) struct Camera {
    pub(super) eye: DVec3,
    pub(super) frustum: Frustum,
    /// The file and the line that it is from.
    origin: Option<String>,
}

impl Camera {
    pub(super) fn new(eye: DVec3, look_at: DVec3, fov: f64, up: Option<DVec3>, size: UVec2) -> Result<Self, Failure> {
        let aspect = f64::from(size.x) / f64::from(size.y);
        Ok(Self { eye, frustum: camera(eye, look_at, fov, Some(aspect), up)?, origin: None })
    }

    /// All cameras of a file.
    pub(super) fn read(path: &Path, up: Option<DVec3>, size: UVec2) -> Result<Vec<Self>, Failure> {
        let lines = read_frames(path).map_err(|error| Failure::Work(error.to_string()))?;
        let of_line = |line: nusselt::io::FrameLine| {
            let origin = format!("{}:{}", path.display(), line.line);
            match Self::new(line.eye, line.look_at, line.fov, up, size) {
                Ok(camera) => Ok(Self { origin: Some(origin), ..camera }),
                // Numbers of a file are not a command line.
                Err(Failure::Usage(what) | Failure::Work(what)) => Err(Failure::Work(format!("{origin}: {what}"))),
            }
        };
        lines.into_iter().map(of_line).collect()
    }

    /// Names the line in what went wrong with the work.
    pub(super) fn place(&self, failure: Failure) -> Failure {
        match (failure, &self.origin) {
            (Failure::Work(what), Some(origin)) => Failure::Work(format!("{origin}: {what}")),
            (failure, _) => failure,
        }
    }
}
