//! Visible fragments in space, lit and shadowed parts, and fragments of the 3D BSP, as groups for [`obj::write`](super::obj::write).

use super::mtl;
use super::obj::Group;
use crate::bsp::SceneBsp;
use crate::contour::{ContourImage, Shadows};
use crate::scene::{PolygonId, Scene, Side};
use glam::DVec3;

/// Every visible part of every polygon, in the polygon's plane: one face a cell, in a group
/// `polygon_K` with the polygon's material, its front where the polygon's front is.
///
/// Corners are rounded. Left out are corners without a point (the ray to them is parallel to the plane,
/// to rounding) and cells too thin to have three different corners.
pub fn visible_groups(image: &ContourImage) -> Vec<Group> {
    let mut cells: Vec<_> = image.cells().filter_map(|cell| Some((cell.polygon()?, cell.id()))).collect();
    cells.sort_unstable();
    let faces = cells.into_iter().map(|(polygon, id)| {
        let cell = image.cell(id);
        let mut corners: Vec<DVec3> = cell.boundary().filter_map(|direction| cell.point_at(direction)).collect();
        // A cell runs clockwise as the eye sees it, that is clockwise around the side that is seen.
        if cell.side() == Some(Side::Front) {
            corners.reverse();
        }
        (polygon, "", corners)
    });
    grouped(image.scene(), faces)
}

/// The fragments into which the 3D BSP cut the scene, likewise.
pub fn fragment_groups(bsp: &SceneBsp) -> Vec<Group> {
    let mut fragments: Vec<_> = bsp.fragments().map(|fragment| (fragment.polygon(), fragment.id())).collect();
    fragments.sort_unstable();
    let faces = fragments.into_iter().map(|(polygon, id)| (polygon, "", bsp.fragment(id).corners().collect()));
    grouped(bsp.scene(), faces)
}

/// The parts of polygons that a light reaches, in groups `polygon_K_lit`, and those that it does not, in groups `polygon_K_shadow`, likewise. Parts have
/// vertices in common as [`Shadows`] has them, so that the file is watertight where the scene is.
pub fn shadow_groups(shadows: &Shadows) -> Vec<Group> {
    let mut parts: Vec<_> = shadows.parts().collect();
    parts.sort_by_key(|part| (part.polygon(), !part.is_lit()));
    let faces = parts.into_iter().map(|part| {
        let corners = part.corners().iter().map(|&corner| shadows.vertices()[corner as usize]);
        (part.polygon(), if part.is_lit() { "_lit" } else { "_shadow" }, corners.collect())
    });
    grouped(shadows.scene(), faces)
}

/// Groups faces that come by ascending polygon, and what is to be added to its name.
fn grouped(scene: &Scene, faces: impl Iterator<Item = (PolygonId, &'static str, Vec<DVec3>)>) -> Vec<Group> {
    let names = mtl::names(scene.materials());
    let mut groups: Vec<Group> = Vec::new();
    let mut last = None;
    for (polygon, kind, mut corners) in faces {
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            continue;
        }
        if last.replace((polygon, kind)) != Some((polygon, kind)) {
            let material = Some(names[scene.polygon(polygon).material_id().index()].clone());
            groups.push(Group { name: format!("polygon_{polygon}{kind}"), material, polygons: Vec::new() });
        }
        if let Some(group) = groups.last_mut() {
            group.polygons.push(corners);
        }
    }
    groups
}
