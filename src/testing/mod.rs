//! Tools for property tests, fuzzing and regression tests, for this crate and for others. Feature `testing`.
//!
//! - *Strategies* for `proptest`, all of them functions: scenes ([`scene`], [`closed_scene`],
//!   [`near_coplanar_pair`], ...), eyes ([`viewpoint`], [`viewpoint_on_edge`], ...), both together ([`case`]), numbers
//!   ([`coordinate`], [`few_ulps_from`]). They have two [`Mode`]s: a coarse grid, where everything coincides
//!   and answers must match exactly, and chaos, anything finite.
//! - [`Case::decode`] makes a case of the bytes of a fuzzer, and every [`Case`] prints itself as Rust.
//! - [`gallery`]: degenerate scenes by name.
//! - *Checks*, which return a [`Defect`] rather than panic: [`check_image`] for a contour image, [`check_bsp`] for a 3D
//!   BSP, [`check_regions`] for the visible regions of an image, [`check_same_view`] and [`check_same_bits`] for two images that must agree, and their parts.
//! - [`RayOracle`], which tells exactly what one ray sees.
//!
//! ```
//! use nusselt::testing::{Mode, case, check_image};
//! use proptest::test_runner::{Config, TestRunner};
//!
//! let mut runner = TestRunner::new(Config { cases: 4, ..Config::default() });
//! runner.run(&case(Mode::Grid), |case| {
//!     let image = case.image().expect("cases on the grid have images");
//!     check_image(&image).expect("the cells tile, and show what is nearest");
//!     Ok(())
//! })?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod case;
mod check;
mod decode;
mod faces;
pub mod gallery;
mod integers;
mod mutants;
mod numbers;
mod scenes;
mod viewpoints;

pub use crate::verify::{RayAnswer, RayOracle};
pub use case::{Case, CaseError, CaseWindows, Outlook, case, case_of};
pub use check::{
    Defect, FragmentFault, angle_tolerance, check_bsp, check_closed, check_fragments, check_image, check_labels,
    check_mirror, check_order, check_regions, check_same_bits, check_same_regions, check_same_view, check_sums,
    check_tiling, inner_directions, telling_directions,
};
pub use faces::Faces;
pub use mutants::{check_verdict, mutated};
pub use numbers::{
    AxisMap, GRID, Mode, axis_map, chaos_coordinate, coordinate, direction, few_ulps_from, grid_coordinate, nudged,
    point,
};
pub use scenes::{
    INSIDE, closed_scene, coplanar_overlaps, cyclic_overlap, duplicates, interpenetrating, mesh_soup,
    near_coplanar_pair, point_inside, scene, t_junctions, tiles, triangle_soup,
};
pub use viewpoints::{free_viewpoint, viewpoint, viewpoint_in_plane, viewpoint_on_edge, viewpoint_on_vertex};
