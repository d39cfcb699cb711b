//! Wavefront OBJ: polygons with objects and materials.
//!
//! Read are `v`, `f` (any number of vertices, in the forms `v`, `v/vt`, `v//vn` and `v/vt/vn`, negative
//! indices too), `o`, `g`, `usemtl` and `mtllib`. Points, lines, texture coordinates and normals
//! are ignored: the sides of a face follow from the order of its vertices. An object or a material
//! without a name is `default`.

mod read;
mod write;

pub use read::parse;
pub(super) use read::read;
pub use write::{Group, write};

/// A name as one can write it into a line of OBJ or MTL so that it reads the same; line breaks and the
/// like become `_`, and no name becomes `default`.
pub(super) fn printable(name: &str) -> String {
    let clean: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    let clean = clean.trim().replace(" #", " _");
    if clean.is_empty() {
        return "default".to_owned();
    }
    match clean.strip_suffix('\\') {
        Some(start) => format!("{start}_"),
        None if clean.starts_with('#') => clean.replacen('#', "_", 1),
        None => clean,
    }
}
