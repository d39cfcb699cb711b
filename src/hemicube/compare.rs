//! All methods side by side, on the same views in one run.

use super::deviations::Deviations;
use super::error::BaselineError;
#[cfg(feature = "rays")]
use super::rays::Rays;
use super::view::Hemicube;
use crate::bsp::SceneBsp;
use crate::bvh::SceneBvh;
use crate::contour::{Domain, SceneOrder, ViewError, ViewOptions, ViewSpace, Viewpoint};
use crate::integral::Sums;
use glam::DVec3;
use std::fmt;
use std::hint::black_box;
use std::num::NonZeroUsize;
use std::time::Instant;

/// A way from a viewpoint to the form factors of all polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// The contour image in the order of the 3D BSP, and its form factors.
    Contour,
    /// The contour image by a hierarchy of boxes, and its form factors.
    ContourByBoxes,
    /// [`Hemicube::view`].
    Hemicube {
        /// Rows and columns of the top face.
        resolution: usize,
    },
    /// [`Hemicube::analytic`].
    Analytic {
        /// Rows and columns of the top face.
        resolution: usize,
    },
    /// `Rays::view`.
    #[cfg(feature = "rays")]
    Rays {
        /// How many.
        rays: u32,
    },
}

impl Method {
    /// Its name, without the resolution.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contour => "contour",
            Self::ContourByBoxes => "contour-boxes",
            Self::Hemicube { .. } => "hemicube",
            Self::Analytic { .. } => "analytic",
            #[cfg(feature = "rays")]
            Self::Rays { .. } => "rays",
        }
    }

    /// Rows and columns of the top face of a hemicube, or the number of rays; `None` for contour images, which have no resolution.
    pub fn resolution(self) -> Option<usize> {
        match self {
            Self::Contour | Self::ContourByBoxes => None,
            Self::Hemicube { resolution } | Self::Analytic { resolution } => Some(resolution),
            #[cfg(feature = "rays")]
            Self::Rays { rays } => Some(rays as usize),
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())?;
        self.resolution().map_or(Ok(()), |resolution| write!(f, " {resolution}"))
    }
}

/// What one method took and how far off it was.
#[derive(Clone, Debug)]
pub struct ComparisonRow {
    /// The method.
    pub method: Method,
    /// What was done once for the scene, in seconds: the hierarchy of boxes, the hemicube's tables, the hierarchy of the rays. 0 for
    /// the contour in the order of the 3D BSP, which is given.
    pub setup_s: f64,
    /// The time of each view with its form factors, in milliseconds: the shortest of all rounds.
    pub view_ms: Vec<f64>,
    /// The relative errors of form factors above 1e-3, over all views.
    pub above_1e3: Deviations,
    /// The relative errors of form factors above 1e-4, over all views; polygons that are seen and lost, of any size.
    pub above_1e4: Deviations,
    /// How many form factors were evaluated, over all views: one for each cell of a contour image, for each pixel of a
    /// hemicube; none for rays.
    pub evaluations: usize,
}

impl ComparisonRow {
    fn new(method: Method, setup_s: f64) -> Self {
        let [above_1e3, above_1e4] = [1e-3, 1e-4].map(Deviations::above);
        Self { method, setup_s, view_ms: Vec::new(), above_1e3, above_1e4, evaluations: 0 }
    }

    /// The mean time of a view in milliseconds; 0 without views.
    pub fn mean_ms(&self) -> f64 {
        self.view_ms.iter().fold(0.0, |sum, ms| sum + ms) / self.view_ms.len().max(1) as f64
    }

    /// The median time of a view in milliseconds, the upper one of two; 0 without views.
    pub fn median_ms(&self) -> f64 {
        let mut sorted = self.view_ms.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    }

    /// The longest time of a view in milliseconds; 0 without views.
    pub fn max_ms(&self) -> f64 {
        self.view_ms.iter().copied().fold(0.0, f64::max)
    }
}

/// Why methods could not be compared. Views are counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// A method that there is not.
    #[error(transparent)]
    Method(#[from] BaselineError),
    /// A contour image failed.
    #[error("view {view}: {source}")]
    Contour {
        /// Which view.
        view: usize,
        /// Why.
        source: ViewError,
    },
    /// Another method failed.
    #[error("view {view}: {source}")]
    Baseline {
        /// Which view.
        view: usize,
        /// Why.
        source: BaselineError,
    },
    /// A domain without a normal has no form factors.
    #[error("view {view}: there are form factors above a plane only; look at a hemisphere")]
    NoNormal {
        /// Which view.
        view: usize,
    },
}

