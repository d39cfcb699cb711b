//! Reading scenes and writing results.
//!
//! Readers take any bytes: what they cannot use they refuse with the file, the line and what to do
//! about it, all faults at once. They keep to memory in proportion to the size of the files.

mod atomic;
#[cfg(feature = "json")]
pub mod certificate;
#[cfg(feature = "json")]
mod contour_json;
mod error;
#[cfg(feature = "json")]
mod geojson;
#[cfg(feature = "json")]
mod json;
mod lines;
pub mod mtl;
mod number;
pub mod obj;
mod svg;
mod visible_obj;

pub use atomic::atomic_write;
#[cfg(feature = "json")]
pub use certificate::{
    CERTIFICATE_SCHEMA, CertificateError, KeptCertificate, SceneSize, read_certificate, write_certificate,
};
#[cfg(feature = "json")]
pub use contour_json::{
    CONTOUR_SCHEMA, CertificateRow, ContourSummary, DomainRow, ObjectRow, PolygonRow, Share, write_contour_json,
};
pub use error::{Fault, Faults, ReadError};
#[cfg(feature = "json")]
pub use geojson::{REGIONS_SCHEMA, write_geojson};
pub use svg::{SvgOptions, write_svg};
pub use visible_obj::{fragment_groups, visible_groups};

use crate::scene::Scene;
use std::fs;
use std::io::{Error, Result as IoResult};
use std::path::{Path, PathBuf};

/// A scene that was read, and what the reader made do with.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene; polygon k is the k-th face of the file.
    pub scene: Scene,
    /// What a user should know: missing material files, faces without area, lines that were ignored.
    pub warnings: Vec<String>,
    /// The files that were read: the scene first, then its material libraries. Results must not replace them.
    pub files: Vec<PathBuf>,
}

/// How a scene is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// What becomes of broken faces. What it changed is in [`Scene::repairs`].
    pub repair: crate::scene::Repair,
}

type Reader = fn(&Path, &ReadOptions) -> Result<Loaded, ReadError>;

/// The formats, by the ending of the file name.
const READERS: &[(&str, Reader)] = &[("obj", obj::read)];

/// The bytes of a regular file. A device or a pipe may never end.
fn read_regular(path: &Path) -> IoResult<Vec<u8>> {
    if !fs::metadata(path)?.is_file() {
        return Err(Error::other("it is not a regular file; name one, or copy it into one"));
    }
    fs::read(path)
}

/// Reads a scene from a file; its ending decides the format, in upper or lower case.
///
/// # Errors
/// If the file cannot be read, its ending is not known, or what it contains cannot be used.
pub fn read_scene(path: &Path, options: &ReadOptions) -> Result<Loaded, ReadError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let is_reader_of = |ending: &str| name.strip_suffix(ending).is_some_and(|stem| stem.ends_with('.'));
    match READERS.iter().find(|(ending, _)| is_reader_of(ending)) {
        Some((_, read)) => read(path, options),
        None => Err(ReadError::UnknownFormat {
            path: path.to_owned(),
            known: READERS.iter().map(|(ending, _)| format!(".{ending}")).collect::<Vec<_>>().join(", "),
        }),
    }
}
