//! STL: triangles, as text or binary.
//!
//! The three vertices of a triangle decide its sides; the normals that are stored beside them, which the vertices
//! imply, and the attribute bytes of binary files are ignored. Binary coordinates are single precision and are kept as they are;
//! those of text are read as f64. In text an object is a solid, by its name (`default` without one), and a facet
//! may have more than three vertices. A file is binary if its size is what its count of triangles says, whatever it
//! starts with; otherwise it is text if it starts with `solid` and has no zero byte near its start.

mod ascii;
mod binary;

use super::draft::Draft;
use super::{Loaded, ReadError, ReadOptions};
use std::path::Path;

/// The size of a binary file before its triangles.
const HEADER: usize = 84;
/// The size of a triangle in a binary file: a normal, three vertices, two bytes.
const TRIANGLE: usize = 50;

pub(super) fn read(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, ReadError> {
    let mut loaded = parse(bytes, &path.to_string_lossy(), options)?;
    loaded.files = vec![path.to_owned()];
    Ok(loaded)
}

/// Reads the bytes of an STL file. `name` is what messages call it. Takes any bytes.
///
/// ```
/// use nusselt::io::{ReadOptions, stl};
/// let text = b"solid roof\nfacet normal 0 0 1\nouter loop\nvertex 0 0 3\nvertex 1 0 3\nvertex 0 1 3\nendloop\nendfacet\nendsolid\n";
/// let loaded = stl::parse(text, "roof.stl", &ReadOptions::default())?;
/// assert_eq!(loaded.scene.objects(), ["roof"]);
///
/// let error = stl::parse(&text[..60], "cut.stl", &ReadOptions::default()).unwrap_err();
/// assert!(error.to_string().starts_with("cut.stl:2: "), "{error}");
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with everything that is wrong.
pub fn parse(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Loaded, ReadError> {
    let draft = Draft::new(name, options);
    if is_text(bytes) { ascii::parse(bytes, draft) } else { binary::parse(bytes, draft) }
}

/// True if this can be nothing but STL.
pub(super) fn is_content(bytes: &[u8]) -> bool {
    has_size_of_its_count(bytes) || is_text(bytes)
}

fn is_text(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let Some((word, rest)) = start.split_at_checked(5) else { return false };
    word.eq_ignore_ascii_case(b"solid")
        && rest.first().is_none_or(u8::is_ascii_whitespace)
        && !has_size_of_its_count(bytes)
        && !bytes[..bytes.len().min(HEADER + TRIANGLE)].contains(&0)
}

/// The number of triangles that a binary file promises.
fn promised(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?) as usize)
}

fn has_size_of_its_count(bytes: &[u8]) -> bool {
    let size = promised(bytes).and_then(|count| count.checked_mul(TRIANGLE)?.checked_add(HEADER));
    size == Some(bytes.len())
}
