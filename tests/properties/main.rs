//! Property tests: what must hold of every scene and every eye, and how answers change when the question does.
//!
//! A case that fails is printed as Rust: paste it into tests/regressions.rs.

mod bsp;
mod laws;
mod moved;
mod proof;
mod regions;
mod tiling;
mod ways;

use glam::DVec3;
use nusselt::testing::Mode;
use proptest::prelude::*;

/// So many cases as `n`, or as `PROPTEST_CASES` asks for.
fn cases(n: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok());
    ProptestConfig { cases: asked.unwrap_or(n), max_shrink_iters: 2_000, ..ProptestConfig::default() }
}

/// Any mode.
fn mode() -> impl Strategy<Value = Mode> {
    prop_oneof![2 => Just(Mode::Grid), 1 => Just(Mode::Chaos)]
}

/// Sixty directions with small whole coordinates, exact under axis maps and scaling, from a seed: so
/// that a failure prints a number rather than a page.
fn grid_directions(seed: u64) -> Vec<DVec3> {
    let mut state = seed;
    let mut coordinate = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % 41) as f64 - 20.0
    };
    (0..60).map(|_| DVec3::new(coordinate(), coordinate(), coordinate())).filter(|&d| d != DVec3::ZERO).collect()
}

/// A check's verdict as a test's.
fn hold<T, E: std::fmt::Display>(verdict: Result<T, E>) -> Result<T, TestCaseError> {
    verdict.map_err(|defect| TestCaseError::fail(defect.to_string()))
}
