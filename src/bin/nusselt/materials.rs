//! Materials that light is computed with.

use crate::args::Common;
use crate::failure::Failure;
use nusselt::brdf::Brdf;
use nusselt::scene::{Material, Scene};
use std::fmt::Display;
use std::path::Path;

/// Where the materials of a scene are defined, as messages start.
pub(crate) struct Materials {
    places: Vec<String>,
}

impl Materials {
    pub(crate) fn new(places: Vec<String>) -> Self {
        Self { places }
    }

    /// Names a material of the scene by its number in what is wrong with it.
    pub(crate) fn about(&self, scene: &Scene, number: usize, what: &dyn Display) -> Failure {
        Failure::about(Path::new(self.place(number)), &told(&scene.materials()[number], what))
    }

    /// Refuses materials that have no reflectance, and warns of those that reflect less than they say; of those that matter.
    pub(crate) fn check(
        &self,
        scene: &Scene,
        common: &Common,
        matters: impl Fn(&Material) -> bool,
    ) -> Result<(), Failure> {
        for (number, material) in scene.materials().iter().enumerate().filter(|(_, material)| matters(material)) {
            material.reflectances().map_err(|error| self.about(scene, number, &error))?;
            if material.reflects_too_much() {
                let what = "Kd and Ks sum to more than 1 in some colour; there both are divided by their sum";
                common.warn(&format!("{}: {}", self.place(number), told(material, &what)));
            }
        }
        Ok(())
    }

    fn place(&self, number: usize) -> &str {
        self.places.get(number).map_or("", String::as_str)
    }
}

/// A material of a scene by its number.
#[derive(Clone, Copy)]
pub(crate) struct Numbered<'a> {
    pub(crate) materials: &'a Materials,
    pub(crate) scene: &'a Scene,
    pub(crate) number: usize,
}

impl Numbered<'_> {
    /// How it reflects.
    pub(crate) fn brdf(&self) -> Result<Box<dyn Brdf>, Failure> {
        let brdf = self.scene.materials()[self.number].brdf();
        brdf.map_err(|error| self.materials.about(self.scene, self.number, &error))
    }
}

fn told(material: &Material, what: &dyn Display) -> String {
    format!("material {:?}: {what}", material.name)
}
