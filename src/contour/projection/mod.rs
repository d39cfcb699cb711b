//! Flat pictures of the sphere of directions.
//!
//! The cells of a [`ContourImage`] are exact; what is drawn of them is floating point, to a stated
//! tolerance. Every picture shows the view as seen by an eye at the viewpoint: right is right, up is
//! up, nothing is mirrored. Since a cell's boundary runs counter-clockwise seen from *outside* of the
//! sphere, its picture runs clockwise (with y up).

mod corners;
mod crossings;
mod flatten;
mod frame;
mod regions;
#[cfg(test)]
mod tests;

pub use frame::ViewFrame;
pub use regions::FlatRegion;

use super::{ContourImage, Domain, Frustum};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// A way to draw directions in a plane. `right`, `up` and `towards` are those of a [`ViewFrame`],
/// `theta` is the angle between a direction and `towards`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Projection {
    /// Nusselt's analog: hemispheres only, straight down onto the tangent plane, the horizon on the unit
    /// circle. Areas are form factors times pi.
    #[default]
    Nusselt,
    /// The image plane of a camera, at distance 1: great circles are straight lines. Shows the square
    /// window with all directions up to 75 degrees to the right, left, top and bottom.
    Gnomonic,
    /// From the opposite pole onto the tangent plane, the radius is tan(theta / 2): angles are kept,
    /// great circles are circles, the horizon is the unit circle. Of the whole sphere it shows the
    /// square window that reaches 135 degrees to the right, left, top and bottom.
    Stereographic,
    /// A panorama: longitude (to the right) and latitude, both in radians. Upright: see
    /// [`ViewFrame::panorama`].
    Equirectangular,
}

impl Projection {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Nusselt, Self::Gnomonic, Self::Stereographic, Self::Equirectangular];

    /// Its name in small letters, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nusselt => "nusselt",
            Self::Gnomonic => "gnomonic",
            Self::Stereographic => "stereographic",
            Self::Equirectangular => "equirectangular",
        }
    }
}

/// Why a view cannot be drawn in a projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectionError {
    /// Nusselt's projection lays two directions on every point unless one half of the sphere is left out.
    #[error(
        "the nusselt projection shows a hemisphere; for the whole sphere use equirectangular, stereographic or gnomonic"
    )]
    NotAHemisphere,
}

/// The half angle of the gnomonic window.
const GNOMONIC_REACH: f64 = 75.0 / 180.0 * PI;
/// How far from `towards` the stereographic window of a sphere reaches.
const STEREOGRAPHIC_REACH: f64 = 135.0 / 180.0 * PI;

/// A rectangle of the picture plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Its lower left corner.
    pub low: DVec2,
    /// Its upper right corner.
    pub high: DVec2,
}

impl Window {
    /// Width and height.
    pub fn size(self) -> DVec2 {
        self.high - self.low
    }

    fn square(half: f64) -> Self {
        Self { low: DVec2::splat(-half), high: DVec2::splat(half) }
    }
}

/// Draws cells and arcs of one view in the plane.
///
/// ```
/// use glam::DVec3;
/// use nusselt::contour::{Projection, Projector, ViewFrame};
///
/// // The octant in front, to the right and above: a quarter of Nusselt's disc.
/// let frame = ViewFrame::new(DVec3::Y, DVec3::Z);
/// let projector = Projector::new(Projection::Nusselt, frame, Some(DVec3::Y))?;
/// let paths = projector.cell(&[DVec3::X, DVec3::Y, DVec3::Z], 1e-4);
/// let area: f64 = paths[0].iter().zip(paths[0].iter().cycle().skip(1)).map(|(p, q)| q.perp_dot(*p) / 2.0).sum();
/// assert!((area - std::f64::consts::FRAC_PI_4).abs() < 1e-3);
/// # Ok::<(), nusselt::contour::ProjectionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Projector {
    projection: Projection,
    frame: ViewFrame,
    window: Window,
    /// Planes through the eye (normals in the frame's axes): cells are cut to their positive sides.
    clips: Vec<DVec3>,
    /// Planes through the eye at which cells and arcs are cut into parts.
    seams: Vec<DVec3>,
}

