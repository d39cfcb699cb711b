//! The Cornell box.

use super::free::{FreeSpace, Solid};
use super::mesh::{Look, Mesh};
use crate::scene::{Axis, Material};
use glam::DVec3;

/// The Cornell box as measured: Cornell University Program of Computer Graphics, "Cornell Box Data"
/// (<https://www.graphics.cornell.edu/online/box/data.html>). Millimetres, y up, the open front at
/// z = 0, 16 quads: 5 of the room, the lamp, and 5 of each block, which have no bottom.
///
/// Fronts are inward for the room, outward for the blocks, and down for the lamp. What differs from
/// the published numbers, and what does not:
///
/// - The front stays open: what is seen through it is background. The published camera stands
///   outside, at (278, 273, -800), and looks along +z.
/// - The published lamp lies in the plane of the ceiling, which the geometry does not cut out around
///   it. Here it hangs 0.1 below, at y = 548.7, so that it is seen and the ceiling stays one quad.
/// - The red wall is not exactly planar (the room was not exactly a box), and stays so.
/// - The floor is whole below the blocks, as a quad.
/// - The published reflectances are spectra; these are their usual linear RGB values, and the lamp's
///   usual radiance (17, 12, 4).
pub fn cornell_box() -> Mesh {
    let mut mesh = Mesh::empty(FreeSpace {
        low: [0.0; 3],
        // The floor is narrowest at the back.
        high: [549.6, 548.7, 559.2],
        up: Axis::Y,
        margin: 5.0,
        solids: Vec::new(),
    });
    let mut known: Vec<[f64; 3]> = Vec::new();
    for (name, material, quads) in OBJECTS {
        let look = Look { object: mesh.add_object(name.to_owned()), material: mesh.add_material(paint(material)) };
        for quad in quads {
            let corners = quad.map(|point| {
                let found = known.iter().position(|other| other.map(f64::to_bits) == point.map(f64::to_bits));
                found.map_or_else(
                    || {
                        known.push(point);
                        mesh.add_vertex(point)
                    },
                    |index| index as u32,
                )
            });
            mesh.add_quad(corners, look);
        }
    }
    for block in [&SHORT_BLOCK, &TALL_BLOCK] {
        mesh.add_solid(Solid::Convex(block.map(plane_of).into()));
    }
    mesh
}

type Quad = [[f64; 3]; 4];

/// Objects with their paint and quads, as published but for the lamp's height.
const OBJECTS: [(&str, &str, &[Quad]); 8] = [
    ("floor", "white", &[[[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]]]),
    ("light", "light", &[[[343.0, 548.7, 227.0], [343.0, 548.7, 332.0], [213.0, 548.7, 332.0], [213.0, 548.7, 227.0]]]),
    ("ceiling", "white", &[[[556.0, 548.8, 0.0], [556.0, 548.8, 559.2], [0.0, 548.8, 559.2], [0.0, 548.8, 0.0]]]),
    ("back_wall", "white", &[[[549.6, 0.0, 559.2], [0.0, 0.0, 559.2], [0.0, 548.8, 559.2], [556.0, 548.8, 559.2]]]),
    ("right_wall", "green", &[[[0.0, 0.0, 559.2], [0.0, 0.0, 0.0], [0.0, 548.8, 0.0], [0.0, 548.8, 559.2]]]),
    ("left_wall", "red", &[[[552.8, 0.0, 0.0], [549.6, 0.0, 559.2], [556.0, 548.8, 559.2], [556.0, 548.8, 0.0]]]),
    ("short_block", "white", &SHORT_BLOCK),
    ("tall_block", "white", &TALL_BLOCK),
];

const SHORT_BLOCK: [Quad; 5] = [
    [[130.0, 165.0, 65.0], [82.0, 165.0, 225.0], [240.0, 165.0, 272.0], [290.0, 165.0, 114.0]],
    [[290.0, 0.0, 114.0], [290.0, 165.0, 114.0], [240.0, 165.0, 272.0], [240.0, 0.0, 272.0]],
    [[130.0, 0.0, 65.0], [130.0, 165.0, 65.0], [290.0, 165.0, 114.0], [290.0, 0.0, 114.0]],
    [[82.0, 0.0, 225.0], [82.0, 165.0, 225.0], [130.0, 165.0, 65.0], [130.0, 0.0, 65.0]],
    [[240.0, 0.0, 272.0], [240.0, 165.0, 272.0], [82.0, 165.0, 225.0], [82.0, 0.0, 225.0]],
];

const TALL_BLOCK: [Quad; 5] = [
    [[423.0, 330.0, 247.0], [265.0, 330.0, 296.0], [314.0, 330.0, 456.0], [472.0, 330.0, 406.0]],
    [[423.0, 0.0, 247.0], [423.0, 330.0, 247.0], [472.0, 330.0, 406.0], [472.0, 0.0, 406.0]],
    [[472.0, 0.0, 406.0], [472.0, 330.0, 406.0], [314.0, 330.0, 456.0], [314.0, 0.0, 456.0]],
    [[314.0, 0.0, 456.0], [314.0, 330.0, 456.0], [265.0, 330.0, 296.0], [265.0, 0.0, 296.0]],
    [[265.0, 0.0, 296.0], [265.0, 330.0, 296.0], [423.0, 330.0, 247.0], [423.0, 0.0, 247.0]],
];

fn paint(name: &str) -> Material {
    let (diffuse, emission) = match name {
        "red" => ([0.63, 0.065, 0.05], [0.0; 3]),
        "green" => ([0.14, 0.45, 0.091], [0.0; 3]),
        "light" => ([0.78; 3], [17.0, 12.0, 4.0]),
        _ => ([0.725, 0.71, 0.68], [0.0; 3]),
    };
    Material { diffuse, emission, ..Material::new(name) }
}

/// A quad's plane: its unit normal, on its front, and its distance from the origin.
fn plane_of(quad: Quad) -> ([f64; 3], f64) {
    let [a, b, c, _] = quad.map(DVec3::from);
    let normal = (b - a).cross(c - a).normalize();
    (normal.to_array(), normal.dot(a))
}
