//! Measures building and viewing generated scenes: `cargo run --release --example measure -- room 10000 20`.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, ViewOptions, Viewpoint};
use nusselt::samples::{Kind, generate};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let kind: Kind = arguments[0].parse()?;
    let polygons: usize = arguments[1].parse()?;
    let views: usize = arguments[2].parse()?;
    let depth: Option<u32> = arguments.get(3).map(|d| d.parse()).transpose()?;
    let mesh = generate(kind, polygons, 1)?;
    let start = Instant::now();
    let scene = mesh.to_builder().build()?;
    let built = start.elapsed();
    let start = Instant::now();
    let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
    println!("scene {built:?} bsp {:?} {:?}", start.elapsed(), bsp.stats());
    let (mut time, mut factors, mut cells, mut visible, mut inserted, mut worst) = (0.0, 0.0, 0, 0, 0, 0.0f64);
    let (mut visited, mut undecided, mut integers, mut skipped) = (0, 0, 0, 0);
    let options = ViewOptions { quadtree_depth: depth };
    for point in mesh.free_points(views, 3) {
        let start = Instant::now();
        let image = bsp.view_with(&Viewpoint::free(DVec3::from(point)), &Domain::Hemisphere(DVec3::Z), &options)?;
        time += start.elapsed().as_secs_f64();
        let start = Instant::now();
        let sums = image.form_factors().ok_or("no normal")?;
        factors += start.elapsed().as_secs_f64();
        cells += image.cell_count();
        visible += sums.polygons.len();
        worst = worst.max((sums.total() - 1.0).abs()).max(sums.background);
        let s = image.stats();
        inserted += s.inserted;
        visited += s.visited_nodes;
        undecided += s.undecided;
        integers += s.decided_by_integers;
        skipped += s.skipped_subtrees;
    }
    let n = views as f64;
    println!(
        "view {:.3} ms, factors {:.3} ms, cells {}, visible {}, inserted {}, skipped {}, visited {}, undecided {}, integers {}, worst {worst:e}",
        time / n * 1e3,
        factors / n * 1e3,
        cells / views,
        visible / views,
        inserted / views,
        skipped / views,
        visited / views as u64,
        undecided / views as u64,
        integers / views as u64,
    );
    Ok(())
}
