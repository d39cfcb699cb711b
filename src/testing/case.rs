//! One thing to test: a scene, an eye, a direction and what is looked at.

use super::viewpoints::{Eye, eye};
use super::{Faces, Mode, direction, scene};
use crate::bsp::{BspError, BspOptions, SceneBsp};
use crate::contour::{ContourImage, Domain, Frustum, ViewError, Viewpoint, Windows};
use crate::scene::{PolygonId, Scene, SceneError, Side};
use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::Index;
use std::fmt;

/// Which directions are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outlook {
    /// All.
    Sphere,
    /// The hemisphere about the case's direction.
    Hemisphere,
    /// What is above one side of a face, from its point nearest to the case's eye; all directions if the
    /// face has no area.
    Above(usize, Side),
    /// What a camera sees that looks along the case's direction, with so many degrees from top to bottom, 1 to 179, and an aspect of 3/2.
    Frustum(u8),
    /// What is seen through windows.
    Windows(CaseWindows),
}

/// Windows of a case: faces of its scene, and the first of them moved by the case's direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CaseWindows {
    /// Numbers of faces, if there are so many.
    pub faces: [usize; 2],
    /// With the one that is moved, too.
    pub with_moved: bool,
    /// Only what is in the hemisphere about the case's direction.
    pub within_hemisphere: bool,
}

/// A scene, an eye and a direction: what a property test draws, a fuzzer decodes, and a regression
/// test keeps. Printed with `{:?}` it is Rust that makes it again.
///
/// ```
/// use nusselt::testing::{Case, Faces, Mode, Outlook};
///
/// let case = Case {
///     mode: Mode::Grid,
///     faces: Faces::from(vec![vec![[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.0, 2.0, 1.0]]]),
///     eye: [0.0, 0.0, 0.0].into(),
///     direction: [0.0, 0.0, 1.0].into(),
///     outlook: Outlook::Sphere,
///     epsilon: 0.0,
/// };
/// nusselt::testing::check_image(&case.image()?)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Case {
    /// What its coordinates look like.
    pub mode: Mode,
    /// The scene.
    pub faces: Faces,
    /// Where one stands.
    pub eye: DVec3,
    /// A direction to look in; the normal of [`Outlook::Hemisphere`].
    pub direction: DVec3,
    /// Which directions are looked at.
    pub outlook: Outlook,
    /// The epsilon of the BSP, in scene units.
    pub epsilon: f64,
}

