//! The rows of the table in docs/comparison.md: hemisphere views with all form factors of generated rooms, one thread. `cargo bench --bench comparison`,
//! or of some rows, such as `-- 10000/hemicube`.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, SceneOrder, ViewOptions, ViewSpace, Viewpoint};
use nusselt::hemicube::{Hemicube, Method, Rays};
use nusselt::samples::{Kind, generate};
use std::hint::black_box;

const SIZES: [usize; 3] = [1_000, 10_000, 50_000];
const RESOLUTIONS: [usize; 7] = [32, 64, 128, 256, 512, 1024, 2048];
const RAYS: [u32; 3] = [1_000, 10_000, 100_000];

fn rows(c: &mut Criterion) {
    for polygons in SIZES {
        let mesh = generate(Kind::Room, polygons, 1).expect("a size the generator takes");
        let scene = mesh.to_builder().build().expect("a generated scene is valid");
        let mut eyes = mesh.free_points(20, 3).into_iter().map(|p| Viewpoint::free(DVec3::from(p))).cycle();
        let mut eye = || eyes.next().expect("an endless cycle");
        let mut group = c.benchmark_group(polygons.to_string());
        group.sample_size(20);
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
        let boxes = SceneBvh::build(&scene);
        for (method, order) in [(Method::Contour, SceneOrder::from(bsp)), (Method::ContourByBoxes, boxes.into())] {
            let (mut space, up) = (ViewSpace::new(), Domain::Hemisphere(DVec3::Z));
            group.bench_function(method.name(), |b| {
                b.iter(|| {
                    let image = order.view_in(&mut space, &eye(), &up, &ViewOptions::default());
                    black_box(image.expect("a view").form_factors());
                });
            });
        }
        for resolution in RESOLUTIONS {
            let mut hemicube = Hemicube::new(&scene, resolution).expect("an even resolution");
            group.bench_function(BenchmarkId::new("hemicube", resolution), |b| {
                b.iter(|| _ = black_box(hemicube.view(&eye(), DVec3::Z).expect("a view").factors().len()));
            });
            group.bench_function(BenchmarkId::new("analytic", resolution), |b| {
                b.iter(|| _ = black_box(hemicube.analytic(&eye(), DVec3::Z).expect("a view").factors().len()));
            });
        }
        let mut tracer = Rays::new(&scene);
        for rays in RAYS {
            group.bench_function(BenchmarkId::new("rays", rays), |b| {
                b.iter(|| _ = black_box(tracer.view(&eye(), DVec3::Z, rays, 1).expect("a view").factors().count()));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, rows);
criterion_main!(benches);
