//! Meshes of polygons.

use super::cases::{cuboid, rectangle, scene_of};
use super::exchange;
use nusselt::factors::PatchPlan;
use nusselt::scene::PolygonId;

#[test]
fn patches_add_up_to_their_polygons() {
    let l = vec![[0., 0., 0.], [2., 0., 0.5], [2., 1., 0.75], [1., 1., 0.5], [1., 2., 0.75], [0., 2., 0.5]];
    let triangle = vec![[5., 0., 0.], [6., 0.3, 0.], [5.2, 1.4, 0.9]];
    let pentagon = vec![[5., 5., 0.], [6., 5., 0.], [6.5, 6., 0.], [5.5, 7., 0.], [4.5, 6., 0.]];
    let polygons = [l, triangle, pentagon, rectangle([0., 0., 3.], [0., 2., 0.], [2., 0., 0.])];
    let scene = scene_of(&polygons);
    let whole = exchange(&scene, PatchPlan::Polygons, 1e-2);
    for longest_edge in [3.0, 0.7, 0.11, 0.03] {
        let mesh = exchange(&scene, PatchPlan::Mesh { longest_edge }, 1e-2);
        for (k, polygon) in whole.patches().iter().enumerate() {
            let parts = mesh.patches().iter().filter(|patch| patch.polygon == PolygonId(k as u32));
            let (count, area) = parts.fold((0, 0.0), |(count, area), patch| (count + 1, area + patch.area));
            assert!(
                (area - polygon.area).abs() < 1e-12 * polygon.area,
                "{k} {longest_edge}: {area} of {}",
                polygon.area
            );
            // No patch is larger than a square of that edge.
            assert!(count as f64 >= polygon.area / (longest_edge * longest_edge), "{k} {longest_edge}: {count}");
        }
    }
}

#[test]
fn a_mesh_of_a_room_is_of_squares() {
    let scene = scene_of(&cuboid([0.; 3], [4., 3., 2.5], true));
    let mesh = exchange(&scene, PatchPlan::Mesh { longest_edge: 0.5 }, 1e-2);
    assert_eq!(mesh.patches().len(), 2 * (8 * 6 + 6 * 5 + 8 * 5));
    // 3 / 0.3 is rounded to a little more than 10.
    let mesh = exchange(&scene, PatchPlan::Mesh { longest_edge: 0.3 }, 1e-2);
    assert_eq!(mesh.patches().len(), 2 * (14 * 10 + 10 * 9 + 14 * 9));
}

#[test]
fn rows_of_meshes_close() {
    let mut polygons = cuboid([0.; 3], [2., 1.5, 1.], true);
    polygons.extend(cuboid([0.5, 0.5, 0.2], [0.9, 0.8, 0.5], false));
    let mesh = exchange(&scene_of(&polygons), PatchPlan::Mesh { longest_edge: 0.3 }, 1e-4);
    for patch in (0..mesh.patches().len()).step_by(13) {
        let row = mesh.row(patch).expect("a row");
        assert!((row.sum() - 1.0).abs() <= 1e-12 && row.background.factor <= 1e-12, "{row:?}");
    }
}
