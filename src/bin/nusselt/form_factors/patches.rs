//! `--patches`: which row is where.

use super::options;
use crate::failure::Failure;
use crate::output::{is_same_file, write_file};
use nusselt::factors::PatchInfo;
use nusselt::io::matrix::{MatrixWriter, PatchesFormat};
use std::path::Path;

/// Refuses a file of patches that is one of the files of the matrix, too.
pub(super) fn keep_apart(patches: Option<&Path>, matrix: Option<&Path>) -> Result<(), Failure> {
    let (Some(patches), Some(matrix)) = (patches, matrix) else { return Ok(()) };
    if MatrixWriter::files(matrix).iter().any(|file| is_same_file(file, patches)) {
        let what = "--patches and -o would write the same file; name two";
        return Err(Failure::Usage(format!("{}: {what}", patches.display())));
    }
    Ok(())
}

pub(super) fn write(path: &Path, patches: &[PatchInfo]) -> Result<(), Failure> {
    let format = PatchesFormat::of(path).ok_or_else(|| Failure::Usage(options::NOT_PATCHES.to_owned()))?;
    write_file(path, |out| format.write(patches, out))
}
