//! Figure 6: a point of a surface, the lamp, and what the point sees, on the hemisphere around it.

use crate::fragments::{ASPECT, DEGREES, EYE, LOOK_AT, SIZE};
use crate::table;
use glam::{DVec2, DVec3};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{ContourImage, Domain, Frustum, Projection, Projector, Viewpoint};
use nusselt::io::{DrawingOptions, Fill, atomic_write, write_drawing};
use nusselt::scene::{PolygonId, PolygonRef, Scene, Side};
use std::error::Error;
use std::fmt::{self, Write as _};
use std::io::Write;
use std::path::Path;

/// The point on the table, and the radius of the hemisphere.
const POINT: DVec3 = DVec3::new(0.1, -0.15, 0.0);
const RADIUS: f64 = 0.8;
const MARGIN: f64 = 20.0;

pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    let scene = table::scene()?;
    let bvh = SceneBvh::build(&scene);
    let frustum = Frustum::new(LOOK_AT - EYE, DVec3::Z, DEGREES, ASPECT)?;
    let picture = bvh.view(&Viewpoint::free(EYE), &Domain::Frustum(frustum))?;
    let projector = Projector::of_image(&picture, Projection::Gnomonic)?;
    let options = DrawingOptions { size: SIZE, fill: Fill::White, ..DrawingOptions::default() };
    let mut drawing = Vec::new();
    write_drawing(&picture, &projector, &options, &mut drawing)?;
    let drawing = String::from_utf8(drawing)?;
    let body = drawing.strip_suffix("</svg>\n").ok_or("the drawing does not end")?;

    let top = scene.polygons().position(|polygon| polygon.object_name() == "table").ok_or("no table")?;
    let on = Viewpoint::on_surface(&scene, PolygonId(top as u32), Side::Front, POINT)?;
    let image = bvh.view(&on, &Domain::Above)?;
    let place = |point: DVec3| {
        let window = projector.window();
        let at = (projector.point(point - EYE) - window.low) / window.size();
        DVec2::new(MARGIN + at.x * SIZE, MARGIN + (1.0 - at.y) * SIZE / ASPECT)
    };
    let dome = dome(&image, &place)?;
    let lamp = scene.polygons().find(|polygon| polygon.material().is_emitter()).ok_or("no lamp")?;
    let rays = rays(&scene, lamp, &place)?;
    let factors = image.form_factors().ok_or("no form factors")?;
    println!("the lamp's form factor is {}", factors.of(lamp.id()));
    atomic_write(&folder.join("receiver.svg"), |out| writeln!(out, "{body}{dome}{rays}</svg>"))?;
    Ok(())
}

/// The part of a closed path on the hemisphere that is turned to the camera, as points.
fn near_part(path: &[DVec3]) -> Vec<DVec3> {
    let to_eye = EYE - POINT;
    // Positive where the hemisphere is turned to the eye.
    let height = |direction: DVec3| direction.dot(to_eye) - RADIUS;
    let (axis, level) = (to_eye.normalize(), RADIUS / to_eye.length());
    // Where the sphere's outline is, as seen by the eye.
    let on_rim = |direction: DVec3| {
        let aside = (direction - axis * direction.dot(axis)).normalize();
        axis * level + aside * (1.0 - level * level).sqrt()
    };
    let mut part: Vec<DVec3> = Vec::new();
    // Where the path left.
    let mut left: Option<DVec3> = None;
    for (k, &from) in path.iter().enumerate() {
        let to = path[(k + 1) % path.len()];
        let [here, there] = [height(from), height(to)];
        if here >= 0.0 {
            part.push(from);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let crossing = on_rim(from.lerp(to, here / (here - there)));
            if let (true, Some(start)) = (there >= 0.0, left) {
                part.extend((1..16).map(|step| on_rim(start.lerp(crossing, f64::from(step) / 16.0))));
            }
            part.push(crossing);
            left = Some(crossing);
        }
    }
    part
}

/// The cells on the side of the hemisphere that is turned to the camera, each in the colour of what it shows.
fn dome(image: &ContourImage, place: &impl Fn(DVec3) -> DVec2) -> Result<String, fmt::Error> {
    let mut text = String::from(r##"<g stroke="#555" stroke-width="0.4" stroke-linejoin="round" fill-opacity="0.8">"##);
    for cell in image.cells() {
        let corners: Vec<DVec3> = cell.boundary().collect();
        let sides = corners.iter().zip(corners.iter().cycle().skip(1));
        let path: Vec<DVec3> = sides
            .flat_map(|(from, to)| (0..24).map(move |step| from.lerp(*to, f64::from(step) / 24.0).normalize()))
            .collect();
        // From a corner that is turned away, if there is one, so that it is left before it is entered.
        let away = path.iter().position(|d| d.dot(EYE - POINT) < RADIUS).unwrap_or(0);
        let first = (away..path.len()).find(|&k| path[k].dot(EYE - POINT) >= RADIUS).unwrap_or(away);
        let turned: Vec<DVec3> = path[first..].iter().chain(&path[..first]).copied().collect();
        let points: Vec<String> = near_part(&turned)
            .into_iter()
            .map(|direction| place(POINT + direction * RADIUS))
            .map(|at| format!("{:.1},{:.1}", at.x, at.y))
            .collect();
        if points.is_empty() {
            continue;
        }
        let data = points.join(" ");
        let colour = match cell.polygon().map(|polygon| image.scene().polygon(polygon).material()) {
            None => "#cfe4f7".to_owned(),
            Some(material) if material.is_emitter() => "#ffd21f".to_owned(),
            Some(material) => {
                // The square root is near enough to how screens show colours.
                let [r, g, b] = material.diffuse.map(|x| (x.sqrt() * 255.0).round());
                format!("rgb({r},{g},{b})")
            }
        };
        write!(text, r#"<path d="M{data}z" fill="{colour}"/>"#)?;
    }
    text.push_str("</g>\n");
    Ok(text)
}

/// From the corners of the lamp to the point.
fn rays(scene: &Scene, lamp: PolygonRef<'_>, place: &impl Fn(DVec3) -> DVec2) -> Result<String, fmt::Error> {
    let mut text = String::from(r##"<g stroke="#c79a00" stroke-width="1" stroke-dasharray="5 4">"##);
    let at = place(POINT);
    for &vertex in lamp.rings().iter().flatten() {
        let corner = place(scene.vertex(vertex));
        write!(text, r#"<path d="M{:.1},{:.1} {:.1},{:.1}"/>"#, corner.x, corner.y, at.x, at.y)?;
    }
    write!(text, r##"</g><circle cx="{:.1}" cy="{:.1}" r="3.5" fill="#111"/>"##, at.x, at.y)?;
    Ok(text)
}
