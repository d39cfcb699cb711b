//! Binary STL: 80 bytes of anything, the number of triangles, and the triangles, all little-endian.

use super::super::draft::Draft;
use super::super::error::Place;
use super::super::{Loaded, ReadError};
use super::{HEADER, TRIANGLE, promised};
use crate::scene::Material;
use glam::DVec3;

/// Reads a binary file. Memory is in proportion to the bytes that are there, not to the count they promise.
pub(super) fn parse(bytes: &[u8], mut draft: Draft<'_>) -> Result<Loaded, ReadError> {
    let Some(count) = promised(bytes) else {
        let size = bytes.len();
        draft.fault(
            Place::File,
            format_args!("neither text that starts with `solid` nor binary: {size} bytes are too few"),
        );
        return Err(draft.into_error());
    };
    let triangles = bytes[HEADER..].chunks_exact(TRIANGLE);
    if triangles.len() < count {
        let there = triangles.len();
        draft.fault(
            Place::File,
            format_args!("it promises {count} triangles, but only {there} are there; it may be cut off"),
        );
        return Err(draft.into_error());
    }
    let extra = bytes.len() - HEADER - count * TRIANGLE;
    if extra > 0 {
        draft.warn(&Place::File, format_args!("the {extra} bytes after the last triangle were ignored"));
    }
    let object = draft.builder.add_object("default");
    let material = draft.builder.add_material(Material::new("default"));
    for (k, triangle) in triangles.take(count).enumerate() {
        // After the normal.
        let corner = |c: usize| DVec3::from([0, 4, 8].map(|at| single(triangle, 12 + 12 * c + at)));
        let corners = [0, 1, 2].map(corner);
        // Once for all corners.
        if !corners.iter().all(|p| p.is_finite()) {
            draft.refuse_vertex(item(k), "a coordinate is not finite; correct it");
        }
        let ring = corners.map(|p| draft.builder.add_vertex(p));
        draft.add_face(vec![ring.to_vec()], object, material);
    }
    draft.finish(item, |_| None)
}

fn item(triangle: usize) -> Place {
    Place::Item(format!("triangle {triangle}"))
}

fn single(bytes: &[u8], at: usize) -> f64 {
    f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
}
