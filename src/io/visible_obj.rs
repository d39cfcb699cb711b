//! Visible fragments in space, and fragments of the 3D BSP, as Wavefront OBJ.

use crate::bsp::SceneBsp;
use crate::contour::ContourImage;
use crate::scene::{Material, PolygonId, Scene, Side};
use glam::DVec3;
use std::io::{self, BufWriter, Write};

/// Writes every visible part of every polygon as faces in the polygon's plane: one face a cell, group
/// `polygon_K`, with the polygon's material, front to the side where the polygon's front is. The object
/// is the polygon's.
///
/// Corners are rounded. Cells too thin to have a face (fewer than three different corners) and corners
/// without a point (the ray to them is parallel to the plane, to rounding) are left out.
///
/// # Errors
/// Those of `out`.
pub fn write_visible_obj(image: &ContourImage, mtl_name: &str, out: impl Write) -> io::Result<()> {
    let mut cells: Vec<_> = image.cells().filter_map(|cell| Some((cell.polygon()?, cell.id()))).collect();
    cells.sort_unstable();
    let mut writer = FaceWriter::new(image.bsp().scene(), mtl_name, out)?;
    for (polygon, id) in cells {
        let cell = image.cell(id);
        let mut corners: Vec<DVec3> = cell.boundary().filter_map(|direction| cell.point_at(direction)).collect();
        // A cell runs clockwise as the eye sees it, that is clockwise around the side that is seen.
        if cell.side() == Some(Side::Front) {
            corners.reverse();
        }
        writer.face(polygon, &corners)?;
    }
    writer.finish()
}

/// Writes the fragments into which the 3D BSP cut the scene, likewise.
///
/// # Errors
/// Those of `out`.
pub fn write_fragments_obj(bsp: &SceneBsp, mtl_name: &str, out: impl Write) -> io::Result<()> {
    let mut fragments: Vec<_> = bsp.fragments().map(|fragment| (fragment.polygon(), fragment.id())).collect();
    fragments.sort_unstable();
    let mut writer = FaceWriter::new(bsp.scene(), mtl_name, out)?;
    for (polygon, id) in fragments {
        writer.face(polygon, &bsp.fragment(id).corners().collect::<Vec<_>>())?;
    }
    writer.finish()
}

/// Writes the material library of such files.
///
/// # Errors
/// Those of `out`.
pub fn write_materials(scene: &Scene, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    for (k, material) in scene.materials().iter().enumerate() {
        writeln!(out, "newmtl {}", material_name(k, material))?;
        let colours = [("Kd", material.diffuse), ("Ks", material.specular), ("Ke", material.emission)];
        for (key, [r, g, b]) in colours {
            writeln!(out, "{key} {r} {g} {b}")?;
        }
        writeln!(out, "Ns {}", material.exponent)?;
    }
    out.flush()
}

/// A name that survives OBJ, which ends names at line breaks and trims them.
fn plain(name: &str) -> String {
    let line: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    line.trim().to_owned()
}

fn material_name(k: usize, material: &Material) -> String {
    let name = plain(&material.name);
    if name.is_empty() { format!("material_{k}") } else { name }
}

struct FaceWriter<'a, W: Write> {
    scene: &'a Scene,
    out: BufWriter<W>,
    vertices: u64,
    polygon: Option<PolygonId>,
}

impl<'a, W: Write> FaceWriter<'a, W> {
    fn new(scene: &'a Scene, mtl_name: &str, out: W) -> io::Result<Self> {
        let mut out = BufWriter::new(out);
        writeln!(out, "mtllib {mtl_name}")?;
        Ok(Self { scene, out, vertices: 0, polygon: None })
    }

    fn face(&mut self, polygon: PolygonId, corners: &[DVec3]) -> io::Result<()> {
        let mut corners = corners.to_vec();
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            return Ok(());
        }
        if self.polygon.replace(polygon) != Some(polygon) {
            let source = self.scene.polygon(polygon);
            let material = source.material_id().index();
            writeln!(self.out, "o {}", plain(source.object_name()))?;
            writeln!(self.out, "g polygon_{polygon}")?;
            writeln!(self.out, "usemtl {}", material_name(material, source.material()))?;
        }
        for p in &corners {
            // Adding 0 turns -0 into 0.
            writeln!(self.out, "v {} {} {}", p.x + 0.0, p.y + 0.0, p.z + 0.0)?;
        }
        write!(self.out, "f")?;
        for k in 1..=corners.len() as u64 {
            write!(self.out, " {}", self.vertices + k)?;
        }
        self.vertices += corners.len() as u64;
        writeln!(self.out)
    }

    fn finish(mut self) -> io::Result<()> {
        self.out.flush()
    }
}
