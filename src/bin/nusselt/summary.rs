//! What summaries have in common.

use serde::Serialize;
use serde_json::{Value, json};
use std::fmt::{Display, Write};

/// Times around the work itself.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Timing {
    pub(crate) load_s: f64,
    /// To build the 3D BSP, or the hierarchy of boxes if that is what views were made with.
    pub(crate) bsp_s: f64,
    pub(crate) views: usize,
    pub(crate) view_ms_mean: f64,
    pub(crate) view_ms_max: f64,
    /// Around the proof, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) certify_ms: Option<f64>,
    /// How many threads there were. A view is made by one of them.
    pub(crate) threads: usize,
}

impl Timing {
    /// Of a command that makes these views.
    pub(crate) fn new(load_s: f64, bsp_s: f64, view_ms: &[f64]) -> Self {
        // Not with sum, which is -0 for none.
        let sum = view_ms.iter().fold(0.0, |sum, ms| sum + ms);
        Self::of_many(load_s, bsp_s, view_ms.len(), sum, view_ms.iter().copied().fold(0.0, f64::max))
    }

    /// The same by the sum and the largest of their times.
    pub(crate) fn of_many(load_s: f64, bsp_s: f64, views: usize, sum_ms: f64, max_ms: f64) -> Self {
        Self {
            load_s,
            bsp_s,
            views,
            view_ms_mean: sum_ms / views.max(1) as f64,
            view_ms_max: max_ms,
            certify_ms: None,
            threads: rayon::current_num_threads(),
        }
    }
}

/// A vector as one would type it.
pub(crate) fn vector(v: glam::DVec3) -> String {
    v.to_array().map(number).join(",")
}

/// The shortest number that reads as the same, with an exponent where it would be long otherwise.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 || (1e-5..1e12).contains(&x.abs()) { format!("{}", x + 0.0) } else { format!("{x:e}") }
}

/// How small something is.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 { "0".to_owned() } else { format!("{x:.1e}") }
}

/// So many of each kind of thing are named, the rest is only counted.
const NAMED: usize = 20;

/// The first ones.
pub(crate) fn named<T>(items: &[T], show: impl Fn(&T) -> String) -> String {
    let first: Vec<_> = items.iter().take(NAMED).map(show).collect();
    let more = if items.len() > NAMED { ", ..." } else { "" };
    first.join(", ") + more
}

/// How many, and which the first ones are.
pub(crate) fn counted<T>(items: &[T], show: impl Fn(&T) -> Value) -> Value {
    json!({ "count": items.len(), "first": items.iter().take(NAMED).map(show).collect::<Vec<_>>() })
}

/// Lines of a name and what there is to say about it.
#[derive(Default)]
pub(crate) struct Lines(pub(crate) String);

impl Lines {
    pub(crate) fn add(&mut self, name: &str, value: impl Display) {
        // Writing to a string does not fail.
        let _ = writeln!(self.0, "{name:<12} {value}");
    }
}
