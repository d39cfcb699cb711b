//! Materials: base colour and emission.

use super::json;
use crate::scene::Material;

/// A material by its name, else its number. Its base colour is taken as diffuse reflectance, whether it is that of a metal or
/// not; colours are linear already.
pub(super) fn material(number: usize, from: &json::Material) -> Material {
    let mut material = Material::new(from.name.clone().unwrap_or_else(|| format!("material_{number}")));
    let base = from.pbr_metallic_roughness.as_ref().and_then(|surface| surface.base_color_factor);
    material.diffuse = base.map_or([1.0; 3], |[red, green, blue, _]| [red, green, blue]);
    let strength = from.extensions.emissive_strength.as_ref().and_then(|known| known.emissive_strength).unwrap_or(1.0);
    material.emission = from.emissive_factor.unwrap_or_default().map(|factor| factor * strength);
    material
}

/// True if textures vary its base colour or its emission.
pub(super) fn has_texture(from: &json::Material) -> bool {
    let base = from.pbr_metallic_roughness.as_ref().is_some_and(|surface| surface.base_color_texture.is_some());
    base || from.emissive_texture.is_some()
}
