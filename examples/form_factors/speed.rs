//! Whole matrices, by one thread and by two.

use super::{city, scenes};
use nusselt::factors::{Exchange, ExchangeError, ExchangeOptions, PatchPlan};
use nusselt::scene::Scene;
use std::error::Error;
use std::fmt::Write;
use std::ops::Range;
use std::time::Instant;

fn scene(name: &str) -> Result<Scene, Box<dyn Error>> {
    Ok(match name {
        "empty" => scenes::room(false)?,
        "box" => scenes::room(true)?,
        blocks => city::city(blocks.parse()?)?,
    })
}

/// Seconds, entries and the worst raw closure.
struct Run {
    seconds: f64,
    entries: usize,
    raw: f64,
}

fn run(exchange: &Exchange, rows: Range<usize>, threads: usize) -> Result<Run, Box<dyn Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let (mut entries, mut raw) = (0, 0.0_f64);
    let start = Instant::now();
    pool.install(|| {
        exchange.rows(rows, |row| {
            entries += row.entries.len();
            raw = raw.max((row.closure_raw - 1.0).abs());
            Ok::<(), ExchangeError>(())
        })
    })?;
    Ok(Run { seconds: start.elapsed().as_secs_f64(), entries, raw })
}

/// Some rows of one scene, for profiles.
pub(super) fn rows_of(name: &str, tolerance: f64, rows: Range<usize>) -> Result<(), Box<dyn Error>> {
    let scene = scene(name)?;
    let options = ExchangeOptions { tolerance, ..ExchangeOptions::default() };
    let exchange = Exchange::new(&scene, PatchPlan::Polygons, options)?;
    let rows = rows.start..rows.end.min(exchange.patches().len());
    let count = rows.len();
    let Run { seconds, entries, raw } = run(&exchange, rows, 1)?;
    println!("{:.3} ms a row, {entries} entries, raw closure {raw:.1e}", seconds * 1e3 / count as f64);
    Ok(())
}

pub(super) fn part() -> Result<String, Box<dyn Error>> {
    let mut table = String::from(
        "| scene | patches | set-up s | 1 thread s | goal s | 2 threads s | ratio | entries | worst raw closure |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    let scenes = [
        ("empty", "the room, empty", 1.0),
        ("box", "the room with a turned box", 15.0),
        ("10", "the city of 10 x 10 blocks", 8.0),
    ];
    for (name, title, goal) in scenes {
        let scene = scene(name)?;
        let start = Instant::now();
        let exchange = Exchange::new(&scene, PatchPlan::Polygons, ExchangeOptions::default())?;
        let set_up = start.elapsed().as_secs_f64();
        let patches = exchange.patches().len();
        // In turn, as the machine may be busy with other things; the shorter ones.
        let mut best = [f64::INFINITY; 2];
        let (mut entries, mut raw) = (0, 0.0);
        for _ in 0..2 {
            for (threads, best) in [1, 2].into_iter().zip(&mut best) {
                let run = run(&exchange, 0..patches, threads)?;
                *best = best.min(run.seconds);
                (entries, raw) = (run.entries, run.raw);
            }
        }
        let [one, two] = best;
        writeln!(
            table,
            "| {title} | {patches} | {set_up:.3} | {one:.2} | {goal} | {two:.2} | {:.2} | {entries} | {raw:.1e} |",
            one / two
        )?;
    }
    Ok(table)
}
