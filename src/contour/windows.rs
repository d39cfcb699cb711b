//! What is seen through windows: only the directions inside of given polygons.

use crate::exact::{Sign, orient3d};
use crate::scene::{Material, PieceRef, PolygonId, Scene, SceneError};
use glam::DVec3;
use std::sync::Arc;

/// Windows: polygons of the scene, or polygons of their own, such as a lamp, a window or the disc of the sun. As a domain they are all directions in
/// which one of them lies, whichever side it shows: their exact union, however they overlap. A polygon that is seen edge-on has none, nor
/// has one without area. Clones are cheap.
///
/// A window hides nothing and lets through what lies before and behind it. A polygon of the scene that is its own window is seen in all of it,
/// but for what is in front of it.
///
/// ```
/// use glam::DVec3;
/// use nusselt::contour::{Domain, SceneOrder, Viewpoint, Windows};
/// use nusselt::scene::{Material, PolygonId, Scene};
///
/// // A lamp, and a board that hides half of it.
/// let vertices = [
///     [-1., -1., 4.], [-1., 1., 4.], [1., 1., 4.], [1., -1., 4.],
///     [0., -9., 2.], [9., -9., 2.], [9., 9., 2.], [0., 9., 2.],
/// ];
/// let scene = Scene::builder().mesh(&vertices, &[vec![0, 1, 2, 3], vec![4, 5, 6, 7]], Material::new("grey")).build()?;
/// let lamp = Windows::polygon(PolygonId(0)).within_hemisphere(DVec3::Z);
/// let image = SceneOrder::new(&scene).view(&Viewpoint::free(DVec3::ZERO), &Domain::Window(lamp))?;
/// let factors = image.form_factors().expect("there is a normal");
/// assert!((factors.of(PolygonId(0)) - factors.of(PolygonId(1))).abs() < 1e-15);
/// assert_eq!(factors.background, 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Windows {
    panes: Arc<[Pane]>,
    horizon: Option<Horizon>,
}

/// One window.
#[derive(Clone, Debug, PartialEq)]
pub enum Pane {
    /// A polygon of the scene.
    Polygon(PolygonId),
    /// A polygon that is exactly planar and convex, with at least three corners, no three of them in line, in either direction.
    Ring(Vec<DVec3>),
}

/// What windows are cut off at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Horizon {
    /// The horizon of the hemisphere about a normal, of any length: see [`Domain::Hemisphere`](super::Domain::Hemisphere).
    Normal(DVec3),
    /// The plane of the surface that the viewpoint is on: see [`Domain::Above`](super::Domain::Above).
    Surface,
}

/// Why there is no such window.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WindowError {
    /// Its points are no polygon: too few, not finite, or crossing themselves.
    #[error("the window is no polygon: {0}")]
    NotAPolygon(#[from] SceneError),
    /// Its points lie on a line.
    #[error("the window has no area")]
    NoArea,
}

impl Windows {
    /// A polygon of the scene, with its exact vertices. That it exists is asked when a view is made.
    #[must_use]
    pub fn polygon(polygon: PolygonId) -> Self {
        Self::polygons([polygon])
    }

    /// Several polygons of the scene. None at all are an empty domain.
    #[must_use]
    pub fn polygons(polygons: impl IntoIterator<Item = PolygonId>) -> Self {
        Self { panes: polygons.into_iter().map(Pane::Polygon).collect(), horizon: None }
    }

    /// A polygon of its own, by its corners in order, in either direction. One that is not exactly planar, or not convex, is
    /// triangulated over its corners, as a polygon of a scene would be.
    ///
    /// ```
    /// use nusselt::contour::{Pane, WindowError, Windows};
    ///
    /// // An L, which is not convex; and a line, which is no window.
    /// let corners = [[0., 0., 3.], [2., 0., 3.], [2., 1., 3.], [1., 1., 3.], [1., 2., 3.], [0., 2., 3.]];
    /// assert_eq!(Windows::free(&corners.map(Into::into))?.panes().len(), 4);
    /// assert_eq!(Windows::free(&[[0.; 3], [1.; 3], [2.; 3]].map(Into::into)), Err(WindowError::NoArea));
    /// # Ok::<(), WindowError>(())
    /// ```
    ///
    /// # Errors
    /// If the points are no polygon, or lie on a line.
    pub fn free(corners: &[DVec3]) -> Result<Self, WindowError> {
        let vertices: Vec<[f64; 3]> = corners.iter().map(DVec3::to_array).collect();
        let face = (0..corners.len()).collect();
        let scene = Scene::builder().mesh(&vertices, &[face], Material::new("window")).build()?;
        let panes: Arc<[Pane]> = scene.pieces().map(|piece| Pane::Ring(strict_corners(piece))).collect();
        if panes.is_empty() { Err(WindowError::NoArea) } else { Ok(Self { panes, horizon: None }) }
    }

    /// A narrow window about a unit direction, as seen from an eye: a triangle at that distance, of which the direction passes through the middle. `None` if that is
    /// beyond all numbers.
    pub(crate) fn about(eye: DVec3, direction: DVec3, distance: f64) -> Option<Self> {
        let (u, v) = direction.any_orthonormal_pair();
        let middle = eye + direction * distance;
        let corners =
            [[1.0, 0.0], [-0.5, 0.9], [-0.5, -0.9]].map(|[x, y]| middle + (u * x + v * y) * (1e-4 * distance));
        let is_finite = corners.iter().all(|corner| corner.is_finite());
        is_finite.then(|| Self { panes: Arc::new([Pane::Ring(corners.into())]), horizon: None })
    }

    /// These and the others; the horizon is that of these.
    #[must_use]
    pub fn and(&self, others: &Self) -> Self {
        Self { panes: self.panes.iter().chain(&*others.panes).cloned().collect(), horizon: self.horizon }
    }

    /// Only what is in the hemisphere about a normal of any length. With it an image has form factors: what is seen of
    /// the windows, and by what they are hidden.
    #[must_use]
    pub fn within_hemisphere(self, normal: DVec3) -> Self {
        Self { horizon: Some(Horizon::Normal(normal)), ..self }
    }

    /// Only what is above the surface that the viewpoint is on; likewise.
    #[must_use]
    pub fn above_surface(self) -> Self {
        Self { horizon: Some(Horizon::Surface), ..self }
    }

    /// The windows one by one.
    pub fn panes(&self) -> &[Pane] {
        &self.panes
    }

    /// What they are cut off at, if anything.
    pub fn horizon(&self) -> Option<Horizon> {
        self.horizon
    }
}

/// The corners of a piece at which it turns.
fn strict_corners(piece: PieceRef<'_>) -> Vec<DVec3> {
    let corners: Vec<DVec3> = piece.points().collect();
    let len = corners.len();
    // A point off the plane: of four that are not in one plane one is.
    let candidates = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let is_off = |&q: &DVec3| corners.windows(3).any(|t| orient3d(t[0], t[1], t[2], q) != Sign::Zero);
    let off = candidates.into_iter().find(is_off).unwrap_or_default();
    let turns = |k: &usize| {
        let [before, after] = [(k + len - 1) % len, (k + 1) % len].map(|k| corners[k]);
        orient3d(before, corners[*k], off, after) != Sign::Zero
    };
    (0..len).filter(turns).map(|k| corners[k]).collect()
}
