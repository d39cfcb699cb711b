//! Exact signs: the kernel on which every decision of this crate stands.
//!
//! Nothing here knows about scenes. A predicate returns a [`Sign`], never a number, and the sign is
//! the sign of the real-number expression for every finite input.

mod approx;
mod approximate;
mod arena;
mod ball;
mod boxes;
mod construct;
mod definition;
pub(crate) mod double;
mod fixed;
mod frame;
mod kernel;
mod orient;
mod reach;
mod sign;
mod stats;
#[cfg(test)]
mod tests;
mod zeros;

pub use definition::{Direction, Plane, Point, Splitter};
pub use kernel::{Along, CircleRelation, DirectionId, Kernel, SplitterId};
pub use orient::orient3d;
pub use sign::Sign;
pub use stats::PredicateStats;

pub(crate) use approx::{Approx3, U, power_of_two_at_most};
pub(crate) use approximate::{ApproxPlane, ApproxPoint};
pub(crate) use arena::{Arena, Kept3};
pub(crate) use boxes::SeenBox;
pub(crate) use construct::Constructor;
pub(crate) use frame::{BitRange, Frame};
pub(crate) use reach::SeenPlane;
pub(crate) use zeros::ZeroComponents;
