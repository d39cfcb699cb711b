//! What a lamp of a generated scene takes, seen from points on the floor: a view limited to the window that the lamp is, and the form
//! factor of the lamp.

use crate::range;
use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, ViewOptions, ViewSpace, Viewpoint, Windows};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{ObjectId, PolygonId, PolygonRef, Scene};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Points on the floor a row; the same for every machine.
const VIEWS: usize = 1000;
/// All points are gone through so many times; the best time of each counts, as other programs take the processor now and then.
const ROUNDS: usize = 5;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "| scene | polygons | window | tiles | ms | worst | hemisphere ms | hidden | partly | cells | inserted | skipped | nodes |\n\
         | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    let mut gains = Vec::new();
    for kind in [Kind::Room, Kind::Office] {
        for polygons in [1_000, 10_000, 50_000] {
            eprintln!("a lamp in a {kind} of {polygons} polygons");
            let mesh = generate(kind, polygons, 1)?;
            let scene = mesh.to_builder().build()?;
            let bvh = SceneBvh::build(&scene);
            let lamp = scene.objects().iter().position(|name| name.starts_with("lamp"));
            let lamp = ObjectId(lamp.ok_or("the scene has a lamp")? as u32);
            let tiles: Vec<PolygonId> =
                scene.polygons().filter(|polygon| polygon.object() == lamp).map(PolygonRef::id).collect();
            let outline = Windows::free(&outline(&scene, &tiles))?;
            let points = mesh.floor_points(VIEWS, 3);
            for (name, windows) in [("outline", outline), ("tiles", Windows::polygons(tiles.iter().copied()))] {
                let (row, gain) = row(&bvh, &points, &tiles, windows)?;
                gains.push(gain);
                writeln!(text, "| {kind} | {polygons} | {name} | {} | {row}", tiles.len())?;
            }
        }
    }
    writeln!(text, "\nA whole hemisphere takes {} times as long as the window.", range(gains))?;
    Ok(text)
}

/// The rectangle that tiles at one height fill.
fn outline(scene: &Scene, tiles: &[PolygonId]) -> [DVec3; 4] {
    let corners = tiles.iter().flat_map(|&tile| scene.polygon(tile).rings().iter().flatten());
    let corners = corners.map(|&vertex| scene.vertex(vertex));
    let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    [low, low.with_x(high.x), high, low.with_y(high.y)]
}

/// The rest of a row, and how many times as long a whole hemisphere takes.
fn row(
    bvh: &SceneBvh,
    points: &[[f64; 3]],
    tiles: &[PolygonId],
    windows: Windows,
) -> Result<(String, f64), Box<dyn Error>> {
    let domain = Domain::Window(windows.within_hemisphere(DVec3::Z));
    let options = ViewOptions::default();
    let mut space = ViewSpace::new();
    let mut best = vec![f64::INFINITY; points.len()];
    let (mut hidden, mut partly) = (0, 0);
    let mut counts = [0; 4];
    let mut seen = Vec::with_capacity(points.len());
    for round in 0..ROUNDS {
        for (point, best) in points.iter().zip(&mut best) {
            let start = Instant::now();
            let image = bvh.view_in(&mut space, &Viewpoint::free(DVec3::from(*point)), &domain, &options)?;
            let factors = image.form_factors().ok_or("the windows have a normal")?;
            let lamp: f64 = tiles.iter().map(|&tile| factors.of(tile)).sum();
            *best = best.min(start.elapsed().as_secs_f64() * 1e3);
            if round > 0 {
                continue;
            }
            hidden += usize::from(lamp == 0.0);
            partly += usize::from(lamp > 0.0 && lamp < factors.total() * (1.0 - 1e-9));
            let stats = image.stats();
            let row = [image.cell_count(), stats.inserted, stats.skipped_subtrees, stats.visited_nodes as usize];
            counts.iter_mut().zip(row).for_each(|(sum, n)| *sum += n);
            seen.push(lamp);
        }
    }
    let mean = best.iter().sum::<f64>() / points.len() as f64;
    let worst = best.iter().copied().fold(0.0, f64::max);
    // The same from whole hemispheres: the lamp's factors must agree.
    let some = points.len() / 20;
    let mut best = vec![f64::INFINITY; some];
    for _ in 0..ROUNDS {
        for ((point, lamp), best) in points.iter().zip(&seen).zip(&mut best) {
            let start = Instant::now();
            let viewpoint = Viewpoint::free(DVec3::from(*point));
            let image = bvh.view_in(&mut space, &viewpoint, &Domain::Hemisphere(DVec3::Z), &options)?;
            let factors = image.form_factors().ok_or("a hemisphere has a normal")?;
            let expected: f64 = tiles.iter().map(|&tile| factors.of(tile)).sum();
            *best = best.min(start.elapsed().as_secs_f64() * 1e3);
            if (expected - lamp).abs() > 1e-12 {
                return Err(format!("{point:?}: the lamp's form factor is {lamp} and not {expected}").into());
            }
        }
    }
    let hemisphere = best.iter().sum::<f64>() / some as f64;
    let means = counts.map(|sum| format!("{:.1}", sum as f64 / points.len() as f64)).join(" | ");
    Ok((format!("{mean:.4} | {worst:.3} | {hemisphere:.3} | {hidden} | {partly} | {means} |"), hemisphere / mean))
}
