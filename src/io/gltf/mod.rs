//! glTF 2.0 and GLB: triangles of the nodes of a scene; [`write_glb`] writes some.
//!
//! The default scene is walked depth-first, each node once, and every triangle of every mesh on the way is a face, in
//! the order of primitives and indices. Coordinates are those after the transforms of the nodes, which are
//! composed in f64; no axes are swapped. Under a transform that mirrors, the sides stay as they are in the mesh. An
//! object is a node, by its name, else that of its mesh, else `node_N`. See docs/formats.md for what is
//! ignored and what is refused.

mod accessor;
mod assemble;
mod buffers;
mod glb;
mod graph;
mod json;
mod material;
mod primitive;
mod write;

pub use write::{GlbMesh, check_positions, write_glb};

use super::draft::Draft;
use super::error::Place;
use super::formats::without_mark;
use super::{Loaded, ReadError, ReadOptions, read_regular};
use json::Root;
use std::collections::HashSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Reads the bytes of a glTF or GLB file, and the buffers that it names beside it.
pub(super) fn read(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, ReadError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut known: HashSet<PathBuf> = HashSet::new();
    let mut files = vec![path.to_owned()];
    let mut loaded = parse(bytes, &path.to_string_lossy(), options, |name| {
        let path = folder.join(name);
        // A file that is named in many ways would be kept as many times.
        if !known.insert(fs::canonicalize(&path)?) {
            return Err(io::Error::other("it is read already, by another name; name it in one way"));
        }
        let bytes = read_regular(&path)?;
        files.push(path);
        Ok(bytes)
    })?;
    loaded.files = files;
    Ok(loaded)
}

/// Reads the bytes of a glTF or GLB file. `name` is what messages call it; `load` gives the bytes of the files
/// that buffers name, each by its path relative to this file, percent-decoded. Takes any bytes. Of what `load` reads nothing is noted
/// in [`Loaded::files`].
///
/// ```
/// use nusselt::io::{ReadOptions, gltf};
/// // A triangle: nine single-precision numbers in a buffer that is part of the file.
/// let text = r#"{ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }],
///     "nodes": [{ "name": "roof", "mesh": 0, "translation": [0, 0, 3] }],
///     "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
///     "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
///     "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
///     "buffers": [{ "byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }] }"#;
/// let loaded = gltf::parse(text.as_bytes(), "roof.gltf", &ReadOptions::default(), |_| Ok(Vec::new()))?;
/// assert_eq!(loaded.scene.objects(), ["roof"]);
/// assert_eq!(loaded.scene.vertices()[2], glam::DVec3::new(0.0, 1.0, 3.0));
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with what is wrong.
pub fn parse(
    bytes: &[u8],
    name: &str,
    options: &ReadOptions,
    load: impl FnMut(&str) -> io::Result<Vec<u8>>,
) -> Result<Loaded, ReadError> {
    let mut draft = Draft::new(name, options);
    match container(bytes, &mut draft) {
        Ok((root, chunk)) => assemble::assemble(&root, bytes.len(), chunk, load, draft),
        Err((place, what)) => {
            draft.fault(place, what);
            Err(draft.into_error())
        }
    }
}

/// A fault, and where.
type Misplaced = (Place, String);

/// The JSON of a file, and the binary chunk of a GLB file.
fn container<'a>(bytes: &'a [u8], draft: &mut Draft<'_>) -> Result<(Root, Option<&'a [u8]>), Misplaced> {
    let is_glb = bytes.starts_with(glb::MAGIC);
    let (text, chunk) = if is_glb {
        let glb::Chunks { json, binary, extra } = glb::split(bytes).map_err(|what| (Place::File, what))?;
        if extra > 0 {
            draft.warn(&Place::File, format_args!("the {extra} bytes after its end were ignored"));
        }
        // Padded with blanks, or by some programs with zeros.
        let end = json.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
        (&json[..end], binary)
    } else {
        (without_mark(bytes), None)
    };
    let root = json::parse(text).map_err(|(line, what)| {
        // The JSON of a GLB file is one line.
        (if is_glb || line == 0 { Place::File } else { Place::Line(line) }, what)
    })?;
    json::check_version(&root).map_err(|what| (Place::Item("asset".to_owned()), what))?;
    Ok((root, chunk))
}
