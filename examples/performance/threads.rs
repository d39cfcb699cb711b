//! Many views by one thread and by more.

use glam::DVec3;
use nusselt::contour::{Domain, SceneOrder, ViewOptions, Viewpoint};
use nusselt::samples::{Kind, generate};
use rayon::ThreadPoolBuilder;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

const VIEWS: usize = 1_000;
/// The shortest of so many times counts, taken in turn.
const ROUNDS: usize = 5;
/// Two threads are to be so many times as fast as one.
const GOAL: f64 = 1.9;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let counts = [1, 2];
    let mut text = String::from(
        "| scene | polygons | 1 thread, s | 2 threads, s | ratio | the goal, 1.9 |\n| --- | ---: | ---: | ---: | ---: | --- |\n",
    );
    for (kind, polygons) in [(Kind::Room, 1_000), (Kind::Room, 10_000), (Kind::City, 10_000)] {
        eprintln!("{VIEWS} views of a {kind} of {polygons} polygons");
        let mesh = generate(kind, polygons, 1)?;
        let order = SceneOrder::new(&mesh.to_builder().build()?);
        let up = Domain::Hemisphere(DVec3::Z);
        let views: Vec<_> =
            mesh.free_points(VIEWS, 3).into_iter().map(|p| (Viewpoint::free(p.into()), up.clone())).collect();
        let mut best = counts.map(|_| f64::INFINITY);
        let mut sums = None;
        for _ in 0..ROUNDS {
            for (threads, best) in counts.into_iter().zip(&mut best) {
                let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
                let start = Instant::now();
                let of_image = |_, image: &nusselt::contour::ContourImage| image.form_factors().map(|f| f.total());
                let totals = pool.install(|| order.views(&views, &ViewOptions::default(), of_image))?;
                *best = best.min(start.elapsed().as_secs_f64());
                if *sums.get_or_insert_with(|| totals.clone()) != totals {
                    return Err("the number of threads changes the result".into());
                }
            }
        }
        let [one, two] = best;
        let ratio = one / two;
        let verdict = if ratio >= GOAL { "met" } else { "missed" };
        writeln!(text, "| {kind} | {polygons} | {one:.3} | {two:.3} | {ratio:.2} | {verdict} |")?;
    }
    Ok(text)
}
