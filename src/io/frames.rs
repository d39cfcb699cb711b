//! Paths of cameras, as text.

use super::error::{Faults, Place, ReadError};
use super::lines::lines;
use super::number::parse as parse_number;
use super::points::{fields, is_header, separation};
use super::read_regular;
use glam::DVec3;
use std::path::Path;

/// A camera of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameLine {
    /// The line it is in, from 1.
    pub line: usize,
    /// Where it stands.
    pub eye: DVec3,
    /// The point that it looks at: another one.
    pub look_at: DVec3,
    /// Its vertical field of view in degrees, above 0 and below 180.
    pub fov: f64,
}

const COLUMNS: [&str; 7] = ["eye x", "eye y", "eye z", "look-at x", "look-at y", "look-at z", "fov"];

/// Reads cameras from a file.
///
/// # Errors
/// If the file cannot be read, is not a regular one, or as [`parse_frames`].
pub fn read_frames(path: &Path) -> Result<Vec<FrameLine>, ReadError> {
    let bytes = read_regular(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    parse_frames(&bytes, &path.to_string_lossy())
}

/// Reads cameras, one a line, each of seven numbers separated by commas or blanks: the eye, the point that it looks at, and the field of view. A first line in which nothing is a number
/// is a header; empty lines are skipped, as is what follows a `#`. `name` is what messages call the file. Takes any bytes.
///
/// ```
/// let frames = nusselt::io::parse_frames(b"# a step to the right\n0,0,1, 5,0,1, 60\n0,-1,1, 5,0,1, 60\n", "path.csv")?;
/// assert_eq!((frames.len(), frames[1].line), (2, 3));
/// let error = nusselt::io::parse_frames(b"0,0,1, 0,0,1, 60\n", "path.csv").unwrap_err();
/// assert_eq!(error.to_string(), "path.csv:1: the camera looks at its own eye; look at another point");
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with everything that is wrong; also if there is no camera.
pub fn parse_frames(bytes: &[u8], name: &str) -> Result<Vec<FrameLine>, ReadError> {
    let mut faults = Faults::default();
    let mut frames = Vec::new();
    for (k, line) in lines(bytes).enumerate() {
        let fields = fields(&line.text);
        if k == 0 && is_header(&fields) {
            continue;
        }
        match frame(line.number, &fields) {
            Ok(frame) => frames.push(frame),
            Err(what) => faults.note(name, Place::Line(line.number), what),
        }
    }
    if frames.is_empty() && faults.is_empty() {
        faults.note(
            name,
            Place::File,
            "it has no cameras; a line is the eye's x y z, the x y z looked at, and the fov",
        );
    }
    if faults.is_empty() { Ok(frames) } else { Err(ReadError::Invalid(faults)) }
}

fn frame(line: usize, fields: &[&str]) -> Result<FrameLine, String> {
    if fields.len() != COLUMNS.len() {
        let (count, advice) = (fields.len(), separation(fields));
        return Err(format!("eye x y z, look-at x y z and fov are 7 fields, not {count}{advice}"));
    }
    let mut values = [0.0; COLUMNS.len()];
    for ((value, field), column) in values.iter_mut().zip(fields).zip(COLUMNS) {
        if field.is_empty() {
            return Err(format!("{column} is empty"));
        }
        *value = parse_number(field).map_err(|what| format!("{column}: {what}"))?;
    }
    let [eye, look_at] = [0, 3].map(|k| DVec3::from_slice(&values[k..]));
    let fov = values[6];
    if eye == look_at {
        return Err("the camera looks at its own eye; look at another point".to_owned());
    }
    if !(fov > 0.0 && fov < 180.0) {
        return Err(format!("fov: {fov} is not above 0 and below 180 degrees"));
    }
    Ok(FrameLine { line, eye, look_at, fov })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_faults_are_named_by_line() {
        let faults = |text: &str| parse_frames(text.as_bytes(), "p.csv").expect_err(text).to_string();
        let text = "x,y,z,tx,ty,tz,fov\n1,2,3,4,5,6\n1,2,3,4,,6,7\n1 2 3 4 5 nan 7\n1 2 3 1 2 3 50\n1 2 3 4 5 6 180\n1 2 3 4 5 6 50\n";
        let expected = "p.csv:2: eye x y z, look-at x y z and fov are 7 fields, not 6\n\
            p.csv:3: look-at y is empty\n\
            p.csv:4: look-at z: `nan` is not a finite number\n\
            p.csv:5: the camera looks at its own eye; look at another point\n\
            p.csv:6: fov: 180 is not above 0 and below 180 degrees";
        assert_eq!(faults(text), expected);
        let semicolons =
            "p.csv:1: eye x y z, look-at x y z and fov are 7 fields, not 1; separate them by commas or blanks";
        assert_eq!(faults("-1;2;3;4;5;6;50\n1 2 3 4 5 6 50\n"), semicolons);
        assert!(faults("").contains("no cameras") && faults("a,b,c,d,e,f,g").contains("no cameras"));
        assert!(parse_frames(b"\xff\xfe\x00,,", "p.csv").is_err());
    }
}
