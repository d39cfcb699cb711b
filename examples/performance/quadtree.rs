//! What a quadtree at the top of the contour tree gains, on the faces of a cube and on image planes, and how it looks.

use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Projection, Projector, Quadtree, Spacing, ViewOptions, ViewSpace, Viewpoint};
use nusselt::io::{SvgOptions, atomic_write, write_svg};
use nusselt::samples::{Kind, Mesh, generate};
use nusselt::scene::Scene;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

const DEPTHS: [u32; 7] = [0, 1, 2, 3, 4, 5, 6];
const VIEWS: usize = 30;
const UP: Domain = Domain::Hemisphere(DVec3::Z);

pub(crate) fn part(images: &Path) -> Result<String, Box<dyn Error>> {
    for (name, quadtree) in [
        ("quadtree-cube", Quadtree::Cube),
        ("quadtree-even", Quadtree::Plane { degrees: 170.0, spacing: Spacing::Even }),
        ("quadtree-centre", Quadtree::Plane { degrees: 170.0, spacing: Spacing::TowardsCentre }),
    ] {
        draw(&images.join(format!("{name}.svg")), quadtree)?;
    }
    let mut text = String::from(
        "Milliseconds a view with all form factors, or solid angles for the sphere; depths across.\n\n| scene | polygons | domain | quadtree |",
    );
    for depth in DEPTHS {
        write!(text, " {depth} |")?;
    }
    text += "\n| --- | ---: | --- | --- |";
    text += &" ---: |".repeat(DEPTHS.len());
    text.push('\n');
    for (kind, polygons) in [
        (Kind::Room, 1_000),
        (Kind::Room, 10_000),
        (Kind::Room, 50_000),
        (Kind::Office, 50_000),
        (Kind::City, 50_000),
        (Kind::Room, 200_000),
    ] {
        eprintln!("quadtrees in a {kind} of {polygons} polygons");
        let mesh = generate(kind, polygons, 1)?;
        let bvh = SceneBvh::build(&mesh.to_builder().build()?);
        for (domain, name) in [(UP, "hemisphere"), (Domain::Sphere, "sphere")] {
            let means = depths(&bvh, &mesh, &domain, Quadtree::Cube)?;
            writeln!(text, "| {kind} | {polygons} | {name} | cube | {means}")?;
        }
        if kind != Kind::Room || polygons != 50_000 {
            continue;
        }
        for degrees in [90.0, 120.0, 150.0, 170.0, 179.0] {
            for (spacing, name) in [(Spacing::Even, "even"), (Spacing::TowardsCentre, "towards the centre")] {
                let means = depths(&bvh, &mesh, &UP, Quadtree::Plane { degrees, spacing })?;
                writeln!(text, "| {kind} | {polygons} | hemisphere | plane of {degrees}, {name} | {means}")?;
            }
        }
    }
    Ok(text)
}

/// Mean times by depth, as the rest of a row. All depths see from a point before the next one is taken.
fn depths(bvh: &SceneBvh, mesh: &Mesh, domain: &Domain, quadtree: Quadtree) -> Result<String, Box<dyn Error>> {
    let mut means = DEPTHS.map(|_| 0.0);
    let mut space = ViewSpace::new();
    for point in mesh.free_points(VIEWS, 3) {
        let eye = Viewpoint::free(DVec3::from(point));
        for (depth, mean) in DEPTHS.into_iter().zip(&mut means) {
            let options = ViewOptions { quadtree_depth: Some(depth), quadtree, ..ViewOptions::default() };
            let start = Instant::now();
            let image = bvh.view_in(&mut space, &eye, domain, &options)?;
            if image.form_factors().is_none() {
                image.solid_angles();
            }
            *mean += start.elapsed().as_secs_f64() * 1e3 / VIEWS as f64;
        }
    }
    Ok(means.map(|ms| format!("{ms:.2} |")).join(" "))
}

/// The quadtree alone, four levels deep.
fn draw(path: &Path, quadtree: Quadtree) -> Result<(), Box<dyn Error>> {
    let bvh = SceneBvh::build(&Scene::builder().build()?);
    let options = ViewOptions { quadtree_depth: Some(4), quadtree, ..ViewOptions::default() };
    let image = bvh.view_with(&Viewpoint::free(DVec3::ZERO), &UP, &options)?;
    let projector = Projector::of_image(&image, Projection::Stereographic)?;
    let options = SvgOptions { show_tree: true, ..SvgOptions::default() };
    Ok(atomic_write(path, |file| write_svg(&image, &projector, &options, file))?)
}
