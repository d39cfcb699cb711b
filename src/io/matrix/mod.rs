//! The matrix of form factors between patches as files: written row by row, resumed, and merged from parts.
//!
//! Rows go to disk as they come, in a file of rows beside the final one (`FILE.partial`, with `FILE.manifest.json` that tells what it
//! belongs to). When all are there, the final file is written from it and renamed. So memory does not grow with the rows, an
//! interrupted run goes on after its last whole row, and the final file does not depend on how often it was interrupted.
//!
//! ```
//! use nusselt::factors::{Entry, PatchInfo, Row, Share};
//! use nusselt::io::matrix::{MatrixJob, MatrixWriter};
//! use nusselt::scene::PolygonId;
//!
//! let scene = nusselt::samples::cornell_box().to_builder().build()?;
//! // Two patches that see half of each other, as something computes them.
//! let patch = |k| PatchInfo { name: format!("patch {k}"), polygon: PolygonId(k), area: 1.0, shape: None };
//! let patches = [patch(0), patch(1)];
//! let half = Share { factor: 0.5, error: 1e-9 };
//! let row = |patch| Row {
//!     patch,
//!     entries: vec![Entry { column: 1 - patch, share: half }],
//!     backs: Share::default(),
//!     background: half,
//!     closure_raw: 1.0,
//! };
//!
//! let job = MatrixJob::new(&scene, &patches).with_option("tolerance", 1e-4);
//! let path = std::env::temp_dir().join(format!("nusselt-doc-{}.csv", std::process::id()));
//! let mut writer = MatrixWriter::create(&path, &job)?; // or resume
//! for k in writer.next_row()..writer.end_row() {
//!     writer.row(&row(k))?;
//! }
//! writer.finish()?;
//! let text = std::fs::read_to_string(&path)?;
//! assert_eq!(text.lines().collect::<Vec<_>>(), [
//!     "row,column,factor,error",
//!     "0,1,0.5,1e-9",
//!     "0,background,0.5,1e-9",
//!     "1,0,0.5,1e-9",
//!     "1,background,0.5,1e-9",
//! ]);
//! # std::fs::remove_file(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod csv;
mod error;
mod format;
mod json;
mod manifest;
mod merge;
mod mtx;
mod npy;
#[cfg(feature = "parquet")]
mod parquet;
mod patches;
mod record;
mod rows;
mod writer;

#[cfg(test)]
mod tests;

pub use super::digest::Digest;
pub use csv::MatrixCsv;
pub use error::MatrixError;
pub use format::MatrixFormat;
pub use manifest::{MANIFEST_SCHEMA, Manifest, MatrixJob, scene_digest};
pub use merge::merge;
pub use patches::{PatchesFormat, read_patches};
pub use writer::MatrixWriter;

/// The schema of the matrix as JSON.
pub const FORM_FACTORS_SCHEMA: &str = "nusselt.form-factors/1";

/// What the last two columns are called in tables.
const BACKS: &str = "backs";
const BACKGROUND: &str = "background";
