//! Points with normals, as text: where to look from.
//!
//! A line holds `x y z nx ny nz [polygon]`, separated by commas or blanks. A first line in which nothing is a number is a header. Empty lines
//! are skipped, as is what follows a `#` at the start of a line or after a blank.

mod blocks;
mod reader;

pub use reader::PointReader;

use super::error::ReadError;
use super::lines::is_blank;
use super::number::{parse as parse_number, shown};
use super::open_regular;
use crate::scene::PolygonId;
use glam::DVec3;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// A point to look from, with the direction that is up there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLine {
    /// The line it is in, from 1.
    pub line: usize,
    /// The point; finite.
    pub point: DVec3,
    /// The normal, of any length; finite and not zero.
    pub normal: DVec3,
    /// The polygon that it is on, if that is told. There need not be one of that number.
    pub polygon: Option<PolygonId>,
}

/// Reads points from a file.
///
/// # Errors
/// If the file cannot be read, is not a regular one, or as [`parse_points`].
pub fn read_points(path: &Path) -> Result<Vec<PointLine>, ReadError> {
    all(open_points(path)?)
}

/// Opens a file of points, to be read a few at a time.
///
/// # Errors
/// If the file cannot be opened, or is not a regular one.
pub fn open_points(path: &Path) -> Result<PointReader<File>, ReadError> {
    let file = open_regular(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    Ok(PointReader::new(file, path.to_string_lossy()))
}

/// Reads points from the bytes of a file. `name` is what messages call it. Takes any bytes.
///
/// ```
/// let points = nusselt::io::parse_points(b"x,y,z,nx,ny,nz\n1,2,0.5,0,0,1\n", "sensors.csv")?;
/// assert_eq!(points[0].point, glam::DVec3::new(1.0, 2.0, 0.5));
/// let error = nusselt::io::parse_points(b"1 2 0.5 0 0 0\n", "sensors.csv").unwrap_err();
/// assert_eq!(error.to_string(), "sensors.csv:1: the normal 0 0 0 has no direction");
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with everything that is wrong; also if there is no point.
pub fn parse_points(bytes: &[u8], name: &str) -> Result<Vec<PointLine>, ReadError> {
    all(PointReader::new(bytes, name))
}

fn all<R: Read>(mut reader: PointReader<R>) -> Result<Vec<PointLine>, ReadError> {
    let (mut all, mut some) = (Vec::new(), Vec::new());
    while reader.next(usize::MAX, &mut some)? {
        all.append(&mut some);
    }
    Ok(all)
}

/// The fields of a line: a comma ends one, and so do blanks.
pub(super) fn fields(text: &str) -> Vec<&str> {
    let mut fields = Vec::new();
    for part in text.split(',') {
        let before = fields.len();
        fields.extend(part.split(is_blank).filter(|field| !field.is_empty()));
        if fields.len() == before {
            fields.push("");
        }
    }
    fields
}

/// True for a first line in which nothing is a number, nor begins like one: `1;2;3` is a line whose fields are not told apart.
pub(super) fn is_header(fields: &[&str]) -> bool {
    let begins = |field: &str| field.trim_start_matches(['+', '-', '.']).starts_with(|c: char| c.is_ascii_digit());
    fields.iter().all(|field| field.parse::<f64>().is_err() && !begins(field))
}

/// What to do with a line of the wrong number of fields, if that can be told.
pub(super) fn separation(fields: &[&str]) -> &'static str {
    let is_separated_otherwise = fields.iter().any(|field| field.contains([';', '|']));
    if is_separated_otherwise { "; separate them by commas or blanks" } else { "" }
}

