//! The comparison as JSON and in words.

use crate::summary::{Lines, Timing, number};
use nusselt::bsp::SceneBsp;
use nusselt::contour::{Domain, Viewpoint};
use nusselt::hemicube::{ComparisonRow, Deviations, Method, reference_method};
use serde::Serialize;
use std::fmt::Write;

/// The schema of what `--json` prints.
const SCHEMA: &str = "nusselt.compare/1";

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    polygons: usize,
    views: usize,
    /// The polygon that each view stands on, if it does.
    on: Vec<Option<u32>>,
    rounds: usize,
    /// The method that the errors of all are against.
    reference: &'static str,
    /// Of the 3D BSP, in scene units.
    epsilon: f64,
    /// Of the contour image. All views are taken by one thread.
    timing: Timing,
    /// How many threads there were to read the scene and to build what is built once.
    build_threads: usize,
    methods: Vec<Row>,
}

/// One method. Counts are over all views.
#[derive(Serialize)]
struct Row {
    method: &'static str,
    /// Pixels along an edge of a hemicube's top face, or the number of rays.
    resolution: Option<usize>,
    #[serde(flatten)]
    timing: Timing,
    view_ms_median: f64,
    /// For what is made once a scene, without the 3D BSP.
    setup_s: f64,
    /// Relative errors of form factors above 1e-4; null if there are none.
    max_error: Option<f64>,
    p99_error: Option<f64>,
    median_error: Option<f64>,
    /// Polygons that are seen and have the form factor 0, of how many that are seen.
    lost: usize,
    visible: usize,
    /// Of form factors.
    evaluations: usize,
    /// Apart for form factors above 1e-3 and 1e-4.
    errors: [Errors; 2],
}

#[derive(Serialize)]
struct Errors {
    above: f64,
    factors: usize,
    max_error: Option<f64>,
    p99_error: Option<f64>,
    median_error: Option<f64>,
}

impl Errors {
    fn new(above: f64, deviations: &Deviations) -> Self {
        let [max_error, p99_error, median_error] = [1.0, 0.99, 0.5].map(|share| deviations.quantile(share));
        Self { above, factors: deviations.count(), max_error, p99_error, median_error }
    }
}

impl Report {
    pub(super) fn new(
        bsp: &SceneBsp,
        views: &[(Viewpoint, Domain)],
        rounds: usize,
        [load_s, bsp_s]: [f64; 2],
        rows: &[ComparisonRow],
    ) -> Self {
        let of_views = |bsp_s, view_ms: &[f64]| Timing { threads: 1, ..Timing::new(load_s, bsp_s, view_ms) };
        let timing =
            |row: &ComparisonRow| of_views(if row.method == Method::Contour { bsp_s } else { 0.0 }, &row.view_ms);
        let methods = rows.iter().map(|row| {
            let errors = [Errors::new(1e-3, &row.above_1e3), Errors::new(1e-4, &row.above_1e4)];
            let Errors { max_error, p99_error, median_error, .. } = errors[1];
            Row {
                method: row.method.name(),
                resolution: row.method.resolution(),
                timing: timing(row),
                view_ms_median: row.median_ms(),
                setup_s: row.setup_s,
                max_error,
                p99_error,
                median_error,
                lost: row.above_1e4.lost(),
                visible: row.above_1e4.visible(),
                evaluations: row.evaluations,
                errors,
            }
        });
        let methods: Vec<Row> = methods.collect();
        // The first method is the contour image.
        let timing = of_views(bsp_s, rows.first().map_or(&[], |row| &row.view_ms));
        let on = views.iter().map(|(viewpoint, _)| viewpoint.surface().map(|(polygon, _)| polygon.0)).collect();
        Self {
            schema: SCHEMA,
            polygons: bsp.scene().polygon_count(),
            views: views.len(),
            on,
            rounds,
            reference: reference_method(bsp).name(),
            epsilon: bsp.epsilon(),
            timing,
            build_threads: rayon::current_num_threads(),
            methods,
        }
    }

    /// A table; counts are for a view.
    pub(super) fn in_words(&self) -> String {
        let mut lines = Lines::default();
        lines.add("scene", format!("{} polygons", self.polygons));
        let on = self.on.iter().flatten().count();
        lines.add(
            "views",
            format!("{}, {on} of them on a polygon; the shortest of {} times counts", self.views, self.rounds),
        );
        lines.add("time", format!("load {:.3} s; setup, in ms, is made once for the scene", self.timing.load_s));
        let why = if self.epsilon > 0.0 {
            format!(", as the 3D BSP is not exact with an epsilon of {}", number(self.epsilon))
        } else {
            String::new()
        };
        lines.add("reference", format!("{}{why}", self.reference));
        lines.add(
            "errors",
            "relative, of form factors above 1e-3 and, with 99% and median, above 1e-4; - where there are none",
        );
        lines.add("counts", "lost of the polygons seen, and evaluations of form factors, for a view");
        let mut text = lines.0;
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "\n{:<15} {:>9} {:>9} {:>9} {:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>11}",
            "method",
            "setup",
            "ms mean",
            "median",
            "worst>1e-3",
            "worst>1e-4",
            "99%",
            "median",
            "lost",
            "seen",
            "evaluations"
        );
        let error = |error: Option<f64>| error.map_or_else(|| "-".to_owned(), |error| format!("{error:.2e}"));
        let each = |count: usize| count as f64 / self.views.max(1) as f64;
        for row in &self.methods {
            let name = row.resolution.map_or_else(|| row.method.to_owned(), |n| format!("{} {n}", row.method));
            let _ = writeln!(
                text,
                "{name:<15} {:>9.1} {:>9.3} {:>9.3} {:>10} {:>10} {:>9} {:>9} {:>9.1} {:>9.1} {:>11.0}",
                1e3 * (row.timing.bsp_s + row.setup_s),
                row.timing.view_ms_mean,
                row.view_ms_median,
                error(row.errors[0].max_error),
                error(row.max_error),
                error(row.p99_error),
                error(row.median_error),
                each(row.lost),
                each(row.visible),
                each(row.evaluations)
            );
        }
        text
    }
}
