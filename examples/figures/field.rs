//! Figure 10: the radiance that the table and the white wall behind it reflect in the studio, straight from its lamps, as surfaces over them: by contour
//! images, and by hemicubes of 64 pixels across.

use crate::studio::studio;
use glam::{DVec2, DVec3};
use nusselt::brdf::Lighting;
use nusselt::contour::SceneOrder;
use nusselt::io::atomic_write;
use nusselt::render::{Shader, ShaderOptions, Shading, Spot};
use nusselt::scene::Side;
use std::error::Error;
use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;

/// Points along and across a surface.
const COLUMNS: usize = 109;
const ROWS: usize = 49;

/// A rectangle of a polygon.
struct Surface {
    name: &'static str,
    object: &'static str,
    /// Which of the object's polygons.
    polygon: usize,
    corner: DVec3,
    along: DVec3,
    across: DVec3,
    normal: DVec3,
}

/// But for a margin.
const SURFACES: [Surface; 2] = [
    Surface {
        name: "field",
        object: "table",
        polygon: 0,
        corner: DVec3::new(1.31, 1.91, 0.75),
        along: DVec3::new(1.78, 0.0, 0.0),
        across: DVec3::new(0.0, 1.08, 0.0),
        normal: DVec3::Z,
    },
    Surface {
        name: "field-wall",
        object: "room",
        polygon: 2,
        corner: DVec3::new(0.05, 4.0, 0.05),
        along: DVec3::new(4.3, 0.0, 0.0),
        across: DVec3::new(0.0, 0.0, 2.5),
        normal: DVec3::NEG_Y,
    },
];

/// The picture, and in it a step back and the height of the largest radiance.
const SIZE: DVec2 = DVec2::new(720.0, 480.0);
const BACK: DVec2 = DVec2::new(2.6, 6.2);
const PEAK: f64 = 125.0;

pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    SURFACES.iter().try_for_each(|surface| draw_of(surface, folder))
}

fn draw_of(surface: &Surface, folder: &Path) -> Result<(), Box<dyn Error>> {
    let exact = radiances(surface, Shading::Contour)?;
    let hemicube = radiances(surface, Shading::Hemicube { resolution: 64 })?;
    let peak = exact.iter().flatten().fold(0.0, |peak: f64, &x| peak.max(x));
    let pairs = || exact.iter().flatten().zip(hemicube.iter().flatten());
    let worst = pairs().map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    let mean = pairs().map(|(x, y)| (x - y).abs()).sum::<f64>() / (ROWS * COLUMNS) as f64;
    println!(
        "{}: hemicubes of 64 are off by {:.1}% of the peak at worst, {:.2}% on average",
        surface.object,
        100.0 * worst / peak,
        100.0 * mean / peak
    );
    write(&exact, peak, &folder.join(format!("{}-contour.svg", surface.name)))?;
    write(&hemicube, peak, &folder.join(format!("{}-hemicube.svg", surface.name)))
}

/// The red of what is reflected along the normal, by row and column.
fn radiances(surface: &Surface, shading: Shading) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let scene = studio().scene()?;
    let polygon = scene.polygons().filter(|polygon| polygon.object_name() == surface.object).nth(surface.polygon);
    let piece = polygon.and_then(|polygon| polygon.pieces().next()).ok_or("no such polygon")?.id();
    let options = ShaderOptions { shading, ..ShaderOptions::default() };
    let shader = Shader::new(SceneOrder::new(&scene), Lighting::default(), options)?;
    let row = |row: usize| {
        let points = (0..COLUMNS).map(|column| {
            let [along, across] = [column as f64 / (COLUMNS - 1) as f64, row as f64 / (ROWS - 1) as f64];
            let near = surface.corner + surface.along * along + surface.across * across;
            shader.reflected(&Spot { piece, side: Side::Front, near }, surface.normal, 0).map(|radiance| radiance.x)
        });
        points.collect::<Result<Vec<f64>, _>>()
    };
    (0..ROWS).map(|k| row(k).map_err(Into::into)).collect()
}

/// Draws rows from the back to the front, each over those behind it.
fn write(field: &[Vec<f64>], peak: f64, path: &Path) -> Result<(), Box<dyn Error>> {
    let place = |row: usize, column: usize, height: f64| {
        let along = column as f64 / (COLUMNS - 1) as f64;
        let width = SIZE.x - 60.0 - BACK.x * ROWS as f64;
        let ground = DVec2::new(30.0 + along * width + BACK.x * row as f64, SIZE.y - 25.0 - BACK.y * row as f64);
        ground - DVec2::Y * height / peak * PEAK
    };
    let mut lines = String::new();
    for (row, heights) in field.iter().enumerate().rev() {
        let mut data = String::new();
        for (column, &height) in heights.iter().enumerate() {
            let at = place(row, column, height);
            write!(data, "{:.1},{:.1} ", at.x, at.y)?;
        }
        let [first, last] = [0, COLUMNS - 1].map(|column| place(row, column, 0.0));
        let skirt = format!("{:.1},{:.1} {:.1},{:.1}", last.x, last.y, first.x, first.y);
        write!(lines, r#"<path class="skirt" d="M{data}{skirt}z"/><path d="M{data}"/>"#)?;
    }
    atomic_write(path, |out| {
        let DVec2 { x, y } = SIZE;
        writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
        writeln!(out, r#"<svg xmlns="http://www.w3.org/2000/svg" width="{x}" height="{y}" viewBox="0 0 {x} {y}">"#)?;
        writeln!(
            out,
            "<style>path{{fill:none;stroke:#7a4a12;stroke-width:.7}}.skirt{{fill:#fbf3e6;stroke:none}}</style>"
        )?;
        writeln!(out, r#"<rect width="{x}" height="{y}" fill="white"/>{lines}</svg>"#)
    })?;
    Ok(())
}
