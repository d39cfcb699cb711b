//! PLY: polygons, as text or binary of either byte order.
//!
//! Read are `x`, `y` and `z` of the element `vertex`, whatever their types; the list `vertex_indices` or `vertex_index`
//! of the element `face`, or the only list that it has, whatever it is called; and `tristrips`, with -1 between
//! strips. All other elements and properties are skipped. Numbers of text files are read as f64, whatever type is
//! declared. The format knows neither objects nor materials: both are `default`.

mod body;
mod header;
mod source;

use super::draft::Draft;
use super::lines::take_line;
use super::{Loaded, ReadError, ReadOptions};
use std::path::Path;

pub(super) fn read(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, ReadError> {
    let mut loaded = parse(bytes, &path.to_string_lossy(), options)?;
    loaded.files = vec![path.to_owned()];
    Ok(loaded)
}

/// Reads the bytes of a PLY file. `name` is what messages call it. Takes any bytes.
///
/// ```
/// use nusselt::io::{ReadOptions, ply};
/// let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
///             element face 1\nproperty list uchar int vertex_indices\nend_header\n\
///             0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
/// let loaded = ply::parse(text.as_bytes(), "floor.ply", &ReadOptions::default())?;
/// assert_eq!(loaded.scene.polygon_count(), 1);
///
/// let text = text.replace("0 1 2 3", "0 1 2 7");
/// let error = ply::parse(text.as_bytes(), "floor.ply", &ReadOptions::default()).unwrap_err();
/// assert_eq!(error.to_string(), "floor.ply:14: there is no vertex 7; they are 0 to 3");
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with everything that is wrong.
pub fn parse(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Loaded, ReadError> {
    let mut draft = Draft::new(name, options);
    match header::parse(bytes) {
        Ok(header) => body::parse(&header, draft),
        Err((place, what)) => {
            draft.fault(place, what);
            Err(draft.into_error())
        }
    }
}

/// True if this can be nothing but PLY.
pub(super) fn is_content(bytes: &[u8]) -> bool {
    let mut rest = bytes;
    rest.starts_with(b"ply") && take_line(&mut rest).trim_ascii_end() == b"ply"
}
