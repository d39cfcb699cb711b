//! A scene whose polygons are the patches of another one's mesh.

use super::{ExchangeError, PatchMesh};
use crate::scene::{PolygonId, Scene};

/// Meshes every polygon of a scene into parts with edges of at most a given length, as [`PatchPlan::Mesh`](super::PatchPlan::Mesh) does, and makes a
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
/// // 6 x 6, and more where blocks stand on it.
/// assert!(floor > 36);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mesh_scene(scene: &Scene, longest_edge: f64) -> Result<(Scene, Vec<PolygonId>), ExchangeError> {
    let mesh = PatchMesh::new(scene, longest_edge)?;
    Ok((mesh.patches().map_err(ExchangeError::Facets)?, mesh.polygons()))
}
