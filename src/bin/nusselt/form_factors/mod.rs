//! `nusselt form-factors`: the matrix of form factors between patches, and its parts put together.

mod certify;
mod enforce;
mod merge;
mod options;
mod pairs;
mod patches;
mod reciprocity;
mod report;
mod tally;

use crate::args::{Common, Loading, parse_arithmetic};
use crate::failure::Failure;
use crate::input::load;
use crate::output::{Unwritten, print, print_json};
use crate::progress::Progress;
use crate::summary::number;
use nusselt::factors::{Exchange, ExchangeError, ExchangeOptions, PatchPlan, Row, Sides};
use nusselt::io::matrix::{MatrixCsv, MatrixError, MatrixJob, MatrixWriter};
use nusselt::scene::Scene;
use nusselt::verify::Arithmetic;
use pairs::{PairCheck, PairSample};
use report::{Asked, Report, Times};
use std::io::{self, BufWriter, ErrorKind};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;
use tally::Tally;

const EXAMPLE: &str = "\
Examples: the matrix of a room, polygon by polygon, for numpy.load
  nusselt form-factors room.obj -o room.npy

In patches of at most half a metre, as a table, and on again after an interruption
  nusselt form-factors room.obj --patch 0.5 -o room.csv
  nusselt form-factors room.obj --patch 0.5 -o room.csv --resume

The same for numpy.load, and where each patch is
  nusselt form-factors room.obj --patch 0.5 -o room.npy --patches room-patches.csv

On two machines, then put together: the same file
  nusselt form-factors city.obj --rows 0..5000 -o a.rows
  nusselt form-factors city.obj --rows 5000..10000 -o b.rows
  nusselt form-factors merge a.rows b.rows -o city.mtx

(A scene that is called merge is named ./merge.)";

/// Compute the matrix of form factors between patches, from the front of each to the fronts of all
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true, disable_help_subcommand = true)]
pub(crate) struct FormFactors {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    #[arg(required = true)]
    scene: Option<PathBuf>,
    /// What a patch is: a polygon, an object, or a part of a polygon with edges of at most this length, in scene units
    #[arg(long, value_name = "polygon|object|SIZE", default_value = "polygon", value_parser = options::parse_patch,
        allow_hyphen_values = true)]
    patch: PatchPlan,
    /// Compute each factor to this absolute error
    #[arg(long, value_name = "T", default_value = "1e-4", value_parser = options::parse_tolerance,
        allow_hyphen_values = true)]
    tolerance: f64,
    /// Count what arrives at the back of a patch for that patch; rows leave from fronts all the same
    #[arg(long)]
    two_sided: bool,
    /// Compute only the rows A to B-1, to be merged: -o takes .rows then
    #[arg(long, value_name = "A..B", value_parser = options::parse_rows, allow_hyphen_values = true)]
    rows: Option<Range<u32>>,
    /// Write to this file; the ending decides: .json, .csv (row,column,factor,error), .npy, .mtx, .parquet (in builds with
    /// the feature parquet), or .rows (for merge). Rows go to FILE.partial as they come
    /// [default: CSV on standard output; with --json nothing but the summary]
    #[arg(short, long, value_name = "FILE", value_parser = options::parse_output)]
    output: Option<PathBuf>,
    /// Write the patches to this file, in the order of rows and columns: .csv (row,name,polygon,area, center and normal), or .obj with a group
    /// for each; before any row is computed
    #[arg(long, value_name = "FILE", value_parser = options::parse_patches)]
    patches: Option<PathBuf>,
    /// Go on with an interrupted run, whose rows are in FILE.partial; the result is the same, byte by byte
    #[arg(long, requires = "output")]
    resume: bool,
    /// Change factors so that exchange is the same both ways and all rows sum to 1, as little as their estimates allow (least squares); how
    /// much is told. All rows are in memory
    #[arg(long, requires = "output", conflicts_with_all = ["rows", "resume", "two_sided"])]
    enforce_reciprocity: bool,
    /// Before anything is computed, prove the views from the middles of up to 16 patches, for all directions, and say so;
    /// =rational shares no predicate with what made them, and takes about a hundred times as long. Up to 256 factors are computed once more
    /// at the end, from the other patch of each pair
    #[arg(long, value_name = "kernel|rational", num_args = 0..=1, require_equals = true,
        default_missing_value = "kernel", value_parser = parse_arithmetic)]
    certify: Option<Arithmetic>,
    #[command(flatten)]
    loading: Loading,
    #[command(subcommand)]
    command: Option<Subcommand>,
}

#[derive(clap::Subcommand)]
enum Subcommand {
    Merge(merge::Merge),
}

