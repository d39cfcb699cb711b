//! The table of docs/verification.md: what a certificate costs, `cargo bench --bench certify`, or for one scene
//! `cargo bench --bench certify -- room 50000`.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, SceneOrder, Viewpoint};
use nusselt::samples::{Kind, Mesh, generate};
use nusselt::verify::{Arithmetic, Extent};
use std::error::Error;
use std::time::Instant;

/// Views a row; the same points for every machine.
const VIEWS: usize = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    println!(
        "| scene | polygons | way | cells | great circles | view ms | evidence ms | A to C | A to D | E | decisions | A to D / view | E / view |"
    );
    println!("| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    if let [kind, polygons] = words.as_slice() {
        return rows(kind.parse()?, polygons.parse()?);
    }
    for kind in Kind::ALL {
        for polygons in [1_000, 10_000, 50_000] {
            rows(kind, polygons)?;
        }
    }
    Ok(())
}

fn rows(kind: Kind, polygons: usize) -> Result<(), Box<dyn Error>> {
    let mesh = generate(kind, polygons, 1)?;
    let scene = mesh.to_builder().build()?;
    row(kind, polygons, "BSP", &mesh, &SceneBsp::build(&scene, &BspOptions::default())?.into())?;
    row(kind, polygons, "boxes", &mesh, &SceneBvh::build(&scene).into())
}

fn row(kind: Kind, polygons: usize, way: &str, mesh: &Mesh, order: &SceneOrder) -> Result<(), Box<dyn Error>> {
    let scene = order.scene();
    let mut seconds = [0.0; 5];
    let mut counts = [0; 3];
    for point in mesh.free_points(VIEWS, 3) {
        let mut start = Instant::now();
        let mut lap = |slot: &mut f64| {
            let now = Instant::now();
            *slot += (now - start).as_secs_f64();
            start = Instant::now();
        };
        let image = order.view(&Viewpoint::free(DVec3::from(point)), &Domain::Hemisphere(DVec3::Z))?;
        lap(&mut seconds[0]);
        let evidence = image.evidence();
        lap(&mut seconds[1]);
        evidence.check_to(scene, Arithmetic::Kernel, Extent::Tiling)?;
        lap(&mut seconds[2]);
        evidence.check_to(scene, Arithmetic::Kernel, Extent::Cones)?;
        lap(&mut seconds[3]);
        let certificate = evidence.check(scene, Arithmetic::Kernel)?;
        lap(&mut seconds[4]);
        let row = [certificate.cells, certificate.great_circles, certificate.exact_decisions as usize];
        counts.iter_mut().zip(row).for_each(|(sum, n)| *sum += n);
    }
    let [view, evidence, tiling, cones, all] = seconds.map(|s| s * 1e3 / VIEWS as f64);
    let [cells, circles, decisions] = counts.map(|sum| sum / VIEWS);
    println!(
        "| {kind} | {polygons} | {way} | {cells} | {circles} | {view:.2} | {evidence:.2} | {tiling:.2} | {cones:.2} | {:.2} | {decisions} | {:.1} | {:.1} |",
        all - cones,
        (evidence + cones) / view,
        (all - cones) / view,
    );
    Ok(())
}
