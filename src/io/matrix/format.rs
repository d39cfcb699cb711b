//! The formats of the matrix, by the ending of the file's name.

use super::rows::{Source, Unwritten};
use super::{MatrixError, csv, json, mtx, npy, record};
use crate::io::atomic_write;
use std::io::Write;
use std::path::Path;

/// A format of files of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MatrixFormat {
    /// `.json`: schema [`FORM_FACTORS_SCHEMA`](super::FORM_FACTORS_SCHEMA), with patches, entries that are not zero, backs, background, sums of rows and
    /// what they were before any residue was placed.
    Json,
    /// `.csv`: the columns `row`, `column`, `factor` and `error`, a line for each entry that is not zero. The column is the number of a patch, `backs` or
    /// `background`.
    Csv,
    /// `.npy` (`NumPy` 1.0): dense, n x (n + 2) numbers of 64 bits, row by row; backs and background come last.
    Npy,
    /// `.mtx` (Matrix Market): sparse, numbered from 1, n x (n + 2) likewise.
    Mtx,
    /// `.parquet`: the table of [`MatrixFormat::Csv`].
    #[cfg(feature = "parquet")]
    Parquet,
    /// `.rows`: the file of rows itself, all or some of them, for [`merge`](super::merge()).
    Rows,
}

impl MatrixFormat {
    pub(super) const ENDINGS: &'static str = ".json, .csv, .npy, .mtx, .parquet, .rows";

    /// The format of a file, by the ending of its name, in upper or lower case.
    ///
    /// # Errors
    /// If it is not known, or not part of this build.
    pub fn of(path: &Path) -> Result<Self, MatrixError> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            "json" => Ok(Self::Json),
            "csv" => Ok(Self::Csv),
            "npy" => Ok(Self::Npy),
            "mtx" => Ok(Self::Mtx),
            "rows" => Ok(Self::Rows),
            #[cfg(feature = "parquet")]
            "parquet" => Ok(Self::Parquet),
            #[cfg(not(feature = "parquet"))]
            "parquet" => Err(MatrixError::NotBuilt { path: path.to_owned(), feature: "parquet" }),
            _ => Err(MatrixError::UnknownEnding { path: path.to_owned() }),
        }
    }

    /// Writes all rows to a file, whole or not at all.
    pub(super) fn write(self, path: &Path, source: &Source) -> Result<(), MatrixError> {
        let written = atomic_write(path, |out| match self {
            Self::Json => json::write(source, out),
            Self::Csv => csv::write(source, out),
            Self::Npy => npy::write(source, out),
            Self::Mtx => mtx::write(source, out),
            #[cfg(feature = "parquet")]
            Self::Parquet => super::parquet::write(source, out),
            Self::Rows => write_rows(source, out),
        });
        written.map_err(|error| error.about(path))
    }
}

/// Writes all that comes before the rows in a file of rows.
pub(super) fn write_head(source: &Source, out: &mut impl Write) -> std::io::Result<()> {
    out.write_all(record::MAGIC)?;
    record::write(out, &serde_json::to_vec(&source.manifest)?)?;
    source.patches.iter().try_for_each(|patch| record::write(out, &record::of_patch(patch)))
}

fn write_rows(source: &Source, out: &mut impl Write) -> Result<(), Unwritten> {
    write_head(source, out)?;
    let mut bytes = Vec::new();
    source.for_each(|row| {
        record::of_row(row, &mut bytes);
        record::write(out, &bytes)
    })
}
