//! A scene whose polygons are the patches of another one's mesh.

use super::facets::spanning;
use super::shape::Frame;
use super::{ExchangeError, mesh};
use crate::scene::{FaceSpec, PolygonId, Scene, VertexId};
use glam::DVec3;
use std::collections::HashMap;

/// Meshes every polygon of a scene into parts with edges of at most a given length, as [`PatchPlan::Mesh`](super::PatchPlan::Mesh) does, and makes a
/// scene of them: its polygon k is patch k, with the object and the material of the polygon that it is part of, which is told too.
/// Edges that polygons share are divided in the same places.
///
/// Corners are rounded, so parts of polygons that are not parallel to a coordinate plane need not lie exactly in one plane.
///
/// # Errors
/// If the length is not a positive number, or the mesh too fine.
///
/// ```
/// use nusselt::factors::mesh_scene;
///
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let (patches, of) = mesh_scene(&scene, 100.0)?;
/// assert!(patches.polygon_count() > 300 && of.len() == patches.polygon_count());
/// let floor = of.iter().filter(|polygon| polygon.0 == 0).count();
/// assert_eq!(floor, 36);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mesh_scene(scene: &Scene, longest_edge: f64) -> Result<(Scene, Vec<PolygonId>), ExchangeError> {
    if !(longest_edge.is_finite() && longest_edge > 0.0) {
        return Err(ExchangeError::BadEdge { longest_edge });
    }
    let mut builder = Scene::builder();
    let materials: Vec<_> = scene.materials().iter().map(|material| builder.add_material(material.clone())).collect();
    let objects: Vec<_> = scene.objects().iter().map(|name| builder.add_object(name)).collect();
    let mut known: HashMap<[u64; 3], usize> = HashMap::new();
    let mut of = Vec::new();
    for polygon in scene.polygons() {
        for piece in polygon.pieces() {
            let outline: Vec<(VertexId, DVec3)> = piece.vertices().iter().map(|&v| (v, scene.vertex(v))).collect();
            let ring: Vec<DVec3> = piece.points().collect();
            let frame = Frame::through(spanning(&ring));
            let parts = mesh::elements(&outline, &frame, longest_edge);
            let parts = parts.map_err(|mesh::TooFine| ExchangeError::TooFine { polygon: polygon.id() })?;
            for part in parts {
                let corner = |p: &DVec3| {
                    let key = p.to_array().map(|x| (x + 0.0).to_bits());
                    *known.entry(key).or_insert_with(|| builder.add_vertex(*p))
                };
                let rings = vec![part.iter().map(corner).collect()];
                let (object, material) = (objects[polygon.object().index()], materials[polygon.material_id().index()]);
                builder.add_face(FaceSpec { rings, object, material });
                of.push(polygon.id());
            }
        }
    }
    if of.len() > u32::MAX as usize - 3 {
        return Err(ExchangeError::TooManyPatches);
    }
    Ok((builder.build().map_err(ExchangeError::Facets)?, of))
}
