//! Lit and shadowed parts of polygons as meshes for [`write_glb`](super::gltf::write_glb).

use super::gltf::GlbMesh;
use crate::contour::{ShadowPart, Shadows};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// What is left of a surface's colour in shadow.
const SHADE: f32 = 0.25;

/// A mesh `polygon_K_lit` in the diffuse colour of the polygon's material for what a light reaches of it, and a mesh `polygon_K_shadow`, a quarter as
/// bright, for what it does not; ascending by polygon. Corners in the middle of straight sides are corners of triangles
/// too, so that the meshes together are watertight where the scene is.
pub fn shadow_meshes(shadows: &Shadows) -> Vec<GlbMesh> {
    let mut parts: Vec<_> = shadows.parts().collect();
    parts.sort_by_key(|part| (part.polygon(), !part.is_lit()));
    let groups = parts.chunk_by(|a, b| (a.polygon(), a.is_lit()) == (b.polygon(), b.is_lit()));
    groups.map(|parts| mesh(shadows, parts)).collect()
}

fn mesh(shadows: &Shadows, parts: &[ShadowPart<'_>]) -> GlbMesh {
    let (polygon, is_lit) = (parts[0].polygon(), parts[0].is_lit());
    let scene = shadows.scene();
    let material = &scene.materials()[scene.polygon(polygon).material_id().index()];
    let mut mesh = GlbMesh {
        name: format!("polygon_{polygon}_{}", if is_lit { "lit" } else { "shadow" }),
        color: material.diffuse.map(|x| x.clamp(0.0, 1.0) as f32 * if is_lit { 1.0 } else { SHADE }),
        ..GlbMesh::default()
    };
    let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
    for part in parts {
        let ring: Vec<u32> = part
            .corners()
            .iter()
            .map(|&corner| {
                *numbers.entry(corner).or_insert_with(|| {
                    mesh.positions.push(shadows.vertices()[corner as usize]);
                    mesh.positions.len() as u32 - 1
                })
            })
            .collect();
        fill(&mut mesh, &ring);
    }
    mesh
}

/// Adds the triangles of a convex ring, some corners of which may be in the middle of straight sides.
fn fill(mesh: &mut GlbMesh, ring: &[u32]) {
    let at = |corner: u32| mesh.positions[corner as usize];
    let doubled = |[a, b, c]: [u32; 3]| (at(b) - at(a)).cross(at(c) - at(a)).length();
    let fan = |apex: u32, first: usize, count: usize| -> Vec<[u32; 3]> {
        let corner = |k: usize| ring[(first + k) % ring.len()];
        (0..count).map(|k| [apex, corner(k), corner(k + 1)]).collect()
    };
    // A fan from one of the corners, if none of its triangles is flat.
    for (k, &apex) in ring.iter().enumerate() {
        let triangles = fan(apex, k + 1, ring.len() - 2);
        let areas: Vec<f64> = triangles.iter().map(|&triangle| doubled(triangle)).collect();
        let whole: f64 = areas.iter().sum();
        if ring.len() == 3 || areas.iter().all(|&area| area > 1e-9 * whole) {
            mesh.triangles.extend(triangles);
            return;
        }
    }
    // Else from a point inside.
    let middle = ring.iter().map(|&corner| at(corner)).sum::<DVec3>() / ring.len() as f64;
    let apex = mesh.positions.len() as u32;
    let triangles = fan(apex, 0, ring.len());
    mesh.positions.push(middle);
    mesh.triangles.extend(triangles);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_with_corners_on_straight_sides_have_no_flat_triangles() {
        let ring = [(0., 0.), (1., 0.), (2., 0.), (4., 0.), (4., 3.), (2., 4.), (0., 3.), (0., 1.)];
        for turn in 0..ring.len() {
            for left_out in 0..=ring.len() {
                let corners = (0..ring.len()).filter(|&k| k != left_out).map(|k| ring[(k + turn) % ring.len()]);
                let positions: Vec<DVec3> = corners.map(|(x, y)| DVec3::new(x, y, 1.0)).collect();
                let ring: Vec<u32> = (0..positions.len() as u32).collect();
                let expected: f64 = (0..positions.len())
                    .map(|k| positions[k].truncate().perp_dot(positions[(k + 1) % positions.len()].truncate()))
                    .sum();
                let mut mesh = GlbMesh { positions, ..GlbMesh::default() };
                fill(&mut mesh, &ring);
                let doubled = |t: &[u32; 3]| {
                    let [a, b, c] = t.map(|k| mesh.positions[k as usize]);
                    (b - a).cross(c - a).z
                };
                assert!(mesh.triangles.iter().all(|t| doubled(t) > 0.1), "{:?}", mesh.triangles);
                let sum: f64 = mesh.triangles.iter().map(doubled).sum();
                assert!((sum - expected).abs() < 1e-12, "{sum} {expected}");
            }
        }
    }
}
