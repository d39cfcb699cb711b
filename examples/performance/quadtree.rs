//! What a quadtree at the top of the contour tree gains, on the faces of a cube and on image planes.

use crate::range;
use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Quadtree, Spacing, ViewOptions, ViewSpace, Viewpoint};
use nusselt::samples::{Kind, Mesh, generate};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

const DEPTHS: [u32; 7] = [0, 1, 2, 3, 4, 5, 6];
const VIEWS: usize = 30;
/// Where image planes are tried.
const PLANES_IN: (Kind, usize) = (Kind::Room, 50_000);
const UP: Domain = Domain::Hemisphere(DVec3::Z);

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "Milliseconds a view with all form factors, or solid angles for the sphere; depths across.\n\n| scene | polygons | domain | quadtree |",
    );
    for depth in DEPTHS {
        write!(text, " {depth} |")?;
    }
    text += " best at | gain | default |\n| --- | ---: | --- | --- |";
    text += &" ---: |".repeat(DEPTHS.len() + 3);
    text.push('\n');
    let (mut gains, mut losses) = (Vec::new(), Vec::new());
    let (mut cube, mut planes) = (f64::INFINITY, Vec::new());
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
            let depths = depths(&bvh, &mesh, &domain, Quadtree::Cube)?;
            gains.push(depths.gain());
            losses.push(depths.default / depths.best());
            if name == "hemisphere" && (kind, polygons) == PLANES_IN {
                cube = depths.best();
            }
            writeln!(text, "| {kind} | {polygons} | {name} | cube | {}", depths.in_words())?;
        }
        if (kind, polygons) != PLANES_IN {
            continue;
        }
        for degrees in [90.0, 120.0, 150.0, 170.0, 179.0] {
            for (spacing, name) in [(Spacing::Even, "even"), (Spacing::TowardsCentre, "towards the centre")] {
                let depths = depths(&bvh, &mesh, &UP, Quadtree::Plane { degrees, spacing })?;
                planes.push((degrees, depths.best()));
                writeln!(
                    text,
                    "| {kind} | {polygons} | hemisphere | plane of {degrees}, {name} | {}",
                    depths.in_words()
                )?;
            }
        }
    }
    writeln!(
        text,
        "\nOn the faces of a cube the best depth is {} times as fast as none, and the default takes {} times as long as the best.",
        range(gains),
        range(losses)
    )?;
    text += "\nImage planes, each at its best depth, against the faces of a cube at theirs (1 is as long), halved evenly and towards the centre: ";
    let planes: Vec<String> = planes
        .chunks(2)
        .filter_map(|pair| {
            let [(degrees, even), (_, centre)] = pair else { return None };
            Some(format!("{degrees} degrees {:.2} and {:.2}", even / cube, centre / cube))
        })
        .collect();
    writeln!(text, "{}.", planes.join("; "))?;
    Ok(text)
}

/// Mean times by depth, in milliseconds.
struct Depths {
    means: [f64; DEPTHS.len()],
    /// At the depth that is chosen if none is asked for.
    default: f64,
}

impl Depths {
    fn best(&self) -> f64 {
        self.means.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// How many times as fast the best depth is as none.
    fn gain(&self) -> f64 {
        self.means[0] / self.best()
    }

    /// The rest of a row.
    fn in_words(&self) -> String {
        let means = self.means.map(|ms| format!("{ms:.2} |")).join(" ");
        let best = DEPTHS.into_iter().zip(self.means).min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(depth, _)| depth);
        format!("{means} {best} | {:.2} | {:.2} |", self.gain(), self.default)
    }
}

/// All depths see from a point before the next one is taken.
fn depths(bvh: &SceneBvh, mesh: &Mesh, domain: &Domain, quadtree: Quadtree) -> Result<Depths, Box<dyn Error>> {
    let mut depths = Depths { means: DEPTHS.map(|_| 0.0), default: 0.0 };
    let mut space = ViewSpace::new();
    for point in mesh.free_points(VIEWS, 3) {
        let eye = Viewpoint::free(DVec3::from(point));
        let Depths { means, default } = &mut depths;
        let all = DEPTHS.into_iter().map(Some).zip(means).chain([(None, default)]);
        for (quadtree_depth, mean) in all {
            let options = ViewOptions { quadtree_depth, quadtree, ..ViewOptions::default() };
            let start = Instant::now();
            let image = bvh.view_in(&mut space, &eye, domain, &options)?;
            if image.form_factors().is_none() {
                image.solid_angles();
            }
            *mean += start.elapsed().as_secs_f64() * 1e3 / VIEWS as f64;
        }
    }
    Ok(depths)
}
