//! What it takes to merge cells to regions, and to draw those in Nusselt's projection.

use crate::range;
use glam::DVec3;
use nusselt::contour::{Domain, Projection, Projector, SceneOrder, ViewOptions, ViewSpace, Viewpoint, VisibleRegion};
use nusselt::samples::{Kind, generate};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Views a row.
const VIEWS: usize = 20;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "| scene | polygons | cells | view ms | merge ms | merge / view | regions | loops | sides | picture ms | points |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    let mut ratios = Vec::new();
    for kind in Kind::ALL {
        for polygons in [1_000, 10_000, 50_000] {
            eprintln!("regions of a {kind} of {polygons} polygons");
            let mesh = generate(kind, polygons, 1)?;
            let order = SceneOrder::new(&mesh.to_builder().build()?);
            let mut space = ViewSpace::new();
            let mut times = [0.0; 3];
            let mut counts = [0; 5];
            for point in mesh.free_points(VIEWS, 3) {
                let eye = Viewpoint::free(DVec3::from(point));
                let start = Instant::now();
                let image = order.view_in(&mut space, &eye, &Domain::Hemisphere(DVec3::Z), &ViewOptions::default())?;
                let viewed = Instant::now();
                let regions = image.regions();
                let merged = Instant::now();
                let picture = Projector::of_image(image, Projection::Nusselt)?.regions(image, Projector::TOLERANCE);
                let drawn = Instant::now();
                for (sum, time) in times.iter_mut().zip([viewed - start, merged - viewed, drawn - merged]) {
                    *sum += time.as_secs_f64() * 1e3 / VIEWS as f64;
                }
                let loops = regions.iter().flat_map(VisibleRegion::loops);
                let rings = picture.iter().flat_map(|region| region.holes.iter().chain([&region.exterior]));
                let row = [
                    image.cell_count(),
                    regions.len(),
                    loops.clone().count(),
                    loops.map(|boundary| boundary.sides().len()).sum(),
                    rings.map(Vec::len).sum(),
                ];
                counts.iter_mut().zip(row).for_each(|(sum, n)| *sum += n);
            }
            let [view, merge, draw] = times;
            let [cells, regions, loops, sides, points] = counts.map(|sum| sum / VIEWS);
            let ratio = merge / view;
            ratios.push(ratio);
            writeln!(
                text,
                "| {kind} | {polygons} | {cells} | {view:.2} | {merge:.2} | {ratio:.2} | {regions} | {loops} | {sides} | {draw:.2} | {points} |"
            )?;
        }
    }
    writeln!(text, "\nMerging takes {} times as long as the view.", range(ratios))?;
    Ok(text)
}
