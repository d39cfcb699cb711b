//! What can be checked before any geometry: numbers are finite, and names and indices exist.

use super::{FaceSpec, Material, PolygonId, SceneProblem};
use glam::DVec3;

/// The vertices that are not finite.
pub(super) fn check_vertices(vertices: &[DVec3], problems: &mut Vec<SceneProblem>) {
    let broken = vertices.iter().enumerate().filter(|(_, p)| !p.is_finite());
    problems.extend(broken.map(|(vertex, _)| SceneProblem::NotFinite { vertex }));
}

/// How much there is of what a face may name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    pub(super) vertices: usize,
    pub(super) objects: usize,
    pub(super) materials: usize,
}

/// Checks the indices of a face; true if its rings are sound.
pub(super) fn check_face(
    polygon: PolygonId,
    face: &FaceSpec,
    counts: Counts,
    problems: &mut Vec<SceneProblem>,
) -> bool {
    let before = problems.len();
    if face.rings.is_empty() {
        problems.push(SceneProblem::TooFewVertices { polygon, count: 0 });
    }
    for ring in &face.rings {
        if ring.len() < 3 {
            problems.push(SceneProblem::TooFewVertices { polygon, count: ring.len() });
        }
        let count = counts.vertices;
        let unknown = ring.iter().copied().filter(|&vertex| vertex >= count);
        problems.extend(unknown.map(|vertex| SceneProblem::UnknownVertex { polygon, vertex, count }));
    }
    let sound = problems.len() == before;
    if face.object.index() >= counts.objects {
        problems.push(SceneProblem::UnknownObject { polygon, object: face.object.0, count: counts.objects });
    }
    if face.material.index() >= counts.materials {
        let (material, count) = (face.material.0, counts.materials);
        problems.push(SceneProblem::UnknownMaterial { polygon, material, count });
    }
    sound
}

/// The materials with numbers that are negative or not finite.
pub(super) fn check_materials(materials: &[Material], problems: &mut Vec<SceneProblem>) {
    for (index, material) in materials.iter().enumerate() {
        let [metallic, roughness] =
            material.metallic_roughness.map_or([0.0; 2], |surface| [surface.metallic, surface.roughness]);
        let base_colour = material.metallic_roughness.map_or([0.0; 3], |surface| surface.base_colour);
        let numbers: [(&'static str, &[f64]); 7] = [
            ("diffuse reflectance", &material.diffuse),
            ("specular reflectance", &material.specular),
            ("exponent", &[material.exponent]),
            ("base colour", &base_colour),
            ("metallic factor", &[metallic]),
            ("roughness", &[roughness]),
            ("emission", &material.emission),
        ];
        let all = numbers.into_iter().flat_map(|(what, values)| values.iter().map(move |&value| (what, value)));
        let is_sound = |x: f64| x.is_finite() && x >= 0.0;
        if let Some((what, value)) = all.into_iter().find(|&(_, value)| !is_sound(value)) {
            let (material, name) = (index as u32, material.name.clone());
            problems.push(SceneProblem::BadMaterial { material, name, what, value });
        }
    }
}
