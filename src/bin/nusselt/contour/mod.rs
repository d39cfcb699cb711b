//! `nusselt contour`: the contour image from one point.

mod place;
mod report;

use crate::args::{
    Common, Loading, Order, Way, parse_arithmetic, parse_aspect, parse_direction, parse_fov, parse_point, parse_surface,
};
use crate::failure::Failure;
use crate::input::{build_order, check_way, load, way};
use crate::output::{check_once, print, print_json, write_file, write_obj};
use crate::progress::Progress;
use crate::proof::{Proof, prove};
use crate::summary::Timing;
use glam::DVec3;
use nusselt::contour::{ContourImage, Projection, Projector, ViewOptions};
use nusselt::io::{
    ContourSummary, SvgOptions, contour_picture, visible_groups, write_certificate, write_contour_json, write_geojson,
    write_png, write_svg,
};
use nusselt::scene::{PolygonId, Side};
use nusselt::verify::Arithmetic;
use std::path::{Path, PathBuf};
use std::time::Instant;

const EXAMPLE: &str = "\
Examples: the form factors of all objects from a point on the floor, and a picture of them
  nusselt contour room.obj --eye 2,1.5,0 --normal 0,0,1 -o view.json -o view.svg

The whole sphere around a point in the air, as a panorama with the contour tree
  nusselt contour room.obj --eye 2,1.5,1.2 --sphere -o tree.svg --show-tree

From the back of polygon 17
  nusselt contour room.obj --eye 2,1.5,0 --on 17:back --json

What a camera sees, 60 degrees from top to bottom
  nusselt contour room.obj --eye 2,1.5,1.2 --look-at 4,1,0.8 --fov 60 --aspect 16/9 -o camera.svg

How much of a lamp, polygon 17, is seen from a point on the floor, and what hides the rest
  nusselt contour room.obj --eye 2,1.5,0 --normal 0,0,1 --window 17

The same with a proof that it is right, kept for nusselt verify
  nusselt contour room.obj --eye 2,1.5,0 --on 17:back --certificate proof.json";

/// Compute the contour image: exactly what is seen from a point, and how much of it
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
#[command(group(clap::ArgGroup::new("stand").args(["normal", "sphere", "on", "look_at"])))]
#[command(group(clap::ArgGroup::new("domain").required(true).multiple(true).args(["normal", "sphere", "on", "look_at", "window"])))]
pub(crate) struct Contour {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    scene: PathBuf,
    /// Where to stand
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    eye: DVec3,
    /// See the hemisphere about this normal, of any length; a point that lies on a polygon with such a normal is
    /// taken to be on it
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    normal: Option<DVec3>,
    /// See the whole sphere
    #[arg(long)]
    sphere: bool,
    /// Stand on polygon K, where it is nearest to --eye, on its front or back, and see what is above
    #[arg(long, value_name = "K[:back]", value_parser = parse_surface, allow_hyphen_values = true)]
    on: Option<(PolygonId, Side)>,
    /// See what a camera sees that looks at this point
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true, requires = "fov")]
    look_at: Option<DVec3>,
    /// The camera's vertical field of view in degrees, above 0 and below 180
    #[arg(long, value_name = "DEG", value_parser = parse_fov, allow_hyphen_values = true)]
    fov: Option<f64>,
    /// The camera's width over height, as a number or a fraction [default: 1]
    #[arg(long, value_name = "W/H", value_parser = parse_aspect, allow_hyphen_values = true)]
    aspect: Option<f64>,
    /// What is up in the camera's picture [default: 0,0,1, or 0,1,0 when looking along it]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// See only what is in the directions of polygon K: a lamp, or a window. May be repeated; with --normal or --on only what is above
    /// the horizon
    #[arg(long, value_name = "K", conflicts_with = "look_at")]
    window: Vec<u32>,
    /// Take --eye as it is, even if it lies on a polygon
    #[arg(long, conflicts_with_all = ["sphere", "on", "look_at"])]
    free: bool,
    /// Write to this file; the ending decides: .json, .svg, .png (without lines, each pixel the mean of what is seen in
    /// it), .obj (visible parts in space), or .geojson (visible regions as polygons with holes, in coordinates of the
    /// picture). May be repeated
    #[arg(short, long, value_name = "FILE", value_parser = Output::parse)]
    output: Vec<Output>,
    /// The width of .png in pixels
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=16384))]
    width: u32,
    /// How to draw .svg, .png and .geojson [default: nusselt; gnomonic for a camera, equirectangular for the sphere]
    #[arg(long, value_name = "NAME", value_parser = parse_projection)]
    projection: Option<Projection>,
    /// Draw the contour tree and the quadtree over .svg
    #[arg(long)]
    show_tree: bool,
    /// How to find what is nearer: whole polygons by a hierarchy of boxes, or the fragments of a 3D BSP; both give the
    /// same image, cut into other cells [default: boxes, and bsp with an epsilon]
    #[arg(long, value_name = "boxes|bsp", value_enum, hide_possible_values = true)]
    way: Option<Way>,
    /// Levels of the quadtree at the top of the contour tree, 0 to 8 [default: by the size of the scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=8))]
    quadtree_depth: Option<u32>,
    /// Prove that the image is right, for all directions, and say so; =rational shares no predicate with what made
    /// the image, and takes about a hundred times as long. An image that fails is not written
    #[arg(long, value_name = "kernel|rational", num_args = 0..=1, require_equals = true,
        default_missing_value = "kernel", value_parser = parse_arithmetic)]
    certify: Option<Arithmetic>,
    /// Prove the image, as --certify does, and keep the evidence in this file, for nusselt verify
    #[arg(long, value_name = "FILE.json", value_parser = parse_certificate)]
    certificate: Option<PathBuf>,
    #[command(flatten)]
    loading: Loading,
    #[command(flatten)]
    order: Order,
}

