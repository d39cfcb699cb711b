//! The table of docs/bsp.md: how the 3D BSP's size, its depth and the time of views depend on how planes are chosen.
//! `cargo bench --bench bsp` takes the generated scenes and those next to the repository; `cargo bench --bench bsp -- FILE ...`
//! takes files.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::io::{ReadOptions, read_scene};
use nusselt::samples::{Kind, generate};
use nusselt::scene::Scene;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// Views a row, from points spread over the scene's box (Halton's sequence).
const VIEWS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    println!("| scene | polygons | fragments | per polygon | depth | build s | view ms |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    if words.is_empty() {
        for kind in Kind::ALL {
            for polygons in [1_000, 50_000] {
                row(&format!("{kind} {polygons}"), &generate(kind, polygons, 1)?.to_builder().build()?)?;
            }
        }
    }
    for word in words {
        let path = Path::new(&word);
        let scene = read_scene(path, &ReadOptions::default())?.scene;
        row(&path.file_stem().unwrap_or_default().to_string_lossy(), &scene)?;
    }
    Ok(())
}

fn row(name: &str, scene: &Scene) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let bsp = SceneBsp::build(scene, &BspOptions::default());
    let built = start.elapsed().as_secs_f64();
    let bsp = match bsp {
        Ok(bsp) => bsp,
        Err(error) => {
            println!("| {name} | {} | {error} | | | {built:.3} | |", scene.polygon_count());
            return Ok(());
        }
    };
    let (low, high) = scene.bounds().ok_or("an empty scene")?;
    let mut seconds = 0.0;
    for k in 1..=VIEWS {
        let share = DVec3::new(halton(k, 2), halton(k, 3), halton(k, 5));
        let eye = low + share * (high - low);
        let start = Instant::now();
        bsp.view(&Viewpoint::free(eye), &Domain::Sphere)?;
        seconds += start.elapsed().as_secs_f64();
    }
    let (count, stats) = (scene.polygon_count(), bsp.stats());
    println!(
        "| {name} | {count} | {} | {:.2} | {} | {built:.3} | {:.3} |",
        stats.fragments,
        stats.fragments as f64 / count as f64,
        stats.depth,
        seconds * 1e3 / VIEWS as f64,
    );
    Ok(())
}

/// The k-th number of van der Corput's sequence.
fn halton(mut k: usize, base: usize) -> f64 {
    let (mut share, mut number) = (1.0, 0.0);
    while k > 0 {
        share /= base as f64;
        number += share * (k % base) as f64;
        k /= base;
    }
    number
}
