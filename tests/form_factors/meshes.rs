//! Meshes of polygons.

use super::cases::{cuboid, rectangle, scene_of};
use super::exchange;
use glam::DVec3;
use nusselt::factors::{PatchPlan, mesh_scene};
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

/// Patch by patch, near the origin and far away, where the exchange computes elsewhere.
#[test]
fn scenes_of_patches_are_those_of_the_mesh() {
    for shift in [0.0, 1e7] {
        let l = [[0., 0., 0.], [2., 0., 0.5], [2., 1., 0.75], [1., 1., 0.5], [1., 2., 0.75], [0., 2., 0.5]];
        let pentagon = [[5., 5., 0.], [6., 5., 0.], [6.5, 6., 0.], [5.5, 7., 0.], [4.5, 6., 0.]];
        let moved = |polygon: &[[f64; 3]]| polygon.iter().map(|p| p.map(|x| x + shift)).collect::<Vec<_>>();
        let scene = scene_of(&[moved(&l), moved(&pentagon)]);
        for longest_edge in [3.0, 0.7, 0.11] {
            let mesh = exchange(&scene, PatchPlan::Mesh { longest_edge }, 1e-2);
            let (patches, of) = mesh_scene(&scene, longest_edge).expect("a mesh");
            assert_eq!(patches.polygon_count(), mesh.patches().len());
            assert!(of.iter().eq(mesh.patches().iter().map(|patch| &patch.polygon)));
            for (polygon, patch) in patches.polygons().zip(mesh.patches()) {
                let shape = patch.shape.as_ref().expect("an area");
                let [ring] = &shape.pieces[..] else { panic!("one piece") };
                let corners: Vec<DVec3> = polygon.rings()[0].iter().map(|&vertex| patches.vertex(vertex)).collect();
                assert_eq!(corners, *ring);
            }
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
fn patches_tell_where_they_are() {
    let l = vec![[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [1., 1., 0.], [1., 2., 0.], [0., 2., 0.]];
    let wall = rectangle([0., 0., 3.], [0., 2., 0.], [0., 0., 2.]);
    let mut polygons = cuboid([5.; 3], [6.; 3], false);
    polygons.extend([l.clone(), wall.clone(), vec![[0.; 3], [1.; 3], [2.; 3]]]);
    let scene = scene_of(&polygons);
    let whole = exchange(&scene, PatchPlan::Polygons, 1e-2);
    let shape = |k: usize| whole.patches()[k].shape.as_ref();
    // Of a polygon of several pieces, the centre of mass: that of 2 x 1 at (1, 0.5) and 1 x 1 at (0.5, 1.5).
    let [of_l, of_wall] = [6, 7].map(|k| shape(k).expect("it has area"));
    assert!(of_l.center.distance(DVec3::new(2.5, 2.5, 0.0) / 3.0) < 1e-15, "{of_l:?}");
    assert!(of_l.normal == Some(DVec3::Z) && of_l.pieces.len() > 1 && of_l.boundary().is_none(), "{of_l:?}");
    assert_eq!((of_wall.center, of_wall.normal), (DVec3::new(0.0, 1.0, 4.0), Some(DVec3::X)));
    assert_eq!(of_wall.boundary(), Some(&wall.iter().map(|&p| DVec3::from(p)).collect::<Vec<_>>()[..]));
    assert_eq!(shape(8), None, "no area");
    // A closed surface has no normal.
    let box_alone = exchange(&scene_of(&polygons[..6]), PatchPlan::Objects, 1e-2);
    let around = box_alone.patches()[0].shape.as_ref().expect("it has area");
    assert_eq!((around.center, around.normal, around.pieces.len()), (DVec3::splat(5.5), None, 6));
    // Parts of a mesh: by polygon, and in a grid along the first edge first.
    let mesh = exchange(&scene, PatchPlan::Mesh { longest_edge: 1.0 }, 1e-2);
    assert!(mesh.patches().is_sorted_by_key(|patch| patch.polygon));
    let of_wall = mesh.patches().iter().filter(|patch| patch.polygon == PolygonId(7));
    let centers: Vec<_> = of_wall.map(|patch| patch.shape.as_ref().expect("it has area").center.to_array()).collect();
    assert_eq!(centers, [[0., 0.5, 3.5], [0., 1.5, 3.5], [0., 0.5, 4.5], [0., 1.5, 4.5]]);
    for (k, patch) in mesh.patches().iter().enumerate() {
        let shape = patch.shape.as_ref().expect("meshes have no patches without area");
        let corners = shape.boundary().expect("one piece");
        let sides = corners.iter().zip(corners.iter().cycle().skip(1));
        let twice: DVec3 = sides.map(|(&a, &b)| (a - shape.center).cross(b - shape.center)).sum();
        let normal = shape.normal.expect("it is flat");
        assert!((twice.dot(normal) / 2.0 - patch.area).abs() < 1e-12, "{k}: counter-clockwise seen from the front");
    }
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
