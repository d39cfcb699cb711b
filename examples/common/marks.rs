//! Parts of pages that a program measures and writes.

use nusselt::io::atomic_write;
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A page of which the text between two marks with a name is written anew.
pub(crate) struct Page {
    path: PathBuf,
    before: String,
    after: String,
}

impl Page {
    /// Reads the page, which has lines `<!-- name: begin -->` and `<!-- name: end -->`.
    pub(crate) fn open(path: &Path, name: &str) -> Result<Self, Box<dyn Error>> {
        let page = std::fs::read_to_string(path)?;
        let [begin, end] = ["begin", "end"].map(|what| format!("<!-- {name}: {what} -->"));
        let parts = page.split_once(&begin).and_then(|(before, rest)| Some((before, rest.split_once(&end)?.1)));
        let (before, after) = parts.ok_or_else(|| format!("{} has no marks for {name}", path.display()))?;
        Ok(Self { path: path.to_owned(), before: format!("{before}{begin}\n"), after: format!("{end}{after}") })
    }

    /// Writes it with that text in it.
    pub(crate) fn write(&self, text: &str) -> Result<(), Box<dyn Error>> {
        let Self { path, before, after } = self;
        Ok(atomic_write(path, |file| write!(file, "{before}\n{text}\n{after}"))?)
    }
}
