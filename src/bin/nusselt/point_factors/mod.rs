//! `nusselt point-factors`: form factors from points to everything that they see.

mod report;
mod table;

use crate::args::{Common, Loading, Order, Way};
use crate::failure::Failure;
use crate::input::{build_order, check_way, load, way};
use crate::output::{Unwritten, keep, print, print_json, write_results};
use crate::place::{PointsOf, stand};
use crate::progress::Progress;
use nusselt::contour::SurfaceIndex;
use nusselt::factors::{By, PointFactors, PointSolver};
use nusselt::io::{PointFactorsFormat, PointFactorsWriter, PointLine};
use nusselt::scene::Scene;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use report::{Report, Totals};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

const EXAMPLE: &str = "\
Examples: the form factor of every object, and of the sky, from every point of a file, whose lines are
x y z nx ny nz [polygon]
  nusselt point-factors street.obj --points sensors.csv -o factors.csv

Of every polygon, as JSON
  nusselt point-factors street.obj --points sensors.csv --by polygon -o factors.json

From standard input to standard output
  echo '2 1.5 0.8  0 0 1' | nusselt point-factors room.obj --points -";

/// Compute form factors from points to all objects or polygons, and to the background (sky view factors)
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct PointFactorsOf {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    scene: PathBuf,
    /// The points, one a line: x y z nx ny nz [polygon], separated by commas or blanks; - is standard input, of which
    /// points are answered as soon as their lines have come. Where a
    /// polygon is named, stand on it where it is nearest, on the side that the normal shows. They are read as they
    /// are needed: there may be any number
    #[arg(long, value_name = "P.csv")]
    points: PathBuf,
    /// Write to this file; the ending decides: .csv (point,name,factor), .json, or .parquet (in builds with the feature
    /// parquet) [default: CSV on standard output; with --json nothing but the summary]
    #[arg(short, long, value_name = "FILE", value_parser = Output::parse)]
    output: Option<Output>,
    /// Tell the factor of every object, or of every polygon; both sides of polygons count
    #[arg(long, value_name = "object|polygon", default_value = "object", value_parser = parse_by)]
    by: By,
    /// Take points as they are, even if they lie on a polygon with such a normal
    #[arg(long)]
    free: bool,
    /// How to find what is nearer: whole polygons by a hierarchy of boxes, or the fragments of a 3D BSP; both see the
    /// same [default: boxes, and bsp with an epsilon]
    #[arg(long, value_name = "boxes|bsp", value_enum, hide_possible_values = true)]
    way: Option<Way>,
    #[command(flatten)]
    loading: Loading,
    #[command(flatten)]
    order: Order,
}

/// A file to write.
#[derive(Clone)]
struct Output {
    path: PathBuf,
    format: PointFactorsFormat,
}

impl Output {
    fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let format = table::format(&path)?;
        Ok(Self { path, format })
    }
}

fn parse_by(text: &str) -> Result<By, String> {
    match text {
        "object" => Ok(By::Object),
        "polygon" => Ok(By::Polygon),
        _ => Err("there are object and polygon".to_owned()),
    }
}

impl PointFactorsOf {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        check_way(self.way, &self.order)?;
        let output = self.output.as_ref().map(|output| output.path.as_path());
        let points = PointsOf::new(&self.points);
        keep(&points.files(), output.into_iter())?;
        let (scene, load_s) = load(&self.scene, output.into_iter(), &self.loading, common)?;
        // Hours of work may come before the last line.
        let count = points.check(&scene)?;
        let (order, order_s) = build_order(&self.scene, &scene, &self.order, way(self.way, &self.order))?;
        let work = Work {
            solver: PointSolver::new(order, self.by),
            surfaces: (!self.free).then(|| SurfaceIndex::new(&scene)),
            points,
            count,
            quiet: common.quiet,
        };
        let totals = match &self.output {
            Some(Output { path, format }) => {
                let mut totals = Totals::default();
                write_results(path, |out| {
                    let mut writer = PointFactorsWriter::new(out, *format, &scene, self.by)?;
                    totals = work.run(|points, factors| write(&mut writer, points, factors))?;
                    writer.finish()?;
                    Ok(())
                })?;
                totals
            }
            None if common.json => work.run(|_, _| Ok(())).map_err(|error| error.about("the summary"))?,
            None => {
                return match self.print_all(&work, &scene) {
                    // The reader has gone away (`| head`).
                    Err(Unwritten::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
                    printed => printed.map_err(|error| error.about("to standard output")),
                };
            }
        };
        let report = Report::new(&scene, self.by, &totals, load_s, order_s);
        if common.json {
            return print_json(&report);
        }
        if common.quiet { Ok(()) } else { print(&report.in_words(output)) }
    }
}

