//! The summary, as JSON and in words.

use crate::summary::{Lines, Timing, number};
use nusselt::factors::{By, PointFactors};
use nusselt::io::POINT_FACTORS_SCHEMA;
use nusselt::scene::Scene;
use serde::Serialize;
use std::path::Path;

/// Over all points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Totals {
    points: usize,
    on: usize,
    factors: u64,
    background: f64,
    worst_closure: f64,
    sum_ms: f64,
    max_ms: f64,
}

impl Totals {
    pub(super) fn add(&mut self, factors: &PointFactors, ms: f64) {
        self.points += 1;
        self.on += usize::from(factors.on.is_some());
        self.factors += factors.factors.len() as u64;
        self.background += factors.background;
        self.worst_closure = self.worst_closure.max((factors.total() - 1.0).abs());
        self.sum_ms += ms;
        self.max_ms = self.max_ms.max(ms);
    }
}

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    by: &'static str,
    polygons: usize,
    points: usize,
    /// How many of them are on a polygon.
    on: usize,
    /// How many factors are not zero, without those of the background.
    factors: u64,
    background_mean: f64,
    /// How far the factors of a point are from summing to 1, at most.
    worst_closure: f64,
    timing: Timing,
}

impl Report {
    pub(super) fn new(scene: &Scene, by: By, totals: &Totals, load_s: f64, order_s: f64) -> Self {
        let Totals { points, on, factors, background, worst_closure, sum_ms, max_ms } = *totals;
        Self {
            schema: POINT_FACTORS_SCHEMA,
            by: by.name(),
            polygons: scene.polygon_count(),
            points,
            on,
            factors,
            background_mean: background / points.max(1) as f64,
            worst_closure,
            timing: Timing::of_many(load_s, order_s, points, sum_ms, max_ms),
        }
    }

    pub(super) fn in_words(&self, output: Option<&Path>) -> String {
        let mut lines = Lines::default();
        lines.add("scene", format!("{} polygons", self.polygons));
        lines.add("points", format!("{}, {} of them on a polygon", self.points, self.on));
        lines.add(
            "factors",
            format!("{} by {}, sums within {} of 1", self.factors, self.by, number(self.worst_closure)),
        );
        lines.add("background", format!("{:.8} on average", self.background_mean));
        let Timing { load_s, bsp_s, view_ms_mean, view_ms_max, .. } = self.timing;
        lines.add(
            "time",
            format!("load {load_s:.3} s, order {bsp_s:.3} s, a view {view_ms_mean:.3} ms, at most {view_ms_max:.3} ms"),
        );
        if let Some(path) = output {
            lines.add("wrote", path.display());
        }
        lines.0
    }
}
