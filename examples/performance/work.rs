//! Work to be counted in instructions, not timed: `performance work KIND POLYGONS WHAT` does one piece of it, and what runs below [`counted`] counts.
//! WHAT is one of
//! - `bsp`, `boxes`: a few views by the 3D BSP or by a hierarchy of boxes, in memory of former ones;
//! - `factors`: their form factors;
//! - `both`: views by boxes with their form factors;
//! - `hemicube`: hemicubes of 512 x 512 pixels;
//! - `floor`: views by the 3D BSP from 100 points on the floor (docs/numerics.md).

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, SceneOrder, ViewError, ViewOptions, ViewSpace, Viewpoint};
use nusselt::hemicube::Hemicube;
use nusselt::samples::generate;
use std::error::Error;
use std::hint::black_box;

/// Views of each scene, but for those from the floor: those that docs/comparison.md times. Fewer tell little, as those from amid the furniture take several
/// times as long as others.
pub(crate) const VIEWS: usize = 20;
const DOMAIN: Domain = Domain::Hemisphere(DVec3::Z);

pub(crate) fn run(words: &[String]) -> Result<(), Box<dyn Error>> {
    let [kind, polygons, what] = words else {
        return Err("work takes KIND POLYGONS bsp|boxes|factors|both|hemicube|floor".into());
    };
    let mesh = generate(kind.parse()?, polygons.parse()?, 1)?;
    let scene = mesh.to_builder().build()?;
    let points = if what == "floor" { mesh.floor_points(100, 3) } else { mesh.free_points(VIEWS, 3) };
    let eyes: Vec<Viewpoint> = points.into_iter().map(|point| Viewpoint::free(DVec3::from(point))).collect();
    match what.as_str() {
        "bsp" | "floor" => views(&SceneBsp::build(&scene, &BspOptions::default())?.into(), &eyes, false)?,
        "boxes" => views(&SceneBvh::build(&scene).into(), &eyes, false)?,
        "both" => views(&SceneBvh::build(&scene).into(), &eyes, true)?,
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
        other => return Err(format!("there is no work {other}").into()),
    }
    Ok(())
}

/// All views twice: the first time for the memory.
fn views(order: &SceneOrder, eyes: &[Viewpoint], with_factors: bool) -> Result<(), ViewError> {
    let mut space = ViewSpace::new();
    let mut all = || {
        eyes.iter().try_for_each(|eye| {
            let image = order.view_in(&mut space, eye, &DOMAIN, &ViewOptions::default())?;
            if with_factors {
                black_box(image.form_factors());
            }
            black_box(image);
            Ok(())
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