/// The formats that are written, by the ending of the file's name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Json,
    Svg,
    Png,
    Obj,
    Geojson,
}

/// A file to write.
#[derive(Clone)]
struct Output {
    path: PathBuf,
    format: Format,
}

impl Output {
    fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let format = match ending.as_deref() {
            Some("json") => Format::Json,
            Some("svg") => Format::Svg,
            Some("png") => Format::Png,
            Some("obj") => Format::Obj,
            Some("geojson") => Format::Geojson,
            _ => return Err("its ending is none of .json, .svg, .png, .obj, .geojson".to_owned()),
        };
        Ok(Self { path, format })
    }
}

fn parse_projection(text: &str) -> Result<Projection, String> {
    let named = Projection::ALL.into_iter().find(|projection| projection.name() == text);
    named.ok_or_else(|| format!("there are {}", Projection::ALL.map(Projection::name).join(", ")))
}

fn parse_certificate(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_json = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    if is_json { Ok(path) } else { Err("certificates are written as .json".to_owned()) }
}

impl Contour {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let projection = self.check()?;
        let camera = self.camera()?;
        let outputs = self.output.iter().map(|output| &output.path).chain(&self.certificate).map(PathBuf::as_path);
        let (scene, load_s) = load(&self.scene, outputs, &self.loading, common)?;
        let (viewpoint, domain) = self.stand(&scene, camera)?;
        let (order, order_s) = build_order(&self.scene, &scene, &self.order, way(self.way, &self.order))?;
        let start = Instant::now();
        let options = ViewOptions { quadtree_depth: self.quadtree_depth, ..ViewOptions::default() };
        let image =
            order.view_with(&viewpoint, &domain, &options).map_err(|error| Failure::about(&self.scene, &error))?;
        let view_ms = start.elapsed().as_secs_f64() * 1e3;
        let mut timing = Timing::new(load_s, order_s, &[view_ms]);
        let mut summary = ContourSummary::new(&image);
        // Before anything is written.
        let proof = self.prove(&image)?;
        if let Some(proof) = &proof {
            timing.certify_ms = Some(proof.certify_ms);
            summary.certificate = Some(proof.certificate.into());
        }
        for output in &self.output {
            self.write(output, projection, &image, &summary, common)?;
        }
        if common.json {
            return print_json(&report::Printed::new(&summary, timing, &image));
        }
        if common.quiet {
            return Ok(());
        }
        let mut lines = report::in_words(&image, &summary, timing);
        if let Some(proof) = &proof {
            proof.tell(&mut lines);
        }
        for path in self.output.iter().map(|output| &output.path).chain(&self.certificate) {
            lines.add("wrote", path.display());
        }
        print(&lines.0)
    }

    /// What can be told to be wrong before any work is done; the projection to draw in.
    fn check(&self) -> Result<Projection, Failure> {
        let usage = |message: String| Err(Failure::Usage(message));
        check_once(self.output.iter().map(|output| &output.path).chain(&self.certificate).map(PathBuf::as_path))?;
        let has_horizon = self.normal.is_some() || self.on.is_some();
        let default = match self.look_at {
            Some(_) => Projection::Gnomonic,
            None if has_horizon => Projection::Nusselt,
            None => Projection::Equirectangular,
        };
        let projection = self.projection.unwrap_or(default);
        if !has_horizon && projection == Projection::Nusselt {
            return usage(format!("--projection: {}", nusselt::contour::ProjectionError::NotAHemisphere));
        }
        check_way(self.way, &self.order)?;
        Ok(projection)
    }

    /// Proves the image if that is asked for, and keeps the evidence.
    fn prove(&self, image: &ContourImage) -> Result<Option<Proof>, Failure> {
        let Some(arithmetic) = self.certify.or(self.certificate.as_ref().map(|_| Arithmetic::Kernel)) else {
            return Ok(None);
        };
        let (evidence, proof) = prove(&self.scene, image, arithmetic)?;
        if let Some(path) = &self.certificate {
            write_file(path, |out| write_certificate(&evidence, image.scene(), out))?;
        }
        Ok(Some(proof))
    }

    fn write(
        &self,
        output: &Output,
        projection: Projection,
        image: &ContourImage,
        summary: &ContourSummary<'_>,
        common: &Common,
    ) -> Result<(), Failure> {
        let path: &Path = &output.path;
        match output.format {
            Format::Json => write_file(path, |out| write_contour_json(image, summary, out)),
            Format::Svg => {
                let projector = projector(image, projection)?;
                let options = SvgOptions { show_tree: self.show_tree, ..SvgOptions::default() };
                write_file(path, |out| write_svg(image, &projector, &options, out))
            }
            Format::Png => {
                let projector = projector(image, projection)?;
                let mut progress = Progress::new("regions painted", None, common.quiet);
                let picture = contour_picture(image, &projector, self.width, |count| progress.add_of(count));
                drop(progress);
                let picture = picture.map_err(|error| Failure::Usage(format!("--width: {error}")))?;
                write_file(path, |out| write_png(&picture, out))
            }
            Format::Geojson => {
                let projector = projector(image, projection)?;
                let mut tangled = 0;
                write_file(path, |out| {
                    tangled = write_geojson(image, &projector, Projector::TOLERANCE, out)?;
                    Ok(())
                })?;
                if tangled > 0 {
                    let what = "their points are rounded, and they have the property `tangled`";
                    let path = path.display();
                    common.warn(&format!("{path}: the rings of {tangled} features may touch or cross: {what}"));
                }
                Ok(())
            }
            Format::Obj => {
                let groups = visible_groups(image);
                write_obj(path, &groups, image.scene())?;
                let cells = image.cells().filter(|cell| cell.polygon().is_some()).count();
                let left_out = cells - groups.iter().map(|group| group.polygons.len()).sum::<usize>();
                if left_out > 0 {
                    let what = "cells too thin to have three different corners were left out";
                    common.warn(&format!("{}: {left_out} {what}", path.display()));
                }
                Ok(())
            }
        }
    }
}

fn projector(image: &ContourImage, projection: Projection) -> Result<Projector, Failure> {
    Projector::of_image(image, projection).map_err(|error| Failure::Usage(error.to_string()))
}
