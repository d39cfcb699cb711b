//! What of a scene is before a plane.

#[cfg(test)]
mod tests;

use crate::exact::{Sign, orient3d};
use crate::scene::{FaceSpec, Material, PieceId, Scene, SupportingPlane, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// The part of a scene that is before a plane, on its front or on its back, without what lies in it, and the piece that each polygon of that is part of. `None` if it is no scene.
///
/// On which side of the plane corners are is decided exactly. Where pieces are cut, new corners are rounded, each once, so that neighbours still meet.
pub(super) fn before(scene: &Scene, plane: SupportingPlane, is_front: bool) -> Option<(Scene, Vec<PieceId>)> {
    let heights: Vec<Height> = scene.vertices().iter().map(|&p| Height::of(scene, plane, is_front, p)).collect();
    let mut builder = Scene::builder();
    let (object, material) = (builder.add_object("before"), builder.add_material(Material::new("any")));
    let mut known: FxHashMap<VertexId, usize> = FxHashMap::default();
    let mut crossings: FxHashMap<[VertexId; 2], usize> = FxHashMap::default();
    let mut pieces = Vec::new();
    let mut ring: Vec<usize> = Vec::new();
    for piece in scene.pieces() {
        let vertices = piece.vertices();
        let side = |v: &VertexId| heights[v.index()].side;
        if !vertices.iter().any(|v| side(v).is_positive()) {
            continue;
        }
        ring.clear();
        for (k, &v) in vertices.iter().enumerate() {
            let next = vertices[if k + 1 == vertices.len() { 0 } else { k + 1 }];
            if !side(&v).is_negative() {
                ring.push(*known.entry(v).or_insert_with(|| builder.add_vertex(scene.vertex(v))));
            }
            if side(&v) == -side(&next) && !side(&v).is_zero() {
                let ends = if v < next { [v, next] } else { [next, v] };
                let crossing = || {
                    let [a, b] = ends.map(|v| heights[v.index()].height);
                    let [p, q] = ends.map(|v| scene.vertex(v));
                    let share = if a + b > 0.0 { a / (a + b) } else { 0.5 };
                    builder.add_vertex(p.lerp(q, share))
                };
                ring.push(*crossings.entry(ends).or_insert_with(crossing));
            }
        }
        let mut add = |ring: Vec<usize>| {
            builder.add_face(FaceSpec { rings: vec![ring], object, material });
            pieces.push(piece.id());
        };
        if vertices.iter().any(|v| side(v).is_negative()) {
            // With rounded corners it need not be planar: triangles are.
            (1..ring.len() - 1).for_each(|k| add(vec![ring[0], ring[k], ring[k + 1]]));
        } else {
            add(ring.clone());
        }
    }
    builder.build().ok().map(|before| (before, pieces))
}

/// How far a point is before a plane.
struct Height {
    /// Exactly: positive before it.
    side: Sign,
    /// How far it is from the plane, on either side, in some unit, rounded.
    height: f64,
}

impl Height {
    fn of(scene: &Scene, plane: SupportingPlane, is_front: bool, p: DVec3) -> Self {
        let (side, height) = match plane {
            SupportingPlane::Axis { axis, value } => {
                let off = p[axis as usize] - value;
                (Sign::of(off), off)
            }
            SupportingPlane::Points(points) => {
                let [a, b, c] = points.map(|v| scene.vertex(v));
                // Of lengths about 1, whose products are numbers whatever the unit; halves, as differences may be no numbers.
                let unit = |v: DVec3| v / v.abs().max_element();
                let [along, across] = [b, c].map(|q| unit(q * 0.5 - a * 0.5));
                (orient3d(a, b, c, p), unit(along.cross(across)).dot(p * 0.5 - a * 0.5))
            }
        };
        Self { side: if is_front { side } else { -side }, height: height.abs() }
    }
}
