//! Scenes, and what gives the order of their polygons, with the time they take.

use crate::args::{Common, Loading, Order, Way};
use crate::failure::Failure;
use crate::materials::Materials;
use crate::output::{can_be_written, clear, keep};
use crate::repairs::changes;
use nusselt::bsp::{BspError, BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::SceneOrder;
use nusselt::io::{ReadError, read_scene};
use nusselt::scene::{DropCause, OrDrop, Repair, Scene};
use std::path::Path;
use std::time::Instant;

/// A scene from a file, and how many seconds reading took. No output may replace what it is read from.
pub(crate) fn load<'a>(
    path: &Path,
    outputs: impl Iterator<Item = &'a Path> + Clone,
    loading: &Loading,
    common: &Common,
) -> Result<(Scene, f64), Failure> {
    let (scene, _, seconds) = load_materials(path, outputs, loading, common)?;
    Ok((scene, seconds))
}

/// The same with where its materials are defined.
pub(crate) fn load_materials<'a>(
    path: &Path,
    outputs: impl Iterator<Item = &'a Path> + Clone,
    loading: &Loading,
    common: &Common,
) -> Result<(Scene, Materials, f64), Failure> {
    keep(&[path.to_owned()], outputs.clone())?;
    outputs.clone().for_each(clear);
    can_be_written(outputs.clone())?;
    let start = Instant::now();
    let loaded = read_scene(path, &loading.options()).map_err(|error| refused(&error, &loading.repair))?;
    let seconds = start.elapsed().as_secs_f64();
    keep(&loaded.files, outputs)?;
    for warning in &loaded.warnings {
        common.warn(warning);
    }
    for change in changes(loaded.scene.repairs()) {
        common.warn(&format!("{}: {change}", path.display()));
    }
    Ok((loaded.scene, Materials::new(loaded.material_places), seconds))
}

/// What is wrong with a file, and with which repair its broken faces would be left out.
fn refused(error: &ReadError, repair: &Repair) -> Failure {
    let mut dropping = *repair;
    if let ReadError::Invalid(faults) = error {
        for cause in faults.droppable() {
            match cause {
                DropCause::Malformed => dropping.malformed = OrDrop::Drop,
                DropCause::SelfCrossing => dropping.self_crossing = OrDrop::Drop,
                // These are refused only if one asks for it.
                DropCause::NonPlanar | DropCause::Duplicate => {}
            }
        }
    }
    if dropping == *repair {
        return Failure::Work(error.to_string());
    }
    Failure::Work(format!("{error}\n--repair {dropping} leaves out such faces, and takes the rest"))
}

/// The 3D BSP of the scene of a file, and how many seconds building it took.
pub(crate) fn build(path: &Path, scene: &Scene, order: &Order) -> Result<(SceneBsp, f64), Failure> {
    let (bsp, seconds) = try_to_build(scene, order);
    Ok((bsp.map_err(|error| Failure::about(path, &error))?, seconds))
}

/// The 3D BSP of a scene, and how many seconds building it, or trying to, took.
pub(crate) fn try_to_build(scene: &Scene, order: &Order) -> (Result<SceneBsp, BspError>, f64) {
    let start = Instant::now();
    let options = BspOptions { epsilon: order.epsilon, ..BspOptions::default() };
    let bsp = SceneBsp::build(scene, &options);
    (bsp, start.elapsed().as_secs_f64())
}

/// What gives the order of the polygons of the scene of a file, and how many seconds building it took.
pub(crate) fn build_order(path: &Path, scene: &Scene, order: &Order, way: Way) -> Result<(SceneOrder, f64), Failure> {
    match way {
        Way::Bsp => {
            let (bsp, seconds) = try_to_build(scene, order);
            let bsp = bsp.map_err(|error| match error {
                BspError::TooManyFragments { .. } => {
                    Failure::about(path, &format_args!("{error}, or take --way boxes without --epsilon"))
                }
                _ => Failure::about(path, &error),
            })?;
            Ok((bsp.into(), seconds))
        }
        Way::Boxes => {
            let start = Instant::now();
            Ok((SceneBvh::build(scene).into(), start.elapsed().as_secs_f64()))
        }
    }
}

/// Refuses an epsilon where there is no 3D BSP.
pub(crate) fn check_way(chosen: Option<Way>, order: &Order) -> Result<(), Failure> {
    if chosen == Some(Way::Boxes) && order.epsilon > 0.0 {
        return Err(Failure::Usage("--epsilon is for the 3D BSP; leave it out, or take --way bsp".to_owned()));
    }
    Ok(())
}

/// The way that was chosen, or the one that goes with the epsilon.
pub(crate) fn way(chosen: Option<Way>, order: &Order) -> Way {
    chosen.unwrap_or(if order.epsilon > 0.0 { Way::Bsp } else { Way::Boxes })
}
