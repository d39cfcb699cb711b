//! Balls: octahedra with subdivided sides, blown up.

use super::free::Ball;
use super::mesh::{Look, Mesh};
use rustc_hash::FxHashMap;

/// The number of triangles of a ball.
pub(super) fn triangle_count(frequency: usize) -> usize {
    8 * frequency * frequency
}

/// Adds a closed ball of triangles, fronts outward, each octant's edges in `frequency` parts. Takes
/// nothing but the four operations and the square root, which round alike everywhere.
pub(super) fn add_ball(mesh: &mut Mesh, ball: Ball, frequency: usize, look: Look) {
    let n = frequency as i64;
    let mut known: FxHashMap<[i64; 3], u32> = FxHashMap::default();
    for octant in 0..8 {
        let signs = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1 } else { -1 });
        let mirrored = signs[0] * signs[1] * signs[2] < 0;
        let mut add = |mesh: &mut Mesh, corners: [[i64; 3]; 3]| {
            let mut corners = corners.map(|corner| {
                let key = [0, 1, 2].map(|axis| signs[axis] * corner[axis]);
                *known.entry(key).or_insert_with(|| mesh.add_vertex(blown_up(key, ball)))
            });
            if mirrored {
                corners.reverse();
            }
            mesh.add_triangle(corners, look);
        };
        for a in 0..n {
            for b in 0..n - a {
                let c = n - 1 - a - b;
                add(mesh, [[a + 1, b, c], [a, b + 1, c], [a, b, c + 1]]);
                if c > 0 {
                    add(mesh, [[a, b + 1, c], [a + 1, b, c], [a + 1, b + 1, c - 1]]);
                }
            }
        }
    }
}

fn blown_up(key: [i64; 3], ball: Ball) -> [f64; 3] {
    let length = (key.iter().map(|&k| k * k).sum::<i64>() as f64).sqrt();
    [0, 1, 2].map(|axis| ball.centre[axis] + ball.radius * (key[axis] as f64 / length))
}
