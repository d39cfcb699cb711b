//! Rows to disk as they come.

use super::format::write_head;
use super::manifest::{Manifest, MatrixJob};
use super::rows::{NextRow, RowsReader, Source};
use super::{MatrixError, MatrixFormat, record};
use crate::factors::Row;
use crate::io::atomic_write;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Writes the rows of a matrix, or some of them, to a file: see the [module](super).
///
/// A writer that is dropped before [`MatrixWriter::finish`] leaves what it has, to be resumed. Memory: the patches and one row.
#[derive(Debug)]
pub struct MatrixWriter {
    path: PathBuf,
    format: MatrixFormat,
    partial: PathBuf,
    out: BufWriter<File>,
    manifest: Manifest,
    next: u32,
    bytes: Vec<u8>,
}

impl MatrixWriter {
    /// All files that a run with this final file writes: itself, and what is there until it is complete.
    pub fn files(path: &Path) -> [PathBuf; 3] {
        [path.to_owned(), partial(path), manifest_path(path)]
    }

    /// Starts a file. Its ending picks the format: see [`MatrixFormat`].
    ///
    /// # Errors
    /// [`MatrixError::Unfinished`] if there is something from an unfinished run. If the ending is not known, if only some of the rows are to be
    /// written but not as `.rows`, if there are no such rows, or if a file cannot be written.
    pub fn create(path: &Path, job: &MatrixJob<'_>) -> Result<Self, MatrixError> {
        let (format, manifest) = plan(path, job)?;
        Self::start(path, format, manifest, job)
    }

    /// Goes on with an unfinished run after its last whole row, or starts if there is none: see [`MatrixWriter::next_row`].
    ///
    /// # Errors
    /// [`MatrixError::Changed`] if the unfinished run was of another scene, with other options, of other patches or rows, or by another version of
    /// this crate. [`MatrixError::NotRows`] or [`MatrixError::Damaged`] if even its patches cannot be read. As [`MatrixWriter::create`] otherwise.
    pub fn resume(path: &Path, job: &MatrixJob<'_>) -> Result<Self, MatrixError> {
        Self::resume_with(path, job, |_| ())
    }

    /// The same, and hands over the rows that are there, in their order: for sums over all rows.
    ///
    /// # Errors
    /// As [`MatrixWriter::resume`].
    pub fn resume_with(path: &Path, job: &MatrixJob<'_>, mut kept: impl FnMut(&Row)) -> Result<Self, MatrixError> {
        let (format, manifest) = plan(path, job)?;
        let partial = partial(path);
        if !partial.try_exists().map_err(MatrixError::io(&partial))? {
            return Self::start(path, format, manifest, job);
        }
        let mut reader = RowsReader::open(&partial)?;
        let differences = reader.manifest.all_differences(&manifest);
        if !differences.is_empty() {
            return Err(MatrixError::Changed { path: partial, differences });
        }
        let mut place = reader.place();
        while let NextRow::Row(row) = reader.next()? {
            place = reader.place();
            kept(&row);
        }
        let next = reader.next_row();
        let open = || {
            let mut file = OpenOptions::new().write(true).open(&partial)?;
            file.set_len(place)?;
            file.seek(SeekFrom::End(0))?;
            Ok(BufWriter::new(file))
        };
        let out = open().map_err(MatrixError::io(&partial))?;
        Ok(Self { path: path.to_owned(), format, partial, out, manifest, next, bytes: Vec::new() })
    }