/// The method of which the form factors are taken for exact where others are compared with them: the contour image in the order of the
/// 3D BSP, or that by a hierarchy of boxes if the 3D BSP was built with an epsilon above 0 and may see a wrong order.
pub fn reference_method(bsp: &SceneBsp) -> Method {
    if bsp.epsilon() > 0.0 { Method::ContourByBoxes } else { Method::Contour }
}

/// So many views are taken in all rounds before the next ones: few enough that what is known of them needs little memory.
const BLOCK: usize = 20;

/// Takes all views with every method, `rounds` times each on one thread, and compares form factors with those of a contour image, which are exact up to
/// the rounding of their sums: in the order of `bsp`, or by a hierarchy of boxes where that has an epsilon ([`reference_method`]).
///
/// Some views are taken by all methods in turn, then by all of them again, so that none has just been taken by a method when it takes it
/// again, and a busy moment of the machine does not meet all times of one method; what a method does once for the scene is timed
/// apart. Factors are looked at outside of the times. `done` is told how many more views were taken; there are
/// `views.len() * methods.len() * rounds` in all.
///
/// Memory: about 36 bytes for each pixel of the top face of every hemicube asked for, and, however many views there are, a few
/// megabytes a method, what is seen in 20 views, and 8 bytes for the time of each view and method.
///
/// ```
/// use nusselt::bsp::{BspOptions, SceneBsp};
/// use nusselt::contour::{Domain, Viewpoint};
/// use nusselt::hemicube::{Method, compare};
/// use std::num::NonZeroUsize;
///
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
/// let views = [(Viewpoint::free(glam::DVec3::new(278.0, 273.0, 1.0)), Domain::Hemisphere(glam::DVec3::Z))];
/// let rows = compare(&bsp, &views, &[Method::Contour, Method::Hemicube { resolution: 64 }], NonZeroUsize::MIN, |_| ())?;
/// assert_eq!(rows[0].above_1e4.quantile(1.0), Some(0.0));
/// println!("{} is off by up to {:?}", rows[1].method, rows[1].above_1e4.quantile(1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If a resolution is not one that hemicubes have, or if a view fails: see [`CompareError`].
pub fn compare(
    bsp: &SceneBsp,
    views: &[(Viewpoint, Domain)],
    methods: &[Method],
    rounds: NonZeroUsize,
    mut done: impl FnMut(usize),
) -> Result<Vec<ComparisonRow>, CompareError> {
    let exact_order: SceneOrder = match reference_method(bsp) {
        Method::ContourByBoxes => SceneBvh::build(bsp.scene()).into(),
        _ => bsp.clone().into(),
    };
    let mut tools = methods.iter().map(|&method| Tool::timed(method, bsp)).collect::<Result<Vec<_>, _>>()?;
    let mut rows: Vec<_> =
        methods.iter().zip(&tools).map(|(&method, tool)| ComparisonRow::new(method, tool.1)).collect();
    let polygons = bsp.scene().polygon_count();
    let [mut factors, mut exact] = [(); 2].map(|()| Vec::with_capacity(polygons));
    for (block, views) in views.chunks(BLOCK).enumerate() {
        let known = views.iter().enumerate().map(|(k, view)| Known::new(&exact_order, view, block * BLOCK + k));
        let known = known.collect::<Result<Vec<_>, _>>()?;
        for row in &mut rows {
            row.view_ms.resize(row.view_ms.len() + known.len(), f64::INFINITY);
        }
        for round in 0..rounds.get() {
            for (row, (tool, _)) in rows.iter_mut().zip(&mut tools) {
                for (known, fastest) in known.iter().zip(&mut row.view_ms[block * BLOCK..]) {
                    let wanted = (round == 0).then_some(&mut factors);
                    let (ms, evaluations) = tool.take(known, wanted)?;
                    *fastest = fastest.min(ms);
                    if round == 0 {
                        row.evaluations += evaluations;
                        dense(&known.exact, polygons, &mut exact);
                        for deviations in [&mut row.above_1e3, &mut row.above_1e4] {
                            deviations.add(factors.iter().copied(), exact.iter().copied());
                        }
                    }
                }
                done(known.len());
            }
        }
    }
    Ok(rows)
}

/// A view and its exact form factors.
struct Known {
    number: usize,
    viewpoint: Viewpoint,
    domain: Domain,
    normal: DVec3,
    exact: Sums,
}

