//! Points as they are read, a few at a time.

use super::super::error::{Faults, Place, ReadError};
use super::super::lines::lines_after;
use super::blocks::{Block, Blocks};
use super::{PointLine, fields, is_header, point};
use std::collections::VecDeque;
use std::io::{self, Read};
use std::path::PathBuf;

/// After the first fault so many bytes more are read, to tell all that is wrong. Standard input may never end.
const MOST_AFTER_FAULT: u64 = 1 << 30;

/// Reads points a few at a time, from files of any length, in a few megabytes of memory: text as [`parse_points`](super::parse_points) takes it.
///
/// ```
/// use nusselt::io::PointReader;
/// let text = "x,y,z,nx,ny,nz\n1,2,0.5,0,0,1\n1,3,0.5,0,0,1\n2,3,0.5,0,0,1\n";
/// let mut reader = PointReader::new(text.as_bytes(), "sensors.csv");
/// let mut points = Vec::new();
/// let mut counts = Vec::new();
/// while reader.next(2, &mut points)? {
///     counts.push(points.len());
/// }
/// assert_eq!(counts, [2, 1]);
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
pub struct PointReader<R> {
    blocks: Blocks<R>,
    name: String,
    read: VecDeque<PointLine>,
    is_first: bool,
    found: u64,
    is_done: bool,
}

impl<R: Read> PointReader<R> {
    /// Reads from anything; it is read in large pieces. `name` is what messages call it.
    pub fn new(reader: R, name: impl Into<String>) -> Self {
        let name = name.into();
        Self { blocks: Blocks::new(reader), name, read: VecDeque::new(), is_first: true, found: 0, is_done: false }
    }

    /// What it reads from, as far as it was read: at first untouched.
    pub fn into_inner(self) -> R {
        self.blocks.into_inner()
    }

    /// How many points were given out or are about to be.
    pub fn found(&self) -> u64 {
        self.found
    }

    /// Puts the next points, at most so many and at least one, in the place of those in `points`. False at the end: then there are none.
    ///
    /// # Errors
    /// [`ReadError::Invalid`] at the end if there was no point at all. With the first line that is wrong: points from the same megabyte
    /// are not given out, what follows is read to tell everything that is wrong (for as much as a gigabyte), and there
    /// are no further points. [`ReadError::Io`] if reading fails.
    pub fn next(&mut self, most: usize, points: &mut Vec<PointLine>) -> Result<bool, ReadError> {
        points.clear();
        while self.read.is_empty() && !self.is_done {
            self.read_block()?;
        }
        points.extend(self.read.drain(..most.max(1).min(self.read.len())));
        Ok(!points.is_empty())
    }

    fn read_block(&mut self) -> Result<(), ReadError> {
        let mut faults = Faults::default();
        let mut taken = 0;
        loop {
            let failed = |source: io::Error| ReadError::Io { path: PathBuf::from(&self.name), source };
            match self.blocks.next().map_err(failed) {
                Err(error) => {
                    self.is_done = true;
                    return Err(error);
                }
                Ok(None) => {
                    self.is_done = true;
                    if self.found == 0 && faults.is_empty() {
                        faults.note(&self.name, Place::File, "it has no points; a line is x y z nx ny nz [polygon]");
                    }
                    break;
                }
                Ok(Some(Block::TooLong(number))) => {
                    self.is_first = false;
                    faults.note(&self.name, Place::Line(number), "the line is longer than a megabyte");
                }
                Ok(Some(Block::Lines(bytes, before))) => {
                    taken += if faults.is_empty() { 0 } else { bytes.len() as u64 };
                    for line in lines_after(bytes, before) {
                        let fields = fields(&line.text);
                        if std::mem::take(&mut self.is_first) && is_header(&fields) {
                            continue;
                        }
                        match point(line.number, &fields) {
                            Ok(point) if faults.is_empty() => self.read.push_back(point),
                            Ok(_) => {}
                            Err(what) => faults.note(&self.name, Place::Line(line.number), what),
                        }
                    }
                }
            }
            if faults.is_empty() || taken > MOST_AFTER_FAULT {
                break;
            }
        }
        if faults.is_empty() {
            self.found += self.read.len() as u64;
            return Ok(());
        }
        self.is_done = true;
        self.read.clear();
        Err(ReadError::Invalid(faults))
    }
}
