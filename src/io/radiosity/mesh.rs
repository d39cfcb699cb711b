//! Surfaces with colours.

use crate::io::gltf::GlbMesh;
use crate::io::number::single;
use crate::io::srgb::encoded;
use crate::radiosity::Surface;
use crate::scene::Scene;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::f64::consts::PI;
use std::io::{self, Write};

/// A factor for radiances that brings 95% of the surface that reflects to at most 0.8: `emission` has the radiosity that each patch of the scene emits.
pub fn auto_exposure(surface: &Surface, emission: &[DVec3]) -> f64 {
    let mut found: Vec<(f64, f64)> = surface
        .triangles
        .iter()
        .zip(&surface.patches)
        .filter(|(_, patch)| emission[patch.index()] == DVec3::ZERO)
        .map(|(triangle, _)| {
            let radiance = triangle.iter().map(|&corner| surface.radiosity[corner as usize]).sum::<DVec3>() / 3.0 / PI;
            (radiance.max_element(), surface.area(*triangle))
        })
        .collect();
    found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut left = 0.05 * found.iter().map(|(_, area)| area).sum::<f64>();
    while let Some((radiance, area)) = found.pop() {
        left -= area;
        if left <= 0.0 {
            return if radiance > 0.0 { (0.8 / radiance).min(f64::MAX) } else { 1.0 };
        }
    }
    1.0
}

/// A mesh for every object, with the radiance times `exposure` at its corners as linear colours, cut off at 1, for
/// [`write_glb`](crate::io::gltf::write_glb). `scene` is that of the patches.
pub fn radiosity_meshes(surface: &Surface, scene: &Scene, exposure: f64) -> Vec<GlbMesh> {
    let mut meshes: Vec<GlbMesh> = scene
        .objects()
        .iter()
        .map(|name| GlbMesh { name: name.clone(), color: [1.0; 3], ..GlbMesh::default() })
        .collect();
    let mut numbers: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for (triangle, patch) in surface.triangles.iter().zip(&surface.patches) {
        let object = scene.polygon(*patch).object();
        let mesh = &mut meshes[object.index()];
        let corners = triangle.map(|corner| {
            *numbers.entry((object.0, corner)).or_insert_with(|| {
                mesh.positions.push(surface.positions[corner as usize]);
                let colour = surface.radiosity[corner as usize] / PI * exposure;
                mesh.colors.push(colour.clamp(DVec3::ZERO, DVec3::ONE).as_vec3().to_array());
                mesh.positions.len() as u32 - 1
            })
        });
        mesh.triangles.push(corners);
    }
    meshes.retain(|mesh| !mesh.triangles.is_empty());
    meshes
}

/// Writes a surface as binary PLY: corners as doubles with the colour that they show (sRGB, of the radiance times `exposure`) and the radiosity as floats
/// (`radiosity_red`, ...), and triangles.
///
/// # Errors
/// Those of `out`, or if there are more than 2^31 corners.
pub fn write_radiosity_ply(surface: &Surface, exposure: f64, out: &mut impl Write) -> io::Result<()> {
    if i32::try_from(surface.positions.len()).is_err() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "PLY files hold at most 2^31 corners"));
    }
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment radiosity in the unit of the emitted radiance times pi\nelement vertex {}\n",
        surface.positions.len()
    )?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property double {axis}")?;
    }
    for channel in ["red", "green", "blue"] {
        writeln!(out, "property uchar {channel}")?;
    }
    for channel in ["red", "green", "blue"] {
        writeln!(out, "property float radiosity_{channel}")?;
    }
    write!(out, "element face {}\nproperty list uchar int vertex_indices\nend_header\n", surface.triangles.len())?;
    for (p, radiosity) in surface.positions.iter().zip(&surface.radiosity) {
        for x in p.to_array() {
            out.write_all(&x.to_le_bytes())?;
        }
        out.write_all(&(*radiosity / PI * exposure).to_array().map(encoded))?;
        for x in radiosity.to_array() {
            out.write_all(&single(x).to_le_bytes())?;
        }
    }
    for triangle in &surface.triangles {
        out.write_all(&[3])?;
        for corner in triangle {
            out.write_all(&corner.to_le_bytes())?;
        }
    }
    Ok(())
}
