//! Parts of a matrix put together.

use super::rows::{RowsReader, Source};
use super::{MatrixError, MatrixFormat};
use std::path::{Path, PathBuf};

/// Puts files of rows (`.rows`) together that have every row of a matrix once, in any order, and writes it all to `output`: the same file, byte
/// by byte, that one run over all rows writes. Memory: the patches of two parts and one row.
///
/// # Errors
/// If a part is no file of rows, is damaged, or is of another matrix than the first; if rows are missing or there twice; if the
/// output's ending is not known, it is one of the parts, or it cannot be written.
pub fn merge(parts: &[PathBuf], output: &Path) -> Result<(), MatrixError> {
    let format = MatrixFormat::of(output)?;
    let (first, others) = parts.split_first().ok_or(MatrixError::NoParts)?;
    if let Some(part) = parts.iter().find(|part| is_same(part, output)) {
        return Err(MatrixError::WouldOverwrite { path: part.clone() });
    }
    let RowsReader { mut manifest, patches, .. } = RowsReader::open(first)?;
    let mut pieces = vec![(manifest.rows(), first)];
    for path in others {
        let other = RowsReader::open(path)?.manifest;
        let differences = manifest.differences(&other);
        if !differences.is_empty() {
            return Err(MatrixError::OtherMatrix { path: path.clone(), first: first.clone(), differences });
        }
        pieces.push((other.rows(), path));
    }
    pieces.sort_by_key(|(rows, _)| (rows.start, rows.end));
    let mut next = 0;
    let mut former = first;
    for (rows, path) in &pieces {
        if rows.start > next {
            return Err(MatrixError::Gap { rows: next..rows.start });
        }
        if rows.start < next {
            let both = rows.start..next.min(rows.end);
            return Err(MatrixError::Overlap { first: former.clone(), second: (*path).clone(), rows: both });
        }
        next = rows.end;
        former = path;
    }
    if next < manifest.patches {
        return Err(MatrixError::Gap { rows: next..manifest.patches });
    }
    manifest.rows = [0, manifest.patches];
    let files = pieces.into_iter().map(|(_, path)| path.clone()).collect();
    format.write(output, &Source { files, manifest, patches })
}

fn is_same(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}
