//! From the materials of scene files to BRDFs.

use super::{Brdf, BrdfError, Lambert, MetallicRoughness, Phong, Sum};
use crate::scene::Material;
use glam::DVec3;

impl Material {
    /// How it reflects.
    ///
    /// Materials of glTF are [`MetallicRoughness`]. Those of MTL are [`Lambert`] of `Kd` and, if `Ks` is not black, [`Phong`] of reflectance `Ks` and
    /// exponent `Ns`, added. MTL says nothing of energy: in colours where `Kd` and `Ks` sum to more than 1, both are divided
    /// by that sum ([`Material::reflects_too_much`] tells).
    ///
    /// # Errors
    /// If a reflectance alone, or a metallic factor or roughness of glTF, is not from 0 to 1, or the exponent above 1,000,000.
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
        let [matt, gloss] = [self.diffuse, self.specular].map(DVec3::from);
        // Each alone has to be a reflectance.
        let matt_alone = Lambert::new(matt)?;
        Phong::new(gloss, self.exponent)?;
        if gloss == DVec3::ZERO {
            return Ok(Box::new(matt_alone));
        }
        let most = (matt + gloss).max(DVec3::ONE);
        let parts: [Box<dyn Brdf>; 2] =
            [Box::new(Lambert::new(matt / most)?), Box::new(Phong::new(gloss / most, self.exponent)?)];
        Ok(Box::new(Sum::new(parts.into())))
    }

    /// True if its diffuse and specular reflectances sum to more than 1 in some colour, so that [`Material::brdf`] makes them smaller.
    pub fn reflects_too_much(&self) -> bool {
        let sums = (0..3).map(|k| self.diffuse[k] + self.specular[k]);
        self.metallic_roughness.is_none() && sums.fold(0.0, f64::max) > 1.0
    }
}
