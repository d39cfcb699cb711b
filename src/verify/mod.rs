//! Checks that share no predicate with the engine.
//!
//! [`RayOracle`] tells what a single ray sees, by brute force over all pieces; [`outside`] has
//! whole images judged by a triangulation from another crate.

mod filter;
mod integers;
pub mod outside;
mod ray;

#[cfg(test)]
mod tests;

pub use ray::{RayAnswer, RayOracle, RayStats};
