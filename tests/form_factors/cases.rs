//! Pairs of patches with a reference for their factor.

use super::references::{behind_a_plate, between_rings, graded, lambert, mean, opposed, perpendicular};
use glam::DVec3;
use nusselt::factors::Row;
use nusselt::scene::{Material, Scene};
use std::f64::consts::TAU;
use std::ops::Range;

/// A factor that is known, or a sum of some.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    pub(crate) row: usize,
    pub(crate) columns: Range<u32>,
    pub(crate) reference: f64,
}

impl Case {
    /// The error allowed, with this one for each factor.
    pub(crate) fn allowed(&self, tolerance: f64) -> f64 {
        tolerance * self.columns.len() as f64
    }

    /// The same of a row that was computed.
    pub(crate) fn of(&self, row: &Row) -> f64 {
        let entries = row.entries.iter().filter(|entry| self.columns.contains(&entry.column));
        entries.map(|entry| entry.share.factor).sum()
    }
}

/// A scene of convex polygons given by their corners.
pub(crate) fn scene_of(polygons: &[Vec<[f64; 3]>]) -> Scene {
    let vertices: Vec<[f64; 3]> = polygons.concat();
    let mut next = 0;
    let faces = polygons.iter().map(|polygon| {
        next += polygon.len();
        (next - polygon.len()..next).collect()
    });
    let faces: Vec<Vec<usize>> = faces.collect();
    Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("a sound scene")
}

/// A rectangle with a corner and two sides; its front is on the side of u x v.
pub(crate) fn rectangle(origin: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Vec<[f64; 3]> {
    let at = |s: f64, t: f64| [0, 1, 2].map(|k| origin[k] + s * u[k] + t * v[k]);
    vec![at(0., 0.), at(1., 0.), at(1., 1.), at(0., 1.)]
}

/// The six faces of a box, with fronts inside or outside: those at the low and the high end of each axis in turn.
pub(crate) fn cuboid(low: [f64; 3], high: [f64; 3], inside: bool) -> Vec<Vec<[f64; 3]>> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        for (value, is_high) in [(low[axis], false), (high[axis], true)] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |p: f64, q: f64| {
                let mut corner = [value; 3];
                (corner[u], corner[v]) = (p, q);
                corner
            };
            let mut face = vec![
                corner(low[u], low[v]),
                corner(high[u], low[v]),
                corner(high[u], high[v]),
                corner(low[u], high[v]),
            ];
            if is_high == inside {
                face.reverse();
            }
            faces.push(face);
        }
    }
    faces
}

/// A regular polygon about the z axis with the area of a disc, counter-clockwise seen from above if it is to be `up`.
pub(crate) fn ring(corners: usize, radius: f64, z: f64, up: bool) -> Vec<[f64; 3]> {
    let step = TAU / corners as f64;
    let equal_area = radius * (step / step.sin()).sqrt();
    let corner = |k: usize| {
        let (sin, cos) = (k as f64 * step).sin_cos();
        [equal_area * cos, equal_area * sin, z]
    };
    let mut ring: Vec<[f64; 3]> = (0..corners).map(corner).collect();
    if !up {
        ring.reverse();
    }
    ring
}

