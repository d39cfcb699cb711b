//! The report on a mesh: open edges, duplicates, T-junctions.

use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{Material, MeshReport, PolygonId, Scene, TJunction, VertexId};

fn report(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> MeshReport {
    Scene::builder().mesh(vertices, faces, Material::new("m")).build().expect("sound").report()
}

#[test]
fn generated_scenes_are_closed() {
    for kind in Kind::ALL {
        let mesh = generate(kind, 2000, 3).expect("enough polygons");
        let report = mesh.to_builder().build().expect("sound").report();
        assert_eq!((report.open_edges.len(), report.turned_edges.len()), (0, 0), "{kind}");
        assert_eq!((report.duplicates.len(), report.degenerate.len()), (0, 0), "{kind}");
    }
}

#[test]
fn the_cornell_box_is_open() {
    let report = cornell_box().to_builder().build().expect("sound").report();
    // The mouth, the lamp, the bottoms of both blocks.
    assert_eq!(report.open_edges.len(), 4 + 4 + 8);
    assert_eq!(report.non_planar.len(), 1);
}

#[test]
fn turned_duplicate_and_degenerate_faces_are_found() {
    let corners = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [2., 0., 0.]];
    let found = report(&corners, &[vec![0, 1, 2, 3], vec![2, 1, 0, 3], vec![0, 1, 4], vec![1, 2, 4]]);
    assert_eq!(found.duplicates, [[PolygonId(0), PolygonId(1)]]);
    assert_eq!(found.degenerate, [PolygonId(2)]);
    assert_eq!(found.crowded_edges.len(), 1);
    assert_eq!(found.crowded_edges[0].polygons, [0, 1, 3].map(PolygonId));
    let turned = report(&corners, &[vec![0, 1, 2, 3], vec![1, 2, 4]]);
    assert_eq!(turned.turned_edges, [[VertexId(1), VertexId(2)]]);
}

#[test]
fn t_junctions_are_told_from_cracks_and_from_corners() {
    let with = |x: f64| {
        let corners = [[0., 0., 0.], [2., 0., 0.], [0., 2., 0.], [x, 1., 0.], [2., 2., 1.], [9., 9., 9.]];
        report(&corners, &[vec![0, 1, 2], vec![3, 4, 5]]).t_junctions
    };
    let edge = [VertexId(1), VertexId(2)];
    assert_eq!(with(1.0), [TJunction { edge, vertex: VertexId(3), exact: true, gap: 0.0 }]);
    let [crack] = with(1.0 + 1e-12)[..] else { panic!("one crack") };
    assert_eq!((crack.edge, crack.vertex, crack.exact), (edge, VertexId(3), false));
    assert!((crack.gap / (1e-12 * 0.5_f64.sqrt()) - 1.0).abs() < 1e-3, "{:e}", crack.gap);
    assert_eq!(with(1.001), []);
}

#[test]
fn clumps_and_far_points_do_not_make_it_slow_or_wrong() {
    // A strip of 20,000 tiny triangles and one vertex very far away.
    let n = 20_000;
    let mut corners: Vec<[f64; 3]> = (0..n).map(|k| [f64::from(k), f64::from(k % 2), 0.0]).collect();
    corners.push([1e30, 0.0, 1e30]);
    let mut faces: Vec<Vec<usize>> = (0..n as usize - 2).map(|k| vec![k, k + 1, k + 2]).collect();
    faces.push(vec![0, 1, n as usize]);
    let found = report(&corners, &faces);
    assert!(found.open_edges.len() > n as usize / 2);
}

#[test]
fn sizes_of_all_kinds_are_taken() {
    for size in [1e-300, 1.0, 1e300] {
        let corners = [[0., 0., 0.], [2., 0., 0.], [0., 2., 0.], [1., 1., 0.], [2., 2., 1.], [9., 9., 9.]];
        let scaled = corners.map(|p| p.map(|x| x * size));
        assert_eq!(report(&scaled, &[vec![0, 1, 2], vec![3, 4, 5]]).t_junctions.len(), 1, "{size:e}");
    }
}
