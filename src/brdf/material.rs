//! From the materials of scene files to BRDFs.

use super::error::reflectance;
use super::{Brdf, BrdfError, Lambert, MetallicRoughness, Phong, Sum};
use crate::scene::Material;
use glam::DVec3;

impl Material {
    /// How it reflects.
    ///
    /// Materials of glTF are [`MetallicRoughness`]. Those of MTL are [`Lambert`] of `Kd` and, if `Ks` is not black, [`Phong`] of reflectance `Ks` and
    /// exponent `Ns`, added, both as [`Material::reflectances`] has them.
    ///
    /// # Errors
    /// As [`Material::reflectances`], and if a metallic factor or roughness of glTF is not from 0 to 1, or the exponent above 1,000,000.
    ///
    /// ```
    /// use nusselt::scene::Material;
    /// let lacquer = Material { diffuse: [0.6, 0.1, 0.1], specular: [0.3; 3], exponent: 50.0, ..Material::new("lacquer") };
    /// let straight_down = lacquer.brdf()?.albedo(glam::DVec3::Z).value;
    /// assert!((straight_down - glam::DVec3::new(0.9, 0.4, 0.4)).length() < 1e-9);
    /// # Ok::<(), nusselt::brdf::BrdfError>(())
    /// ```
    pub fn brdf(&self) -> Result<Box<dyn Brdf>, BrdfError> {
        if let Some(surface) = self.metallic_roughness {
            return Ok(Box::new(MetallicRoughness::try_from(surface)?));
        }
        let [matt, gloss] = self.reflectances()?;
        let parts = (Lambert::new(matt)?, Phong::new(gloss, self.exponent)?);
        if gloss == DVec3::ZERO {
            return Ok(Box::new(parts.0));
        }
        let parts: [Box<dyn Brdf>; 2] = [Box::new(parts.0), Box::new(parts.1)];
        Ok(Box::new(Sum::new(parts.into())))
    }

    /// What part it reflects diffusely, and what part specularly, for all that computes with light. MTL says nothing of energy: in colours where `Kd` and `Ks` sum to more
    /// than 1, or `Kd` alone does, both are divided by that sum ([`Material::reflects_too_much`] tells). Materials of glTF have their base colour as the one, which has
    /// to be a reflectance as it is, and nothing as the other.
    ///
    /// # Errors
    /// If one is negative or no number, or a base colour is above 1.
    pub fn reflectances(&self) -> Result<[DVec3; 2], BrdfError> {
        if let Some(surface) = self.metallic_roughness {
            return Ok([reflectance(DVec3::from(surface.base_colour))?, DVec3::ZERO]);
        }
        // Halves, of which no sum overflows; they are as exact.
        let halves = [self.diffuse, self.specular].map(|colour| DVec3::from(colour) * 0.5);
        let most = (halves[0] + halves[1]).max(DVec3::splat(0.5));
        let [matt, gloss] = halves.map(|half| reflectance(half / most));
        Ok([matt?, gloss?])
    }

    /// True if its diffuse and specular reflectances sum to more than 1 in some colour, so that [`Material::reflectances`] makes them smaller.
    pub fn reflects_too_much(&self) -> bool {
        let sums = (0..3).map(|k| self.diffuse[k] + self.specular[k]);
        self.metallic_roughness.is_none() && sums.fold(0.0, f64::max) > 1.0
    }
}
