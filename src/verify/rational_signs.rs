//! Signs from `num-rational` alone: slow, and without a line in common with the engine.
//!
//! Coordinates become rational numbers, normals and planes are computed from them as the definitions say,
//! and each vector is then multiplied by what makes it whole and free of common factors. Nothing is filtered
//! and nothing is rounded.

use super::evidence::HalfSphere;
use super::rational::{RationalPlane, Vector, cross, dot, exact, normal, rational, sign_of, whole};
use super::signs::Signs;
use crate::exact::{Plane, Sign, Splitter};
use crate::scene::Scene;
use glam::DVec3;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use std::collections::HashMap;

/// Exact vectors of all that was taken in.
pub(super) struct RationalSigns {
    eye: Vector<BigRational>,
    /// A number that makes every coordinate whole, and the eye times that.
    scale: BigInt,
    scaled_eye: Vector<BigInt>,
    splitters: Vec<Splitter>,
    /// Whole multiples of the normals.
    normals: Vec<Vector<BigInt>>,
    /// Whole multiples of the planes.
    planes: Vec<([BigInt; 3], BigInt)>,
    decisions: u64,
}

impl RationalSigns {
    pub(super) fn new(scene: &Scene, eye: DVec3) -> Self {
        let coordinates = scene.vertices().iter().copied().chain([eye]).flat_map(|p| p.to_array());
        let scale = coordinates.fold(BigInt::from(1), |scale, x| scale.lcm(rational(x).denom()));
        let scaled_eye = exact(eye).map(|x| (x * BigRational::from_integer(scale.clone())).to_integer());
        Self {
            eye: exact(eye),
            scale,
            scaled_eye,
            splitters: Vec::new(),
            normals: Vec::new(),
            planes: Vec::new(),
            decisions: 0,
        }
    }

    /// A multiple of a coordinate, the same for all.
    fn scaled(&self, x: f64) -> BigInt {
        let x = rational(x);
        x.numer() * (&self.scale / x.denom())
    }

    /// The sign of a plane's height at a point.
    fn height_at(&self, (normal, offset): &([BigInt; 3], BigInt), point: DVec3) -> Sign {
        sign_of(&(dot(normal, &point.to_array().map(|x| self.scaled(x))) - offset))
    }

    fn decide(&mut self, sign: Sign) -> Sign {
        self.decisions += 1;
        sign
    }
}

impl Signs for RationalSigns {
    fn add(&mut self, splitter: &Splitter) -> u32 {
        self.splitters.push(*splitter);
        self.normals.push(whole(&normal(&self.eye, splitter)));
        self.normals.len() as u32 - 1
    }

    fn add_plane(&mut self, plane: &Plane) -> u32 {
        let RationalPlane { normal: [x, y, z], offset } = RationalPlane::new(plane);
        let offset = offset * BigRational::from_integer(self.scale.clone());
        let [x, y, z, offset] = whole(&[x, y, z, offset]);
        self.planes.push(([x, y, z], offset));
        self.planes.len() as u32 - 1
    }

    fn orientation(&mut self, splitters: [u32; 3]) -> Sign {
        let [a, b, c] = splitters.map(|s| &self.normals[s as usize]);
        let sign = sign_of(&dot(a, &cross(b, c)));
        self.decide(sign)
    }

    fn side(&mut self, direction: DVec3, splitter: u32) -> Sign {
        let sign = sign_of(&dot(&self.normals[splitter as usize], &whole(&exact(direction))));
        self.decide(sign)
    }

    fn height(&mut self, point: DVec3, plane: u32) -> Sign {
        let sign = self.height_at(&self.planes[plane as usize], point);
        self.decide(sign)
    }

    /// Whole vectors without common factors are equal or opposite where their great circles are one.
    fn great_circles(&mut self) -> Option<Vec<(u32, Sign)>> {
        let mut firsts: HashMap<&Vector<BigInt>, u32> = HashMap::new();
        let mut circles = Vec::with_capacity(self.normals.len());
        for (k, normal) in (0..).zip(&self.normals) {
            let opposite = normal.clone().map(|x| -x);
            let known = match (firsts.get(normal), firsts.get(&opposite)) {
                (Some(&first), _) => Some((first, Sign::Positive)),
                (None, Some(&first)) => Some((first, Sign::Negative)),
                (None, None) => None,
            };
            circles.push(known.filter(|_| !normal.iter().all(Zero::is_zero)).unwrap_or_else(|| {
                firsts.insert(normal, k);
                (k, Sign::Positive)
            }));
        }
        self.decisions += circles.len() as u64;
        Some(circles)
    }

    fn box_outside(&mut self, sides: &[HalfSphere], corners: [DVec3; 2]) -> bool {
        let from_eye = |p: DVec3| [0, 1, 2].map(|k| self.scaled(p[k]) - &self.scaled_eye[k]);
        let [low, high] = corners.map(from_eye);
        sides.iter().any(|side| {
            let normal = &self.normals[side.splitter as usize];
            // The corner that lies furthest on the inside.
            let terms = [0, 1, 2].map(|k| {
                let up = normal[k].is_positive() == side.inside.is_positive();
                &normal[k] * if up { &high[k] } else { &low[k] }
            });
            sign_of(&terms.into_iter().sum::<BigInt>()) * side.inside != Sign::Positive
        })
    }

    fn box_beyond(&mut self, plane: u32, side: Sign, [low, high]: [DVec3; 2]) -> bool {
        let plane = &self.planes[plane as usize];
        // The corner that lies furthest on the other side.
        let corner = [0, 1, 2].map(|k| {
            let up = plane.0[k].is_negative() == side.is_positive();
            if up { high[k] } else { low[k] }
        });
        self.height_at(plane, DVec3::from(corner)) == side
    }

    fn definition(&self, splitter: u32) -> &Splitter {
        &self.splitters[splitter as usize]
    }

    fn rounded(&self, splitter: u32) -> DVec3 {
        let normal = &self.normals[splitter as usize];
        // Divided by what the largest component is close to, each fits an f64.
        let bits = normal.iter().map(BigInt::bits).max().unwrap_or(0).saturating_sub(64);
        DVec3::from([0, 1, 2].map(|k| (&normal[k] >> bits).to_f64().unwrap_or(0.0)))
    }

    fn decisions(&self) -> u64 {
        self.decisions
    }
}
