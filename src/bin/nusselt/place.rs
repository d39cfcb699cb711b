//! Where several commands stand.

use crate::failure::Failure;
use glam::DVec3;
use nusselt::contour::{Domain, Frustum, FrustumError, SurfaceError, SurfaceIndex, Viewpoint};
use nusselt::io::{PointLine, PointReader, open_points};
use nusselt::scene::{PieceId, PolygonId, Scene, Side};
use std::fmt::Display;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What a camera sees that looks from one point at another, with a vertical field of view in degrees.
pub(crate) fn camera(
    eye: DVec3,
    look_at: DVec3,
    fov: f64,
    aspect: Option<f64>,
    up: Option<DVec3>,
) -> Result<Frustum, Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let aspect = aspect.unwrap_or(1.0);
    // Halves, so that no difference overflows.
    let towards = look_at * 0.5 - eye * 0.5;
    let towards = if towards == DVec3::ZERO { look_at - eye } else { towards };
    if towards == DVec3::ZERO {
        return usage("--look-at is --eye; look at another point".to_owned());
    }
    let made = match up {
        Some(up) => Frustum::new(towards, up, fov, aspect),
        None => match Frustum::new(towards, DVec3::Z, fov, aspect) {
            Err(FrustumError::UpAlong) => Frustum::new(towards, DVec3::Y, fov, aspect),
            made => made,
        },
    };
    match made {
        Ok(frustum) => Ok(frustum),
        Err(error @ FrustumError::UpAlong) => usage(format!("--up: {error}")),
        Err(error) => usage(format!("--look-at, --fov and --aspect: {error}")),
    }
}

/// The hemisphere about a normal: above the polygon that the eye is meant to be on, unless it is to be `free`.
pub(crate) fn hemisphere(
    scene: &Scene,
    eye: DVec3,
    normal: DVec3,
    free: bool,
) -> Result<(Viewpoint, Domain), SurfaceError> {
    let surface = if free { None } else { Viewpoint::surface_at(scene, eye, normal) };
    above(scene, eye, normal, surface)
}

/// On a polygon of the scene of a file, where it is nearest to the eye.
pub(crate) fn on_polygon(
    file: &Path,
    scene: &Scene,
    polygon: PolygonId,
    side: Side,
    eye: DVec3,
) -> Result<Viewpoint, Failure> {
    Viewpoint::on_surface(scene, polygon, side, eye).map_err(|error| match error {
        SurfaceError::UnknownPolygon { .. } => Failure::Usage(format!("--on: {error}")),
        _ => Failure::about(file, &error),
    })
}

/// On the polygon that the point names, on the side that its normal shows; otherwise where it is meant to be: on one of the surfaces,
/// unless there are none given.
pub(crate) fn stand(
    scene: &Scene,
    surfaces: Option<&SurfaceIndex>,
    point: &PointLine,
) -> Result<(Viewpoint, Domain), SurfaceError> {
    let PointLine { point: eye, normal, polygon, .. } = *point;
    match polygon {
        Some(polygon) => Ok((Viewpoint::on_surface_towards(scene, polygon, normal, eye)?, Domain::Above)),
        None => above(scene, eye, normal, surfaces.and_then(|surfaces| surfaces.surface_at(eye, normal))),
    }
}

fn above(
    scene: &Scene,
    eye: DVec3,
    normal: DVec3,
    surface: Option<(PieceId, Side)>,
) -> Result<(Viewpoint, Domain), SurfaceError> {
    match surface {
        Some((piece, side)) => Ok((Viewpoint::on_piece(scene, piece, side, eye)?, Domain::Above)),
        None => Ok((Viewpoint::free(eye), Domain::Hemisphere(normal))),
    }
}

/// Points to look from: a file, or `-` for standard input.
#[derive(Clone, Copy)]
pub(crate) struct PointsOf<'a> {
    path: &'a Path,
}

impl<'a> PointsOf<'a> {
    pub(crate) fn new(path: &'a Path) -> Self {
        Self { path }
    }

    fn is_stdin(self) -> bool {
        self.path == Path::new("-")
    }

    /// What messages call it.
    pub(crate) fn name(self) -> String {
        if self.is_stdin() { "standard input".to_owned() } else { self.path.display().to_string() }
    }

    /// The files that it is.
    pub(crate) fn files(self) -> Vec<PathBuf> {
        if self.is_stdin() { Vec::new() } else { vec![self.path.to_owned()] }
    }

    /// Starts reading. Who writes to standard input may wait for an answer before he goes on.
    pub(crate) fn open(self) -> Result<PointReader<Box<dyn Read>>, Failure> {
        if self.is_stdin() {
            return Ok(PointReader::live(Box::new(std::io::stdin().lock()), self.name()));
        }
        let file = open_points(self.path).map_err(|error| Failure::Work(error.to_string()))?.into_inner();
        Ok(PointReader::new(Box::new(file), self.name()))
    }

    /// Reads a file once to see that it can be used to its end; how many points there are. Of standard input nothing is known before.
    pub(crate) fn check(self, scene: &Scene) -> Result<Option<usize>, Failure> {
        if self.is_stdin() {
            return Ok(None);
        }
        let mut reader = self.open()?;
        let mut points = Vec::new();
        let mut count = 0;
        while reader.next(usize::MAX, &mut points).map_err(|error| Failure::Work(error.to_string()))? {
            count += points.len();
            for point in points.iter().filter(|point| point.polygon.is_some()) {
                stand(scene, None, point).map_err(|error| self.failed_at(point, &error))?;
            }
        }
        Ok(Some(count))
    }

    /// What is wrong with a point.
    pub(crate) fn failed_at(self, point: &PointLine, error: &impl Display) -> Failure {
        Failure::Work(format!("{}:{}: {error}", self.name(), point.line))
    }
}