impl FormFactors {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        if let Some(Subcommand::Merge(merge)) = &self.command {
            return merge.run(common);
        }
        let Some(file) = &self.scene else { return Err(Failure::Usage("name a scene".to_owned())) };
        let outputs = self.output.as_deref().map(MatrixWriter::files);
        let outputs = outputs.iter().flatten().chain(&self.patches).map(PathBuf::as_path);
        patches::keep_apart(self.patches.as_deref(), self.output.as_deref())?;
        let (scene, load_s) = load(file, outputs, &self.loading, common)?;
        let start = Instant::now();
        let exchange = self.prepare(file, &scene)?;
        warn_of_contacts(file, &exchange, common)?;
        let mut times = Times::new(load_s, start.elapsed().as_secs_f64());
        let job = self.job(&scene, &exchange);
        let rows = job.manifest().map_err(|error| refused(file, error))?.rows();
        // Before anything is written.
        let proved = self.certify.map(|by| certify::prove_sample(file, &scene, exchange.patches(), rows.clone(), by));
        let mut proved = proved.transpose()?;
        if let Some(path) = &self.patches {
            patches::write(path, exchange.patches())?;
        }
        let mut tally = Tally::new(exchange.patches(), rows.clone(), self.tolerance, self.two_sided);
        tally.sample = (proved.is_some() && !self.two_sided).then(|| PairSample::new(exchange.patches(), rows.clone()));
        let mut work = Work { file, exchange: &exchange, tally: &mut tally, times: &mut times, quiet: common.quiet };
        let mut enforced = None;
        match &self.output {
            Some(path) if self.enforce_reciprocity => enforced = Some(work.enforce(path, &job)?),
            Some(path) => work.write_file(path, &job, self.resume)?,
            None if common.json => work.run(rows.clone(), |_| Ok(())).map_err(|error| error.about("the summary"))?,
            None => {
                let printed = work.print_all(rows);
                tally.warn(common);
                self.check_pairs(&tally, &exchange, common)?;
                return printed;
            }
        }
        tally.warn(common);
        if let Some(proved) = &mut proved {
            proved.pairs = self.check_pairs(&tally, &exchange, common)?;
        }
        let patches = exchange.patches().len();
        let asked = Asked { patch: self.plan_name(), patches, two_sided: self.two_sided, rows };
        let mut report = Report::new(&scene, asked, &tally, &times, proved.as_ref());
        report.enforced = enforced;
        if common.json {
            return print_json(&report);
        }
        if common.quiet { Ok(()) } else { print(&report.in_words(self.output.as_deref())) }
    }

    /// Computes a sample of pairs once more, and warns if it does not agree.
    fn check_pairs(
        &self,
        tally: &Tally<'_>,
        exchange: &Exchange,
        common: &Common,
    ) -> Result<Option<PairCheck>, Failure> {
        let Some(sample) = &tally.sample else { return Ok(None) };
        let check = sample.check(exchange, self.tolerance).map_err(|error| Failure::Work(error.to_string()))?;
        if check.pairs_above_tolerance > 0 {
            let (above, checked, tolerance) = (check.pairs_above_tolerance, check.checked, number(self.tolerance));
            common.warn(&format!(
                "{above} of {checked} pairs, computed once more from their other patch, differ by more than the tolerance \
                 {tolerance}; {}",
                tally::advice(self.tolerance)
            ));
        }
        Ok(Some(check))
    }

    fn prepare(&self, file: &Path, scene: &Scene) -> Result<Exchange, Failure> {
        options::check_fineness(scene, self.patch)
            .map_err(|error| Failure::Usage(format!("--patch: {}: {error}", file.display())))?;
        let sides = if self.two_sided { Sides::Both } else { Sides::Fronts };
        let options = ExchangeOptions { tolerance: self.tolerance, sides, ..ExchangeOptions::default() };
        Exchange::new(scene, self.patch, options).map_err(|error| match error {
            ExchangeError::TooFine { .. } | ExchangeError::TooManyPatches | ExchangeError::BadEdge { .. } => {
                Failure::Usage(format!("--patch: {}: {error}", file.display()))
            }
            ExchangeError::BadTolerance { .. } => Failure::Usage(format!("--tolerance: {error}")),
            _ => Failure::about(file, &error),
        })
    }

    /// What is computed, with all that rows depend on.
    fn job<'a>(&self, scene: &'a Scene, exchange: &'a Exchange) -> MatrixJob<'a> {
        let job = MatrixJob::new(scene, exchange.patches())
            .with_option("--patch", self.plan_name())
            .with_option("--tolerance", self.tolerance)
            .with_option("--two-sided", self.two_sided)
            .with_option("--enforce-reciprocity", self.enforce_reciprocity);
        match &self.rows {
            Some(rows) => job.with_rows(rows.clone()),
            None => job,
        }
    }

    fn plan_name(&self) -> String {
        options::name(self.patch)
    }
}

