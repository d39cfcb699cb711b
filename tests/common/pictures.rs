//! What scenes of pictures are made of.

use glam::DVec3;
use nusselt::render::Spot;
use nusselt::scene::{Material, PieceId, Side};

/// Matt, of one colour.
pub(crate) fn material(name: &str, diffuse: f64, emission: f64) -> Material {
    Material { diffuse: [diffuse; 3], emission: [emission; 3], ..Material::new(name) }
}

/// A square at a height, its front upwards.
pub(crate) fn square(low: [f64; 2], high: [f64; 2], z: f64) -> [[f64; 3]; 4] {
    [[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]]
}

/// A point of the front of the first piece, which is at z = 0.
pub(crate) fn floor_spot(x: f64, y: f64) -> Spot {
    Spot { piece: PieceId(0), side: Side::Front, near: DVec3::new(x, y, 0.0) }
}
