//! The table of docs/performance.md about windows: `cargo bench --bench windows [-- room 50000]`. What a lamp of a generated scene takes, seen from
//! points on the floor: a view limited to the window that the lamp is, and the form factor of the lamp.

use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, ViewOptions, ViewSpace, Viewpoint, Windows};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{ObjectId, PolygonId, PolygonRef, Scene};
use std::error::Error;
use std::time::Instant;

/// Points on the floor a row; the same for every machine.
const VIEWS: usize = 1000;

/// All points are gone through so many times; the best time of each counts, as other programs take the processor now and then.
const ROUNDS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    println!(
        "| scene | polygons | window | tiles | ms | worst | hemisphere ms | hidden | partly | cells | inserted | skipped | nodes |"
    );
    println!("| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    if let [kind, polygons, ..] = words.as_slice() {
        return rows(kind.parse()?, polygons.parse()?);
    }
    for kind in [Kind::Room, Kind::Office] {
        for polygons in [1_000, 10_000, 50_000] {
            rows(kind, polygons)?;
        }
    }
    Ok(())
}

fn rows(kind: Kind, polygons: usize) -> Result<(), Box<dyn Error>> {
    let mesh = generate(kind, polygons, 1)?;
    let scene = mesh.to_builder().build()?;
    let bvh = SceneBvh::build(&scene);
    let lamp = scene.objects().iter().position(|name| name.starts_with("lamp")).ok_or("the scene has a lamp")?;
    let tiles: Vec<PolygonId> =
        scene.polygons().filter(|polygon| polygon.object() == ObjectId(lamp as u32)).map(PolygonRef::id).collect();
    let outline = outline(&scene, &tiles);
    let points = mesh.floor_points(VIEWS, 3);
    row(&format!("| {kind} | {polygons} | outline"), &bvh, &points, &tiles, &Windows::free(&outline)?)?;
    row(&format!("| {kind} | {polygons} | tiles"), &bvh, &points, &tiles, &Windows::polygons(tiles.iter().copied()))
}

/// The rectangle that tiles at one height fill.
fn outline(scene: &Scene, tiles: &[PolygonId]) -> [DVec3; 4] {
    let corners = tiles.iter().flat_map(|&tile| scene.polygon(tile).rings().iter().flatten());
    let corners = corners.map(|&vertex| scene.vertex(vertex));
    let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    [low, low.with_x(high.x), high, low.with_y(high.y)]
}

fn row(
    name: &str,
    bvh: &SceneBvh,
    points: &[[f64; 3]],
    tiles: &[PolygonId],
    windows: &Windows,
) -> Result<(), Box<dyn Error>> {
    let domain = Domain::Window(windows.clone().within_hemisphere(DVec3::Z));
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
    let all = best.iter().sum();
    let worst = best.iter().copied().fold(0.0, f64::max);
    // The same from whole hemispheres: the lamp's factors must agree.
    let (some, mut hemisphere) = (points.len() / 20, 0.0);
    for (point, lamp) in points.iter().zip(&seen).take(some) {
        let start = Instant::now();
        let viewpoint = Viewpoint::free(DVec3::from(*point));
        let image = bvh.view_in(&mut space, &viewpoint, &Domain::Hemisphere(DVec3::Z), &options)?;
        let factors = image.form_factors().ok_or("a hemisphere has a normal")?;
        let expected: f64 = tiles.iter().map(|&tile| factors.of(tile)).sum();
        hemisphere += start.elapsed().as_secs_f64() * 1e3;
        assert!((expected - lamp).abs() <= 1e-12, "{point:?}: {lamp} instead of {expected}");
    }
    let mean = |sum: f64, count: usize| sum / count as f64;
    let means = counts.map(|sum| format!("{:.1}", mean(sum as f64, points.len()))).join(" | ");
    println!(
        "{name} | {} | {:.4} | {worst:.3} | {:.3} | {hidden} | {partly} | {means} |",
        tiles.len(),
        mean(all, points.len()),
        mean(hemisphere, some),
    );
    Ok(())
}
