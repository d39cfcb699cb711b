//! The options of `form-factors`, as they are typed.

use crate::summary::number;
use nusselt::factors::PatchPlan;
use nusselt::io::matrix::MatrixFormat;
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
