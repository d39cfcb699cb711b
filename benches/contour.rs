//! Building the 3D BSP and viewing generated scenes: `cargo bench --bench contour`.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, ViewOptions, Viewpoint};
use nusselt::samples::{Kind, Mesh, generate};
use nusselt::scene::Scene;
use std::hint::black_box;

const SIZES: [usize; 3] = [1_000, 10_000, 50_000];

fn sample(kind: Kind, polygons: usize) -> (Mesh, Scene) {
    let mesh = generate(kind, polygons, 1).expect("a size the generator takes");
    let scene = mesh.to_builder().build().expect("a generated scene is valid");
    (mesh, scene)
}

fn bsp(c: &mut Criterion) {
    let mut group = c.benchmark_group("bsp");
    group.sample_size(10);
    for kind in Kind::ALL {
        for polygons in SIZES {
            let (_, scene) = sample(kind, polygons);
            group.bench_function(BenchmarkId::new(kind.name(), polygons), |b| {
                b.iter(|| SceneBsp::build(black_box(&scene), &BspOptions::default()));
            });
        }
    }
    group.finish();
}

fn view(c: &mut Criterion) {
    let mut group = c.benchmark_group("hemisphere");
    group.sample_size(20);
    for kind in Kind::ALL {
        for polygons in SIZES {
            let (mesh, scene) = sample(kind, polygons);
            let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
            let mut eyes = mesh.free_points(20, 3).into_iter().map(DVec3::from).cycle();
            group.bench_function(BenchmarkId::new(kind.name(), polygons), |b| {
                b.iter(|| {
                    let eye = eyes.next().expect("an endless cycle");
                    let image = bsp.view(&Viewpoint::free(eye), &Domain::Hemisphere(DVec3::Z));
                    image.map(|image| image.form_factors())
                });
            });
        }
    }
    group.finish();
}

fn quadtree(c: &mut Criterion) {
    let mut group = c.benchmark_group("quadtree_depth");
    group.sample_size(20);
    let (mesh, scene) = sample(Kind::Room, 10_000);
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
    for depth in 0..=6 {
        let options = ViewOptions { quadtree_depth: Some(depth), ..ViewOptions::default() };
        let mut eyes = mesh.free_points(20, 3).into_iter().map(DVec3::from).cycle();
        group.bench_function(BenchmarkId::from_parameter(depth), |b| {
            b.iter(|| {
                let eye = eyes.next().expect("an endless cycle");
                bsp.view_with(&Viewpoint::free(eye), &Domain::Hemisphere(DVec3::Z), &options)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, bsp, view, quadtree);
criterion_main!(benches);
