//! Arguments that several commands take.

use crate::failure::Failure;
use glam::DVec3;
use nusselt::io::{Origin, ReadOptions};
use nusselt::scene::{PolygonId, Repair, RepairSpecError, Side};
use nusselt::verify::Arithmetic;
use std::num::NonZeroUsize;

/// What all commands take.
#[derive(clap::Args)]
pub(crate) struct Common {
    /// Use this many threads; the results are the same for any number [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = parse_threads, allow_hyphen_values = true)]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Print neither warnings nor a summary in words
    #[arg(long, global = true)]
    pub(crate) quiet: bool,
    /// Print the summary as JSON
    #[arg(long, global = true)]
    pub(crate) json: bool,
}

impl Common {
    /// Starts the threads that share the work.
    pub(crate) fn start_threads(&self) -> Result<(), Failure> {
        let count = self.threads.map_or(0, NonZeroUsize::get);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build_global();
        pool.map_err(|error| Failure::Work(format!("cannot start threads: {error}; try fewer with --threads")))
    }

    /// Prints a warning to stderr.
    pub(crate) fn warn(&self, warning: &str) {
        use std::io::Write;
        if !self.quiet {
            // If stderr is closed there is no one left to warn.
            let _ = writeln!(std::io::stderr(), "nusselt: warning: {warning}");
        }
    }
}

/// How scenes are read.
#[derive(clap::Args)]
pub(crate) struct Loading {
    /// What becomes of broken faces, as a list such as non-planar=drop,weld=0.001 of:
    /// non-planar=triangulate|reject|drop, zero-area=keep|reject, self-crossing=reject|drop,
    /// malformed=reject|drop (bad indices, numbers that are not finite), duplicate=keep|reject|drop (the later one),
    /// weld=T (moves vertices onto others nearer than T, in scene units). The first of each is the default. What is
    /// dropped keeps its number; what is changed is said, and listed by nusselt info
    #[arg(long, value_name = "SPEC", default_value_t, value_parser = parse_repair, hide_default_value = true)]
    pub(crate) repair: Repair,
    /// Take this level of detail of city objects, like 2 or 2.2 (CityJSON) [default: the highest of each]
    #[arg(long, value_name = "L", value_parser = parse_lod, allow_hyphen_values = true)]
    lod: Option<String>,
    /// Take coordinates as they are in the reference system of the file, without its translation (local), or as the
    /// integers that the file has (CityJSON)
    #[arg(long, value_name = "file|local|integers", default_value = "file", value_parser = parse_origin)]
    origin: Origin,
}

impl Loading {
    pub(crate) fn options(&self) -> ReadOptions {
        ReadOptions { repair: self.repair, lod: self.lod.clone(), origin: self.origin }
    }
}

fn parse_origin(text: &str) -> Result<Origin, String> {
    match text {
        "file" => Ok(Origin::File),
        "local" => Ok(Origin::Local),
        "integers" => Ok(Origin::Integers),
        _ => Err("there are file, local and integers".to_owned()),
    }
}

fn parse_repair(text: &str) -> Result<Repair, String> {
    text.parse().map_err(|error: RepairSpecError| error.to_string())
}

/// How the 3D BSP is built.
#[derive(clap::Args)]
pub(crate) struct Order {
    /// Leave polygons uncut that poke less than this through a splitting plane of the 3D BSP, in scene units; 0 is exact
    #[arg(long, value_name = "E", default_value = "0", value_parser = parse_epsilon, allow_hyphen_values = true)]
    pub(crate) epsilon: f64,
}

/// The two ways to a contour image.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Way {
    /// Whole polygons, by a hierarchy of boxes
    Boxes,
    /// Fragments, by a 3D BSP
    Bsp,
}

fn parse_threads(text: &str) -> Result<NonZeroUsize, String> {
    let count = text.parse().ok().filter(|&count: &NonZeroUsize| count.get() <= 1024);
    count.ok_or_else(|| "it takes a whole number from 1 to 1024".to_owned())
}

/// A finite number.
pub(crate) fn parse_number(text: &str) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| format!("{:?} is not a number", text.trim()))?;
    if number.is_finite() { Ok(number) } else { Err(format!("{} is not finite", text.trim())) }
}

/// It stays as it is written, for messages.
fn parse_lod(text: &str) -> Result<String, String> {
    parse_number(text).map(|_| text.to_owned())
}

fn parse_epsilon(text: &str) -> Result<f64, String> {
    let epsilon = parse_number(text)?;
    if epsilon < 0.0 { Err("it takes a distance of at least 0".to_owned()) } else { Ok(epsilon) }
}

/// A field of view in degrees.
pub(crate) fn parse_fov(text: &str) -> Result<f64, String> {
    let degrees = parse_number(text)?;
    if degrees > 0.0 && degrees < 180.0 { Ok(degrees) } else { Err("it is above 0 and below 180 degrees".to_owned()) }
}

/// Width over height: a number, or a fraction `W/H`.
pub(crate) fn parse_aspect(text: &str) -> Result<f64, String> {
    let (width, height) = match text.split_once('/') {
        Some((width, height)) => (parse_number(width)?, parse_number(height)?),
        None => (parse_number(text)?, 1.0),
    };
    let aspect = width / height;
    if width > 0.0 && height > 0.0 && aspect > 0.0 && aspect.is_finite() {
        Ok(aspect)
    } else {
        Err("it is a width over a height, both above 0".to_owned())
    }
}

/// A point `X,Y,Z`.
pub(crate) fn parse_point(text: &str) -> Result<DVec3, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else {
        return Err(format!("it takes three numbers X,Y,Z without blanks between them, not {}", parts.len()));
    };
    Ok(DVec3::new(parse_number(x)?, parse_number(y)?, parse_number(z)?))
}

/// A vector `X,Y,Z` that is not zero.
pub(crate) fn parse_direction(text: &str) -> Result<DVec3, String> {
    let vector = parse_point(text)?;
    if vector == DVec3::ZERO { Err("the zero vector has no direction".to_owned()) } else { Ok(vector) }
}

/// A side of a polygon: `K` or `K:back`.
pub(crate) fn parse_surface(text: &str) -> Result<(PolygonId, Side), String> {
    let (number, side) = match text.split_once(':') {
        None => (text, Side::Front),
        Some((number, "front")) => (number, Side::Front),
        Some((number, "back")) => (number, Side::Back),
        Some((_, other)) => return Err(format!("the side is front or back, not {other:?}")),
    };
    let number = number.parse().map_err(|_| format!("{number:?} is not the number of a polygon, counted from 0"))?;
    Ok((PolygonId(number), side))
}

/// The arithmetic of a proof.
pub(crate) fn parse_arithmetic(text: &str) -> Result<Arithmetic, String> {
    match text {
        "kernel" => Ok(Arithmetic::Kernel),
        "rational" => Ok(Arithmetic::Rational),
        _ => Err("there are kernel and rational".to_owned()),
    }
}
