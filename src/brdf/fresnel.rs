//! Fresnel's reflectance of a smooth boundary.

use super::BrdfError;
use super::error::reflectance;
use glam::DVec3;

/// What part of unpolarised light a smooth boundary reflects, by the cosine of the angle of incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fresnel(Kind);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    All,
    Schlick(DVec3),
    Dielectric(f64),
    Conductor { eta: DVec3, absorption: DVec3 },
}

impl Fresnel {
    /// All of it, at any angle.
    pub const ALL: Self = Self(Kind::All);

    /// Schlick's approximation ("An inexpensive BRDF model for physically-based rendering", 1994) from the reflectance at normal incidence.
    ///
    /// # Errors
    /// If that is not from 0 to 1.
    pub fn schlick(at_normal: DVec3) -> Result<Self, BrdfError> {
        Ok(Self(Kind::Schlick(reflectance(at_normal)?)))
    }

    /// A boundary to a transparent medium of that refractive index relative to the outside.
    ///
    /// # Errors
    /// If it is not from 0.01 to 100.
    pub fn dielectric(index: f64) -> Result<Self, BrdfError> {
        indices(DVec3::splat(index), DVec3::ZERO)?;
        Ok(Self(Kind::Dielectric(index)))
    }

    /// A boundary to a metal of the refractive index eta + i k, by colour.
    ///
    /// # Errors
    /// If eta is not from 0.01 to 100, or k not from 0 to 100.
    pub fn conductor(eta: DVec3, absorption: DVec3) -> Result<Self, BrdfError> {
        indices(eta, absorption)?;
        Ok(Self(Kind::Conductor { eta, absorption }))
    }

    /// The reflectance for light at an angle of that cosine to the normal, 0 to 1.
    pub fn reflectance(&self, cosine: f64) -> DVec3 {
        let cosine = cosine.clamp(0.0, 1.0);
        match self.0 {
            Kind::All => DVec3::ONE,
            Kind::Schlick(at_normal) => at_normal + (DVec3::ONE - at_normal) * (1.0 - cosine).powi(5),
            Kind::Dielectric(index) => DVec3::splat(dielectric(cosine, index)),
            Kind::Conductor { eta, absorption } => {
                DVec3::from([0, 1, 2].map(|k| conductor(cosine, eta[k], absorption[k])))
            }
        }
    }
}

fn indices(eta: DVec3, absorption: DVec3) -> Result<(), BrdfError> {
    let within = |v: DVec3, low: f64| v.cmpge(DVec3::splat(low)).all() && v.cmple(DVec3::splat(100.0)).all();
    match (within(eta, 0.01), within(absorption, 0.0)) {
        (true, true) => Ok(()),
        (false, _) => Err(BrdfError::BadIndex(eta)),
        (true, false) => Err(BrdfError::BadIndex(absorption)),
    }
}

fn dielectric(cosine: f64, index: f64) -> f64 {
    let square = 1.0 - (1.0 - cosine * cosine) / (index * index);
    if square <= 0.0 {
        return 1.0;
    }
    let refracted = square.sqrt();
    let parallel = (index * cosine - refracted) / (index * cosine + refracted);
    let perpendicular = (cosine - index * refracted) / (cosine + index * refracted);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Born and Wolf, *Principles of Optics*, as written out by Pharr, Jakob and Humphreys.
fn conductor(cosine: f64, eta: f64, k: f64) -> f64 {
    let [cos2, sin2] = [cosine * cosine, 1.0 - cosine * cosine];
    let difference = eta * eta - k * k - sin2;
    let a2_plus_b2 = (difference * difference + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (a2_plus_b2 + difference)).max(0.0).sqrt();
    let perpendicular = (a2_plus_b2 + cos2 - 2.0 * a * cosine) / (a2_plus_b2 + cos2 + 2.0 * a * cosine);
    let [one, two] = [cos2 * a2_plus_b2 + sin2 * sin2, 2.0 * a * cosine * sin2];
    0.5 * perpendicular * (1.0 + (one - two) / (one + two))
}

#[cfg(test)]
mod tests {
    use super::Fresnel;
    use glam::DVec3;

    #[test]
    fn known_values() {
        let glass = Fresnel::dielectric(1.5).unwrap();
        assert!((glass.reflectance(1.0).x - 0.04).abs() < 1e-15);
        assert!((glass.reflectance(0.0).x - 1.0).abs() < 1e-15);
        // At Brewster's angle only perpendicular light is reflected: r = (1 - n^2) / (1 + n^2).
        let brewster = (1.0 + 1.5_f64 * 1.5).sqrt().recip();
        let expected = 0.5 * ((1.0 - 2.25) / 3.25_f64).powi(2);
        assert!((glass.reflectance(brewster).x - expected).abs() < 1e-15);
        // Total reflection into the thinner medium.
        assert!((Fresnel::dielectric(1.0 / 1.5).unwrap().reflectance(0.5).x - 1.0).abs() < f64::EPSILON);
        let [eta, k] = [DVec3::new(0.2, 0.9, 1.5), DVec3::new(3.9, 2.4, 1.9)];
        let metal = Fresnel::conductor(eta, k).unwrap().reflectance(1.0);
        let expected = ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k);
        assert!((metal - expected).length() < 1e-14, "{metal} {expected}");
    }

    #[test]
    fn a_metal_without_absorption_is_a_dielectric() {
        let metal = Fresnel::conductor(DVec3::splat(1.7), DVec3::ZERO).unwrap();
        let glass = Fresnel::dielectric(1.7).unwrap();
        for k in 0..=100 {
            let cosine = f64::from(k) / 100.0;
            let [one, two] = [metal.reflectance(cosine).x, glass.reflectance(cosine).x];
            assert!((one - two).abs() < 1e-13, "{cosine}: {one} {two}");
        }
    }

    #[test]
    fn bad_parameters_are_refused() {
        assert!(Fresnel::dielectric(0.0).is_err() && Fresnel::dielectric(f64::NAN).is_err());
        assert!(Fresnel::schlick(DVec3::new(0.0, 1.1, 0.0)).is_err());
        assert!(Fresnel::conductor(DVec3::ONE, -DVec3::ONE).is_err());
    }
}
