//! `nusselt render`: pictures by ray tracing with contour shading.

mod indirect;
mod outputs;
mod path;

use crate::args::{Common, Loading, parse_direction, parse_fov, parse_point};
use crate::brdf::{BrdfSpec, GRAMMAR};
use crate::failure::Failure;
use crate::input::{build_order, load_materials};
use crate::lighting::Lights;
use crate::materials::{Materials, Numbered};
use crate::output::{Unwritten, print, print_json, write_results};
use crate::progress::SharedProgress;
use crate::radiosity::parse_size;
use crate::summary::{Lines, Timing, number};
use glam::{DVec3, UVec2};
use indirect::{Interreflection, Solved};
use nusselt::brdf::{Brdf, Light, ReflectError};
use nusselt::contour::SceneOrder;
use nusselt::io::write_png_rows;
use nusselt::render::{Band, RenderError, Rendered, Shader, ShaderOptions, Shading, render, render_bands};
use nusselt::scene::{Material, Scene};
use outputs::Output;
use path::Camera;
use serde_json::json;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

const EXAMPLES: &str = "\
Examples: a room with the light that its surfaces send to each other
  nusselt render room.obj --eye 0.4,0.4,1.6 --look-at 4,2,0.8 --fov 70 --size 640x480 -o room.png

Light straight from its lamps alone, by contour images, and by hemicubes of 64 pixels across
  nusselt render room.obj --eye 0.4,0.4,1.6 --look-at 4,2,0.8 --fov 70 --size 640x480 --direct -o contour.png
  nusselt render room.obj --eye 0.4,0.4,1.6 --look-at 4,2,0.8 --fov 70 --size 640x480 --direct --shading hemicube:64 -o hemicube.png

A mirror instead of the material called floor, and a sequence of pictures, walk_0001.png and on
  nusselt render room.obj --frames path.csv --size 320x240 --brdf floor=lambert:0.2+mirror:0.5 -o walk.png";

/// Render what a camera sees, with exact visibility in every pixel and exact soft shadows
#[derive(clap::Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{GRAMMAR}"))]
#[command(group(clap::ArgGroup::new("camera").required(true).args(["eye", "frames"])))]
pub(crate) struct Render {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON. Fronts emit what their materials say (Ke, emissiveFactor)
    scene: PathBuf,
    /// Where the camera stands
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true, requires = "look_at", requires = "fov")]
    eye: Option<DVec3>,
    /// The point that it looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true, conflicts_with = "frames")]
    look_at: Option<DVec3>,
    /// Its vertical field of view in degrees, above 0 and below 180
    #[arg(long, value_name = "DEG", value_parser = parse_fov, allow_hyphen_values = true, conflicts_with = "frames")]
    fov: Option<f64>,
    /// What is up in the picture [default: 0,0,1, or 0,1,0 when looking along it]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// A picture for each line of this file: the eye, the point looked at and the field of view, seven numbers separated
    /// by commas or blanks. -o x.png writes `x_0001.png` and on, all with one exposure
    #[arg(long, value_name = "PATH.csv")]
    frames: Option<PathBuf>,
    /// The picture's width and height in pixels; of more than 33554432 pixels, which are not kept in memory, with --exposure
    /// and one -o x.png
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = parse_pixels)]
    size: UVec2,
    /// Write to this file; the ending decides: .png (sRGB, after the exposure) or .exr (radiances; needs the feature
    /// exr). May be repeated
    #[arg(short, long, value_name = "FILE", required = true, value_parser = Output::parse)]
    output: Vec<Output>,
    /// How it is found what a point sees: contour (exactly), hemicube:N (by a hemicube of N pixels across), or rays:N (by N
    /// random rays)
    #[arg(long, value_name = "SHADING", default_value = "contour", value_parser = parse_shading)]
    shading: Shading,
    #[command(flatten)]
    interreflection: Interreflection,
    /// Give the material of this name another BRDF: see below. May be repeated
    #[arg(long, value_name = "NAME=SPEC", value_parser = parse_brdf)]
    brdf: Vec<(String, BrdfSpec)>,
    #[command(flatten)]
    lights: Lights,
    /// Polygons emit from their backs too; with --direct
    #[arg(long, requires = "direct")]
    two_sided: bool,
    /// Follow what is seen in mirrors so many times from one to another
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(0..=64))]
    mirrors: u32,
    /// Show radiances times this in .png [default: so that 95% of what reflects, in the first picture, is at most 0.8]
    #[arg(long, value_name = "FACTOR", value_parser = parse_size, allow_hyphen_values = true)]
    exposure: Option<f64>,
    #[command(flatten)]
    loading: Loading,
}

/// `WxH`.
fn parse_pixels(text: &str) -> Result<UVec2, String> {
    let sides = text.split_once(['x', 'X']).map(|(width, height)| [width, height].map(|side| side.parse().ok()));
    let Some([Some(width), Some(height)]) = sides else {
        return Err("it takes a width and a height in pixels, WxH".to_owned());
    };
    if (1..=MOST_SIDE).contains(&width) && (1..=MOST_SIDE).contains(&height) {
        Ok(UVec2::new(width, height))
    } else {
        Err(format!("each side has from 1 to {MOST_SIDE} pixels"))
    }
}

