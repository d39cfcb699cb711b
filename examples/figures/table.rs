//! A table with a few things on it below a lamp: the scene of figures 2 and 6. Three bars lie on each other in a ring, so that a BSP has to cut.

use crate::shop::{Shop, turned};
use glam::DVec3;
use nusselt::scene::{Material, Scene, SceneError};

/// The scene, z up.
pub(crate) fn scene() -> Result<Scene, SceneError> {
    let mut shop = Shop::default();
    let thing = |shop: &mut Shop, name: &str, diffuse, emission| {
        shop.object(name);
        shop.material(Material { diffuse, emission, ..Material::new(name) });
    };
    thing(&mut shop, "table", [0.55, 0.42, 0.3], [0.0; 3]);
    shop.prism(&turned([0.0, 0.0], [4.0, 3.0], 0.0), [-0.15, 0.0]);
    thing(&mut shop, "box", [0.65, 0.2, 0.15], [0.0; 3]);
    shop.prism(&turned([-1.1, 0.6], [0.8, 0.8], 25.0), [0.0, 0.9]);
    thing(&mut shop, "book", [0.2, 0.35, 0.6], [0.0; 3]);
    shop.prism(&turned([0.9, -0.6], [1.1, 0.7], -15.0), [0.0, 0.25]);
    thing(&mut shop, "prism", [0.25, 0.5, 0.25], [0.0; 3]);
    shop.prism(&[[0.25, 0.375], [1.25, 0.5], [0.625, 1.25]], [0.0, 1.3]);
    thing(&mut shop, "bars", [0.75, 0.6, 0.25], [0.0; 3]);
    for turn in 0..3 {
        let ends = [-1.0, 1.0].map(|along| {
            let (sine, cosine) = (f64::from(turn) * 120.0 + 20.0).to_radians().sin_cos();
            // Beside the middle, from low to high.
            let [x, y] = [along * 0.62, -0.2];
            DVec3::new(x * cosine - y * sine - 0.95, x * sine + y * cosine - 0.75, 0.25 + 0.17 * along)
        });
        shop.bar(ends, 0.1);
    }
    thing(&mut shop, "lamp", [0.8; 3], [10.0, 9.0, 7.0]);
    let lamp = turned([0.1, -0.5], [1.2, 0.6], 10.0);
    shop.face(&lamp.iter().rev().map(|&[x, y]| DVec3::new(x, y, 2.2)).collect::<Vec<_>>());
    shop.scene()
}
