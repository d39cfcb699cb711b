//! Scenes and their 3D BSPs, with the time they take.

use crate::args::{Common, Order};
use crate::failure::Failure;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::io::read_scene;
use nusselt::scene::Scene;
use std::path::Path;
use std::time::Instant;

/// A scene from a file, and how many seconds reading took.
pub(crate) fn load(path: &Path, common: &Common) -> Result<(Scene, f64), Failure> {
    let start = Instant::now();
    let loaded = read_scene(path).map_err(|error| Failure::Work(error.to_string()))?;
    let seconds = start.elapsed().as_secs_f64();
    for warning in &loaded.warnings {
        common.warn(warning);
    }
    Ok((loaded.scene, seconds))
}

/// Its 3D BSP, and how many seconds building it took.
pub(crate) fn build(scene: &Scene, order: &Order) -> Result<(SceneBsp, f64), Failure> {
    let start = Instant::now();
    let options = BspOptions { epsilon: order.epsilon };
    let bsp = SceneBsp::build(scene, &options).map_err(|error| Failure::Work(error.to_string()))?;
    Ok((bsp, start.elapsed().as_secs_f64()))
}