/// Warns of polygons on each other of which it is not clear whether they shut each other off, or which of them is seen.
fn warn_of_contacts(file: &Path, exchange: &Exchange, common: &Common) -> Result<(), Failure> {
    let pairs = exchange.half_shut().map_err(|error| Failure::about(file, &error))?;
    if let [[a, b], rest @ ..] = &pairs[..] {
        let more = if rest.is_empty() { String::new() } else { format!(" (and {} more pairs)", rest.len()) };
        common.warn(&format!(
            "polygons {a} and {b}{more} lie on each other, face to face, but bodies there overlap or are open: each sees what is before it, and \
             not the other; close the bodies (nusselt info tells of open edges and T-junctions) to have them shut off"
        ));
    }
    if let Some([a, b]) = exchange.overlap() {
        common.warn(&format!(
            "polygons {a} and {b} show the same way and lie on each other within rounding, which tells which of them is seen: rows that see \
             them take long and may not close; cut off one of them where the other one is"
        ));
    }
    Ok(())
}

/// What is wrong with files of the matrix: some of it can only be told when the scene is read, and is the command line's fault all the same.
fn refused(scene: &Path, error: MatrixError) -> Failure {
    match error {
        MatrixError::BadRange { .. } => Failure::Usage(format!("--rows: {}: {error}", scene.display())),
        MatrixError::TooManyPatches { .. } => Failure::Usage(format!("--patch: {}: {error}", scene.display())),
        MatrixError::PartFormat { .. } | MatrixError::UnknownEnding { .. } | MatrixError::NotBuilt { .. } => {
            Failure::Usage(error.to_string())
        }
        MatrixError::WouldOverwrite { .. } | MatrixError::NoParts => Failure::Usage(error.to_string()),
        MatrixError::BadArea { .. } => Failure::about(scene, &error),
        MatrixError::Unfinished { path } => {
            let path = path.display();
            Failure::Work(format!("{path} is there from an unfinished run; go on with --resume, or delete it"))
        }
        MatrixError::Io { path, source } => Unwritten::Io(source).about(path.display()),
        _ => Failure::Work(error.to_string()),
    }
}

/// What is to be done for every row.
struct Work<'a, 'p> {
    file: &'a Path,
    exchange: &'p Exchange,
    tally: &'a mut Tally<'p>,
    times: &'a mut Times,
    quiet: bool,
}

impl Work<'_, '_> {
    fn write_file(&mut self, path: &Path, job: &MatrixJob<'_>, resume: bool) -> Result<(), Failure> {
        let writer = if resume {
            MatrixWriter::resume_with(path, job, |row| self.tally.add_kept(row))
        } else {
            MatrixWriter::create(path, job)
        };
        let file = self.file;
        let mut writer = writer.map_err(|error| refused(file, error))?;
        let rows = writer.next_row()..writer.end_row();
        let partial = MatrixWriter::files(path)[1].display().to_string();
        let keep = |failure: Failure| match failure {
            Failure::Work(message) => Failure::Work(format!("{message}; the rows before are in {partial}")),
            usage @ Failure::Usage(_) => usage,
        };
        self.run(rows, |row| writer.row(row).map_err(|error| Unwritten::Failed(refused(file, error))))
            .map_err(|error| keep(error.about(path.display())))?;
        let start = Instant::now();
        writer.finish().map_err(|error| refused(file, error))?;
        self.times.write_s = start.elapsed().as_secs_f64();
        Ok(())
    }

    /// As CSV. A reader that has gone away (`| head`) is not a failure.
    fn print_all(&mut self, rows: Range<u32>) -> Result<(), Failure> {
        let write_all = || {
            let mut table = MatrixCsv::new(BufWriter::with_capacity(1 << 16, io::stdout()))?;
            self.run(rows, |row| Ok(table.row(row)?))?;
            table.finish()?;
            Ok(())
        };
        match write_all() {
            Err(Unwritten::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            printed => printed.map_err(|error| error.about("to standard output")),
        }
    }

    /// Computes rows in all threads, and hands them on in their order, each as soon as all before it are there.
    fn run(
        &mut self,
        rows: Range<u32>,
        mut write: impl FnMut(&Row) -> Result<(), Unwritten> + Send,
    ) -> Result<(), Unwritten> {
        let Self { file, exchange, tally, times, quiet } = self;
        let mut progress = Progress::new("rows", Some(rows.len()), *quiet);
        let start = Instant::now();
        let ended = exchange.timed_rows(rows.start as usize..rows.end as usize, |row, took| {
            times.add_row(took);
            tally.add(&row);
            write(&row)?;
            progress.add(1);
            Ok::<(), Stopped>(())
        });
        times.rows_s += start.elapsed().as_secs_f64();
        ended.map_err(|stopped| match stopped {
            Stopped::NoRow(error) => Unwritten::Failed(Failure::about(file, &error)),
            Stopped::Unwritten(unwritten) => unwritten,
        })
    }
}

/// Why there are no more rows.
enum Stopped {
    NoRow(ExchangeError),
    Unwritten(Unwritten),
}

impl From<ExchangeError> for Stopped {
    fn from(error: ExchangeError) -> Self {
        Self::NoRow(error)
    }
}

impl From<Unwritten> for Stopped {
    fn from(unwritten: Unwritten) -> Self {
        Self::Unwritten(unwritten)
    }
}