/// A picture of more pixels than this is written as it is made.
const MOST_KEPT: u64 = 1 << 25;

/// Why a picture was not written to the end.
enum Unmade {
    Io(io::Error),
    Render(RenderError),
}

impl From<io::Error> for Unmade {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<RenderError> for Unmade {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}

/// 2^28 pixels are the most of a picture.
const MOST_SIDE: u32 = 16_384;

fn parse_shading(text: &str) -> Result<Shading, String> {
    let known = "there are contour, hemicube:N (N even, 2 to 4096) and rays:N (N from 1 to 1000000)";
    match text.split_once(':') {
        None if text == "contour" => Ok(Shading::Contour),
        Some(("hemicube", number)) => match number.parse() {
            Ok(resolution) if (2..=4096).contains(&resolution) && resolution % 2 == 0 => {
                Ok(Shading::Hemicube { resolution })
            }
            _ => Err(known.to_owned()),
        },
        Some(("rays", number)) => match number.parse() {
            Ok(rays) if (1..=1_000_000).contains(&rays) => Ok(Shading::Rays { rays }),
            _ => Err(known.to_owned()),
        },
        _ => Err(known.to_owned()),
    }
}

/// `NAME=SPEC`.
fn parse_brdf(text: &str) -> Result<(String, BrdfSpec), String> {
    let (name, spec) = text.split_once('=').ok_or("it takes the form NAME=SPEC")?;
    Ok((name.to_owned(), BrdfSpec::parse(spec)?))
}

impl Render {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        self.check_memory()?;
        let lighting = self.lights.lighting(self.two_sided)?;
        let cameras = self.cameras()?;
        let files = outputs::files(&self.output, self.frames.as_deref(), cameras.len())?;
        let (scene, materials, load_s) =
            load_materials(&self.scene, files.iter().map(PathBuf::as_path), &self.loading, common)?;
        let is_dark =
            !scene.materials().iter().any(Material::is_emitter) && lighting.sky.is_none() && lighting.lights.is_empty();
        if is_dark {
            let advice = "give it --sky, --point-light or --directional-light";
            common.warn(&format!("{}: nothing emits light, so the picture is black; {advice}", self.scene.display()));
        }
        let brdfs = self.brdfs(&scene, &materials, common)?;
        let (order, order_s) = self.order(&scene)?;
        let options = ShaderOptions { shading: self.shading, mirrors: self.mirrors, ..ShaderOptions::default() };
        let shader = Shader::with_brdfs(order, brdfs, lighting, options).map_err(|error| self.refused(&error))?;
        let (shader, solved) = self.interreflection.add_to(shader, self.shading, &cameras, &self.scene, common)?;
        let mut exposure = self.exposure;
        let (mut frame_ms, mut points) = (Vec::new(), 0);
        let pixels = (self.size.x as usize * self.size.y as usize).saturating_mul(cameras.len());
        let progress = SharedProgress::new("pixels", Some(pixels), common.quiet);
        for (k, camera) in cameras.iter().enumerate() {
            let start = Instant::now();
            if let Some(exposure) = exposure.filter(|_| self.is_large()) {
                points += self.render_into(&files[k], exposure, &shader, camera, &progress)?;
                frame_ms.push(start.elapsed().as_secs_f64() * 1e3);
                continue;
            }
            let rendered = self.render(&shader, camera, &progress)?;
            frame_ms.push(start.elapsed().as_secs_f64() * 1e3);
            points += rendered.points;
            let exposure = *exposure.get_or_insert_with(|| rendered.auto_exposure());
            for (j, output) in self.output.iter().enumerate() {
                output.write(&files[j * cameras.len() + k], &rendered, exposure)?;
            }
        }
        drop(progress);
        let timing = Timing::new(load_s, order_s, &frame_ms);
        self.tell(common, &files, &frame_ms, points, exposure.unwrap_or(1.0), &solved, timing)
    }

    /// True if pictures are not kept, but written as they are made.
    fn is_large(&self) -> bool {
        u64::from(self.size.x) * u64::from(self.size.y) > MOST_KEPT
    }

    /// Refuses pictures that would have to be kept and are too large for that.
    fn check_memory(&self) -> Result<(), Failure> {
        let is_streamed = self.exposure.is_some() && self.output.len() == 1 && self.output.iter().all(Output::is_png);
        if !self.is_large() || is_streamed {
            return Ok(());
        }
        let gigabytes = f64::from(self.size.x) * f64::from(self.size.y) * 40.0 / 1e9;
        Err(Failure::Usage(format!(
            "--size: so large a picture would take {gigabytes:.1} GB to keep; of more than {MOST_KEPT} pixels it is written as it is made, which takes an --exposure (that of a smaller one will do) and one -o x.png"
        )))
    }

    fn cameras(&self) -> Result<Vec<Camera>, Failure> {
        match (&self.frames, self.eye, self.look_at, self.fov) {
            (Some(path), ..) => Camera::read(path, self.up, self.size),
            (None, Some(eye), Some(look_at), Some(fov)) => {
                Ok(vec![Camera::new(eye, look_at, fov, self.up, self.size)?])
            }
            _ => Err(Failure::Usage("give --eye, --look-at and --fov, or --frames".to_owned())),
        }
    }

