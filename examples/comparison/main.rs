//! The measured part of docs/comparison.md and its figures: `cargo run --release --example comparison`.
//!
//! Hemisphere views, normal up, of the generated room from points inside, by all methods, on one thread. Rewrites what is between the marks in
//! docs/comparison.md, a paragraph of README.md, and docs/images/comparison-*.svg. Another folder in place of docs, with a comparison.md in it, may be
//! named; README.md stays as it is then.

mod derived;
mod figures;
#[path = "../common/machine.rs"]
mod machine;
#[path = "../common/marks.rs"]
mod marks;
mod tables;

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::hemicube::{ComparisonRow, Method, compare};
use nusselt::samples::{Kind, generate};
use std::error::Error;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The sizes of the room.
const POLYGONS: [usize; 3] = [1_000, 10_000, 50_000];
/// Views of each; the same points for every method and machine.
const VIEWS: usize = 20;
/// Each view is taken as often, in turn with the others, and the shortest time counts.
const ROUNDS: usize = 9;
const RESOLUTIONS: [usize; 7] = [32, 64, 128, 256, 512, 1024, 2048];
const RAYS: [u32; 3] = [1_000, 10_000, 100_000];

/// A room and what was measured in it.
struct Room {
    polygons: usize,
    bsp_s: f64,
    rows: Vec<ComparisonRow>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let other = std::env::args_os().nth(1).map(PathBuf::from);
    let docs = other.clone().unwrap_or_else(|| root.join("docs"));
    // Before anything is measured.
    let page = marks::Page::open(&docs.join("comparison.md"), "measured")?;
    let readme = other.is_none().then(|| marks::Page::open(&root.join("README.md"), "comparison")).transpose()?;
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let start = Instant::now();
    let rooms = POLYGONS.map(measure).into_iter().collect::<Result<Vec<_>, _>>()?;
    figures::draw(&rooms, &docs.join("images"))?;
    page.write(&format!("{}\n{}\n", tables::text(&rooms), machine::sentence()))?;
    if let Some(readme) = readme {
        readme.write(&derived::summary(&rooms))?;
    }
    eprintln!("{:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

fn measure(polygons: usize) -> Result<Room, Box<dyn Error>> {
    let mesh = generate(Kind::Room, polygons, 1)?;
    let scene = mesh.to_builder().build()?;
    let start = Instant::now();
    let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
    let bsp_s = start.elapsed().as_secs_f64();
    let points = mesh.free_points(VIEWS, 3);
    let view = |point| (Viewpoint::free(DVec3::from(point)), Domain::Hemisphere(DVec3::Z));
    let views: Vec<_> = points.into_iter().map(view).collect();
    let mut methods = vec![Method::Contour, Method::ContourByBoxes];
    for resolution in RESOLUTIONS {
        methods.extend([Method::Hemicube { resolution }, Method::Analytic { resolution }]);
    }
    methods.extend(RAYS.map(|rays| Method::Rays { rays }));
    let rounds = NonZeroUsize::new(ROUNDS).ok_or("no rounds")?;
    let mut done = 0;
    let rows = compare(&bsp, &views, &methods, rounds, |count| {
        done += count;
        eprintln!("{polygons} polygons: {done} of {} views", views.len() * methods.len() * ROUNDS);
    })?;
    Ok(Room { polygons, bsp_s, rows })
}
