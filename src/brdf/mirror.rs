//! Perfect mirrors.

use super::{Brdf, Form, Fresnel, mirrored};
use glam::DVec3;

/// A smooth surface: what is seen in the mirror direction, times a reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    fresnel: Fresnel,
}

impl Mirror {
    /// With that reflectance by angle.
    pub fn new(fresnel: Fresnel) -> Self {
        Self { fresnel }
    }
}

impl Brdf for Mirror {
    /// Zero: all of it is in its one direction.
    fn eval(&self, _incoming: DVec3, _outgoing: DVec3) -> DVec3 {
        DVec3::ZERO
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        Form::Dirac { direction: mirrored(outgoing), reflectance: self.fresnel.reflectance(outgoing.z) }
    }
}