/// All of them.
pub(crate) fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name: String, polygons: &[Vec<[f64; 3]>], column: u32, reference: f64| {
        cases.push(Case { name, scene: scene_of(polygons), row: 0, columns: column..column + 1, reference });
    };
    for (a, b, c) in [(1.0, 1.0, 1.0), (2.0, 0.5, 0.7), (1.0, 3.0, 0.1), (1.0, 1.0, 0.001), (1.0, 1.0, 30.0)] {
        let below = rectangle([0.; 3], [a, 0., 0.], [0., b, 0.]);
        let above = rectangle([0., 0., c], [0., b, 0.], [a, 0., 0.]);
        add(format!("opposed {a} x {b}, gap {c}"), &[below, above], 1, opposed(a, b, c));
    }
    for (w, h, l) in [(1.0, 1.0, 1.0), (2.0, 0.5, 3.0), (0.1, 4.0, 1.0), (1.0, 0.01, 1.0)] {
        let floor = rectangle([0.; 3], [w, 0., 0.], [0., l, 0.]);
        let wall = rectangle([0.; 3], [0., l, 0.], [0., 0., h]);
        add(format!("right angle {w} to {h}, edge {l}"), &[floor, wall], 1, perpendicular(w, h, l));
    }
    for degrees in [30.0_f64, 60.0, 120.0, 150.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let floor = rectangle([0.; 3], [1.0, 0., 0.], [0., 1.5, 0.]);
        let leaf = rectangle([0.; 3], [0., 1.5, 0.], [0.8 * cos, 0., 0.8 * sin]);
        let target: Vec<DVec3> = leaf.iter().rev().map(|&p| DVec3::from(p)).collect();
        let places = graded();
        let reference = mean(&places, &places, |u, v| lambert(DVec3::new(u, 1.5 * v, 0.0), DVec3::Z, &target).abs());
        add(format!("wedge of {degrees} degrees"), &[floor, leaf], 1, reference);
    }
    for (r1, r2, c) in [(1.0, 1.0, 1.0), (0.5, 2.0, 1.0)] {
        let [disc, target] = [ring(48, r1, 0.0, true), ring(48, r2, c, false)];
        let reference = between_rings(&disc, &target);
        add(format!("disc of {r1} to one of {r2}, gap {c}, as 48-gons"), &[disc, target], 1, reference);
    }
    let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|face| face.map(|k| corners[k]).to_vec());
    add("tetrahedron".to_owned(), &tetrahedron, 1, 1.0 / 3.0);
    add("cube, opposite face".to_owned(), &cuboid([0.; 3], [2.; 3], true), 1, opposed(1.0, 1.0, 1.0));
    add("cube, next face".to_owned(), &cuboid([0.; 3], [2.; 3], true), 2, perpendicular(1.0, 1.0, 1.0));
    let plates = [
        ([0., 1., 0., 1.], [0.2, 0.6, 0.3, 0.9], 0.5, [0., 1., 0., 1.], 1.0),
        ([0., 1., 0., 1.], [0.0, 0.5, 0.0, 1.0], 0.5, [0., 1., 0., 1.], 1.0),
        ([0., 2., 0., 1.], [-1.0, 0.7, 0.4, 3.0], 0.1, [-1., 1., 0.5, 2.], 1.5),
        ([0., 1., 0., 1.], [0.4, 0.6, 0.4, 0.6], 0.9, [0., 1., 0., 1.], 1.0),
        ([0., 1., 0., 1.], [0.49, 0.51, 0.0, 1.0], 0.3, [0., 1., 0., 1.], 0.5),
    ];
    for (k, (from, blocker, middle, to, top)) in plates.into_iter().enumerate() {
        let level = |[x0, x1, y0, y1]: [f64; 4], z: f64| rectangle([x0, y0, z], [x1 - x0, 0., 0.], [0., y1 - y0, 0.]);
        let [mut ceiling, mut plate] = [level(to, top), level(blocker, middle)];
        ceiling.reverse();
        plate.reverse();
        let polygons = [level(from, 0.0), ceiling, plate];
        add(format!("behind a plate, {}", k + 1), &polygons, 1, behind_a_plate(from, blocker, middle, to, top));
    }
    // By symmetry a sixth of what the inner one, which sees nothing else, exchanges.
    let polygons = [cuboid([0.; 3], [3.; 3], true), cuboid([1.; 3], [2.; 3], false)].concat();
    let name = "cube in a cube, a face to the inner one".to_owned();
    cases.push(Case { name, scene: scene_of(&polygons), row: 0, columns: 6..12, reference: 1.0 / 9.0 });
    cases
}