/// Why there is no image of a case.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError {
    /// A face is no polygon.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene has no BSP.
    #[error(transparent)]
    Bsp(#[from] BspError),
    /// There is no view.
    #[error(transparent)]
    View(#[from] ViewError),
}

impl Case {
    /// Its scene.
    ///
    /// # Errors
    /// If some face is no polygon.
    pub fn scene(&self) -> Result<Scene, CaseError> {
        Ok(self.faces.scene()?)
    }

    /// The BSP of its scene.
    ///
    /// # Errors
    /// If some face is no polygon, if epsilon is bad, or if there are too many fragments.
    pub fn bsp(&self) -> Result<SceneBsp, CaseError> {
        let options = BspOptions { epsilon: self.epsilon, ..BspOptions::default() };
        Ok(SceneBsp::build(&self.scene()?, &options)?)
    }

    /// Where it looks from, and in which directions.
    pub fn viewpoint(&self, scene: &Scene) -> (Viewpoint, Domain) {
        let free = Viewpoint::free(self.eye);
        match self.outlook {
            Outlook::Hemisphere if self.direction != DVec3::ZERO => (free, Domain::Hemisphere(self.direction)),
            Outlook::Sphere | Outlook::Hemisphere => (free, Domain::Sphere),
            Outlook::Above(face, side) => match Viewpoint::on_surface(scene, PolygonId(face as u32), side, self.eye) {
                Ok(viewpoint) => (viewpoint, Domain::Above),
                Err(_) => (free, Domain::Sphere),
            },
            Outlook::Frustum(degrees) => {
                // Whatever the direction is, one of two axes is across it.
                let towards = if self.direction == DVec3::ZERO { DVec3::X } else { self.direction };
                let cameras = [DVec3::Z, DVec3::Y].map(|up| Frustum::new(towards, up, f64::from(degrees), 1.5));
                let camera = cameras.into_iter().find_map(Result::ok);
                (free, camera.map_or(Domain::Sphere, Domain::Frustum))
            }
            Outlook::Windows(windows) => (free, Domain::Window(self.windows(windows))),
        }
    }

    fn windows(&self, CaseWindows { faces, with_moved, within_hemisphere }: CaseWindows) -> Windows {
        let known = faces.into_iter().filter(|&face| face < self.faces.len());
        let mut windows = Windows::polygons(known.map(|face| PolygonId(face as u32)));
        if with_moved && let Some(corners) = self.faces.loops().get(faces[0]) {
            let moved: Vec<DVec3> = corners.iter().map(|&p| p + self.direction).collect();
            // Rounding may have made it no polygon.
            if let Ok(own) = Windows::free(&moved) {
                windows = windows.and(&own);
            }
        }
        let has_normal = within_hemisphere && self.direction != DVec3::ZERO;
        if has_normal { windows.within_hemisphere(self.direction) } else { windows }
    }

    /// The view of a BSP of its scene.
    ///
    /// # Errors
    /// If the eye or the direction is not finite, or if there are too many cells.
    pub fn view(&self, bsp: &SceneBsp) -> Result<ContourImage, CaseError> {
        let (viewpoint, domain) = self.viewpoint(bsp.scene());
        Ok(bsp.view(&viewpoint, &domain)?)
    }

    /// Its contour image.
    ///
    /// # Errors
    /// As for [`Case::bsp`] and [`Case::view`].
    pub fn image(&self) -> Result<ContourImage, CaseError> {
        self.view(&self.bsp()?)
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, faces, eye, direction, outlook, epsilon } = self;
        let [eye, direction] = [eye, direction].map(|v| format!("{:?}", v.to_array()));
        let outlook = match outlook {
            Outlook::Above(face, side) => format!("Above({face}, Side::{side:?})"),
            other => format!("{other:?}"),
        };
        writeln!(f, "Case {{")?;
        writeln!(f, "    mode: Mode::{mode:?},")?;
        writeln!(f, "    faces: {faces:?},")?;
        writeln!(f, "    eye: {eye}.into(),")?;
        writeln!(f, "    direction: {direction}.into(),")?;
        writeln!(f, "    outlook: Outlook::{outlook},")?;
        writeln!(f, "    epsilon: {epsilon:?},")?;
        write!(f, "}}")
    }
}

/// A scene of any kind with an eye, a direction and an outlook, all of one mode; epsilon is 0.
pub fn case(mode: Mode) -> impl Strategy<Value = Case> {
    case_of(mode, scene(mode))
}

/// The same for scenes of one kind.
pub fn case_of(mode: Mode, scenes: impl Strategy<Value = Faces>) -> impl Strategy<Value = Case> {
    let outlook = (0u8..12, any::<[Index; 2]>(), 1u8..180, any::<[bool; 2]>());
    (scenes, eye(mode), direction(mode), outlook).prop_map(move |(faces, eye, direction, outlook)| {
        let (kind, which, degrees, [with_moved, within_hemisphere]) = outlook;
        let face = |k: usize| which[k].index(faces.len());
        let outlook = match kind {
            0..4 => Outlook::Sphere,
            4..6 => Outlook::Hemisphere,
            6 => Outlook::Frustum(degrees),
            _ if faces.is_empty() => Outlook::Sphere,
            7 => Outlook::Above(face(0), Side::Front),
            8 => Outlook::Above(face(0), Side::Back),
            _ => Outlook::Windows(CaseWindows { faces: [0, 1].map(face), with_moved, within_hemisphere }),
        };
        Case { mode, eye: Eye::among(&eye, &faces), faces, direction, outlook, epsilon: 0.0 }
    })
}
