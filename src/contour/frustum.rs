//! What a camera sees: the directions between four planes through the eye.

use super::projection::ViewFrame;
use crate::exact::{Kernel, Sign, Splitter};
use glam::DVec3;

/// The directions that a camera sees: those inside of four half-spaces through the eye. Copies are cheap.
///
/// Their normals are rounded once, when it is made; from then on they are exactly what they are, and so is the domain.
///
/// ```
/// use glam::DVec3;
/// use nusselt::contour::{Domain, Frustum, SceneOrder, Viewpoint};
///
/// // A right angle up and across, towards +y: one face of a cube.
/// let frustum = Frustum::new(DVec3::Y, DVec3::Z, 90.0, 1.0)?;
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let image = SceneOrder::new(&scene).view(&Viewpoint::free(DVec3::splat(270.0)), &Domain::Frustum(frustum))?;
/// let seen = image.solid_angles().total();
/// assert!((seen - 4.0 * std::f64::consts::PI / 6.0).abs() < 1e-14);
/// image.certify()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    normals: [DVec3; 4],
    frame: ViewFrame,
    degrees: f64,
    aspect: f64,
}

/// Why there is no such camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrustumError {
    /// Zero, infinite or not a number.
    #[error("the direction that the camera looks in is zero or not finite")]
    BadDirection,
    /// Zero, infinite or not a number.
    #[error("the camera's up is zero or not finite")]
    BadUp,
    /// Up does not tell which way is up: its angle with the direction is below 1e-9 radians, or above pi less that.
    #[error("the camera's up is along the direction it looks in; give another up")]
    UpAlong,
    /// Not between 0 and 180 degrees.
    #[error("the vertical field of view is an angle above 0 and below 180 degrees")]
    BadAngle,
    /// Not above 0, or infinite.
    #[error("the aspect, width over height, is above 0")]
    BadAspect,
    /// Rounded to f64, the four planes have no convex cone between them.
    #[error("the camera's view is too thin, or too close to half of all directions, to be told from that in f64")]
    Degenerate,
}

impl Frustum {
    /// The camera that looks along `towards` with `up` as far up as that allows, both of any length. `degrees` is the vertical field of view,
    /// from the lower to the upper border, above 0 and below 180; `aspect` is width over height, in the image plane.
    ///
    /// # Errors
    /// Where one of these is out of its range, or where rounding leaves no convex cone: with angles of 1e-15 degrees, for one.
    pub fn new(towards: DVec3, up: DVec3, degrees: f64, aspect: f64) -> Result<Self, FrustumError> {
        let has_direction = |v: DVec3| v.is_finite() && v != DVec3::ZERO;
        if !has_direction(towards) {
            return Err(FrustumError::BadDirection);
        }
        if !has_direction(up) {
            return Err(FrustumError::BadUp);
        }
        if !(degrees > 0.0 && degrees < 180.0) {
            return Err(FrustumError::BadAngle);
        }
        if !(aspect > 0.0 && aspect.is_finite()) {
            return Err(FrustumError::BadAspect);
        }
        let frame = ViewFrame::checked(towards, up).ok_or(FrustumError::UpAlong)?;
        let (sine, cosine) = (degrees / 2.0).to_radians().sin_cos();
        let (right, up, towards) = (frame.right(), frame.up(), frame.towards());
        // Of the directions at the border x = a tan(v / 2) of the image plane z = 1, and of the opposite one; and likewise up.
        let [across, height] = [(aspect * sine, right), (sine, up)].map(|(reach, axis)| {
            let size = reach.max(cosine);
            [-1.0, 1.0].map(|sign| towards * (reach / size) + axis * (sign * cosine / size))
        });
        let [[r, l], [t, b]] = [across, height];
        let normals = [t, r, b, l];
        let is_finite = (aspect * (degrees / 2.0).to_radians().tan()).is_finite();
        if is_finite && is_convex(&normals) {
            Ok(Self { normals, frame, degrees, aspect })
        } else {
            Err(FrustumError::Degenerate)
        }
    }

    /// The normals of the half-spaces, to the inside: those of the upper, right, lower and left border.
    pub fn normals(&self) -> [DVec3; 4] {
        self.normals
    }

    /// Right, up and where it looks.
    pub fn frame(&self) -> ViewFrame {
        self.frame
    }

    /// The vertical field of view, in degrees.
    pub fn degrees(&self) -> f64 {
        self.degrees
    }

    /// Width over height.
    pub fn aspect(&self) -> f64 {
        self.aspect
    }
}

/// True if four half-spaces, in their order counter-clockwise, bound a convex cone with four sides, exactly.
fn is_convex(normals: &[DVec3; 4]) -> bool {
    let mut kernel = Kernel::new([], DVec3::ZERO);
    let sides = normals.map(|normal| kernel.add_splitter(&Splitter::Given(normal)));
    (0..4).all(|k| {
        let (next, second) = ((k + 1) % 4, (k + 2) % 4);
        kernel.orientation_of([sides[k], sides[next], sides[second]]) == Sign::Positive
    })
}
