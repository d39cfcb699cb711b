//! What a view costs, against the polygons of the scene and against those seen.

use crate::plot::{Log, Series, chart};
use crate::range;
use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, ViewOptions, ViewSpace, Viewpoint};
use nusselt::samples::{Kind, generate};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

const SIZES: [usize; 10] = [1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 200_000, 500_000, 1_000_000];

/// The mean of the views of one scene.
struct Row {
    kind: Kind,
    polygons: usize,
    build_s: f64,
    view_ms: f64,
    factors_ms: f64,
    visible: f64,
    cells: f64,
    /// Visible polygons and milliseconds, of each view.
    views: Vec<(f64, f64)>,
}

pub(crate) fn part(images: &Path) -> Result<String, Box<dyn Error>> {
    let mut rows = Vec::new();
    for kind in Kind::ALL {
        for polygons in SIZES {
            eprintln!("{kind} of {polygons} polygons");
            rows.push(measure(kind, polygons)?);
        }
    }
    let lines = |of: fn(&Row) -> Vec<(f64, f64)>| {
        Kind::ALL.map(|kind| {
            let points = rows.iter().filter(|row| row.kind == kind).flat_map(of).collect();
            Series { name: kind.name(), points }
        })
    };
    let [polygons, ms] = ["polygons in the scene", "milliseconds a view, with all form factors"];
    let time = Log { title: ms, range: (0.02, 1_000.0) };
    let all = lines(|row| vec![(row.polygons as f64, row.view_ms + row.factors_ms)]);
    chart(&images.join("scaling-polygons.svg"), &Log { title: polygons, range: (800.0, 1.2e6) }, &time, &all, true)?;
    let visible = Log { title: "polygons seen", range: (10.0, 3e5) };
    chart(&images.join("scaling-visible.svg"), &visible, &time, &lines(|row| row.views.clone()), false)?;
    let mut text = String::from(
        "| scene | polygons | build s | view ms | factors ms | visible | cells | us a visible polygon |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for row in &rows {
        let Row { kind, polygons, build_s, view_ms, factors_ms, visible, cells, .. } = row;
        let each = (view_ms + factors_ms) * 1e3 / visible;
        writeln!(
            text,
            "| {kind} | {polygons} | {build_s:.3} | {view_ms:.2} | {factors_ms:.2} | {visible:.0} | {cells:.0} | {each:.2} |"
        )?;
    }
    let each = |row: &Row| (row.view_ms + row.factors_ms) * 1e3 / row.visible;
    writeln!(text, "\nMicroseconds a visible polygon, of all scenes: {}.", range(rows.iter().map(each)))?;
    Ok(text)
}

fn measure(kind: Kind, polygons: usize) -> Result<Row, Box<dyn Error>> {
    let mesh = generate(kind, polygons, 1)?;
    let scene = mesh.to_builder().build()?;
    let start = Instant::now();
    let bvh = SceneBvh::build(&scene);
    let build_s = start.elapsed().as_secs_f64();
    let points = mesh.free_points(if polygons > 100_000 { 20 } else { 100 }, 3);
    let mut space = ViewSpace::new();
    let mut row =
        Row { kind, polygons, build_s, view_ms: 0.0, factors_ms: 0.0, visible: 0.0, cells: 0.0, views: Vec::new() };
    for point in &points {
        let start = Instant::now();
        let eye = Viewpoint::free(DVec3::from(*point));
        let image = bvh.view_in(&mut space, &eye, &Domain::Hemisphere(DVec3::Z), &ViewOptions::default())?;
        let seen = Instant::now();
        let factors = image.form_factors().ok_or("a hemisphere has a normal")?;
        let [view, sum] = [seen - start, seen.elapsed()].map(|time| time.as_secs_f64() * 1e3);
        let count = points.len() as f64;
        row.view_ms += view / count;
        row.factors_ms += sum / count;
        row.visible += factors.polygons.len() as f64 / count;
        row.cells += image.cell_count() as f64 / count;
        row.views.push((factors.polygons.len() as f64, view + sum));
    }
    Ok(row)
}
