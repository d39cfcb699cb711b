//! Sums of BRDFs.

use super::{Brdf, Form};
use glam::DVec3;

/// Several BRDFs one above the other, added up: a matt base and a glossy lobe, for example. That they do not reflect more than
/// they get together is up to whoever adds them.
#[derive(Default)]
pub struct Sum {
    parts: Vec<Box<dyn Brdf>>,
}

impl Sum {
    /// Of those parts; each is integrated in its own form.
    pub fn new(parts: Vec<Box<dyn Brdf>>) -> Self {
        Self { parts }
    }
}

impl Brdf for Sum {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        self.parts.iter().map(|part| part.eval(incoming, outgoing)).sum()
    }

    fn form(&self, _outgoing: DVec3) -> Form<'_> {
        Form::Sum(&self.parts)
    }

    fn is_reciprocal(&self) -> bool {
        self.parts.iter().all(|part| part.is_reciprocal())
    }
}
