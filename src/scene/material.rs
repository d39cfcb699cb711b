//! Materials.

/// What a surface reflects and emits. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Diffuse reflectance (MTL `Kd`), each in 0..=1 by convention.
    pub diffuse: [f64; 3],
    /// Specular reflectance (MTL `Ks`).
    pub specular: [f64; 3],
    /// Phong exponent (MTL `Ns`).
    pub exponent: f64,
    /// How it reflects by glTF, if it is from there: then that holds, and not the specular reflectance and exponent of MTL. The diffuse
    /// reflectance is the base colour, whether it is that of a metal or not.
    pub metallic_roughness: Option<MetallicRoughness>,
    /// Emitted radiance, in W / (m^2 sr) or the scene's unit for it (MTL `Ke`); from fronts only.
    pub emission: [f64; 3],
}

/// Reflection as glTF states it: a metal, a matt base below a clear coat, or a mixture of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetallicRoughness {
    /// What a metal reflects at normal incidence, and the diffuse reflectance of what is none; each 0 to 1.
    pub base_colour: [f64; 3],
    /// 1 for a metal, 0 for what is none.
    pub metallic: f64,
    /// 0 to 1: the square root of the roughness that microfacet models have.
    pub roughness: f64,
}

impl Material {
    /// A grey, matt material of that name that emits nothing.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            diffuse: [0.5; 3],
            specular: [0.0; 3],
            exponent: 0.0,
            metallic_roughness: None,
            emission: [0.0; 3],
        }
    }

    /// True if it emits anything.
    pub fn is_emitter(&self) -> bool {
        self.emission.iter().any(|&e| e > 0.0)
    }
}
