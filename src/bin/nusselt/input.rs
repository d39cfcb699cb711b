//! Scenes and their 3D BSPs, with the time they take.

use crate::args::{Common, Order, Reading};
use crate::failure::Failure;
use crate::output::keep;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::io::read_scene;
use nusselt::scene::Scene;
use std::path::Path;
use std::time::Instant;

/// A scene from a file, and how many seconds reading took. No output may replace what it is read from.
pub(crate) fn load<'a>(
    path: &Path,
    reading: &Reading,
    outputs: impl Iterator<Item = &'a Path> + Clone,
    common: &Common,
) -> Result<(Scene, f64), Failure> {
    keep(&[path.to_owned()], outputs.clone())?;
    let start = Instant::now();
    let loaded = read_scene(path, &reading.options()).map_err(|error| Failure::Work(error.to_string()))?;
    let seconds = start.elapsed().as_secs_f64();
    keep(&loaded.files, outputs)?;
    for warning in &loaded.warnings {
        common.warn(warning);
    }
    Ok((loaded.scene, seconds))
}

/// The 3D BSP of the scene of a file, and how many seconds building it took.
pub(crate) fn build(path: &Path, scene: &Scene, order: &Order) -> Result<(SceneBsp, f64), Failure> {
    let start = Instant::now();
    let options = BspOptions { epsilon: order.epsilon, ..BspOptions::default() };
    let bsp = SceneBsp::build(scene, &options).map_err(|error| Failure::about(path, &error))?;
    Ok((bsp, start.elapsed().as_secs_f64()))
}
