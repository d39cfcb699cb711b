//! Both sides of planes through a room.

use super::*;
use crate::samples::{Kind, generate};

fn area(scene: &Scene, piece: PieceId) -> f64 {
    let ring: Vec<DVec3> = scene.piece(piece).points().collect();
    (1..ring.len() - 1).map(|k| (ring[k] - ring[0]).cross(ring[k + 1] - ring[0])).sum::<DVec3>().length() / 2.0
}

#[test]
fn both_sides_of_a_plane_make_the_scene() {
    let scene = generate(Kind::Room, 300, 3).unwrap().to_builder().build().unwrap();
    let mut cut = 0;
    for plane in scene.planes().iter().step_by(5) {
        let mut areas = vec![0.0; scene.piece_count()];
        for is_front in [true, false] {
            let (part, pieces) = before(&scene, *plane, is_front).unwrap();
            assert_eq!(part.polygon_count(), pieces.len());
            for polygon in part.polygons() {
                let of = pieces[polygon.id().index()];
                areas[of.index()] += polygon.pieces().map(|piece| area(&part, piece.id())).sum::<f64>();
                for piece in polygon.pieces() {
                    // On its side of the plane, and of the piece that it is part of.
                    let normal = |scene: &Scene, piece: PieceId| {
                        let p: Vec<DVec3> = scene.piece(piece).points().collect();
                        (1..p.len() - 1).map(|k| (p[k] - p[0]).cross(p[k + 1] - p[0])).sum::<DVec3>()
                    };
                    let along = normal(&part, piece.id()).dot(normal(&scene, of).normalize());
                    // Corners are rounded by 1e-16 times lengths up to 10: thinner slivers may be turned.
                    assert!(along > -1e-15, "{along:e} of {:e}", normal(&scene, of).length());
                    for p in piece.points() {
                        let Height { side, height } = Height::of(&scene, *plane, is_front, p);
                        assert!(!side.is_negative() || height < 1e-14, "{p} is {height} behind");
                    }
                }
            }
        }
        for piece in scene.pieces() {
            let side = |v: &VertexId| Height::of(&scene, *plane, true, scene.vertex(*v)).side;
            let is_in_plane = piece.vertices().iter().all(|v| side(v).is_zero());
            let expected = if is_in_plane { 0.0 } else { area(&scene, piece.id()) };
            let sides: Vec<Sign> = piece.vertices().iter().map(side).collect();
            cut += usize::from(sides.contains(&Sign::Positive) && sides.contains(&Sign::Negative));
            let found = areas[piece.id().index()];
            assert!((found - expected).abs() < 1e-12 * expected.max(1e-3), "{found} {expected}");
        }
    }
    assert!(cut > 100, "{cut}");
}

/// Whatever the unit: products of lengths are no numbers here.
#[test]
fn scaled_scenes_are_cut_at_the_same_places() {
    let scaled = |exponent: i32| {
        let unit = 2f64.powi(exponent);
        let corners = [[0., 0., 0.], [4., 1., 0.3], [1., 3., 2.], [-1., 0., 1.], [3., 0.5, 2.], [2., 3., -1.]];
        let corners: Vec<[f64; 3]> = corners.iter().map(|p| p.map(|x| x * unit)).collect();
        let faces = [vec![0, 1, 2], vec![3, 4, 5]];
        let scene = Scene::builder().mesh(&corners, &faces, Material::new("any")).build().unwrap();
        let plane = scene.pieces().next().unwrap().plane();
        let (part, _) = before(&scene, plane, true).unwrap();
        part.vertices().iter().map(|&p| p / unit).collect::<Vec<_>>()
    };
    let expected = scaled(0);
    assert!(expected.len() >= 3);
    for exponent in [-500, -270, 255, 500, 1020] {
        assert_eq!(scaled(exponent), expected, "2^{exponent}");
    }
}
