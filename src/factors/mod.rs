//! Form factors from points ([`PointSolver`]), and between patches: the matrix of radiation exchange, row by row ([`Exchange`]).
//!
//! `F[i][j]` is the part of what leaves the front of patch i, diffusely, that arrives at the front of patch j; what arrives at backs and
//! what leaves the scene are told apart, so that every row sums to 1.
//!
//! `docs/form-factors.md` tells how, with what accuracy and at what cost.

mod blocker;
mod blockers;
mod bodies;
mod closure;
mod contacts;
mod contour;
mod cubature;
mod cut;
mod element;
mod element_pairs;
mod element_row;
mod error;
mod exchange;
mod facets;
mod footprints;
mod halving;
mod hidden;
mod lies;
mod mesh;
mod meshed;
mod options;
mod outlines;
mod pair;
mod partly;
mod patch_mesh;
mod pieces;
mod placement;
mod points;
mod quads;
mod received;
mod reciprocity;
mod rings;
mod row;
mod row_space;
mod rows_once;
mod rule;
mod screens;
mod seen;
mod shaft;
mod shape;
mod shared;
mod shut;
mod touching;
mod tree;
mod viewed;

pub use error::ExchangeError;
pub use exchange::Exchange;
pub use meshed::mesh_scene;
pub use options::{ExchangeOptions, PatchPlan, Sides};
pub use patch_mesh::PatchMesh;
pub use points::{By, PointError, PointFactors, PointSolver, PointsError};
pub(crate) use received::Receivers;
pub use reciprocity::{Reciprocal, ReciprocityError, make_reciprocal};
pub use row::{Entry, PatchInfo, PatchShape, Row, Share};
pub use rows_once::RowsOnce;
pub use viewed::ViewedRows;
