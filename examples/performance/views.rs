//! What views of closed scenes take, by the 3D BSP and by a hierarchy of boxes.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, SceneOrder, ViewOptions, ViewSpace, Viewpoint};
use nusselt::samples::{Kind, generate};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Views a row; the same points for every machine.
const VIEWS: usize = 100;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "| scene | polygons | way | build s | view ms | worst | factors ms | cells | visible | inserted | skipped | nodes | filter undecided | integers | worst sum |\n\
         | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for kind in Kind::ALL {
        for polygons in [1_000, 10_000, 50_000] {
            eprintln!("views of a {kind} of {polygons} polygons");
            let mesh = generate(kind, polygons, 1)?;
            let scene = mesh.to_builder().build()?;
            let points = mesh.free_points(VIEWS, 3);
            let start = Instant::now();
            let order = SceneBsp::build(&scene, &BspOptions::default())?.into();
            write!(text, "| {kind} | {polygons} | BSP | {:.3} ", start.elapsed().as_secs_f64())?;
            text += &rest(&order, &points)?;
            let start = Instant::now();
            let order = SceneBvh::build(&scene).into();
            write!(text, "| {kind} | {polygons} | boxes | {:.3} ", start.elapsed().as_secs_f64())?;
            text += &rest(&order, &points)?;
        }
    }
    Ok(text)
}

/// The rest of a row; each view in the memory of the one before.
fn rest(order: &SceneOrder, points: &[[f64; 3]]) -> Result<String, Box<dyn Error>> {
    let (mut view, mut longest, mut factors, mut worst) = (0.0, 0.0f64, 0.0, 0.0f64);
    let mut counts = [0; 7];
    let mut space = ViewSpace::new();
    for point in points {
        let eye = Viewpoint::free(DVec3::from(*point));
        let start = Instant::now();
        let image = order.view_in(&mut space, &eye, &Domain::Hemisphere(DVec3::Z), &ViewOptions::default())?;
        let time = start.elapsed().as_secs_f64();
        let sums = image.form_factors().ok_or("a hemisphere has a normal")?;
        factors += start.elapsed().as_secs_f64() - time;
        view += time;
        longest = longest.max(time);
        worst = worst.max((sums.total() - 1.0).abs()).max(sums.background);
        let stats = image.stats();
        let row = [
            image.cell_count(),
            sums.polygons.len(),
            stats.inserted,
            stats.skipped_subtrees,
            stats.visited_nodes as usize,
            stats.predicates.undecided() as usize,
            (stats.predicates.fixed + stats.predicates.arbitrary) as usize,
        ];
        counts.iter_mut().zip(row).for_each(|(sum, n)| *sum += n);
    }
    let milli = |seconds: f64| seconds * 1e3 / points.len() as f64;
    let means = counts.map(|sum| (sum / points.len()).to_string()).join(" | ");
    Ok(format!("| {:.2} | {:.2} | {:.2} | {means} | {worst:.0e} |\n", milli(view), longest * 1e3, milli(factors)))
}
