//! Reading files of rows. They may hold anything: what they say is checked, and memory is in proportion to what is there.

use super::manifest::{MANIFEST_SCHEMA, Manifest, patches_digest};
use super::{MatrixError, record};
use crate::factors::{PatchInfo, Row};
use crate::io::open_regular;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

/// A manifest takes no more.
const MOST_MANIFEST: usize = 1 << 20;

/// A file of rows that is being read.
pub(super) struct RowsReader {
    path: PathBuf,
    input: BufReader<File>,
    /// Bytes that were not read yet.
    left: u64,
    length: u64,
    bytes: Vec<u8>,
    pub(super) manifest: Manifest,
    pub(super) patches: Vec<PatchInfo>,
    next: u32,
}

/// The next record of a file of rows.
pub(super) enum NextRow {
    Row(Row),
    /// All rows of the manifest have been read, and nothing follows.
    End,
    /// What follows the last whole row is no whole row, or nothing.
    Broken,
}

impl RowsReader {
    /// Opens a file and reads all that comes before the rows.
    pub(super) fn open(path: &Path) -> Result<Self, MatrixError> {
        let file = open_regular(path).map_err(MatrixError::io(path))?;
        let length = file.metadata().map_err(MatrixError::io(path))?.len();
        let mut input = BufReader::with_capacity(1 << 16, file);
        let mut magic = [0; 16];
        match input.read_exact(&mut magic) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {}
            read => read.map_err(MatrixError::io(path))?,
        }
        if magic != *record::MAGIC {
            return Err(MatrixError::NotRows { path: path.to_owned() });
        }
        let (mut left, mut bytes) = (length.saturating_sub(16), Vec::new());
        let mut next = |what: &str| {
            let read = record::read(&mut input, &mut left, &mut bytes).map_err(MatrixError::io(path))?;
            read.ok_or_else(|| MatrixError::damaged(path, format!("{what} is cut off or changed")))?;
            Ok::<_, MatrixError>(std::mem::take(&mut bytes))
        };
        let text = next("its manifest")?;
        let manifest = (text.len() <= MOST_MANIFEST).then(|| serde_json::from_slice::<Manifest>(&text).ok());
        let bad = || MatrixError::damaged(path, "its manifest cannot be read");
        let manifest =
            manifest.flatten().filter(|m| m.rows[0] <= m.rows[1] && m.rows[1] <= m.patches).ok_or_else(bad)?;
        if manifest.schema != MANIFEST_SCHEMA {
            return Err(MatrixError::NotRows { path: path.to_owned() });
        }
        let mut patches = Vec::new();
        for k in 0..manifest.patches {
            let bytes = next(&format!("patch {k}"))?;
            let patch = record::to_patch(&bytes);
            patches.push(patch.ok_or_else(|| MatrixError::damaged(path, format!("patch {k} cannot be read")))?);
        }
        if patches_digest(&patches) != manifest.patches_digest {
            return Err(MatrixError::damaged(path, "its patches are not those of its manifest"));
        }
        let next = manifest.rows[0];
        Ok(Self { path: path.to_owned(), input, left, length, bytes, manifest, patches, next })
    }

    /// The number of the next row.
    pub(super) fn next_row(&self) -> u32 {
        self.next
    }

    /// How many bytes were read.
    pub(super) fn place(&self) -> u64 {
        self.length - self.left
    }

    /// Reads the next record.
    pub(super) fn next(&mut self) -> Result<NextRow, MatrixError> {
        if self.next == self.manifest.rows[1] {
            return Ok(if self.left == 0 { NextRow::End } else { NextRow::Broken });
        }
        let read =
            record::read(&mut self.input, &mut self.left, &mut self.bytes).map_err(MatrixError::io(&self.path))?;
        let row = read.and_then(|()| record::to_row(&self.bytes));
        let row = row.filter(|row| row.patch == self.next && record::fault(row, self.manifest.patches).is_none());
        let Some(row) = row else { return Ok(NextRow::Broken) };
        self.next += 1;
        Ok(NextRow::Row(row))
    }

    /// Hands on all rows, which must be there.
    pub(super) fn for_each<E: From<MatrixError>>(mut self, mut f: impl FnMut(&Row) -> Result<(), E>) -> Result<(), E> {
        loop {
            match self.next()? {
                NextRow::Row(row) => f(&row)?,
                NextRow::End => return Ok(()),
                NextRow::Broken => {
                    let what = if self.next == self.manifest.rows[1] {
                        "something follows its last row".to_owned()
                    } else {
                        format!("row {} is missing, cut off or changed", self.next)
                    };
                    return Err(MatrixError::damaged(&self.path, what).into());
                }
            }
        }
    }
}

/// Rows of a matrix that may be gone through more than once: files of rows that have them all together, in order.
pub(super) struct Source {
    pub(super) files: Vec<PathBuf>,
    pub(super) manifest: Manifest,
    pub(super) patches: Vec<PatchInfo>,
}

impl Source {
    /// Hands on all rows in order.
    pub(super) fn for_each(&self, mut f: impl FnMut(&Row) -> io::Result<()>) -> Result<(), Unwritten> {
        for path in &self.files {
            let reader = RowsReader::open(path)?;
            reader.for_each(|row| f(row).map_err(Unwritten::from))?;
        }
        Ok(())
    }
}

/// Why a file was not written: reading the rows failed, or writing.
pub(super) enum Unwritten {
    Rows(MatrixError),
    Io(io::Error),
}

impl From<MatrixError> for Unwritten {
    fn from(error: MatrixError) -> Self {
        Self::Rows(error)
    }
}

impl From<io::Error> for Unwritten {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Unwritten {
    /// With the name of the file that was to be written.
    pub(super) fn about(self, path: &Path) -> MatrixError {
        match self {
            Self::Rows(error) => error,
            Self::Io(source) => MatrixError::Io { path: path.to_owned(), source },
        }
    }
}
