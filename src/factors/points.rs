//! Form factors from points: from differential elements to everything that they see.

use crate::contour::{ContourImage, Domain, SceneOrder, ViewError, ViewOptions, ViewSpaces, Viewpoint};
use crate::parallel;
use crate::scene::PolygonId;

/// Of what factors are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum By {
    /// Of every object.
    #[default]
    Object,
    /// Of every polygon.
    Polygon,
}

impl By {
    /// Its name in files: `object` or `polygon`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Object => "object",
            Self::Polygon => "polygon",
        }
    }
}

/// What one point sees.
#[derive(Clone, Debug, PartialEq)]
pub struct PointFactors {
    /// The polygon that it is on, if it is.
    pub on: Option<PolygonId>,
    /// The number of each visible object or polygon, ascending, with its form factor: whichever side is seen. None is 0.
    pub factors: Vec<(u32, f64)>,
    /// The form factor of the background: the sky view factor, if the background is sky.
    pub background: f64,
}

impl PointFactors {
    /// Of an image; `None` if its domain has no normal.
    pub fn of(image: &ContourImage, by: By) -> Option<Self> {
        let sums = image.precise_form_factors()?;
        let mut factors: Vec<(u32, f64)> = match by {
            By::Object => sums.by_object(image.scene()).into_iter().map(|(object, f)| (object.0, f)).collect(),
            By::Polygon => sums.polygons.iter().map(|sum| (sum.polygon.0, sum.both())).collect(),
        };
        // A sliver that is thinner than its own rounding.
        factors.retain(|(_, factor)| *factor > 0.0);
        let on = image.viewpoint().surface().map(|(polygon, _)| polygon);
        Some(Self { on, factors, background: sums.background })
    }

    /// All factors and the background: 1 up to rounding.
    pub fn total(&self) -> f64 {
        self.factors.iter().map(|(_, factor)| factor).sum::<f64>() + self.background
    }
}

/// Computes form factors from points, in memory that is used again from one to the next. Threads share it.
///
/// ```
/// use nusselt::contour::{Domain, SceneOrder, Viewpoint};
/// use nusselt::factors::{By, PointSolver};
/// use nusselt::scene::{Material, Scene};
/// use glam::DVec3;
///
/// // A square of 2 by 2 one unit above.
/// let square = [[-1., -1., 1.], [1., -1., 1.], [1., 1., 1.], [-1., 1., 1.]];
/// let scene = Scene::builder().mesh(&square, &[vec![0, 1, 2, 3]], Material::new("grey")).build()?;
/// let solver = PointSolver::new(SceneOrder::new(&scene), By::Object);
/// let up = Domain::Hemisphere(DVec3::Z);
/// let points: Vec<_> = [0.0, 5.0].map(|x| (Viewpoint::free(DVec3::new(x, 0.0, 0.0)), up.clone())).to_vec();
/// let all = solver.solve_all(&points)?;
/// assert!((all[0].factors[0].1 - 0.5541).abs() < 1e-4 && all[1].background > 0.99);
/// assert!(all.iter().all(|point| (point.total() - 1.0).abs() < 1e-15));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct PointSolver {
    order: SceneOrder,
    by: By,
    options: ViewOptions,
    spaces: ViewSpaces,
}

/// Why there are no form factors from a point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PointError {
    /// There is no view.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The domain is the whole sphere.
    #[error("form factors take a hemisphere")]
    NoNormal,
}

impl PointSolver {
    /// For a scene in an order.
    pub fn new(order: SceneOrder, by: By) -> Self {
        Self { order, by, options: ViewOptions::default(), spaces: ViewSpaces::new() }
    }

    /// With other options for views.
    #[must_use]
    pub fn with_options(self, options: ViewOptions) -> Self {
        Self { options, ..self }
    }

    /// The scene.
    pub fn order(&self) -> &SceneOrder {
        &self.order
    }

    /// Of what factors are told.
    pub fn by(&self) -> By {
        self.by
    }

    /// The form factors from one point: each within 1e-12, and within 1e-9 of itself down to 1e-15 (see
    /// [`ContourImage::precise_form_factors`]). The cost is that of a view.
    ///
    /// # Errors
    /// If there is no view, or the domain is a sphere.
    pub fn solve(&self, viewpoint: &Viewpoint, domain: &Domain) -> Result<PointFactors, PointError> {
        self.spaces.with(|space| {
            let image = self.order.view_in(space, viewpoint, domain, &self.options)?;
            PointFactors::of(image, self.by).ok_or(PointError::NoNormal)
        })
    }

    /// The same from many points, in their order. With the feature `parallel` the threads of the current `rayon` pool share the work; the
    /// results are the same bits for any number of them. All results are in memory: pass a few thousand points at a time.
    ///
    /// # Errors
    /// The first point that there are none of, by its place in the list.
    pub fn solve_all(&self, points: &[(Viewpoint, Domain)]) -> Result<Vec<PointFactors>, PointsError> {
        let solve = |index: usize| {
            let (viewpoint, domain) = &points[index];
            self.solve(viewpoint, domain).map_err(|source| PointsError { index, source })
        };
        parallel::map((0..points.len()).collect(), solve).into_iter().collect()
    }
}

/// Which of many points there are no form factors from, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("point {index}: {source}")]
pub struct PointsError {
    /// The place in the list, from 0.
    pub index: usize,
    /// Why.
    pub source: PointError,
}