impl Projector {
    /// For directions with `horizon . d >= 0`, or for the whole sphere.
    ///
    /// # Errors
    /// For [`Projection::Nusselt`] of the whole sphere.
    pub fn new(projection: Projection, frame: ViewFrame, horizon: Option<DVec3>) -> Result<Self, ProjectionError> {
        let whole = horizon.is_none();
        let (mut clips, mut seams) = (Vec::new(), Vec::new());
        let window = match projection {
            Projection::Nusselt if whole => return Err(ProjectionError::NotAHemisphere),
            Projection::Nusselt => Window::square(1.0),
            Projection::Gnomonic => {
                let reach = GNOMONIC_REACH.tan();
                clips.extend([DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y].map(|n| n + DVec3::Z * reach));
                Window::square(reach)
            }
            Projection::Stereographic => {
                seams.extend([DVec3::X, DVec3::Y, DVec3::Z]);
                Window::square(if whole { (STEREOGRAPHIC_REACH / 2.0).tan() } else { 1.0 })
            }
            Projection::Equirectangular => {
                seams.extend([DVec3::X, DVec3::Z]);
                panorama_window(horizon.map(|normal| frame.components(normal)))
            }
        };
        Ok(Self { projection, frame, window, clips, seams })
    }

    /// For a contour image, in the frame that suits: for a camera's view [`Frustum::frame`], in a gnomonic picture with the borders of the view;
    /// [`ViewFrame::new`] about the normal of a hemisphere or about +y, [`ViewFrame::panorama`] for equirectangular pictures.
    ///
    /// # Errors
    /// As [`Projector::new`].
    pub fn of_image(image: &ContourImage, projection: Projection) -> Result<Self, ProjectionError> {
        let normal = image.normal();
        if let (Domain::Frustum(frustum), Projection::Gnomonic) = (image.domain(), projection) {
            return Ok(Self::of_camera(frustum));
        }
        let camera = if let Domain::Frustum(frustum) = image.domain() { Some(frustum.frame()) } else { None };
        let towards = normal.or(camera.map(ViewFrame::towards)).unwrap_or(DVec3::Y);
        let frame = match (projection, camera) {
            (Projection::Equirectangular, _) => ViewFrame::panorama(towards),
            (_, Some(frame)) => frame,
            _ => ViewFrame::upright(towards),
        };
        Self::new(projection, frame, normal)
    }

    /// The image plane of a camera, at distance 1, from border to border.
    fn of_camera(frustum: &Frustum) -> Self {
        let height = (frustum.degrees() / 2.0).to_radians().tan();
        Self::of_plane(frustum.frame(), DVec2::new(frustum.aspect() * height, height))
    }

    /// The part of an image plane at distance 1 that reaches so far to each side.
    pub(crate) fn of_plane(frame: ViewFrame, reach: DVec2) -> Self {
        let clips = [DVec3::X, DVec3::Y].into_iter().zip(reach.to_array());
        let clips = clips.flat_map(|(axis, reach)| [axis, -axis].map(|n| n + DVec3::Z * reach)).collect();
        let window = Window { low: -reach, high: reach };
        Self { projection: Projection::Gnomonic, frame, window, clips, seams: Vec::new() }
    }

    /// The projection.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// The view frame.
    pub fn frame(&self) -> ViewFrame {
        self.frame
    }

    /// What the picture covers, y up.
    pub fn window(&self) -> Window {
        self.window
    }

    /// Where a direction lies in the picture, be it inside of the window or not. The opposite of
    /// `towards` in a stereographic picture, and the horizon in a gnomonic one, are infinitely far away.
    pub fn point(&self, direction: DVec3) -> DVec2 {
        self.place(self.frame.components(direction))
    }

    /// Where a direction that a gnomonic picture shows lies in it: rounding may have turned it beyond the borders, or the horizon.
    fn point_within(&self, direction: DVec3) -> DVec2 {
        let d = self.frame.components(direction);
        (d.truncate() / d.z.max(f64::MIN_POSITIVE)).clamp(self.window.low, self.window.high)
    }

    /// The same for a direction in the frame's axes.
    fn place(&self, d: DVec3) -> DVec2 {
        match self.projection {
            Projection::Nusselt => d.truncate() / d.length(),
            Projection::Gnomonic => d.truncate() / d.z,
            Projection::Stereographic => d.truncate() / (d.length() + d.z),
            Projection::Equirectangular => DVec2::new(d.x.atan2(d.z), d.y.atan2(d.x.hypot(d.z))),
        }
    }
}

/// The longitudes and latitudes of a hemisphere, or of the sphere.
fn panorama_window(normal: Option<DVec3>) -> Window {
    let mut window = Window { low: DVec2::new(-PI, -FRAC_PI_2), high: DVec2::new(PI, FRAC_PI_2) };
    if let Some(n) = normal {
        let tilt = n.y.atan2(n.x.hypot(n.z));
        // A pole inside of the hemisphere brings all longitudes.
        if tilt.abs() < 1e-12 {
            (window.low.x, window.high.x) = (-FRAC_PI_2, FRAC_PI_2);
        } else if tilt > 0.0 {
            window.low.y = tilt - FRAC_PI_2;
        } else {
            window.high.y = tilt + FRAC_PI_2;
        }
    }
    window
}
