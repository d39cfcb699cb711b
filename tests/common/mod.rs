//! Scenes and small tools that several tests share.
#![allow(dead_code, reason = "every test file uses its own part")]

#[cfg(feature = "cli")]
pub(crate) mod browser;
pub(crate) mod face;
pub(crate) mod pictures;
#[cfg(feature = "cli")]
pub(crate) mod program;
pub(crate) mod scenes;

use glam::{DMat3, DQuat, DVec3};
use nusselt::scene::{Material, Scene};

/// A small deterministic generator (Knuth's MMIX constants).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in a cube around the origin.
    pub(crate) fn in_cube(&mut self, half: f64) -> DVec3 {
        DVec3::new(self.within(-half, half), self.within(-half, half), self.within(-half, half))
    }

    /// Uniform on the sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let d = self.in_cube(1.0);
            if (1e-3..1.0).contains(&d.length_squared()) {
                return d;
            }
        }
    }

    /// A whole number in 0..n.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
}

/// Faces under construction.
#[derive(Clone, Default)]
pub(crate) struct Faces {
    pub(crate) vertices: Vec<[f64; 3]>,
    pub(crate) faces: Vec<Vec<usize>>,
}

impl Faces {
    /// One face; gives its number.
    pub(crate) fn face(&mut self, corners: &[DVec3]) -> usize {
        let first = self.vertices.len();
        self.vertices.extend(corners.iter().map(DVec3::to_array));
        self.faces.push((first..first + corners.len()).collect());
        self.faces.len() - 1
    }

    /// The six faces of a box, turned by `turn`; fronts inwards for a room.
    pub(crate) fn cuboid(&mut self, center: DVec3, half: DVec3, turn: DQuat, inwards: bool) {
        let turn = DMat3::from_quat(turn);
        let corner = |k: usize| {
            let sign = |bit: usize| if k & bit == 0 { -1.0 } else { 1.0 };
            let local = DVec3::new(sign(1), sign(2), sign(4)) * half;
            center + if turn == DMat3::IDENTITY { local } else { turn * local }
        };
        for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let mut corners = quad.map(corner);
            if inwards {
                corners.reverse();
            }
            self.face(&corners);
        }
    }

    pub(crate) fn build(&self) -> Scene {
        Scene::builder().mesh(&self.vertices, &self.faces, Material::new("grey")).build().expect("a valid scene")
    }
}

/// A closed room of half size 10 with `n` boxes, which may overlap; half of them are turned.
pub(crate) fn cluttered_room(n: usize, seed: u64) -> Faces {
    let mut random = Random(seed);
    let mut faces = Faces::default();
    faces.cuboid(DVec3::ZERO, DVec3::splat(10.0), DQuat::IDENTITY, true);
    for k in 0..n {
        let center = random.in_cube(8.0);
        let half = random.in_cube(0.5).abs() + 0.1;
        let turn = match k % 4 {
            0 | 1 => DQuat::IDENTITY,
            2 => DQuat::from_rotation_z(random.within(0.0, 3.0)),
            _ => DQuat::from_axis_angle(random.direction().normalize(), random.within(0.0, 3.0)),
        };
        faces.cuboid(center, half, turn, false);
    }
    faces
}
