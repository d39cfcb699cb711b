//! A room with a table, two lamps, a mirror and a polished floor: the scene of figures 8, 9 and 10, and of the picture that README begins with.

use crate::shop::{Shop, turned};
use glam::DVec3;
use nusselt::scene::Material;
use std::error::Error;
use std::path::Path;

/// Writes docs/scenes/studio.obj; `folder` is that of the images.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    let scenes = folder.parent().ok_or("the folder of images is within another")?.join("scenes");
    std::fs::create_dir_all(&scenes)?;
    Ok(studio().write(&scenes, "studio")?)
}

pub(crate) fn studio() -> Shop {
    let [width, depth, height] = [4.4, 4.0, 2.6];
    let matt = |name: &str, diffuse| Material { diffuse, ..Material::new(name) };
    let mut shop = Shop::default();
    shop.object("room");
    // The corners of the room, and its walls by them.
    let at = |k: usize| DVec3::new([0.0, width][k & 1], [0.0, depth][k >> 1 & 1], [0.0, height][k >> 2]);
    let wall = |shop: &mut Shop, corners: [usize; 4]| shop.face(&corners.map(at));
    let (diffuse, specular) = ([0.3, 0.25, 0.2], [0.3; 3]);
    shop.material(Material { diffuse, specular, exponent: 120.0, ..Material::new("floor") });
    wall(&mut shop, [0, 1, 3, 2]);
    shop.material(matt("white", [0.78, 0.77, 0.73]));
    wall(&mut shop, [4, 6, 7, 5]);
    wall(&mut shop, [2, 3, 7, 6]);
    wall(&mut shop, [0, 4, 5, 1]);
    shop.material(matt("red", [0.62, 0.14, 0.1]));
    wall(&mut shop, [0, 2, 6, 4]);
    shop.material(matt("blue", [0.14, 0.24, 0.5]));
    wall(&mut shop, [1, 5, 7, 3]);

    shop.object("table");
    shop.material(matt("wood", [0.42, 0.27, 0.15]));
    shop.block([1.3, 1.9, 0.7], [3.1, 3.0, 0.75]);
    for [x, y] in [[1.36, 1.96], [2.98, 1.96], [1.36, 2.88], [2.98, 2.88]] {
        shop.block([x, y, 0.0], [x + 0.06, y + 0.06, 0.7]);
    }
    shop.object("chest");
    shop.prism(&turned([3.7, 3.2], [0.7, 0.5], -80.0), [0.0, 0.8]);
    shop.object("box");
    shop.material(matt("ochre", [0.72, 0.5, 0.14]));
    shop.prism(&turned([1.65, 2.6], [0.36, 0.36], 25.0), [0.75, 1.15]);
    shop.object("prism");
    shop.material(matt("green", [0.2, 0.48, 0.22]));
    shop.prism(&[[2.25, 2.7], [2.6, 2.6], [2.5, 2.95]], [0.75, 1.35]);
    shop.object("book");
    shop.material(matt("navy", [0.1, 0.14, 0.36]));
    shop.prism(&turned([2.15, 2.2], [0.42, 0.3], -15.0), [0.75, 0.82]);
    shop.object("ball");
    let (diffuse, specular) = ([0.06; 3], [0.85, 0.8, 0.72]);
    shop.material(Material { diffuse, specular, exponent: 300.0, ..Material::new("metal") });
    shop.ball(DVec3::new(2.8, 2.3, 0.93), 0.18);

    shop.object("mirror");
    shop.material(matt("frame", [0.08; 3]));
    shop.block([0.5, 3.96, 0.9], [1.2, 3.995, 2.0]);
    shop.material(matt("mirror", [0.02; 3]));
    let pane = |[low_x, low_z]: [f64; 2], [high_x, high_z]: [f64; 2], y: f64| {
        [[low_x, low_z], [high_x, low_z], [high_x, high_z], [low_x, high_z]].map(|[x, z]| DVec3::new(x, y, z))
    };
    shop.face(&pane([0.53, 0.93], [1.17, 1.97], 3.955));

    shop.object("lamp");
    let lamp = |name: &str, emission| Material { emission, ..matt(name, [0.8; 3]) };
    shop.material(lamp("lamp", [22.0, 19.0, 14.0]));
    shop.face(&[[1.9, 2.2], [1.9, 2.5], [2.5, 2.5], [2.5, 2.2]].map(|[x, y]| DVec3::new(x, y, 2.55)));
    shop.object("window");
    shop.material(lamp("sky", [2.2, 2.8, 3.6]));
    shop.face(&[[0.6, 0.9], [0.6, 2.1], [1.9, 2.1], [1.9, 0.9]].map(|[y, z]| DVec3::new(4.395, y, z)));
    shop
}
