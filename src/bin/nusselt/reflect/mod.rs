//! `nusselt reflect`: the radiance that a surface reflects towards a viewer.

mod report;

use crate::args::{Common, Loading, Order, Way, parse_direction, parse_number, parse_point, parse_surface};
use crate::brdf::{BrdfSpec, GRAMMAR};
use crate::failure::Failure;
use crate::input::{build_order, check_way, load_materials, way};
use crate::lighting::Lights;
use crate::materials::Numbered;
use crate::output::{print, print_json, write_file};
use crate::place::{hemisphere, on_polygon};
use crate::summary::Timing;
use glam::DVec3;
use nusselt::brdf::{Brdf, Light, ReflectError};
use nusselt::contour::{ContourImage, Domain};
use nusselt::integral::CubatureOptions;
use nusselt::io::{BrdfPicture, write_brdf_svg};
use nusselt::scene::{PolygonId, Side};
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLES: &str = "\
Examples: a glossy spot on the floor of a room, lit by its lamps
  nusselt reflect room.obj --eye 2,1.5,0 --normal 0,0,1 --view 1,0,1 --brdf lambert:0.3+phong:50:0.4

As the scene has it, outdoors, below a clear sky with the sun behind the viewer, as JSON
  nusselt reflect yard.glb --eye 3,1,0 --on 17 --view 0,-1,1 --brdf material --sky clear:40,50,70:0,-1,1 \\
    --directional-light 0,-1,1:900 --json

The contour image mapped on the projected BRDF (fig. 7 of the report), and the BRDF as a lobe (its fig. 1)
  nusselt reflect room.obj --eye 2,1.5,0 --normal 0,0,1 --view 1,0,1 --brdf ggx:0.3 -o plane.svg
  nusselt reflect room.obj --eye 2,1.5,0 --normal 0,0,1 --view 1,0,1 --brdf ggx:0.3 -o lobe.svg --picture lobe";

/// Compute the radiance that a surface reflects towards a viewer, from all that it sees, with an error bound
#[derive(clap::Args)]
#[command(after_help = format!("{GRAMMAR}\n\n{EXAMPLES}"))]
#[command(group(clap::ArgGroup::new("stand").required(true).args(["normal", "on"])))]
pub(crate) struct Reflect {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON. Polygons emit what their materials say (Ke, emissiveFactor)
    scene: PathBuf,
    /// Where the surface is
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    eye: DVec3,
    /// Its normal, of any length; a point that lies on a polygon with such a normal is taken to be on it
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    normal: Option<DVec3>,
    /// Stand on polygon K, where it is nearest to --eye, on its front or back
    #[arg(long, value_name = "K[:back]", value_parser = parse_surface, allow_hyphen_values = true)]
    on: Option<(PolygonId, Side)>,
    /// Take --eye as it is, even if it lies on a polygon
    #[arg(long, conflicts_with = "on")]
    free: bool,
    /// From the surface towards the viewer, above the surface, of any length
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    view: DVec3,
    /// How it reflects: see below
    #[arg(long, value_name = "SPEC", value_parser = BrdfSpec::parse, allow_hyphen_values = true)]
    brdf: BrdfSpec,
    /// The surface's x direction, for models that are not the same all around [default: any, but always the same]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    tangent: Option<DVec3>,
    #[command(flatten)]
    lights: Lights,
    /// Polygons emit from their backs too
    #[arg(long)]
    two_sided: bool,
    /// The error allowed, as a part of the largest colour of the value; 1e-12 is always allowed. What has a closed form is
    /// as exact as that goes
    #[arg(long, value_name = "T", default_value = "1e-4", value_parser = parse_tolerance, allow_hyphen_values = true)]
    tolerance: f64,
    /// Draw the BRDF to this .svg file
    #[arg(short, long, value_name = "FILE.svg", value_parser = parse_svg)]
    output: Option<PathBuf>,
    /// What to draw: plane, BRDF x cosine x ratio of solid angles on the image plane, with the contour image over it; polar, the
    /// BRDF in the plane of normal and viewer; lobe, the same in space [default: plane]
    #[arg(long, value_name = "plane|polar|lobe", value_parser = parse_picture, requires = "output")]
    picture: Option<BrdfPicture>,
    /// How to find what is nearer: whole polygons by a hierarchy of boxes, or the fragments of a 3D BSP [default: boxes, and bsp with an epsilon]
    #[arg(long, value_name = "boxes|bsp", value_enum, hide_possible_values = true)]
    way: Option<Way>,
    #[command(flatten)]
    loading: Loading,
    #[command(flatten)]
    order: Order,
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    let tolerance = parse_number(text)?;
    if (1e-12..=1.0).contains(&tolerance) { Ok(tolerance) } else { Err("it is from 1e-12 to 1".to_owned()) }
}