fn point(line: usize, fields: &[&str]) -> Result<PointLine, String> {
    let (numbers, polygon) = match fields {
        // A table with a column for polygons may leave it empty.
        [numbers @ .., ""] if numbers.len() == 6 => (numbers, None),
        [numbers @ .., polygon] if numbers.len() == 6 => (numbers, Some(*polygon)),
        numbers if numbers.len() == 6 => (numbers, None),
        _ => {
            let (count, advice) = (fields.len(), separation(fields));
            return Err(format!("x y z nx ny nz [polygon] are 6 or 7 fields, not {count}{advice}"));
        }
    };
    let mut values = [0.0; 6];
    for (value, (field, column)) in values.iter_mut().zip(numbers.iter().zip(["x", "y", "z", "nx", "ny", "nz"])) {
        if field.is_empty() {
            return Err(format!("{column} is empty"));
        }
        *value = parse_number(field).map_err(|what| format!("{column}: {what}"))?;
    }
    let [point, normal] = [0, 3].map(|k| DVec3::from_slice(&values[k..]));
    if normal == DVec3::ZERO {
        return Err("the normal 0 0 0 has no direction".to_owned());
    }
    let polygon = polygon.map(|text| {
        let number = text.parse().map(PolygonId);
        number.map_err(|_| format!("{} is not the number of a polygon, counted from 0", shown(text)))
    });
    Ok(PointLine { line, point, normal, polygon: polygon.transpose()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str) -> String {
        parse_points(text.as_bytes(), "p.csv").expect_err(text).to_string()
    }

    #[test]
    fn fields_are_separated_by_commas_or_blanks() {
        let text = "\u{feff}X, Y, Z, Nx, Ny, Nz, Polygon\r\n1, 2,3 ,0,0,1,7\n\n# a note\n1\t2  3 0 0 -1e0 # up\n1,2,3,0,1,0,\n";
        let points = parse_points(text.as_bytes(), "p.csv").expect("good lines");
        let line = |line, normal, polygon| PointLine { line, point: DVec3::new(1.0, 2.0, 3.0), normal, polygon };
        let expected = [line(2, DVec3::Z, Some(PolygonId(7))), line(5, DVec3::NEG_Z, None), line(6, DVec3::Y, None)];
        assert_eq!(points, expected);
        // Without a header the first line counts.
        assert_eq!(parse_points(b"0 0 0 0 0 1", "p.csv").map(|points| points.len()).ok(), Some(1));
    }

    #[test]
    fn all_faults_are_named_by_line() {
        assert_eq!(faults(""), "p.csv: it has no points; a line is x y z nx ny nz [polygon]");
        assert_eq!(faults("x y z nx ny nz"), faults(""));
        let semicolons =
            "p.csv:1: x y z nx ny nz [polygon] are 6 or 7 fields, not 1; separate them by commas or blanks";
        assert_eq!(faults("0.5;-2;3;0;0;1\n1 2 3 0 0 1\n"), semicolons);
        let text = "1 2 3\n1,2,3,0,,1\n1 2 3 0 0 inf\n1 2 3 0 0 0\n1 2 3 0 0 1 -2\n1 2 3 0 0 1 2 3\nx 2 3 0 0 1\n0 0 0 0 0 1\n";
        let expected = "p.csv:1: x y z nx ny nz [polygon] are 6 or 7 fields, not 3\n\
            p.csv:2: ny is empty\n\
            p.csv:3: nz: `inf` is not a finite number\n\
            p.csv:4: the normal 0 0 0 has no direction\n\
            p.csv:5: `-2` is not the number of a polygon, counted from 0\n\
            p.csv:6: x y z nx ny nz [polygon] are 6 or 7 fields, not 8\n\
            p.csv:7: x: `x` is not a number";
        assert_eq!(faults(text), expected);
    }

    #[test]
    fn any_bytes_are_refused_or_read() {
        for bytes in [&b"\xff\xfe\x00"[..], b",,,,,,", b"\\\n1", b"nan nan nan nan nan nan", b"1,2,3,4,5,6,7,\n"] {
            assert!(parse_points(bytes, "p.csv").is_err(), "{bytes:?}");
        }
    }
}