impl PointFactorsOf {
    /// Writes CSV to standard output.
    fn print_all(&self, work: &Work<'_>, scene: &Scene) -> Result<(), Unwritten> {
        let out = BufWriter::with_capacity(1 << 16, io::stdout());
        let mut writer = PointFactorsWriter::new(out, PointFactorsFormat::Csv, scene, self.by)?;
        // Who reads the header before asking for a point would wait for it.
        writer.flush()?;
        work.run(|points, factors| {
            write(&mut writer, points, factors)?;
            // Who asked may wait for them.
            writer.flush()
        })?;
        writer.finish()?;
        Ok(())
    }
}

fn write<W: Write + Send>(
    writer: &mut PointFactorsWriter<W>,
    points: &[PointLine],
    factors: &[PointFactors],
) -> io::Result<()> {
    points.iter().zip(factors).try_for_each(|(point, factors)| writer.write(point.point, point.normal, factors))
}

/// So many bytes of factors are in memory at a time.
const MOST_BYTES: usize = 1 << 28;
/// So many points are shared by the threads at a time, if that allows it.
const MOST_POINTS: usize = 512;

/// What is to be done for every point.
struct Work<'a> {
    solver: PointSolver,
    /// Where points may be meant to be on; `None` if they are free.
    surfaces: Option<SurfaceIndex>,
    points: PointsOf<'a>,
    count: Option<usize>,
    quiet: bool,
}

impl Work<'_> {
    /// Reads points, computes their factors in all threads, and hands them on in their order: some at a time, and all before a point that there are none
    /// of.
    fn run(&self, mut write: impl FnMut(&[PointLine], &[PointFactors]) -> io::Result<()>) -> Result<Totals, Unwritten> {
        let mut progress = Progress::new("points", self.count, self.quiet);
        let mut reader = self.points.open()?;
        let most = self.chunk();
        let mut totals = Totals::default();
        let mut chunk = Vec::new();
        while reader.next(most, &mut chunk).map_err(|error| Failure::Work(error.to_string()))? {
            let solved: Vec<_> = chunk.par_iter().map(|point| self.solve(point)).collect();
            let mut all = Vec::with_capacity(chunk.len());
            let failure = solved.into_iter().find_map(|solved| {
                let (factors, ms) = match solved {
                    Ok(solved) => solved,
                    Err(failure) => return Some(failure),
                };
                totals.add(&factors, ms);
                all.push(factors);
                None
            });
            write(&chunk, &all)?;
            if let Some(failure) = failure {
                return Err(failure.into());
            }
            progress.add(chunk.len());
        }
        Ok(totals)
    }

    fn solve(&self, point: &PointLine) -> Result<(PointFactors, f64), Failure> {
        let scene = self.solver.order().scene();
        let start = Instant::now();
        let (viewpoint, domain) =
            stand(scene, self.surfaces.as_ref(), point).map_err(|error| self.points.failed_at(point, &error))?;
        let factors = self.solver.solve(&viewpoint, &domain).map_err(|error| self.points.failed_at(point, &error))?;
        Ok((factors, start.elapsed().as_secs_f64() * 1e3))
    }

    /// How many points are taken at a time.
    fn chunk(&self) -> usize {
        let scene = self.solver.order().scene();
        let most = match self.solver.by() {
            By::Object => scene.objects().len(),
            By::Polygon => scene.polygon_count(),
        };
        (MOST_BYTES / (most.max(1) * size_of::<(u32, f64)>())).clamp(rayon::current_num_threads(), MOST_POINTS)
    }
}

/// True if the file's name has that ending.
fn ends_with(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending))
}
