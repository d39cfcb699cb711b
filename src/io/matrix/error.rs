//! What can go wrong with files of the matrix.

use crate::scene::PolygonId;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Why there is no file of the matrix, or none that can be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MatrixError {
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The ending of the file's name is not known.
    #[error("{}: its ending is none of {}", path.display(), super::MatrixFormat::ENDINGS)]
    UnknownEnding {
        /// The file.
        path: PathBuf,
    },
    /// The writer of the format is not part of this build.
    #[error("{}: this build is without the feature {feature}; build it with --features {feature}, or take another ending", path.display())]
    NotBuilt {
        /// The file.
        path: PathBuf,
        /// The feature of the crate that has it.
        feature: &'static str,
    },
    /// Some of the rows in a format for all of them.
    #[error("{}: some of the rows are written as .rows, to be merged; name such a file", path.display())]
    PartFormat {
        /// The file.
        path: PathBuf,
    },
    /// There are no such rows.
    #[error("there are no rows {}..{}: the matrix has {count}, numbered from 0", rows.start, rows.end)]
    BadRange {
        /// The rows asked for.
        rows: Range<u32>,
        /// How many there are.
        count: u32,
    },
    /// More patches than 32 bits number.
    #[error("{count} patches are too many; make them larger")]
    TooManyPatches {
        /// How many there are.
        count: usize,
    },
    /// The area of a patch is beyond what numbers hold.
    #[error(
        "the area of patch {patch} (polygon {polygon}) is {area:e} in square scene units, beyond the range of numbers; scale the scene"
    )]
    BadArea {
        /// The patch.
        patch: usize,
        /// The polygon that it is, or is part of.
        polygon: PolygonId,
        /// What comes out: infinite, or 0 where it is not.
        area: f64,
    },
    /// An unfinished run is in the way.
    #[error("{} is there from an unfinished run; resume it, or delete it to start again", path.display())]
    Unfinished {
        /// Its file of rows.
        path: PathBuf,
    },
    /// An unfinished run was of another scene, with other options, of other patches or rows.
    #[error("{} is of another run: {}; run it as before, or delete it to start again", path.display(), differences.join("; "))]
    Changed {
        /// Its file of rows.
        path: PathBuf,
        /// What differs.
        differences: Vec<String>,
    },
    /// A row that is not the next one.
    #[error("row {found} came where row {expected} is next")]
    OutOfOrder {
        /// The number of the next row.
        expected: u32,
        /// That of the row that came.
        found: u32,
    },
    /// A row with numbers that it cannot have.
    #[error("row {row}: {what}")]
    BadRow {
        /// Its number.
        row: u32,
        /// What is wrong.
        what: &'static str,
    },
    /// Rows are missing at the end.
    #[error("rows {}..{} are missing", missing.start, missing.end)]
    Incomplete {
        /// Those that did not come.
        missing: Range<u32>,
    },
    /// The file is no file of rows.
    #[error("{}: it is not a file of rows (.rows, .partial) of this program; check the name", path.display())]
    NotRows {
        /// The file.
        path: PathBuf,
    },
    /// A file of rows has been cut off or changed.
    #[error("{}: {what}; delete it, and compute it again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where, and what is wrong.
        what: String,
    },
    /// There is nothing to merge.
    #[error("name the parts to be merged")]
    NoParts,
    /// A part is of another matrix than the first.
    #[error("{} does not go with {}: {}", path.display(), first.display(), differences.join("; "))]
    OtherMatrix {
        /// The part.
        path: PathBuf,
        /// The first part.
        first: PathBuf,
        /// What differs.
        differences: Vec<String>,
    },
    /// No part has some of the rows.
    #[error("no part has the rows {}..{}", rows.start, rows.end)]
    Gap {
        /// These.
        rows: Range<u32>,
    },
    /// Two parts have some of the rows.
    #[error("{} and {} both have the rows {}..{}", first.display(), second.display(), rows.start, rows.end)]
    Overlap {
        /// The one.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// These.
        rows: Range<u32>,
    },
    /// The merged file would replace a part.
    #[error("{} is a part that is read; name another file", path.display())]
    WouldOverwrite {
        /// The part.
        path: PathBuf,
    },
}

impl MatrixError {
    /// With the name of the file.
    pub(super) fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        |source| Self::Io { path, source }
    }

    pub(super) fn damaged(path: &Path, what: impl Into<String>) -> Self {
        Self::Damaged { path: path.to_owned(), what: what.into() }
    }
}
