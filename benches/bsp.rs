//! The tables of docs/bsp.md. `cargo bench --bench bsp` compares the choices of splitting planes on generated scenes and on those next to
//! the repository; `cargo bench --bench bsp -- FILE ...` on files; `cargo bench --bench bsp -- size` builds large scenes.

use glam::DVec3;
use nusselt::bsp::{BspOptions, PlaneChoice, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::io::{ReadOptions, read_scene};
use nusselt::samples::{Kind, generate};
use nusselt::scene::Scene;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

const CHOICES: [PlaneChoice; 3] = [PlaneChoice::Balanced, PlaneChoice::SurfaceArea, PlaneChoice::Polygons];

/// Planes of polygons alone take quadratic time on convex meshes: not tried beyond this.
const MOST_FOR_POLYGONS: usize = 20_000;

/// Views a row, in all directions, from points spread over the scene's box (Halton's sequence).
const VIEWS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    if words == ["size"] {
        return sizes();
    }
    println!("| scene | polygons | planes | fragments | per polygon | depth | build s | view ms |");
    println!("| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: |");
    let mut files: Vec<PathBuf> = words.iter().map(PathBuf::from).collect();
    if words.is_empty() {
        for kind in Kind::ALL {
            for polygons in [1_000, 50_000] {
                rows(&kind.to_string(), &generate(kind, polygons, 1)?.to_builder().build()?)?;
            }
        }
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes");
        let known = ["classic/spot.obj", "classic/teapot.obj", "degenerate/manifold/openscad-nonmanifold-crash.obj"];
        let more = ["Cray_left.obj", "Generic_Twin_7863.1.t0_left.obj", "Offset1.obj", "self_intersectA.obj"];
        files.extend(known.iter().map(|name| scenes.join(name)));
        files.extend(more.iter().map(|name| scenes.join("degenerate/manifold").join(name)));
        files.retain(|path| {
            let is_there = path.exists();
            if !is_there {
                eprintln!("SKIPPED: {} is not there", path.display());
            }
            is_there
        });
    }
    for path in files {
        let scene = read_scene(&path, &ReadOptions::default())?.scene;
        rows(&path.file_stem().unwrap_or_default().to_string_lossy(), &scene)?;
    }
    Ok(())
}

fn rows(name: &str, scene: &Scene) -> Result<(), Box<dyn Error>> {
    let count = scene.polygon_count();
    for planes in CHOICES {
        if planes == PlaneChoice::Polygons && count > MOST_FOR_POLYGONS {
            continue;
        }
        let start = Instant::now();
        let built = SceneBsp::build(scene, &BspOptions { planes, ..BspOptions::default() });
        let seconds = start.elapsed().as_secs_f64();
        let bsp = match built {
            Ok(bsp) => bsp,
            Err(error) => {
                println!("| {name} | {count} | {planes:?} | {error} | | | {seconds:.3} | |");
                continue;
            }
        };
        let (low, high) = scene.bounds().ok_or("an empty scene")?;
        let start = Instant::now();
        for k in 1..=VIEWS {
            let share = DVec3::new(halton(k, 2), halton(k, 3), halton(k, 5));
            bsp.view(&Viewpoint::free(low + share * (high - low)), &Domain::Sphere)?;
        }
        let view = start.elapsed().as_secs_f64() * 1e3 / VIEWS as f64;
        let stats = bsp.stats();
        let ratio = stats.fragments as f64 / count as f64;
        println!(
            "| {name} | {count} | {planes:?} | {} | {ratio:.2} | {} | {seconds:.3} | {view:.2} |",
            stats.fragments, stats.depth
        );
    }
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

fn sizes() -> Result<(), Box<dyn Error>> {
    println!(
        "| scene | polygons | fragments | per polygon | depth | scene s | 1 thread s | 2 threads s | bytes per polygon | at most |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for kind in Kind::ALL {
        for polygons in [50_000, 200_000, 1_000_000] {
            let mesh = generate(kind, polygons, 1)?;
            let start = Instant::now();
            let scene = mesh.to_builder().build()?;
            let scene_seconds = start.elapsed().as_secs_f64();
            drop(mesh);
            let [one, two] = [1, 2].map(|threads| -> Result<_, Box<dyn Error>> {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
                let start = Instant::now();
                let bsp = pool.install(|| SceneBsp::build(&scene, &BspOptions::default()))?;
                Ok((start.elapsed().as_secs_f64(), bsp))
            });
            let ((one, bsp), (two, bsp_of_two)) = (one?, two?);
            drop(bsp_of_two);
            // In this thread alone, so that all is counted: the scene with its tree, and the most while both are made.
            let mut tree = None;
            let counted = allocation_counter::measure(|| {
                let scene = generate(kind, polygons, 1).ok().and_then(|mesh| mesh.to_builder().build().ok());
                let options = BspOptions { grain: Some(0), ..BspOptions::default() };
                tree = scene.and_then(|scene| SceneBsp::build(&scene, &options).ok());
            });
            let stats = bsp.stats();
            println!(
                "| {kind} | {polygons} | {} | {:.2} | {} | {scene_seconds:.2} | {one:.2} | {two:.2} | {} | {} |",
                stats.fragments,
                stats.fragments as f64 / polygons as f64,
                stats.depth,
                counted.bytes_current / polygons as i64,
                counted.bytes_max / polygons as u64,
            );
            drop(tree);
        }
    }
    Ok(())
}
