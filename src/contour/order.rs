//! The two ways to a contour image behind one door.

use super::domain::Domain;
use super::image::ContourImage;
use super::view::{ViewError, ViewOptions, ViewSpace};
use super::viewpoint::Viewpoint;
use crate::bsp::{SceneBsp, Skeleton, UncutSliver};
use crate::bvh::SceneBvh;
use crate::scene::Scene;

/// What gives the polygons of a scene from near to far, and so its contour images: a hierarchy of boxes or a 3D BSP. Both
/// show the same, cut into other cells. Cloning it is cheap: clones share their data.
///
/// [`SceneOrder::new`] takes boxes, which were faster in all scenes that were measured (docs/performance.md). A [`SceneBsp`] is for those who want
/// the report's way: fragments, exact front-to-back order of all of them, or an epsilon.
///
/// ```
/// use nusselt::contour::{Domain, SceneOrder, Viewpoint};
/// use nusselt::scene::{Material, Scene};
///
/// let square = [[-1., -1., 1.], [1., -1., 1.], [1., 1., 1.], [-1., 1., 1.]];
/// let scene = Scene::builder().mesh(&square, &[vec![0, 1, 2, 3]], Material::new("grey")).build()?;
/// let image = SceneOrder::new(&scene).view(&Viewpoint::free(glam::DVec3::ZERO), &Domain::Sphere)?;
/// // One of the six faces of a cube.
/// let square = image.cells().filter(|cell| cell.polygon().is_some());
/// let seen: f64 = square.map(|cell| cell.solid_angle()).sum();
/// assert!((seen - 4.0 * std::f64::consts::PI / 6.0).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub enum SceneOrder {
    /// Whole polygons roughly from near to far; where two meet in the image their planes decide.
    Boxes(SceneBvh),
    /// Fragments of polygons exactly from near to far.
    Bsp(SceneBsp),
}

impl From<SceneBvh> for SceneOrder {
    fn from(bvh: SceneBvh) -> Self {
        Self::Boxes(bvh)
    }
}

impl From<SceneBsp> for SceneOrder {
    fn from(bsp: SceneBsp) -> Self {
        Self::Bsp(bsp)
    }
}

impl SceneOrder {
    /// The faster one, with what it needs built: once a scene. The cost is that of [`SceneBvh::build`].
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self::Boxes(SceneBvh::build(scene))
    }

    /// The scene it is of.
    pub fn scene(&self) -> &Scene {
        match self {
            Self::Boxes(bvh) => bvh.scene(),
            Self::Bsp(bsp) => bsp.scene(),
        }
    }

    /// The contour image from a viewpoint.
    ///
    /// # Errors
    /// As [`SceneBvh::view`].
    pub fn view(&self, viewpoint: &Viewpoint, domain: &Domain) -> Result<ContourImage, ViewError> {
        self.view_with(viewpoint, domain, &ViewOptions::default())
    }

    /// The same with options.
    ///
    /// # Errors
    /// As [`SceneBvh::view_with`].
    pub fn view_with(
        &self,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
    ) -> Result<ContourImage, ViewError> {
        match self {
            Self::Boxes(bvh) => bvh.view_with(viewpoint, domain, options),
            Self::Bsp(bsp) => bsp.view_with(viewpoint, domain, options),
        }
    }

    /// The same in memory that was used for views before: the image lasts until the next one.
    ///
    /// # Errors
    /// As [`SceneBvh::view_with`].
    pub fn view_in<'s>(
        &self,
        space: &'s mut ViewSpace,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
    ) -> Result<&'s ContourImage, ViewError> {
        match self {
            Self::Boxes(bvh) => bvh.view_in(space, viewpoint, domain, options),
            Self::Bsp(bsp) => bsp.view_in(space, viewpoint, domain, options),
        }
    }

    pub(crate) fn skeleton(&self) -> &Skeleton {
        match self {
            Self::Boxes(bvh) => &bvh.hierarchy.skeleton,
            Self::Bsp(bsp) => &bsp.tree.skeleton,
        }
    }

    /// What a 3D BSP left uncut because of its epsilon; empty if that is 0, and without a BSP.
    pub fn uncut_slivers(&self) -> &[UncutSliver] {
        match self {
            Self::Boxes(_) => &[],
            Self::Bsp(bsp) => bsp.uncut_slivers(),
        }
    }

    /// The epsilon of the 3D BSP, in scene units; 0 without one.
    pub fn epsilon(&self) -> f64 {
        match self {
            Self::Boxes(_) => 0.0,
            Self::Bsp(bsp) => bsp.epsilon(),
        }
    }
}
