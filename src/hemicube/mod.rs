//! Baselines that the contour image is compared with: the hemicube, the hemicube with analytic form factors, and rays.
//!
//! - [`Hemicube`]: form factors by z-buffers on the five faces of half a cube (Cohen and Greenberg 1985).
//! - [`Hemicube::analytic`]: visibility by the same z-buffers, form factors by the analytic formula (after Baum,
//!   Rushmeier and Winget 1989).
//! - `Rays`, with the feature `rays`: the share of cosine-distributed rays that meet a polygon.
//!
//! [`compare`] takes the same views with all of them and with the contour image, and tells times and errors.
//!
//! They are approximations, made as fast as they can well be, so that a comparison with them is worth
//! something. What was and what was not optimised: `docs/comparison.md`.
//!
//! Sources: M. Cohen, D. Greenberg, *The Hemi-Cube: A Radiosity Solution for Complex Environments*, SIGGRAPH 1985. D. Baum,
//! H. Rushmeier, J. Winget, *Improving Radiosity Solutions Through the Use of Analytically Determined Form-Factors*, SIGGRAPH 1989.

mod analytic;
mod compare;
mod delta;
mod deviations;
mod error;
mod face;
mod geometry;
mod raster;
#[cfg(feature = "rays")]
mod rays;
mod runs;
mod view;

pub use analytic::AnalyticView;
pub use compare::{CompareError, ComparisonRow, Method, compare, reference_method};
pub use deviations::Deviations;
pub use error::BaselineError;
pub use face::Face;
#[cfg(feature = "rays")]
pub use rays::{Rays, RaysView};
pub use view::{Hemicube, HemicubePixel, HemicubeStats, HemicubeView};