impl Known {
    fn new(order: &SceneOrder, (viewpoint, domain): &(Viewpoint, Domain), number: usize) -> Result<Self, CompareError> {
        // The baselines take all of a hemisphere.
        if !matches!(domain, Domain::Sphere | Domain::Hemisphere(_) | Domain::Above) {
            return Err(CompareError::NoNormal { view: number });
        }
        let failed = |source| CompareError::Contour { view: number, source };
        let image = order.view(viewpoint, domain).map_err(failed)?;
        match (image.normal(), image.form_factors()) {
            (Some(normal), Some(exact)) => {
                Ok(Self { number, viewpoint: *viewpoint, domain: domain.clone(), normal, exact })
            }
            _ => Err(CompareError::NoNormal { view: number }),
        }
    }
}

/// A method with what it makes once for all views.
enum Tool {
    /// With the memory that its views use in turn.
    Contour(SceneOrder, Box<ViewSpace>),
    Hemicube(Box<Hemicube>),
    Analytic(Box<Hemicube>),
    #[cfg(feature = "rays")]
    Rays(Box<Rays>, u32),
}

impl Tool {
    /// With the seconds that making it took.
    fn timed(method: Method, bsp: &SceneBsp) -> Result<(Self, f64), BaselineError> {
        let scene = bsp.scene();
        let start = Instant::now();
        let tool = match method {
            // Made before.
            Method::Contour => return Ok((Self::Contour(bsp.clone().into(), Box::default()), 0.0)),
            Method::ContourByBoxes => Self::Contour(SceneBvh::build(scene).into(), Box::default()),
            Method::Hemicube { resolution } => Self::Hemicube(Box::new(Hemicube::new(scene, resolution)?)),
            Method::Analytic { resolution } => Self::Analytic(Box::new(Hemicube::new(scene, resolution)?)),
            #[cfg(feature = "rays")]
            Method::Rays { rays: 0 } => return Err(BaselineError::NoRays),
            #[cfg(feature = "rays")]
            Method::Rays { rays } => Self::Rays(Box::new(Rays::new(scene)), rays),
        };
        Ok((tool, start.elapsed().as_secs_f64()))
    }

    /// Takes a view: the milliseconds it took, and how many form factors were evaluated. Replaces `wanted` by the form factors of all
    /// polygons by their numbers.
    fn take(&mut self, view: &Known, mut wanted: Option<&mut Vec<f64>>) -> Result<(f64, usize), CompareError> {
        let Known { number, ref viewpoint, ref domain, normal, .. } = *view;
        let failed = |source| CompareError::Baseline { view: number, source };
        if let Some(wanted) = wanted.as_deref_mut() {
            wanted.clear();
        }
        match self {
            Self::Contour(order, space) => {
                let start = Instant::now();
                let image = order.view_in(space, viewpoint, domain, &ViewOptions::default());
                let image = image.map_err(|source| CompareError::Contour { view: number, source })?;
                let sums = black_box(image.form_factors()).ok_or(CompareError::NoNormal { view: number })?;
                let ms = since(start);
                if let Some(factors) = wanted {
                    dense(&sums, order.scene().polygon_count(), factors);
                }
                Ok((ms, image.cell_count()))
            }
            Self::Hemicube(hemicube) => {
                let start = Instant::now();
                let seen = black_box(hemicube.view(viewpoint, normal).map_err(failed)?);
                let ms = since(start);
                keep(wanted, seen.factors().iter().copied());
                Ok((ms, seen.stats().pixels))
            }
            Self::Analytic(hemicube) => {
                let start = Instant::now();
                let seen = black_box(hemicube.analytic(viewpoint, normal).map_err(failed)?);
                let ms = since(start);
                keep(wanted, seen.factors().iter().copied());
                Ok((ms, seen.evaluations()))
            }
            #[cfg(feature = "rays")]
            Self::Rays(tracer, rays) => {
                let start = Instant::now();
                let seen = black_box(tracer.view(viewpoint, normal, *rays, number as u64).map_err(failed)?);
                let ms = since(start);
                keep(wanted, seen.factors());
                Ok((ms, 0))
            }
        }
    }
}

fn since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

fn keep(wanted: Option<&mut Vec<f64>>, factors: impl Iterator<Item = f64>) {
    if let Some(wanted) = wanted {
        wanted.extend(factors);
    }
}

/// The form factors of all polygons by their numbers.
fn dense(sums: &Sums, polygons: usize, factors: &mut Vec<f64>) {
    factors.clear();
    factors.resize(polygons, 0.0);
    for sum in &sums.polygons {
        factors[sum.polygon.index()] = sum.both();
    }
}
