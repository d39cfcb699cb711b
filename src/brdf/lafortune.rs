//! Generalised cosine lobes.

use super::error::{exponent, reflectance};
use super::phong::whole;
use super::{Brdf, BrdfError, Form, Lobe, are_above};
use crate::integral::{Peak, Smoothness};
use glam::DVec3;
use std::f64::consts::TAU;

/// weight max(0, Cx ux vx + Cy uy vy + Cz uz vz)^n (Lafortune, Foo, Torrance and Greenberg, "Non-linear approximation of
/// reflectance functions", SIGGRAPH 1997). Several lobes are a [`Sum`](super::Sum).
///
/// For a fixed viewer it is a Phong lobe about (Cx vx, Cy vy, Cz vz): whole exponents from 1 to 65,535 are integrated in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lafortune {
    /// Of the lobe scaled to a largest C of 1, in sr^-1.
    weight: DVec3,
    /// C over its largest component.
    scales: DVec3,
    exponent: f64,
}

impl Lafortune {
    /// A lobe of those scales C (-1, -1, 1 is Phong's), exponent n, and weight in units of (n + 2) / (2 pi) sr^-1 for the largest scale 1: of
    /// weight rho and scales -1, -1, 1 it is [`Phong`](super::Phong) of reflectance rho.
    ///
    /// # Errors
    /// If the weight is not from 0 to 1, a scale not finite, or n not from 0 to 1,000,000. If the lobe may reflect more than
    /// it gets, by the bound weight max(|C|)^n.
    pub fn new(weight: DVec3, scales: DVec3, n: f64) -> Result<Self, BrdfError> {
        let (weight, exponent) = (reflectance(weight)?, exponent(n)?);
        if !scales.is_finite() {
            return Err(BrdfError::BadScale(scales));
        }
        let largest = scales.abs().max_element();
        let power = largest.powf(exponent);
        let most = weight.max_element() * power;
        // Rounding of the power of a scale of 1 is none; another one just at the bound may be refused.
        if most > 1.0 {
            return Err(BrdfError::NotConserving(most));
        }
        let scales = if largest > 0.0 { scales / largest } else { DVec3::ZERO };
        Ok(Self { weight: weight * (power * (exponent + 2.0) / TAU), scales, exponent })
    }
}

impl Brdf for Lafortune {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        let base = (self.scales * outgoing).dot(incoming);
        if !are_above(incoming, outgoing) || base <= 0.0 {
            return DVec3::ZERO;
        }
        self.weight * base.powf(self.exponent)
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let along = self.scales * outgoing;
        let length = along.length();
        let Some(axis) = along.try_normalize() else { return Form::Lobes(Vec::new()) };
        if let Some(power) = whole(self.exponent).filter(|&power| power > 0) {
            let weight = self.weight * length.powf(self.exponent);
            return Form::Lobes(vec![Lobe { axis, power, weight }]);
        }
        let width = 1.0 / self.exponent.max(1.0).sqrt();
        Form::General { peaks: vec![Peak { axis, width }], creases: vec![axis], smoothness: Smoothness::Smooth }
    }
}
