//! Form factors from points, and between patches: the matrix of radiation exchange, row by row.

mod points;
mod row;

pub use points::{By, PointError, PointFactors, PointSolver, PointsError};
pub use row::{Entry, PatchInfo, Row, Share};
