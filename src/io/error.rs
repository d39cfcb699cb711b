//! What can go wrong when a scene is read.

use std::fmt;
use std::path::PathBuf;

/// Why a scene could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// There is no reader for the ending of the file name.
    #[error("cannot read {}: its ending is not one of {known}; convert it or rename it", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// The endings that are known.
        known: String,
    },
    /// What the file contains cannot be used.
    #[error("{0}")]
    Invalid(Faults),
}

/// One thing that is wrong in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The name of the file.
    pub file: String,
    /// The line, from 1; `None` if the file as a whole is meant.
    pub line: Option<usize>,
    /// What is wrong and what to do.
    pub what: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.what),
            None => write!(f, "{}: {}", self.file, self.what),
        }
    }
}

/// Everything that is wrong in a file. Shown are the first few, one a line, and how many more there are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    kept: Vec<Fault>,
    count: usize,
}

impl Faults {
    /// So many are kept; a file of garbage may have one in every line.
    const KEPT: usize = 10_000;
    /// So many are shown.
    const SHOWN: usize = 8;

    /// Notes a fault; past the first ten thousand they are only counted.
    pub(crate) fn note(&mut self, file: &str, line: Option<usize>, what: impl fmt::Display) {
        self.count += 1;
        if self.kept.len() < Self::KEPT {
            self.kept.push(Fault { file: file.to_owned(), line, what: what.to_string() });
        }
    }

    /// Puts them in order of file and line.
    pub(crate) fn sort(&mut self) {
        self.kept.sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
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
