//! Reading scenes and writing results.
//!
//! Readers take any bytes: what they cannot use they refuse with the file, the line and what to do
//! about it, all faults at once. They keep to memory in proportion to the size of the files.

#[cfg(any(feature = "cityjson", feature = "gltf"))]
mod absent;
mod atomic;
#[cfg(feature = "json")]
pub mod certificate;
#[cfg(feature = "cityjson")]
pub mod cityjson;
#[cfg(feature = "json")]
mod contour_json;
#[cfg(feature = "json")]
mod digest;
mod draft;
mod error;
#[cfg(feature = "exr")]
mod exr;
mod formats;
mod frames;
#[cfg(feature = "json")]
mod geojson;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(feature = "json")]
mod json;
mod lines;
#[cfg(feature = "json")]
pub mod matrix;
mod merl;
pub mod mtl;
mod number;
pub mod obj;
#[cfg(feature = "parquet")]
mod parquet;
pub mod ply;
#[cfg(feature = "png")]
mod png;
mod point_factors;
mod points;
mod quoted;
#[cfg(all(feature = "gltf", feature = "json"))]
pub mod radiosity;
mod sh;
#[cfg(feature = "gltf")]
mod shadow_glb;
mod srgb;
pub mod stl;
mod svg;
#[cfg(any(feature = "cityjson", feature = "gltf", feature = "json"))]
mod told;
mod visible_obj;

pub use atomic::{atomic_write, check_writable, remove_abandoned};
#[cfg(feature = "json")]
pub use certificate::{
    CERTIFICATE_SCHEMA, CertificateError, KeptCertificate, SceneSize, read_certificate, write_certificate,
};
#[cfg(feature = "json")]
pub use contour_json::{
    CONTOUR_SCHEMA, CertificateRow, ContourSummary, DomainRow, ObjectRow, PolygonRow, Share, write_contour_json,
};
pub use error::{Fault, Faults, Place, ReadError};
#[cfg(feature = "exr")]
pub use exr::write_exr;
pub use frames::{FrameLine, parse_frames, read_frames};
#[cfg(feature = "json")]
pub use geojson::{REGIONS_SCHEMA, write_geojson};
pub use merl::{parse_merl, read_merl, write_merl};
#[cfg(feature = "png")]
pub use png::{PngRows, contour_picture, write_png, write_png_rows};
pub use point_factors::{POINT_FACTORS_SCHEMA, PointFactorsFormat, PointFactorsWriter};
pub use points::{PointLine, PointReader, open_points, parse_points, read_points};
pub use sh::{parse_sh, read_sh, write_sh};
#[cfg(feature = "gltf")]
pub use shadow_glb::shadow_meshes;
pub use svg::{BrdfPicture, DrawingCounts, DrawingOptions, Fill, SvgOptions, write_brdf_svg, write_drawing, write_svg};
pub use visible_obj::{fragment_groups, shadow_groups, visible_groups};

use crate::scene::{Repair, Scene};
use formats::Format;
use std::fs::{self, File};
use std::io::{Error, Read, Result as IoResult};
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
    /// Where each material of the scene is defined, as messages start: `room.mtl:7`; the name of the file where that is not known.
    pub material_places: Vec<String>,
}

/// How a scene is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// What becomes of broken faces. What it changed is in [`Scene::repairs`].
    pub repair: Repair,
    /// The level of detail of city objects, as CityJSON has it: `2` or `2.2`. By default the highest of each.
    pub lod: Option<String>,
    /// What the coordinates of a CityJSON file are.
    pub origin: Origin,
}

/// What coordinates are in a scene from a CityJSON file, whose vertices are integers v with a scale and a translation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// Coordinates in the reference system of the file: v x scale + translate, each operation rounded to f64.
    #[default]
    File,
    /// v x scale, rounded once: the same unit, but a local origin. Numbers are small, so they keep more digits.
    Local,
    /// v itself: integers up to 2^53 are not rounded, what is planar stays planar, and the unit is the file's scale (often a millimetre),
    /// which must be the same along all axes. Templates, and vertices that are no integers, are rounded all the same.
    Integers,
}

/// The bytes of a regular file.
fn read_regular(path: &Path) -> IoResult<Vec<u8>> {
    let mut file = open_regular(path)?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a regular file. A device or a pipe may never end.
fn open_regular(path: &Path) -> IoResult<File> {
    if !fs::metadata(path)?.is_file() {
        return Err(Error::other("it is not a regular file; name one, or copy it into one"));
    }
    File::open(path)
}

/// Reads a scene from a file. Its ending decides the format, in upper or lower case; if that is not known, its content
/// does.
///
/// # Errors
/// If the file cannot be read, neither ending nor content are known, or what it contains cannot be used.
pub fn read_scene(path: &Path, options: &ReadOptions) -> Result<Loaded, ReadError> {
    let bytes = read_regular(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    let format = Format::of(path, &bytes)?;
    let mut loaded = format.read(path, &bytes, options)?;
    if format.name != "CityJSON" && (options.lod.is_some() || options.origin != Origin::File) {
        let what = "levels of detail and local origins are for CityJSON; they were ignored";
        loaded.warnings.push(format!("{}: it is {}: {what}", path.display(), format.name));
    }
    Ok(loaded)
}
