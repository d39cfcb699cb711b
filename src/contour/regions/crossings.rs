//! Where polygons that are seen beside each other pass through each other.

use super::mosaic::Mosaic;
use super::outlines::{Outlines, Run};
use crate::bsp::LineId;
use crate::contour::directions::CircleId;
use crate::contour::image::ContourImage;
use crate::scene::PieceRef;

/// True if the planes of what is seen to both sides of a run meet where it is, and no edge of that is there: the great circle may have come by another name.
pub(super) fn is_crossing(image: &ContourImage, outlines: &mut Outlines<'_>, run: Run, circle: CircleId) -> bool {
    let (skeleton, scene) = (image.skeleton(), image.scene());
    let there = Run { forward: !run.forward, ..run };
    let [Some(a), Some(b)] = [run, there].map(|run| {
        let cell = outlines.mosaic.faces[outlines.face_beside(run)? as usize].cell?;
        Some(scene.piece(image.cell(cell).piece()?))
    }) else {
        return false;
    };
    let mut planes = [a, b].map(PieceRef::plane_id);
    planes.sort_unstable();
    if planes[0] == planes[1] {
        return false;
    }
    let edges = [a, b].into_iter().flat_map(PieceRef::edges);
    let lines: Vec<LineId> = edges.map(|edge| skeleton.representative(LineId(edge.0)).0).collect();
    let Mosaic { directions, knife, .. } = &mut outlines.mosaic;
    if directions.line(circle).is_some_and(|line| lines.contains(&line)) {
        return false;
    }
    let crease = skeleton.approx_crease_normal(image.viewpoint().eye(), planes);
    let turned = crease.v.normalize_or_zero().cross(directions.normal(circle).v.normalize_or_zero()).length();
    // Both are known to 1e-13 then.
    if !crease.is_poor() && turned > 1e-12 {
        return false;
    }
    let (directions, cache) = (directions.to_mut(), &mut knife.cache);
    let own = directions.primitive_normal(skeleton, circle, cache).0;
    let crease = directions.push_crease(skeleton, planes, cache);
    if directions.primitive_normal(skeleton, crease, cache).0 != own {
        return false;
    }
    lines.into_iter().all(|line| {
        let line = directions.push_line(skeleton, line, cache);
        directions.primitive_normal(skeleton, line, cache).0 != own
    })
}
