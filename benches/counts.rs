//! Work to be counted in instructions, not timed: `benches/counts.sh` runs it under callgrind and prints a table, which compares commits
//! without the noise of a shared machine. `cargo bench --bench counts -- room 10000 boxes` does one row: a few views by the 3D BSP
//! (`bsp`), by a hierarchy of boxes (`boxes`), their form factors (`factors`), or hemicubes of 512 x 512 pixels (`hemicube`).
//! Views are taken in memory of former ones. Only what runs below [`counted`] counts.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, SceneOrder, ViewError, ViewOptions, ViewSpace, Viewpoint};
use nusselt::hemicube::Hemicube;
use nusselt::samples::generate;
use std::error::Error;
use std::hint::black_box;

/// Views a row.
const VIEWS: usize = 4;
const DOMAIN: Domain = Domain::Hemisphere(DVec3::Z);

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let [kind, polygons, what] = words.as_slice() else {
        return Err("usage: counts KIND POLYGONS bsp|boxes|factors|hemicube (see benches/counts.sh)".into());
    };
    let mesh = generate(kind.parse()?, polygons.parse()?, 1)?;
    let scene = mesh.to_builder().build()?;
    let eyes: Vec<Viewpoint> =
        mesh.free_points(VIEWS, 3).into_iter().map(|point| Viewpoint::free(DVec3::from(point))).collect();
    match what.as_str() {
        "bsp" => {
            views(&SceneBsp::build(&scene, &BspOptions::default())?.into(), &eyes)?;
        }
        "boxes" => {
            views(&SceneBvh::build(&scene).into(), &eyes)?;
        }
        "factors" => {
            let boxes = SceneBvh::build(&scene);
            let images = eyes.iter().map(|eye| boxes.view(eye, &DOMAIN)).collect::<Result<Vec<_>, _>>()?;
            counted(|| images.iter().for_each(|image| drop(black_box(image.form_factors()))));
        }
        "hemicube" => {
            let mut hemicube = Hemicube::new(&scene, 512)?;
            counted(|| {
                eyes.iter().try_for_each(|eye| {
                    hemicube.view(eye, DVec3::Z).map(|view| view.stats().pixels).map(|n| _ = black_box(n))
                })
            })?;
        }
        other => return Err(format!("no such row: {other}").into()),
    }
    Ok(())
}

/// All views twice: the first time for the memory.
fn views(order: &SceneOrder, eyes: &[Viewpoint]) -> Result<(), ViewError> {
    let mut space = ViewSpace::new();
    let mut all = || {
        eyes.iter().try_for_each(|eye| {
            order.view_in(&mut space, eye, &DOMAIN, &ViewOptions::default()).map(|image| _ = black_box(image))
        })
    };
    all()?;
    counted(all)
}

/// Callgrind collects in here.
#[inline(never)]
fn counted<T>(work: impl FnOnce() -> T) -> T {
    black_box(work())
}
