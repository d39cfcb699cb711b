//! Triangles that overlap each other in the image: the work of polygon booleans.

use glam::DVec3;
use nusselt::contour::{Domain, SceneOrder, ViewOptions, ViewSpace, Viewpoint};
use nusselt::scene::{Material, Scene};
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

const COUNTS: [usize; 5] = [1_000, 2_000, 3_000, 10_000, 30_000];
/// The shortest of so many times counts.
const ROUNDS: usize = 9;
/// Microseconds a triangle at most.
const GOAL: f64 = 5.0;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "| triangles | their size | visible | cells | build ms | view and form factors ms | us a triangle |\n\
         | ---: | --- | ---: | ---: | ---: | ---: | ---: |\n",
    );
    let mut growths = Vec::new();
    let mut missed = Vec::new();
    for (size, name) in [(1.0, "the disc"), (0.1, "a tenth of it")] {
        let mut times = Vec::new();
        for count in COUNTS {
            eprintln!("{count} triangles of size {size}");
            let scene = triangles(count, size)?;
            let start = Instant::now();
            let order = SceneOrder::new(&scene);
            let build = start.elapsed().as_secs_f64() * 1e3;
            let (eye, up) = (Viewpoint::free(DVec3::ZERO), Domain::Hemisphere(DVec3::Z));
            let mut space = ViewSpace::new();
            let (mut best, mut visible, mut cells) = (f64::INFINITY, 0, 0);
            for _ in 0..ROUNDS {
                let start = Instant::now();
                let image = order.view_in(&mut space, &eye, &up, &ViewOptions::default())?;
                let factors = image.form_factors().ok_or("a hemisphere has a normal")?;
                best = best.min(start.elapsed().as_secs_f64() * 1e3);
                (visible, cells) = (factors.polygons.len(), image.cell_count());
            }
            let each = best * 1e3 / count as f64;
            times.push(each);
            if each > GOAL {
                missed.push(format!("{count} on {name}"));
            }
            writeln!(text, "| {count} | {name} | {visible} | {cells} | {build:.1} | {best:.2} | {each:.2} |")?;
        }
        if let (Some(first), Some(last)) = (times.first(), times.last()) {
            growths.push(format!("{:.2} times as long on {name}", last / first));
        }
    }
    let missed = if missed.is_empty() { "nowhere".to_owned() } else { format!("for {}", missed.join(", ")) };
    let [first, .., last] = COUNTS;
    writeln!(
        text,
        "\nMore than {GOAL} microseconds a triangle: {missed}. From {first} triangles to {last}, each takes {}.",
        growths.join(" and ")
    )?;
    Ok(text)
}

/// Triangles with their corners at random in discs of that radius about random points of the unit disc, each at a height of its own between 1 and 2
/// and as much larger: seen from the origin they overlap on one disc.
fn triangles(count: usize, size: f64) -> Result<Scene, Box<dyn Error>> {
    let mut state = 1_u64;
    let mut random = move || {
        // Knuth's generator for 64 bits.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(53)
    };
    let mut in_disc = move |radius: f64| {
        let (r, turn) = (radius * random().sqrt(), TAU * random());
        [r * turn.cos(), r * turn.sin()]
    };
    let mut vertices = Vec::new();
    for k in 0..count {
        // In no order.
        let z = 1.0 + (k as f64 * 0.618_033_988_749_894_8).fract();
        let [x, y] = in_disc(1.0 - size);
        for _ in 0..3 {
            let [u, v] = in_disc(size);
            vertices.push([(x + u) * z, (y + v) * z, z]);
        }
    }
    let faces: Vec<Vec<usize>> = (0..count).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Ok(Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build()?)
}
