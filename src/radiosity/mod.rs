//! Radiosity: what diffuse surfaces send to each other until nothing is left to send.
//!
//! [`Solver`] shoots (progressive refinement, Cohen, Chen, Wallace and Greenberg 1988) with the form factors of
//! [`Exchange`](crate::factors::Exchange), whose rows close: what one patch sends arrives at fronts, at backs, or leaves the scene, and nothing is lost.
//! [`Gather`] computes radiosities of points from the exact contour image above each, without error but that of the patches' radiosities; a [`Surface`] is
//! a mesh with such radiosities at its corners, finer where they change quickly.
//! [`uneven_patches`] tells which patches are too large for what changes on them; with those halved, [`Solver::start_from`] goes on.
//!
//! Radiosities and emitted radiances are linear RGB: a material's emission L is a radiosity of pi L, and so the picture of a surface of radiosity B has the radiance B / pi.

mod balance;
mod bounces;
mod corners;
mod error;
mod gather;
mod groups;
mod residual;
mod rings;
mod solver;
mod surface;
mod uneven;

pub use balance::Balance;
pub use bounces::Gathered;
pub use error::RadiosityError;
pub use gather::Gather;
pub(crate) use rings::{in_own_unit, normal, off};
pub use solver::{Shot, Solver, SolverOptions, SolverState};
pub use surface::{Surface, SurfaceOptions};
pub use uneven::uneven_patches;

use glam::DVec3;

/// The sum of red, green and blue, by which patches are compared.
fn strength(colour: DVec3) -> f64 {
    colour.element_sum()
}
