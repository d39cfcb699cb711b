//! The forms in which a BRDF can be integrated.

use super::Brdf;
use crate::integral::{Harmonics, Peak, Smoothness};
use glam::{DMat3, DVec3};

/// In what form a BRDF, for one direction towards the viewer, is a function of the direction towards the light.
#[non_exhaustive]
pub enum Form<'a> {
    /// A sum of powers of cosines, integrated by moments in closed form.
    Lobes(Vec<Lobe>),
    /// All of it into one direction, as by a mirror: what is seen there is looked up.
    Dirac {
        /// Where the light comes from: a unit vector.
        direction: DVec3,
        /// The part of its radiance that is reflected, 0 to 1.
        reflectance: DVec3,
    },
    /// A series of spherical harmonics without the cosine, integrated with it in closed form. To band 64 at most, else by cubature.
    Harmonics(Harmonics),
    /// A linearly transformed cosine in place of BRDF times cosine: with w = `inverse` u it is `weight` max(0, wz) det(inverse) / (pi |w|^4). A polygon is
    /// transformed, and then a matt surface's form factor in closed form.
    Transformed {
        /// From directions to those in which it is a cosine; of positive determinant.
        inverse: DMat3,
        /// Its integral over all directions.
        weight: DVec3,
        /// The integral over all directions above the surface of the difference to what it stands for, in size.
        distance: DVec3,
        /// The least and the largest value of what it stands for, BRDF times cosine, over a convex polygon above the horizon with those unit corners: what a small
        /// polygon off the lobe reflects is between the two times its solid angle, which tells more than the distance.
        range: Box<Range<'a>>,
    },
    /// A sum of BRDFs, each in its own form.
    Sum(&'a [Box<dyn Brdf>]),
    /// Anything else, for adaptive cubature.
    General {
        /// Where it is large.
        peaks: Vec<Peak>,
        /// Normals of great circles at which it has a kink: polygons are cut there.
        creases: Vec<DVec3>,
        /// Whether it has other kinks.
        smoothness: Smoothness,
    },
}

/// The least and the largest value of a function over a convex polygon of those unit corners.
pub type Range<'a> = dyn Fn(&[DVec3]) -> [DVec3; 2] + 'a;

/// `weight` max(0, axis.u)^power: a lobe of a Phong model, or with power 0 a matt surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// A unit vector. Of no meaning if the power is 0, where the lobe is the whole hemisphere.
    pub axis: DVec3,
    /// The exponent.
    pub power: u16,
    /// In sr^-1.
    pub weight: DVec3,
}

impl Lobe {
    pub(super) fn peak(&self) -> Peak {
        Peak { axis: self.axis, width: 1.0 / f64::from(self.power.max(1)).sqrt() }
    }

    pub(super) fn eval(&self, incoming: DVec3) -> DVec3 {
        if self.power == 0 {
            self.weight
        } else {
            self.weight * self.axis.dot(incoming).max(0.0).powi(i32::from(self.power))
        }
    }
}
