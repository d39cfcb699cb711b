//! A BRDF taken apart: what is matt, what is a mirror, and the rest.

use crate::brdf::{Brdf, Form};
use glam::DVec3;

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
            Form::Dirac { direction, reflectance } => self.mirrors.push((direction, reflectance)),
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
}
