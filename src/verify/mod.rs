//! Checks that share no predicate with the engine.
//!
//! [`RayOracle`] tells what a single ray sees, by brute force over all pieces.

mod filter;
mod integers;
mod ray;

#[cfg(test)]
mod tests;

pub use ray::{RayAnswer, RayOracle, RayStats};
