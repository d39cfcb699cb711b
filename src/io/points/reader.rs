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
    /// What comes after the points that were read.
    failure: Option<ReadError>,
    /// Whether nothing may be waited for as long as there is something.
    is_live: bool,
}

impl<R: Read> PointReader<R> {
    /// Reads from anything; it is read in large pieces. `name` is what messages call it.
    pub fn new(reader: R, name: impl Into<String>) -> Self {
        Self::of(Blocks::new(reader), name.into(), false)
    }

    /// Reads from something whose other end may wait for an answer, such as a pipe: points are given out as soon as their lines have come whole, ended by
    /// LF, as many as one call of `read` gives, up to some thousands.
    pub fn live(reader: R, name: impl Into<String>) -> Self {
        Self::of(Blocks::live(reader), name.into(), true)
    }

    fn of(blocks: Blocks<R>, name: String, is_live: bool) -> Self {
        let read = VecDeque::new();
        Self { blocks, name, read, is_first: true, found: 0, is_done: false, failure: None, is_live }
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
    /// [`ReadError::Invalid`] at the end if there was no point at all, and with the first line that is wrong, after the points before it. What
    /// follows that line is read to tell everything that is wrong (for as much as a gigabyte; of what is [`live`](PointReader::live), only what has
    /// come with it), and there are no further points. [`ReadError::Io`] if reading fails.
    pub fn next(&mut self, most: usize, points: &mut Vec<PointLine>) -> Result<bool, ReadError> {
        points.clear();
        while self.read.is_empty() {
            if let Some(failure) = self.failure.take() {
                return Err(failure);
            }
            if self.is_done {
                break;
            }
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
            if faults.is_empty() || self.is_live || taken > MOST_AFTER_FAULT {
                break;
            }
        }
        self.found += self.read.len() as u64;
        if !faults.is_empty() {
            self.is_done = true;
            self.failure = Some(ReadError::Invalid(faults));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use std::rc::Rc;

    /// Gives one piece of a text with each read, and counts them.
    struct Pieces(Vec<&'static str>, Rc<Cell<usize>>);

    impl Read for Pieces {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let count = self.1.get();
            self.1.set(count + 1);
            let piece = self.0.get(count).copied().unwrap_or_default().as_bytes();
            into[..piece.len()].copy_from_slice(piece);
            Ok(piece.len())
        }
    }

    #[test]
    fn what_has_come_is_given_out_before_more_is_read() {
        let pieces =
            vec!["x y z ", "nx ny nz\n1 2 3", " 0 0 1\n1 2", " 4 0 0 1\r\n1 2 5 0 0 1\n", "1 2 6 0 0 1\n1 x\n"];
        let reads = Rc::new(Cell::new(0));
        let mut reader = PointReader::live(Pieces(pieces, reads.clone()), "pipe");
        let mut points = Vec::new();
        let mut next = |most| {
            let more = reader.next(most, &mut points).map_err(|error| error.to_string())?;
            Ok::<_, String>((more, points.iter().map(|p| p.point.z).collect::<Vec<_>>(), reads.get()))
        };
        assert_eq!(next(9), Ok((true, vec![3.0], 3)));
        assert_eq!(next(1), Ok((true, vec![4.0], 4)));
        assert_eq!(next(9), Ok((true, vec![5.0], 4)), "no read for what is there");
        // Points before a line that is wrong, then the error without another read.
        assert_eq!(next(9), Ok((true, vec![6.0], 5)));
        let error = next(9).expect_err("not a point");
        assert!(error.starts_with("pipe:6: ") && reads.get() == 5, "{error}");
        assert_eq!(reader.next(9, &mut points).map_err(|error| error.to_string()), Ok(false));
        assert_eq!(reader.found(), 4);
    }
}