fn parse_svg(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_svg = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if is_svg { Ok(path) } else { Err("pictures are written as .svg".to_owned()) }
}

fn parse_picture(text: &str) -> Result<BrdfPicture, String> {
    let named = BrdfPicture::ALL.into_iter().find(|picture| picture.name() == text);
    named.ok_or_else(|| format!("there are {}", BrdfPicture::ALL.map(BrdfPicture::name).join(", ")))
}

impl Reflect {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        check_way(self.way, &self.order)?;
        let lighting = self.lights.lighting(self.two_sided)?;
        let outputs = self.output.iter().map(PathBuf::as_path);
        let (scene, materials, load_s) = load_materials(&self.scene, outputs, &self.loading, common)?;
        let (viewpoint, domain) = match (self.on, self.normal) {
            (Some((polygon, side)), _) => (on_polygon(&self.scene, &scene, polygon, side, self.eye)?, Domain::Above),
            (None, normal) => hemisphere(&scene, self.eye, normal.unwrap_or_default(), self.free)
                .map_err(|error| Failure::about(&self.scene, &error))?,
        };
        let number = viewpoint.surface().map(|(polygon, _)| scene.polygon(polygon).material_id().index());
        let own = number.filter(|_| self.brdf.has_material()).map(|number| &scene.materials()[number]);
        materials.check(&scene, common, |material| own.is_some_and(|own| std::ptr::eq(own, material)))?;
        let brdf = self.brdf.brdf(number.map(|number| Numbered { materials: &materials, scene: &scene, number }))?;
        let (order, order_s) = build_order(&self.scene, &scene, &self.order, way(self.way, &self.order))?;
        let start = Instant::now();
        let image = order.view(&viewpoint, &domain).map_err(|error| Failure::about(&self.scene, &error))?;
        let timing = Timing::new(load_s, order_s, &[start.elapsed().as_secs_f64() * 1e3]);
        let start = Instant::now();
        let options = CubatureOptions { relative: self.tolerance, absolute: 1e-12, ..CubatureOptions::default() };
        let radiance = lighting.reflected(&image, &*brdf, self.tangent, self.view, options).map_err(refused)?;
        let reflect_ms = start.elapsed().as_secs_f64() * 1e3;
        let allowed = 1e-12_f64.max(self.tolerance * radiance.value.max_element());
        // A light exactly behind an edge, or a mirror that shows one, has no better answer.
        if radiance.error.max_element() > 1.01 * allowed {
            common.warn("the error is larger than --tolerance allows; it is printed with the radiance");
        }
        self.draw(&image, &*brdf)?;
        let albedo = nusselt::brdf::albedo_towards(&image, &*brdf, self.tangent, self.view).map_err(refused)?;
        let report = report::Report::new(&image, radiance, albedo, self.view, timing, reflect_ms);
        if common.json {
            return print_json(&report);
        }
        if common.quiet { Ok(()) } else { print(&report.in_words(&image, self.output.as_deref())) }
    }

    fn draw(&self, image: &ContourImage, brdf: &dyn Brdf) -> Result<(), Failure> {
        let Some(path) = &self.output else { return Ok(()) };
        let picture = self.picture.unwrap_or_default();
        write_file(path, |out| write_brdf_svg(image, brdf, self.tangent, self.view, picture, out))
    }
}

/// The image has a normal and emissions are checked with the scene: what is left is said on the command line.
fn refused(error: ReflectError) -> Failure {
    match error {
        ReflectError::BadView(_) => Failure::Usage(format!("--view: {error}")),
        ReflectError::BadTangent(_) => Failure::Usage(format!("--tangent: {error}")),
        ReflectError::BadLight(Light::Point { .. }) => Failure::Usage(format!("--point-light: {error}")),
        ReflectError::BadLight(_) => Failure::Usage(format!("--directional-light: {error}")),
        _ => Failure::Work(error.to_string()),
    }
}
