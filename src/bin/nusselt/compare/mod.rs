//! `nusselt compare`: the contour image beside the methods that approximate it.

mod report;

use crate::args::{Common, Loading, Order, parse_direction, parse_point};
use crate::failure::Failure;
use crate::input::{build, load};
use crate::output::{print, print_json};
use crate::place::{PointsOf, stand};
use crate::progress::Progress;
use glam::DVec3;
use nusselt::contour::SurfaceIndex;
use nusselt::hemicube::{CompareError, Hemicube, Method, compare};
use nusselt::io::PointLine;
use std::fmt::Display;
use std::num::NonZeroUsize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Examples: all methods from every point of a file, whose lines are x y z nx ny nz [polygon]
  nusselt compare room.obj --points sensors.csv

From one point, upwards, against hemicubes of 256 and 512 only, as JSON
  nusselt compare room.obj --eye 2,1.5,0.8 --normal 0,0,1 --resolutions 256,512 --rays none --json";

/// Compare the contour image with the hemicube, analytic form factors on a z-buffer, and rays: time, error, evaluations
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
#[command(group(clap::ArgGroup::new("place").required(true).args(["points", "eye"])))]
pub(crate) struct Compare {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    scene: PathBuf,
    /// Look from the points of this file, one a line: x y z nx ny nz [polygon], separated by commas or blanks; - is
    /// standard input. Where a polygon is named, stand on it where it is nearest, on the side that the normal shows
    #[arg(long, value_name = "P.csv", conflicts_with = "normal")]
    points: Option<PathBuf>,
    /// Look from this point
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true, requires = "normal")]
    eye: Option<DVec3>,
    /// See the hemisphere about this normal, of any length
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true, requires = "eye")]
    normal: Option<DVec3>,
    /// Take points as they are, even if they lie on a polygon with such a normal
    #[arg(long)]
    free: bool,
    /// Resolutions of the hemicube and of the z-buffer: even numbers, or none
    #[arg(long, value_name = "N,N,...", default_value = "64,128,256,512,1024", value_parser = parse_resolutions)]
    resolutions: List<usize>,
    /// Numbers of rays, or none
    #[arg(long, value_name = "N,N,...", default_value = "10000,100000", value_parser = parse_rays)]
    rays: List<u32>,
    /// Take every view so many times with every method; its shortest time counts, 1 to 1000
    #[arg(long, value_name = "N", default_value = "3", value_parser = parse_rounds)]
    rounds: NonZeroUsize,
    #[command(flatten)]
    loading: Loading,
    #[command(flatten)]
    order: Order,
}

/// Numbers with commas between them. A type of its own, as several values are another thing to the parser of arguments.
#[derive(Clone)]
struct List<T>(Vec<T>);

fn parse_resolutions(text: &str) -> Result<List<usize>, String> {
    let most = Hemicube::MAX_RESOLUTION;
    parse_list(text, |&n: &usize| n > 0 && n.is_multiple_of(2) && n <= most)
        .ok_or_else(|| format!("it takes even numbers from 2 to {most} with commas between them, or none"))
}

fn parse_rays(text: &str) -> Result<List<u32>, String> {
    parse_list(text, |&n: &u32| (1..=1_000_000_000).contains(&n))
        .ok_or_else(|| "it takes numbers from 1 to 1000000000 with commas between them, or none".to_owned())
}

fn parse_list<T: std::str::FromStr>(text: &str, is_good: impl Fn(&T) -> bool) -> Option<List<T>> {
    if text == "none" {
        return Some(List(Vec::new()));
    }
    text.split(',').map(|word| word.parse().ok().filter(&is_good)).collect::<Option<_>>().map(List)
}

fn parse_rounds(text: &str) -> Result<NonZeroUsize, String> {
    let count = text.parse().ok().filter(|&count: &NonZeroUsize| count.get() <= 1000);
    count.ok_or_else(|| "it takes a whole number from 1 to 1000".to_owned())
}

impl Compare {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let points = self.points()?;
        let (scene, load_s) = load(&self.scene, std::iter::empty(), &self.loading, common)?;
        let surfaces = (!self.free).then(|| SurfaceIndex::new(&scene));
        let views = points.iter().map(|point| {
            let view = stand(&scene, surfaces.as_ref(), point);
            view.map_err(|error| self.failed_at(point, &error))
        });
        let views = views.collect::<Result<Vec<_>, _>>()?;
        let (bsp, bsp_s) = build(&self.scene, &scene, &self.order)?;
        let methods = self.methods();
        let mut progress = Progress::new("views", Some(views.len() * methods.len() * self.rounds.get()), common.quiet);
        let rows = compare(&bsp, &views, &methods, self.rounds, |count| progress.add(count));
        drop(progress);
        let rows = rows.map_err(|error| match &error {
            CompareError::Contour { view, source } => self.failed_at(&points[*view], source),
            CompareError::Baseline { view, source } => self.failed_at(&points[*view], source),
            error => Failure::Work(error.to_string()),
        })?;
        let report = report::Report::new(&bsp, &views, self.rounds.get(), [load_s, bsp_s], &rows);
        if common.json {
            return print_json(&report);
        }
        if common.quiet { Ok(()) } else { print(&report.in_words()) }
    }

    fn methods(&self) -> Vec<Method> {
        let mut methods = vec![Method::Contour, Method::ContourByBoxes];
        for &resolution in &self.resolutions.0 {
            methods.extend([Method::Hemicube { resolution }, Method::Analytic { resolution }]);
        }
        methods.extend(self.rays.0.iter().map(|&rays| Method::Rays { rays }));
        methods
    }

    /// Where to look from.
    fn points(&self) -> Result<Vec<PointLine>, Failure> {
        match (&self.points, self.eye, self.normal) {
            (Some(path), ..) => read(PointsOf::new(path)),
            (None, Some(point), Some(normal)) => Ok(vec![PointLine { line: 1, point, normal, polygon: None }]),
            _ => Err(Failure::Usage("give --points, or --eye and --normal".to_owned())),
        }
    }

    /// Names the line of a point, or the scene for `--eye`.
    fn failed_at(&self, point: &PointLine, error: &impl Display) -> Failure {
        match &self.points {
            Some(path) => PointsOf::new(path).failed_at(point, error),
            None => Failure::about(&self.scene, error),
        }
    }
}

/// So many points are taken: all of them are looked from before anything is said.
const MOST_POINTS: usize = 10_000_000;

fn read(points: PointsOf<'_>) -> Result<Vec<PointLine>, Failure> {
    let mut reader = points.open()?;
    let (mut all, mut some) = (Vec::new(), Vec::new());
    while reader.next(usize::MAX, &mut some).map_err(|error| Failure::Work(error.to_string()))? {
        all.append(&mut some);
        if all.len() > MOST_POINTS {
            return Err(Failure::Work(format!("{}: more than {MOST_POINTS} points; split it", points.name())));
        }
    }
    Ok(all)
}
