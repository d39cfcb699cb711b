//! A scene whose polygons are the patches of another one's mesh.

use super::element::Elements;
use super::facets::Facets;
use super::{ExchangeError, PatchPlan};
use crate::scene::{FaceSpec, PolygonId, Scene};
use glam::DVec3;
use std::collections::HashMap;

/// Meshes every polygon of a scene into parts with edges of at most a given length, as [`PatchPlan::Mesh`] does, and makes a
/// scene of them: its polygon k is patch k of an exchange with that plan, with the object and the material of the polygon that it is part of, which is told too.
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
    let facets = Facets::of(scene).map_err(ExchangeError::Facets)?;
    let elements = Elements::of(scene, &facets, PatchPlan::Mesh { longest_edge })?;
    let mut builder = Scene::builder();
    let materials: Vec<_> = scene.materials().iter().map(|material| builder.add_material(material.clone())).collect();
    let objects: Vec<_> = scene.objects().iter().map(|name| builder.add_object(name)).collect();
    let mut known: HashMap<[u64; 3], usize> = HashMap::new();
    for (patch, own) in elements.patches.iter().zip(&elements.of_patch) {
        let polygon = scene.polygon(patch.polygon);
        let mut corner = |p: DVec3| {
            let key = p.to_array().map(|x| (x + 0.0).to_bits());
            *known.entry(key).or_insert_with(|| builder.add_vertex(p))
        };
        // One element, unless rounding leaves it no area: then a point keeps its number.
        let mut rings: Vec<Vec<usize>> = Vec::new();
        for element in own.iter().map(|&element| &elements.all[element as usize]) {
            rings.push(element.ring.iter().map(|&p| corner(facets.placement.global(p))).collect());
        }
        if rings.is_empty() {
            let first = polygon.rings().first().and_then(|ring| ring.first());
            let at = corner(first.map_or(DVec3::ZERO, |&vertex| scene.vertex(vertex)));
            rings.push(vec![at; 3]);
        }
        let (object, material) = (objects[polygon.object().index()], materials[polygon.material_id().index()]);
        builder.add_face(FaceSpec { rings, object, material });
    }
    let of = elements.patches.iter().map(|patch| patch.polygon).collect();
    Ok((builder.build().map_err(ExchangeError::Facets)?, of))
}
