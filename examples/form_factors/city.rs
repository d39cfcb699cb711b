//! A city of patches.

use nusselt::scene::{Material, Scene, SceneError};

/// Quadrilaterals with vertices of their own; equal ones become one in the scene.
#[derive(Default)]
pub(crate) struct Quads {
    vertices: Vec<[f64; 3]>,
    faces: Vec<Vec<usize>>,
}

impl Quads {
    pub(crate) fn push(&mut self, corners: [[f64; 3]; 4]) {
        let first = self.vertices.len();
        self.vertices.extend(corners);
        self.faces.push((first..first + 4).collect());
    }

    /// A grid of columns times rows between corners that run counter-clockwise seen from the front; `map` moves its points.
    pub(crate) fn grid(
        &mut self,
        corners: [[f64; 3]; 4],
        [columns, rows]: [usize; 2],
        map: &impl Fn([f64; 3]) -> [f64; 3],
    ) {
        let [a, b, _, d] = corners;
        let point = |i: usize, j: usize| {
            let (s, t) = (i as f64 / columns as f64, j as f64 / rows as f64);
            // Exact where a coordinate is the same in all corners.
            map([0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * s + (d[k] - a[k]) * t))
        };
        for j in 0..rows {
            for i in 0..columns {
                self.push([point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
            }
        }
    }

    /// The six faces of a box, fronts inside or outside, each in `cells` squared patches.
    pub(crate) fn cuboid(
        &mut self,
        low: [f64; 3],
        high: [f64; 3],
        inside: bool,
        cells: usize,
        map: &impl Fn([f64; 3]) -> [f64; 3],
    ) {
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for (value, outwards) in [(low[axis], false), (high[axis], true)] {
                let corner = |p: f64, q: f64| {
                    let mut corner = [value; 3];
                    (corner[u], corner[v]) = (p, q);
                    corner
                };
                let mut corners = [
                    corner(low[u], low[v]),
                    corner(high[u], low[v]),
                    corner(high[u], high[v]),
                    corner(low[u], high[v]),
                ];
                if outwards == inside {
                    corners = [corners[0], corners[3], corners[2], corners[1]];
                }
                self.grid(corners, [cells, cells], map);
            }
        }
    }

    pub(crate) fn scene(&self) -> Result<Scene, SceneError> {
        Scene::builder().mesh(&self.vertices, &self.faces, Material::new("grey")).build()
    }
}

pub(crate) fn same(p: [f64; 3]) -> [f64; 3] {
    p
}

/// A city of k x k blocks with one box each, under a box of sky: all of it one closed surface.
pub(crate) fn city(k: usize) -> Result<Scene, SceneError> {
    let mut quads = Quads::default();
    // Streets of 12 and blocks of 20 metres in turn.
    let mut lines = vec![0.0];
    for strip in 0..=2 * k {
        lines.push(lines[strip] + if strip % 2 == 0 { 12.0 } else { 20.0 });
    }
    let end = lines[2 * k + 1];
    let mut state = 1u64;
    for j in 0..=2 * k {
        for i in 0..=2 * k {
            let (x, y) = ([lines[i], lines[i + 1]], [lines[j], lines[j + 1]]);
            if i % 2 == 0 || j % 2 == 0 {
                quads.push([[x[0], y[0], 0.], [x[1], y[0], 0.], [x[1], y[1], 0.], [x[0], y[1], 0.]]);
                continue;
            }
            // Heights of 6 to 36 metres, by a linear congruence (Knuth).
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let height = 6.0 + (state >> 33) as f64 / (1u64 << 31) as f64 * 30.0;
            let mut block = Quads::default();
            block.cuboid([x[0], y[0], 0.0], [x[1], y[1], height], false, 1, &same);
            for face in block.faces {
                let corners = [0, 1, 2, 3].map(|k| block.vertices[face[k]]);
                // Not the face on the ground.
                if corners.iter().any(|corner| corner[2] > 0.0) {
                    quads.push(corners);
                }
            }
        }
    }
    let top = 50.0;
    quads.grid([[0., 0., top], [0., end, top], [end, end, top], [end, 0., top]], [k, k], &same);
    for wall in [
        [[0., 0., 0.], [0., 0., top], [end, 0., top], [end, 0., 0.]],
        [[end, 0., 0.], [end, 0., top], [end, end, top], [end, end, 0.]],
        [[end, end, 0.], [end, end, top], [0., end, top], [0., end, 0.]],
        [[0., end, 0.], [0., end, top], [0., 0., top], [0., 0., 0.]],
    ] {
        quads.grid(wall, [1, k], &same);
    }
    quads.scene()
}
