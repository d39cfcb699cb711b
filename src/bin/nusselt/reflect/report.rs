//! The radiance as JSON and in words.

use crate::summary::{Lines, Timing, vector};
use glam::DVec3;
use nusselt::brdf::RgbEstimate;
use nusselt::contour::ContourImage;
use nusselt::scene::Side;
use serde::Serialize;
use std::path::Path;

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    eye: [f64; 3],
    on: Option<u32>,
    normal: [f64; 3],
    view: [f64; 3],
    radiance: [f64; 3],
    error: [f64; 3],
    albedo: [f64; 3],
    cells: usize,
    timing: Timing,
    reflect_ms: f64,
}

impl Report {
    pub(super) fn new(
        image: &ContourImage,
        radiance: RgbEstimate,
        albedo: RgbEstimate,
        view: DVec3,
        timing: Timing,
        reflect_ms: f64,
    ) -> Self {
        let viewpoint = image.viewpoint();
        Self {
            schema: "nusselt.reflect/1",
            eye: viewpoint.eye().to_array(),
            on: viewpoint.surface().map(|(polygon, _)| polygon.0),
            normal: image.normal().unwrap_or_default().to_array(),
            view: view.to_array(),
            radiance: radiance.value.to_array(),
            error: radiance.error.to_array(),
            albedo: albedo.value.to_array(),
            cells: image.cell_count(),
            timing,
            reflect_ms,
        }
    }

    pub(super) fn in_words(&self, image: &ContourImage, picture: Option<&Path>) -> String {
        let mut lines = Lines::default();
        let on = image.viewpoint().surface().map(|(polygon, side)| {
            let side = if side == Side::Front { "front" } else { "back" };
            format!(", on the {side} of polygon {polygon} ({})", image.scene().polygon(polygon).object_name())
        });
        lines.add("eye", format!("{}{}", vector(self.eye.into()), on.unwrap_or_default()));
        lines.add("normal", vector(self.normal.into()));
        lines.add("view", vector(self.view.into()));
        lines.add("", ["red", "green", "blue"].map(|name| format!("{name:>14}")).join(" "));
        lines.add("radiance", self.radiance.map(|x| format!("{x:>14.8e}")).join(" "));
        lines.add("error", self.error.map(|x| format!("{x:>14.1e}")).join(" "));
        lines.add("albedo", self.albedo.map(|x| format!("{x:>14.8}")).join(" "));
        lines.add(
            "time",
            format!(
                "load {:.3} s, order {:.3} s, view {:.3} ms of {} cells, reflection {:.3} ms",
                self.timing.load_s, self.timing.bsp_s, self.timing.view_ms_max, self.cells, self.reflect_ms
            ),
        );
        if let Some(path) = picture {
            lines.add("wrote", path.display());
        }
        lines.0
    }
}
