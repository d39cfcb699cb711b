//! What the checker asks of an arithmetic. Two answer: the engine's kernel, and plain rational numbers.

use super::evidence::HalfSphere;
use crate::exact::{Plane, Sign, Splitter};
use glam::DVec3;

/// Exact signs seen from one eye. Splitters and planes are named by the order in which they were taken
/// in, each from 0.
pub(super) trait Signs {
    /// Takes in a great circle.
    fn add(&mut self, splitter: &Splitter) -> u32;

    /// Takes in a plane.
    fn add_plane(&mut self, plane: &Plane) -> u32;

    /// The sign of `n_1 . (n_2 x n_3)`.
    fn orientation(&mut self, splitters: [u32; 3]) -> Sign;

    /// The sign of `n . d`.
    fn side(&mut self, direction: DVec3, splitter: u32) -> Sign;

    /// The sign of `N . (p - a)`: on which side of a plane a point is.
    fn height(&mut self, point: DVec3, plane: u32) -> Sign;

    /// For each splitter one on the same great circle that stands for all on it, and whether the two are
    /// oriented alike. Splitters without a great circle, as their normal is 0, stand for themselves.
    ///
    /// `None` if so many of them nearly coincide that telling them apart would take too long.
    fn great_circles(&mut self) -> Option<Vec<(u32, Sign)>>;

    /// True if the inside of a box certainly lies outside of one of the half spheres.
    fn box_outside(&mut self, sides: &[HalfSphere], corners: [DVec3; 2]) -> bool;

    /// True if a box certainly lies on that side of a plane, and does not touch it.
    fn box_beyond(&mut self, plane: u32, side: Sign, corners: [DVec3; 2]) -> bool;

    /// A splitter that was taken in.
    fn definition(&self, splitter: u32) -> &Splitter;

    /// A normal in floating point, for messages and for what need not be exact.
    fn rounded(&self, splitter: u32) -> DVec3;

    /// How many signs were decided.
    fn decisions(&self) -> u64;
}
