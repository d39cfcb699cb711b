//! Materials: metal or not, rough or smooth, and emission.

use super::json;
use crate::scene::{Material, MetallicRoughness};

/// A material by its name, else its number. Its base colour is taken as diffuse reflectance too, whether it is that of a metal or
/// not; colours are linear already. What is not said is as the specification has it: a white, rough metal.
pub(super) fn material(number: usize, from: &json::Material) -> Material {
    let mut material = Material::new(from.name.clone().unwrap_or_else(|| format!("material_{number}")));
    let surface = from.pbr_metallic_roughness.as_ref();
    let base = surface.and_then(|surface| surface.base_color_factor);
    material.diffuse = base.map_or([1.0; 3], |[red, green, blue, _]| [red, green, blue]);
    material.metallic_roughness = Some(MetallicRoughness {
        base_colour: material.diffuse,
        metallic: surface.and_then(|surface| surface.metallic_factor).unwrap_or(1.0),
        roughness: surface.and_then(|surface| surface.roughness_factor).unwrap_or(1.0),
    });
    let strength = from.extensions.emissive_strength.as_ref().and_then(|known| known.emissive_strength).unwrap_or(1.0);
    material.emission = from.emissive_factor.unwrap_or_default().map(|factor| factor * strength);
    material
}

/// True if textures vary how it reflects or what it emits.
pub(super) fn has_texture(from: &json::Material) -> bool {
    let surface = from.pbr_metallic_roughness.as_ref();
    surface.is_some_and(|s| s.base_color_texture.is_some() || s.metallic_roughness_texture.is_some())
        || from.emissive_texture.is_some()
}
