//! CityJSON 2.0, 1.1 and 1.0: the surfaces of city objects.
//!
//! City objects are taken in the order of the file, of each the geometries of its highest level of detail (or of the
//! one that [`ReadOptions::lod`] names), and of these the surfaces, depth-first: each is a face, inner rings are its
//! holes. The front of a surface is its outside. An object is a city object, by its id; a material is named after the semantic
//! surface (`RoofSurface`), else after the type of the city object. What coordinates are, [`ReadOptions::origin`] decides. See
//! docs/formats.md for what is ignored and what is refused.

mod assemble;
mod boundary;
mod coordinates;
mod json;
mod lod;

use super::draft::Draft;
use super::error::Place;
use super::formats::without_mark;
use super::{Loaded, ReadError, ReadOptions};
use std::path::Path;

pub(super) fn read(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, ReadError> {
    let mut loaded = parse(bytes, &path.to_string_lossy(), options)?;
    loaded.files = vec![path.to_owned()];
    Ok(loaded)
}

/// Reads the bytes of a CityJSON file. `name` is what messages call it. Takes any bytes.
///
/// ```
/// use nusselt::io::{Origin, ReadOptions, cityjson};
/// let text = r#"{ "type": "CityJSON", "version": "2.0",
///     "transform": { "scale": [0.5, 0.5, 0.5], "translate": [1000, 0, 0] },
///     "vertices": [[0, 0, 6], [2, 0, 6], [0, 2, 6]],
///     "CityObjects": { "shed": { "type": "Building", "geometry": [
///         { "type": "MultiSurface", "lod": "2", "boundaries": [[[0, 1, 2]]],
///           "semantics": { "surfaces": [{ "type": "RoofSurface" }], "values": [0] } }] } } }"#;
/// let loaded = cityjson::parse(text.as_bytes(), "shed.city.json", &ReadOptions::default())?;
/// assert_eq!(loaded.scene.objects(), ["shed"]);
/// assert_eq!(loaded.scene.materials()[0].name, "RoofSurface");
/// assert_eq!(loaded.scene.vertices()[1], glam::DVec3::new(1001.0, 0.0, 3.0));
///
/// let options = ReadOptions { origin: Origin::Integers, ..ReadOptions::default() };
/// let loaded = cityjson::parse(text.as_bytes(), "shed.city.json", &options)?;
/// assert_eq!(loaded.scene.vertices()[1], glam::DVec3::new(2.0, 0.0, 6.0));
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with what is wrong.
pub fn parse(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Loaded, ReadError> {
    let mut draft = Draft::new(name, options);
    match json::parse(without_mark(bytes)) {
        Ok(model) => assemble::assemble(&model, bytes.len(), options, draft),
        Err((line, what)) => {
            draft.fault(if line == 0 { Place::File } else { Place::Line(line) }, what);
            Err(draft.into_error())
        }
    }
}
