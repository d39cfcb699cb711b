//! A room of patches.

use super::city::{Quads, same};
use nusselt::scene::{Scene, SceneError};

/// A room of 4 x 3 x 2.5, its walls in 20 x 20 patches; if asked for, around a turned box of 8 x 8 patches a face.
pub(crate) fn room(with_box: bool) -> Result<Scene, SceneError> {
    let mut quads = Quads::default();
    quads.cuboid([0.; 3], [4.0, 3.0, 2.5], true, 20, &same);
    if with_box {
        let (sin, cos) = 0.5_f64.sin_cos();
        let turned = |[x, y, z]: [f64; 3]| [2.1 + cos * x - sin * y, 1.4 + sin * x + cos * y, z];
        quads.cuboid([-0.6, -0.5, 0.4], [0.6, 0.5, 1.4], false, 8, &turned);
    }
    quads.scene()
}
