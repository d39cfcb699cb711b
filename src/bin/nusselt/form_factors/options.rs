//! The options of `form-factors`, as they are typed.

use crate::summary::number;
use glam::DVec3;
use nusselt::factors::PatchPlan;
use nusselt::io::matrix::{MatrixFormat, PatchesFormat};
use nusselt::scene::Scene;
use std::ops::Range;
use std::path::PathBuf;

pub(super) fn parse_patch(text: &str) -> Result<PatchPlan, String> {
    match text {
        "polygon" => Ok(PatchPlan::Polygons),
        "object" => Ok(PatchPlan::Objects),
        _ => match positive(text) {
            Some(longest_edge) => Ok(PatchPlan::Mesh { longest_edge }),
            None => Err("it is polygon, object, or the length of the longest edge in scene units, above 0".to_owned()),
        },
    }
}

/// More patches than this are not made: a row of the matrix would be as long.
const MOST_PATCHES: f64 = 4e6;

/// Refuses a mesh that would have more patches, before there is memory for them. What is counted are the fewest that there can be: none is
/// larger than a square with edges of that length, and none is longer than two of them.
pub(super) fn check_fineness(scene: &Scene, plan: PatchPlan) -> Result<(), String> {
    let PatchPlan::Mesh { longest_edge } = plan else { return Ok(()) };
    let fewest = scene.pieces().map(|piece| {
        // In edges, so that no square overflows unless there are too many.
        let corners: Vec<DVec3> = piece.points().map(|corner| corner / longest_edge).collect();
        let from_first = corners.iter().map(|&corner| corner - corners[0]);
        let twice_area: DVec3 = from_first.clone().zip(from_first.clone().skip(1)).map(|(a, b)| a.cross(b)).sum();
        let length = from_first.map(DVec3::length).fold(0.0, f64::max);
        (twice_area.length() / 2.0).max(length / 2.0)
    });
    let fewest: f64 = fewest.sum();
    if fewest <= MOST_PATCHES {
        return Ok(());
    }
    Err(format!("there would be more than {MOST_PATCHES} patches; take a longer edge than {}", number(longest_edge)))
}

/// As it is typed.
pub(super) fn name(plan: PatchPlan) -> String {
    match plan {
        PatchPlan::Polygons => "polygon".to_owned(),
        PatchPlan::Objects => "object".to_owned(),
        PatchPlan::Mesh { longest_edge } => number(longest_edge),
    }
}

pub(super) fn parse_tolerance(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "it takes an absolute error above 0, such as 1e-4".to_owned())
}

fn positive(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0)
}

pub(super) const NOT_PATCHES: &str = "patches are written as .csv or .obj";

pub(super) fn parse_patches(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if PatchesFormat::of(&path).is_some() { Ok(path) } else { Err(NOT_PATCHES.to_owned()) }
}

pub(super) fn parse_rows(text: &str) -> Result<Range<u32>, String> {
    let numbers = text.split_once("..").and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
    numbers
        .filter(|rows: &Range<u32>| !rows.is_empty())
        .ok_or_else(|| "it takes A..B, the first row, counted from 0, and one more than the last: 0..100".to_owned())
}

/// A file whose ending is known.
pub(super) fn parse_output(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match MatrixFormat::of(&path) {
        Ok(_) => Ok(path),
        // The file is named by whoever tells it.
        Err(error) => Err(error.to_string().trim_start_matches(&format!("{}: ", path.display())).to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_fine_meshes_are_told_before_they_are_made() {
        let scene = nusselt::samples::cornell_box().to_builder().build().expect("the box");
        let check = |longest_edge| check_fineness(&scene, PatchPlan::Mesh { longest_edge });
        assert!(check(10.0).is_ok() && check(1e300).is_ok());
        for longest_edge in [0.1, 1e-9, 1e-200, f64::MIN_POSITIVE] {
            assert!(check(longest_edge).is_err(), "{longest_edge}");
        }
        assert!(check_fineness(&scene, PatchPlan::Polygons).is_ok());
    }

    #[test]
    fn options_are_read_as_they_are_named() {
        for text in ["polygon", "object", "0.25", "1e-9", "3"] {
            assert_eq!(name(parse_patch(text).expect("an option")), text);
        }
        for text in ["0", "-1", "nan", "inf", "1e999", "", "polygons", "0x1"] {
            assert!(parse_patch(text).is_err() && parse_tolerance(text).is_err(), "{text}");
        }
        assert_eq!(parse_rows("3..6"), Ok(3..6));
        for text in ["3", "3..", "..6", "6..3", "3..3", "-1..2", "3...6", "3..=6", "0..4294967296"] {
            assert!(parse_rows(text).is_err(), "{text}");
        }
    }
}
