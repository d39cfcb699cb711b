//! Form factors between patches: the matrix of radiation exchange, row by row.

mod row;

pub use row::{Entry, PatchInfo, Row, Share};
