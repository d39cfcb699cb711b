//! A BRDF taken apart: what is matt, what is a mirror, and the rest.

use crate::brdf::{Brdf, Form};
use glam::DVec3;

/// A direction towards a viewer by whom all mirrors are seen: from straight above some are left out of a sum.
pub(super) const ASLANT: DVec3 = DVec3::new(0.6, 0.0, 0.8);

/// The parts of a BRDF for one direction towards the viewer.
#[derive(Default)]
pub(super) struct Leaves<'a> {
    /// The matt parts, and the sum of their values in sr^-1.
    pub(super) matt: Vec<&'a dyn Brdf>,
    pub(super) weight: DVec3,
    /// What is seen in these directions, in the surface's frame, is reflected by these parts.
    pub(super) mirrors: Vec<(DVec3, DVec3)>,
    pub(super) glossy: Vec<&'a dyn Brdf>,
}

impl<'a> Leaves<'a> {
    pub(super) fn new(brdf: &'a dyn Brdf, outgoing: DVec3) -> Self {
        let mut leaves = Self::default();
        leaves.add(brdf, outgoing);
        leaves
    }

    fn add(&mut self, brdf: &'a dyn Brdf, outgoing: DVec3) {
        match brdf.form(outgoing) {
            Form::Sum(parts) => parts.iter().for_each(|part| self.add(&**part, outgoing)),
            Form::Dirac { direction, reflectance } => self.add_mirror(direction, reflectance),
            Form::Lobes(lobes) if lobes.iter().all(|lobe| lobe.power == 0) => {
                let weight: DVec3 = lobes.iter().map(|lobe| lobe.weight).sum();
                if weight != DVec3::ZERO {
                    self.weight += weight;
                    self.matt.push(brdf);
                }
            }
            _ => self.glossy.push(brdf),
        }
    }

    /// Mirrors that show the same are one: each would be followed apart, and so would all that it meets. One that reflects nothing is none.
    fn add_mirror(&mut self, direction: DVec3, reflectance: DVec3) {
        if let Some((_, sum)) = self.mirrors.iter_mut().find(|(other, _)| *other == direction) {
            *sum += reflectance;
        } else if reflectance != DVec3::ZERO {
            self.mirrors.push((direction, reflectance));
        }
    }
}

/// True if light from there is reflected as by a flat mirror; both are in the surface's frame.
pub(super) fn is_mirrored(outgoing: DVec3, incoming: DVec3) -> bool {
    incoming == DVec3::new(-outgoing.x, -outgoing.y, outgoing.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::{Fresnel, Lambert, Mirror, Sum};

    #[test]
    fn mirrors_of_one_direction_are_one() {
        let [dim, bright] = [0.04, 0.3].map(|at_normal| Fresnel::schlick(DVec3::splat(at_normal)).unwrap());
        let mirror = |fresnel: Fresnel| -> Box<dyn Brdf> { Box::new(Mirror::new(fresnel)) };
        let matt: Box<dyn Brdf> = Box::new(Lambert::new(DVec3::splat(0.2)).unwrap());
        let inner: Box<dyn Brdf> = Box::new(Sum::new(vec![mirror(bright), mirror(dim)]));
        let sum = Sum::new(vec![mirror(dim), matt, inner]);
        let outgoing = DVec3::new(0.6, 0.0, 0.8);
        let leaves = Leaves::new(&sum, outgoing);
        let reflectance = dim.reflectance(0.8) + bright.reflectance(0.8) + dim.reflectance(0.8);
        assert_eq!(leaves.mirrors, [(DVec3::new(-0.6, 0.0, 0.8), reflectance)]);
        assert_eq!((leaves.matt.len(), leaves.glossy.len()), (1, 0));
    }
}
