//! What can go wrong when a scene is read.

use crate::scene::DropCause;
use std::fmt;
use std::path::PathBuf;

/// Why a scene could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("cannot read {}: {source}{}", path.display(), advice(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The ending of the file name is not known, and its content is that of no format that can be told by it.
    #[error("cannot read {}: its ending is not one of {known}, nor is its content; convert it or rename it", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// The endings that are known.
        known: String,
    },
    /// The reader for the format is not part of this build.
    #[error("cannot read {}: it is {format}, and this build is without the feature {feature}; build it with", path.display())]
    NotBuilt {
        /// The file.
        path: PathBuf,
        /// What the format is called.
        format: &'static str,
        /// The feature of the crate that has the reader.
        feature: &'static str,
    },
    /// What the file contains cannot be used.
    #[error("{0}")]
    Invalid(Faults),
}

/// What to do about what the system says, to be written after it.
pub(super) fn advice(error: &std::io::Error) -> &'static str {
    match error.kind() {
        std::io::ErrorKind::NotFound => "; check the name and the folder",
        std::io::ErrorKind::PermissionDenied => "; allow reading it, or copy it",
        _ => "",
    }
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line, from 1.
    Line(usize),
    /// A part that the format has a name or a number for: `mesh 0, primitive 2, triangle 7`.
    Item(String),
}

impl Place {
    /// The place with the name of its file, as messages start: `a.obj:7` or `a.glb: mesh 0`.
    pub(super) fn within(&self, file: &str) -> String {
        match self {
            Self::File => file.to_owned(),
            Self::Line(line) => format!("{file}:{line}"),
            Self::Item(item) => format!("{file}: {item}"),
        }
    }
}

/// One thing that is wrong in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The name of the file.
    pub file: String,
    /// Where in it.
    pub place: Place,
    /// What is wrong and what to do.
    pub what: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place.within(&self.file), self.what)
    }
}

/// Everything that is wrong in a file. Shown are the first few, one a line, and how many more there are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    kept: Vec<Fault>,
    count: usize,
    causes: Vec<DropCause>,
}

impl Faults {
    /// So many are kept; a file of garbage may have one in every line.
    const KEPT: usize = 10_000;
    /// So many are shown.
    const SHOWN: usize = 8;

    /// Notes a fault; past the first ten thousand they are only counted.
    pub(crate) fn note(&mut self, file: &str, place: Place, what: impl fmt::Display) {
        self.count += 1;
        if self.kept.len() < Self::KEPT {
            self.kept.push(Fault { file: file.to_owned(), place, what: what.to_string() });
        }
    }

    /// Notes that a fault would have been none with the policy that drops such faces.
    pub(crate) fn note_cause(&mut self, cause: DropCause) {
        if !self.causes.contains(&cause) {
            self.causes.push(cause);
        }
    }

    /// The policies of a [`Repair`](crate::scene::Repair) that drop faces with faults like some of these.
    pub fn droppable(&self) -> &[DropCause] {
        &self.causes
    }

    /// Puts them in order of file and line; what is not in a line comes first, as it was noted.
    pub(crate) fn sort(&mut self) {
        let line = |fault: &Fault| if let Place::Line(line) = fault.place { line } else { 0 };
        self.kept.sort_by(|a, b| a.file.cmp(&b.file).then(line(a).cmp(&line(b))));
    }

    /// The faults, in order of their places; at most the first ten thousand.
    pub fn list(&self) -> &[Fault] {
        &self.kept
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, fault) in self.kept.iter().take(Self::SHOWN).enumerate() {
            if k > 0 {
                f.write_str("\n")?;
            }
            fault.fmt(f)?;
        }
        match self.count.saturating_sub(Self::SHOWN) {
            0 => Ok(()),
            more => write!(f, "\nand {more} more"),
        }
    }
}
