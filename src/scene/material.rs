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
    /// Emitted radiance, in W / (m^2 sr) or the scene's unit for it (MTL `Ke`); from fronts only.
    pub emission: [f64; 3],
}

impl Material {
    /// A grey, matt material of that name that emits nothing.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), diffuse: [0.5; 3], specular: [0.0; 3], exponent: 0.0, emission: [0.0; 3] }
    }

    /// True if it emits anything.
    pub fn is_emitter(&self) -> bool {
        self.emission.iter().any(|&e| e > 0.0)
    }
}
