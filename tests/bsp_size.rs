//! The 3D BSP of meshes that are hard on it: how many fragments, and how deep.

use nusselt::bsp::{BspOptions, PlaneChoice, SceneBsp};
use nusselt::scene::{Material, Scene};
use std::f64::consts::PI;

fn scene(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Scene {
    Scene::builder().mesh(vertices, faces, Material::new("grey")).build().expect("a good mesh")
}

/// A ball of `k` bands of `k` quads, cut into triangles.
fn ball(k: usize) -> Scene {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for i in 0..=k {
        for j in 0..k {
            let (t, p) = (PI * i as f64 / k as f64, 2.0 * PI * j as f64 / k as f64);
            vertices.push([t.sin() * p.cos(), t.sin() * p.sin(), t.cos()]);
        }
    }
    for i in 0..k {
        for j in 0..k {
            let next = (j + 1) % k;
            let [a, b, c, d] = [i * k + j, (i + 1) * k + j, (i + 1) * k + next, i * k + next];
            faces.extend([vec![a, b, c], vec![a, c, d]]);
        }
    }
    scene(&vertices, &faces)
}

/// `n` triangles around a tip.
fn cone(n: usize) -> Scene {
    let mut vertices = vec![[0.1, 0.2, 1.3]];
    vertices.extend((0..n).map(|k| 2.0 * PI * k as f64 / n as f64).map(|a| [a.cos(), a.sin(), 0.0]));
    let faces: Vec<_> = (0..n).map(|k| vec![0, 1 + k, 1 + (k + 1) % n]).collect();
    scene(&vertices, &faces)
}

/// `n` triangles around an edge that all have.
fn fan(n: usize) -> Scene {
    let mut vertices = vec![[0.0; 3], [0.3, 0.2, 1.0]];
    vertices.extend((0..n).map(|k| 2.0 * PI * k as f64 / n as f64).map(|a| [a.cos(), a.sin(), 0.5]));
    let faces: Vec<_> = (0..n).map(|k| vec![0, 1, 2 + k]).collect();
    scene(&vertices, &faces)
}

/// At most thrice the polygons, and thrice the depth of a balanced tree.
fn check(name: &str, scene: &Scene) {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("few fragments");
    let (polygons, stats) = (scene.piece_count(), bsp.stats());
    assert!(stats.fragments <= 3 * polygons, "{name}: {} fragments of {polygons} polygons", stats.fragments);
    let balanced = (polygons as f64).log2();
    assert!(stats.depth as f64 <= 3.0 * balanced, "{name}: depth {} with {polygons} polygons", stats.depth);
}

#[test]
fn convex_meshes_do_not_become_lists() {
    for k in [10, 31, 70] {
        check("ball", &ball(k));
    }
    for n in [100, 1_000, 10_000] {
        check("cone", &cone(n));
        check("fan", &fan(n));
    }
    // What is avoided.
    let list = SceneBsp::build(&cone(300), &BspOptions { planes: PlaneChoice::Polygons, ..BspOptions::default() });
    assert!(list.unwrap().stats().depth >= 100);
}

#[test]
fn building_makes_progress_where_rounding_puts_quads_off_their_plane() {
    // Quads that are planar in decimals only, turned: each becomes two triangles, nearly in one plane; many copies in one place.
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for k in 0..200 {
        let turn = f64::from(k) * 0.1;
        let corner = |x: f64, y: f64| {
            let (s, c) = turn.sin_cos();
            [c * x - s * y, s * x + c * y, 0.1 * x + 0.7 * y + 1e-9 * f64::from(k % 3)]
        };
        let first = vertices.len();
        vertices.extend([corner(0.1, 0.2), corner(1.3, 0.2), corner(1.3, 0.9), corner(0.1, 0.9)]);
        faces.push((first..first + 4).collect());
    }
    let scene = scene(&vertices, &faces);
    for epsilon in [0.0, 1e-12, 1e-6] {
        for planes in [PlaneChoice::Balanced, PlaneChoice::SurfaceArea, PlaneChoice::Polygons] {
            let bsp = SceneBsp::build(&scene, &BspOptions { epsilon, planes, ..BspOptions::default() }).unwrap();
            assert!(bsp.fragment_count() >= scene.piece_count(), "epsilon {epsilon}");
        }
    }
}
