//! What is written of a solution.

use super::{Radiosity, Stage};
use crate::args::Common;
use crate::failure::Failure;
use crate::output::write_file;
use crate::progress::SharedProgress;
use glam::DVec3;
use nusselt::io::gltf::write_glb;
use nusselt::io::radiosity::{
    RadiosityTable, auto_exposure, radiosity_meshes, write_radiosity_html, write_radiosity_json, write_radiosity_ply,
};
use nusselt::radiosity::{Gather, Solver, Surface, SurfaceOptions};
use nusselt::scene::{PolygonId, Scene};
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Glb,
    Ply,
    Html,
    Json,
}

#[derive(Clone)]
pub(super) struct Output {
    pub(super) path: PathBuf,
    format: Format,
}

impl Output {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let format = match path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("glb") => Format::Glb,
            Some("ply") => Format::Ply,
            Some("html") => Format::Html,
            Some("json") => Format::Json,
            _ => return Err("its ending is none of .glb, .ply, .html, .json".to_owned()),
        };
        Ok(Self { path, format })
    }

    pub(super) fn is_glb(&self) -> bool {
        self.format == Format::Glb
    }
}

impl Radiosity {
    /// Writes all files; gives the surface, if there was one to make.
    pub(super) fn write(
        &self,
        stage: &Stage,
        solver: &Solver<'_>,
        common: &Common,
    ) -> Result<Option<Surface>, Failure> {
        let Stage { patches, of, regions, exchange, .. } = stage;
        let ambient = self.ambient.then(|| solver.ambient());
        for output in self.output.iter().filter(|output| output.format == Format::Json) {
            let centers: Vec<_> = patches.polygons().map(|patch| middle(patches, patch.id())).collect();
            let ambient = ambient.as_deref();
            let table = RadiosityTable { solver, patches: exchange.patches(), of, centers: &centers, ambient };
            write_file(&output.path, |out| write_radiosity_json(&table, out))?;
        }
        if self.output.iter().all(|output| output.format == Format::Json) {
            return Ok(None);
        }
        let sum = |(&b, ambient): (&DVec3, &DVec3)| b + ambient;
        let shown = ambient.map(|ambient| solver.radiosity().iter().zip(&ambient).map(sum).collect::<Vec<_>>());
        let shown = shown.as_deref().unwrap_or(solver.radiosity());
        let gather = Gather::new(exchange, solver.emission(), solver.reflectance(), shown);
        let options = SurfaceOptions { detail: self.detail, depth: self.depth, ..SurfaceOptions::default() };
        let views = SharedProgress::new("views from corners", None, common.quiet);
        let surface = Surface::watched(patches, regions, &gather, &options, &|_| true, &|count| views.add(count))
            .map_err(|error| self.about(&error))?;
        drop(views);
        let exposure = self.exposure.unwrap_or_else(|| auto_exposure(&surface, solver.emission()));
        for Output { path, format } in &self.output {
            match format {
                Format::Glb => write_file(path, |out| write_glb(out, &radiosity_meshes(&surface, patches, exposure)))?,
                Format::Ply => write_file(path, |out| write_radiosity_ply(&surface, exposure, out))?,
                Format::Html => {
                    let up = self.up.unwrap_or_else(|| usual_up(&self.scene));
                    let title = self.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                    write_file(path, |out| write_radiosity_html(&surface, &title, exposure, up, out))?;
                }
                Format::Json => {}
            }
        }
        Ok(Some(surface))
    }
}

/// What is up in scenes of a file's format: y in glTF, which says so; elsewhere z, as for cameras.
fn usual_up(file: &Path) -> DVec3 {
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if matches!(&*ending, "gltf" | "glb") { DVec3::Y } else { DVec3::Z }
}

/// The mean of the corners of a polygon, or the origin if it has none.
fn middle(scene: &Scene, polygon: PolygonId) -> DVec3 {
    let polygon = scene.polygon(polygon);
    let ring = polygon.rings().first().map_or(&[][..], Vec::as_slice);
    let sum: DVec3 = ring.iter().map(|&vertex| scene.vertex(vertex)).sum();
    sum / ring.len().max(1) as f64
}