    fn order(&self, scene: &Scene) -> Result<(SceneOrder, f64), Failure> {
        build_order(&self.scene, scene, &crate::args::Order { epsilon: 0.0 }, crate::args::Way::Boxes)
    }

    /// The BRDF of each material.
    fn brdfs(&self, scene: &Scene, places: &Materials, common: &Common) -> Result<Vec<Box<dyn Brdf>>, Failure> {
        let materials = scene.materials();
        for (name, _) in &self.brdf {
            if !materials.iter().any(|material| material.name == *name) {
                let names: Vec<&str> = materials.iter().map(|material| material.name.as_str()).collect();
                let known = crate::summary::named(&names, |name| (*name).to_owned());
                return Err(Failure::Usage(format!("--brdf: there is no material {name:?}; there are {known}")));
            }
        }
        let given = |material: &Material| {
            let named = self.brdf.iter().rev().find(|(name, _)| *name == material.name);
            named.map(|(_, spec)| spec)
        };
        // Interreflection goes by what materials say, whatever they are given.
        let matters =
            |material: &Material| !self.interreflection.direct || given(material).is_none_or(BrdfSpec::has_material);
        places.check(scene, common, matters)?;
        let brdf = |(number, material): (usize, &Material)| {
            let numbered = Numbered { materials: places, scene, number };
            given(material).map_or_else(|| numbered.brdf(), |spec| spec.brdf(Some(numbered)))
        };
        materials.iter().enumerate().map(brdf).collect()
    }

    fn render(&self, shader: &Shader, camera: &Camera, progress: &SharedProgress) -> Result<Rendered, Failure> {
        render(shader, camera.eye, &camera.frustum, self.size, &|count| progress.add(count))
            .map_err(|error| camera.place(self.refused(&error)))
    }

    /// Writes a picture as it is made; gives how many points were shaded.
    fn render_into(
        &self,
        file: &Path,
        exposure: f64,
        shader: &Shader,
        camera: &Camera,
        progress: &SharedProgress,
    ) -> Result<usize, Failure> {
        let mut points = 0;
        write_results(file, |out| {
            write_png_rows(self.size, out, |rows| {
                let done = |count| progress.add(count);
                let take = |band: Band| Ok(rows.write(&band.displayed(exposure))?);
                let result = render_bands(shader, camera.eye, &camera.frustum, self.size, &done, take);
                points = result.map_err(|error| match error {
                    Unmade::Io(error) => Unwritten::Io(error),
                    Unmade::Render(error) => camera.place(self.refused(&error)).into(),
                })?;
                Ok(())
            })
        })?;
        Ok(points)
    }

    fn refused(&self, error: &RenderError) -> Failure {
        match error {
            RenderError::Light(ReflectError::BadLight(light)) => {
                let option = if matches!(light, Light::Point { .. }) { "--point-light" } else { "--directional-light" };
                Failure::Usage(format!("{option}: {error}"))
            }
            _ => Failure::about(&self.scene, error),
        }
    }

    #[expect(clippy::too_many_arguments, reason = "all that there is to tell")]
    fn tell(
        &self,
        common: &Common,
        files: &[PathBuf],
        frame_ms: &[f64],
        points: usize,
        exposure: f64,
        solved: &Solved,
        timing: Timing,
    ) -> Result<(), Failure> {
        let render_s = frame_ms.iter().fold(0.0, |sum, ms| sum + ms) / 1e3;
        if common.json {
            return print_json(&json!({
                "schema": "nusselt.render/1", "size": self.size.to_array(), "frames": frame_ms.len(), "points": points,
                "exposure": exposure, "patches": solved.patches, "shots": solved.shots, "bounces": solved.bounces, "corners": solved.corners,
                "solve_s": solved.solve_s, "surface_s": solved.surface_s, "render_s": render_s, "timing": timing,
                "files": files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
            }));
        }
        if common.quiet {
            return Ok(());
        }
        let mut lines = Lines::default();
        let of = if frame_ms.len() == 1 { String::new() } else { format!(" in each of {} pictures", frame_ms.len()) };
        lines.add("pixels", format!("{} x {}{of}", self.size.x, self.size.y));
        lines.add("shaded", format!("{points} points"));
        if solved.patches > 0 {
            let Solved { patches, shots, bounces, corners, solve_s, surface_s } = solved;
            let did = if *bounces > 0 {
                format!("lit each other by {bounces} bounces")
            } else {
                format!("shot {shots} times")
            };
            lines.add("patches", format!("{patches}, which {did} in {solve_s:.2} s"));
            if *corners > 0 {
                lines.add("corners", format!("{corners} with a view each, in {surface_s:.2} s"));
            }
        }
        lines.add("exposure", number(exposure));
        lines.add("time", format!("{render_s:.2} s"));
        let shown: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
        lines.add("wrote", crate::summary::named(&shown, |file| file.display().to_string()));
        print(&lines.0)
    }
}
