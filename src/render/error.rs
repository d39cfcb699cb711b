//! Why there is no picture.

use crate::brdf::{BrdfError, ReflectError};
use crate::contour::{SurfaceError, ViewError};
use crate::hemicube::BaselineError;
use crate::picture::SizeError;
use crate::scene::PolygonId;

/// Why there is no picture, or no radiance of a point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A picture of that size cannot be made.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// A material has no BRDF.
    #[error("material {material:?}: {source}")]
    Material {
        /// Its name.
        material: String,
        /// Why.
        source: BrdfError,
    },
    /// There are not as many BRDFs as materials.
    #[error("{found} BRDFs are given for {expected} materials")]
    WrongBrdfs {
        /// How many are given.
        found: usize,
        /// How many materials there are.
        expected: usize,
    },
    /// The patches of interreflection are not those of the scene.
    #[error("the patches of interreflection are of {found} polygons, but the scene has {expected}")]
    OtherPatches {
        /// How many polygons they are of, at least.
        found: usize,
        /// How many the scene has.
        expected: usize,
    },
    /// There is no such hemicube, or no ray.
    #[error(transparent)]
    Baseline(#[from] BaselineError),
    /// A light without extent is not fit for use.
    #[error(transparent)]
    Light(ReflectError),
    /// A radiance is more than numbers hold.
    #[error(
        "the light in column {x}, row {y} of the picture is brighter than numbers hold (1e308); make emissions and lights smaller"
    )]
    TooBright {
        /// The pixel's column, from 0 at the left.
        x: u32,
        /// Its row, from 0 at the top.
        y: u32,
    },
    /// There is no view of the camera, or from a light.
    #[error("no view from {from}: {source}")]
    View {
        /// From where.
        from: &'static str,
        /// Why.
        source: ViewError,
    },
    /// There is no view from a point that is seen.
    #[error("no view from polygon {polygon}: {source}")]
    Point {
        /// The polygon that it is on.
        polygon: PolygonId,
        /// Why.
        source: ViewError,
    },
    /// A point is on no surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// No light is reflected from a point.
    #[error("polygon {polygon}: {source}")]
    Reflect {
        /// The polygon that it is on.
        polygon: PolygonId,
        /// Why.
        source: ReflectError,
    },
}
