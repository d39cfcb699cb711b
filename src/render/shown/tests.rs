//! What cameras show.

use super::*;
use crate::brdf::{Lighting, Mirror};
use crate::contour::SceneOrder;
use crate::factors::PatchMesh;
use crate::picture::PixelParts;
use crate::render::ShaderOptions;
use crate::samples::{Kind, generate};
use crate::scene::{PolygonId, Scene, Side};
use glam::UVec2;

fn room() -> (Scene, Indirect) {
    let scene = generate(Kind::Room, 300, 2).unwrap().to_builder().build().unwrap();
    let (mesh, hosts) = PatchMesh::joined(&scene, 0.5).unwrap();
    let dark = vec![DVec3::ZERO; mesh.len()];
    let polygons = scene.polygon_count();
    let indirect = Indirect::new(&mesh.patches().unwrap(), &mesh.polygons(), polygons, &dark, &dark);
    (scene, indirect.with_hosts(hosts))
}

#[test]
fn every_patch_that_a_pixel_shows_is_shown() {
    let (scene, indirect) = room();
    let shader = Shader::new(SceneOrder::new(&scene), Lighting::default(), ShaderOptions::default()).unwrap();
    let cameras = [([0.4, 0.4, 1.6], [4.0, 2.0, 0.8]), ([2.0, 1.5, 0.3], [1.9, 1.6, 3.0])];
    for (eye, at) in cameras.map(|(eye, at)| (DVec3::from(eye), DVec3::from(at))) {
        let camera = Frustum::new(at - eye, DVec3::Z, 70.0, 1.0).unwrap();
        let shown = shader.shown(&indirect, eye, &camera).unwrap();
        let image = shader.order.view(&Viewpoint::free(eye), &Domain::Frustum(camera)).unwrap();
        let size = UVec2::splat(64);
        let parts = PixelParts::new(&image, size).unwrap().unwrap();
        let mut looked = 0;
        parts.tile(UVec2::ZERO, size, |_, _, of_pixel| {
            for part in of_pixel.iter().filter(|part| part.side == Some(Side::Front)) {
                let cell = image.cell(part.cell);
                let (Some(polygon), Some(point)) = (cell.polygon(), cell.point_at(part.direction)) else {
                    continue;
                };
                let patch = indirect.patch_at(polygon, point).unwrap();
                assert!(shown[patch.index()], "{patch} of {polygon}");
                looked += 1;
            }
        });
        let count = shown.iter().filter(|&&is_shown| is_shown).count();
        assert!(looked >= 64 * 64 && count < shown.len() * 3 / 4, "{looked} {count} of {}", shown.len());
    }
}

#[test]
fn a_mirror_may_show_anything() {
    let (scene, indirect) = room();
    let mirrors = scene
        .materials()
        .iter()
        .map(|_| -> Box<dyn Brdf> { Box::new(Mirror::new(crate::brdf::Fresnel::schlick(DVec3::splat(0.5)).unwrap())) });
    let order = SceneOrder::new(&scene);
    let shader = Shader::with_brdfs(order, mirrors.collect(), Lighting::default(), ShaderOptions::default()).unwrap();
    let camera = Frustum::new(DVec3::X, DVec3::Z, 1.0, 1.0).unwrap();
    let shown = shader.shown(&indirect, DVec3::new(0.4, 0.4, 1.6), &camera).unwrap();
    assert!(shown.len() == indirect.patch_count() && shown.iter().all(|&is_shown| is_shown));
    assert_eq!(indirect.patch_at(PolygonId(0), DVec3::ZERO).map(|patch| shown[patch.index()]), Some(true));
}