    fn start(path: &Path, format: MatrixFormat, manifest: Manifest, job: &MatrixJob<'_>) -> Result<Self, MatrixError> {
        let partial = partial(path);
        let manifest_path = manifest_path(path);
        if partial.try_exists().map_err(MatrixError::io(&partial))? {
            return Err(MatrixError::Unfinished { path: partial });
        }
        let source = Source { files: Vec::new(), manifest, patches: job.patches.to_vec() };
        // What comes before the rows is there as a whole, or the run has not started.
        atomic_write(&partial, |out| write_head(&source, out)).map_err(MatrixError::io(&partial))?;
        let write_manifest = |out: &mut BufWriter<File>| {
            serde_json::to_writer_pretty(&mut *out, &source.manifest)?;
            out.write_all(b"\n")
        };
        atomic_write(&manifest_path, write_manifest).map_err(MatrixError::io(&manifest_path))?;
        let file = OpenOptions::new().append(true).open(&partial).map_err(MatrixError::io(&partial))?;
        let Source { manifest, .. } = source;
        let next = manifest.rows[0];
        Ok(Self {
            path: path.to_owned(),
            format,
            partial,
            out: BufWriter::new(file),
            manifest,
            next,
            bytes: Vec::new(),
        })
    }

    /// The number of the row that is to come next.
    pub fn next_row(&self) -> u32 {
        self.next
    }

    /// One more than the number of the last row.
    pub fn end_row(&self) -> u32 {
        self.manifest.rows[1]
    }

    /// What the run belongs to.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Writes the next row; it is in the file when this returns.
    ///
    /// # Errors
    /// If it is not the next row, if its columns do not ascend or do not exist, if a number is not finite, or if writing fails. After
    /// any error but the last the writer can go on.
    pub fn row(&mut self, row: &Row) -> Result<(), MatrixError> {
        if row.patch != self.next || self.next == self.end_row() {
            return Err(MatrixError::OutOfOrder { expected: self.next, found: row.patch });
        }
        if let Some(what) = record::fault(row, self.manifest.patches) {
            return Err(MatrixError::BadRow { row: row.patch, what });
        }
        record::of_row(row, &mut self.bytes);
        let written = record::write(&mut self.out, &self.bytes).and_then(|()| self.out.flush());
        written.map_err(MatrixError::io(&self.partial))?;
        self.next += 1;
        Ok(())
    }

    /// Gives the run up: removes what there is of it.
    ///
    /// # Errors
    /// If a file cannot be removed.
    pub fn discard(self) -> Result<(), MatrixError> {
        let Self { path, partial, out, .. } = self;
        drop(out);
        let manifest = manifest_path(&path);
        [partial, manifest].iter().try_for_each(|file| fs::remove_file(file).map_err(MatrixError::io(file)))
    }

    /// Writes the final file from the rows, renames it, and removes what the unfinished run left.
    ///
    /// # Errors
    /// If rows are missing, or a file cannot be read or written; the run can be resumed then.
    pub fn finish(mut self) -> Result<(), MatrixError> {
        if self.next < self.end_row() {
            return Err(MatrixError::Incomplete { missing: self.next..self.end_row() });
        }
        let synced = self.out.flush().and_then(|()| self.out.get_ref().sync_all());
        synced.map_err(MatrixError::io(&self.partial))?;
        if self.format == MatrixFormat::Rows {
            fs::rename(&self.partial, &self.path).map_err(MatrixError::io(&self.path))?;
        } else {
            let RowsReader { patches, manifest, .. } = RowsReader::open(&self.partial)?;
            let source = Source { files: vec![self.partial.clone()], manifest, patches };
            self.format.write(&self.path, &source)?;
            fs::remove_file(&self.partial).map_err(MatrixError::io(&self.partial))?;
        }
        let manifest = manifest_path(&self.path);
        match fs::remove_file(&manifest) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(MatrixError::io(&manifest)(error)),
            _ => Ok(()),
        }
    }
}

/// What is to be written, as far as it can be told before anything is.
fn plan(path: &Path, job: &MatrixJob<'_>) -> Result<(MatrixFormat, Manifest), MatrixError> {
    let format = MatrixFormat::of(path)?;
    let manifest = job.manifest()?;
    if format != MatrixFormat::Rows && !manifest.is_whole() {
        return Err(MatrixError::PartFormat { path: path.to_owned() });
    }
    Ok((format, manifest))
}

fn partial(path: &Path) -> PathBuf {
    beside(path, ".partial")
}

fn manifest_path(path: &Path) -> PathBuf {
    beside(path, ".manifest.json")
}

fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    path.with_file_name(name)
}
