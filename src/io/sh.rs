//! BRDFs as tables of spherical harmonics, as text. `docs/formats.md` describes the format.

use super::error::{Faults, Place, ReadError};
use super::lines::{Line, lines};
use super::number::{Shortest, parse as parse_number, shown};
use super::{atomic_write, open_regular};
use crate::brdf::{ShBrdf, ShSymmetry};
use glam::DVec3;
use std::io::{Read, Result as IoResult, Write};
use std::path::Path;

/// The first line of a file.
const HEADER: &str = "nusselt sh 1";
/// No file is longer: the largest table, with every number written out.
const LONGEST: u64 = 32 << 20;

/// Reads a BRDF from a file of spherical harmonics.
///
/// # Errors
/// If the file cannot be read, is not a regular one, is of more than 32 MB, or as [`parse_sh`].
pub fn read_sh(path: &Path) -> Result<ShBrdf, ReadError> {
    let failed = |source| ReadError::Io { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    open_regular(path).map_err(failed)?.take(LONGEST + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > LONGEST {
        return Err(fault(&path.to_string_lossy(), Place::File, "it has more than 32 MB: no table is as large"));
    }
    parse_sh(&bytes, &path.to_string_lossy())
}

/// Reads a BRDF from the bytes of a file. `name` is what messages call it. Takes any bytes.
///
/// ```
/// let text = b"nusselt sh 1\nsymmetry isotropic\nband 0\nentries 1\n0 0 0 2 1 0.5\nend\n";
/// let brdf = nusselt::io::parse_sh(text, "matt.sh")?;
/// assert_eq!(brdf.coefficients(), [glam::DVec3::new(2.0, 1.0, 0.5)]);
/// let error = nusselt::io::parse_sh(&text[..39], "matt.sh").unwrap_err();
/// assert_eq!(error.to_string(), "matt.sh:4: there is no line `entries COUNT`; is the file truncated?");
/// # Ok::<(), nusselt::io::ReadError>(())
/// ```
///
/// # Errors
/// [`ReadError::Invalid`] with the first line that is wrong: no header, a band that is too high, an index that is not in the
/// table or is there twice, a number that is not finite, too few or too many entries.
pub fn parse_sh(bytes: &[u8], name: &str) -> Result<ShBrdf, ReadError> {
    let mut lines = lines(bytes);
    // The number of the line that would be next, for what is missing.
    let mut next = 1;
    let mut take = |what: &str| -> Result<Line<'_>, ReadError> {
        let line = lines.next().ok_or_else(|| {
            fault(name, Place::Line(next), &format!("there is no line `{what}`; is the file truncated?"))
        })?;
        next = line.number + 1;
        Ok(line)
    };
    let header = take(HEADER)?;
    if header.text.split_whitespace().ne(HEADER.split(' ')) {
        let what =
            format!("it starts with {} instead of `{HEADER}`; name a file of spherical harmonics", shown(&header.text));
        return Err(fault(name, Place::Line(header.number), &what));
    }
    let line = take("symmetry isotropic|general")?;
    let symmetry = match line.split() {
        ("symmetry", "isotropic") => ShSymmetry::Isotropic,
        ("symmetry", "general") => ShSymmetry::General,
        _ => {
            let what = format!("{} should be `symmetry isotropic` or `symmetry general`", shown(&line.text));
            return Err(fault(name, Place::Line(line.number), &what));
        }
    };
    let line = take("band BAND")?;
    let highest = symmetry.highest_band();
    let band = value_of(&line, "band", u64::from(highest), name)? as u16;
    let line = take("entries COUNT")?;
    let size = symmetry.count(band);
    let count = value_of(&line, "entries", size as u64, name)? as usize;
    let mut table: Vec<Option<DVec3>> = vec![None; size];
    for k in 0..count {
        let line = take(&format!("entry {} of {count}", k + 1))?;
        let refuse = |what: &str| fault(name, Place::Line(line.number), what);
        let (at, value) = entry(&line.text, symmetry, band).map_err(|what| refuse(&what))?;
        if table[at].replace(value).is_some() {
            return Err(refuse("an entry of these indices came before; leave one out"));
        }
    }
    let line = take("end")?;
    if line.text != "end" {
        let what = format!("{} should be `end` after {count} entries; correct the line `entries`", shown(&line.text));
        return Err(fault(name, Place::Line(line.number), &what));
    }
    if let Some(line) = lines.next() {
        return Err(fault(name, Place::Line(line.number), "there is more after the line `end`; remove it"));
    }
    let table = table.into_iter().map(Option::unwrap_or_default).collect();
    ShBrdf::new(symmetry, band, table).map_err(|error| fault(name, Place::File, &error.to_string()))
}

fn fault(name: &str, place: Place, what: &str) -> ReadError {
    let mut faults = Faults::default();
    faults.note(name, place, what);
    ReadError::Invalid(faults)
}

/// The whole number after a keyword, up to a limit.
fn value_of(line: &Line<'_>, keyword: &str, highest: u64, name: &str) -> Result<u64, ReadError> {
    let (found, rest) = line.split();
    let value = rest.parse::<u64>().ok().filter(|&value| found == keyword && value <= highest);
    value.ok_or_else(|| {
        let what = format!("{} should be `{keyword}` and a whole number to {highest}", shown(&line.text));
        fault(name, Place::Line(line.number), &what)
    })
}

/// Where in the table an entry is, and its value.
fn entry(text: &str, symmetry: ShSymmetry, band: u16) -> Result<(usize, DVec3), String> {
    let fields: Vec<&str> = text.split_whitespace().collect();
    let (names, indices) = match symmetry {
        ShSymmetry::Isotropic => ("m l k", 3),
        ShSymmetry::General => ("l m k n", 4),
    };
    if fields.len() != indices + 3 {
        return Err(format!("it has {} fields instead of {}: {names} red green blue", fields.len(), indices + 3));
    }
    let mut whole = [0_i32; 4];
    for (value, field) in whole.iter_mut().zip(&fields[..indices]) {
        *value = field.parse().map_err(|_| format!("{} is not a whole number", shown(field)))?;
    }
    let (isotropic, general) = (symmetry == ShSymmetry::Isotropic, symmetry == ShSymmetry::General);
    let band_of = |l: i32| u16::try_from(l).ok().filter(|&l| l <= band);
    let at = match whole {
        [m, l, k, _] if isotropic => match [m, l, k].map(band_of) {
            [Some(m), Some(l), Some(k)] if m <= l && m <= k => Some(ShBrdf::index_isotropic(band, m, l, k)),
            _ => None,
        },
        [l, m, k, n] if general => match [l, k].map(band_of) {
            [Some(lower), Some(upper)] if m.unsigned_abs() <= l as u32 && n.unsigned_abs() <= k as u32 => {
                Some(ShBrdf::index_general(band, (lower, m), (upper, n)))
            }
            _ => None,
        },
        _ => None,
    };
    let at =
        at.ok_or_else(|| format!("there is no harmonic {names} of {} to band {band}", fields[..indices].join(" ")))?;
    let mut value = DVec3::ZERO;
    for (k, field) in fields[indices..].iter().enumerate() {
        value[k] = parse_number(field)?;
    }
    if !crate::brdf::is_usable(value) {
        return Err("a coefficient may not be larger than 1e12".to_owned());
    }
    Ok((at, value))
}

/// Writes a BRDF to a file that [`read_sh`] reads as the same numbers. Entries that are 0 are left out.
///
/// # Errors
/// If the file cannot be written.
pub fn write_sh(path: &Path, brdf: &ShBrdf) -> IoResult<()> {
    atomic_write(path, |file| write_to(file, brdf))
}

fn write_to(out: &mut impl Write, brdf: &ShBrdf) -> IoResult<()> {
    let (band, table) = (brdf.band(), brdf.coefficients());
    let symmetry = match brdf.symmetry() {
        ShSymmetry::Isotropic => "isotropic",
        ShSymmetry::General => "general",
    };
    let entries = table.iter().filter(|value| **value != DVec3::ZERO).count();
    writeln!(out, "{HEADER}\nsymmetry {symmetry}\nband {band}\nentries {entries}")?;
    let mut write = |indices: &[i32], at: usize| -> IoResult<()> {
        if table[at] == DVec3::ZERO {
            return Ok(());
        }
        for index in indices {
            write!(out, "{index} ")?;
        }
        let [r, g, b] = table[at].to_array().map(Shortest);
        writeln!(out, "{r} {g} {b}")
    };
    match brdf.symmetry() {
        ShSymmetry::Isotropic => {
            for m in 0..=band {
                for l in m..=band {
                    for k in m..=band {
                        write(&[m, l, k].map(i32::from), ShBrdf::index_isotropic(band, m, l, k))?;
                    }
                }
            }
        }
        ShSymmetry::General => {
            let harmonics = || (0..=band).flat_map(|l| (-i32::from(l)..=i32::from(l)).map(move |m| (l, m)));
            for (l, m) in harmonics() {
                for (k, n) in harmonics() {
                    let at = ShBrdf::index_general(band, (l, m), (k, n));
                    write(&[i32::from(l), m, i32::from(k), n], at)?;
                }
            }
        }
    }
    writeln!(out, "end")
}

#[cfg(test)]
mod tests {
    use super::{parse_sh, read_sh, write_sh, write_to};
    use crate::brdf::{Fresnel, Ggx, ShBrdf, ShSymmetry};
    use glam::DVec3;

    fn samples() -> [ShBrdf; 2] {
        let brushed = Ggx::new(Fresnel::schlick(DVec3::new(0.9, 0.5, 0.1)).unwrap(), 0.4, 0.8).unwrap();
        [(ShSymmetry::Isotropic, 7), (ShSymmetry::General, 3)]
            .map(|(symmetry, band)| ShBrdf::project(&brushed, symmetry, band).unwrap().brdf)
    }

    fn text(brdf: &ShBrdf) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_to(&mut bytes, brdf).unwrap();
        bytes
    }

    #[test]
    fn what_is_written_is_read_again() {
        for brdf in samples() {
            assert_eq!(parse_sh(&text(&brdf), "a.sh").unwrap(), brdf);
            let path = std::env::temp_dir().join(format!("nusselt-sh-{}-{}", std::process::id(), brdf.band()));
            write_sh(&path, &brdf).unwrap();
            assert_eq!(read_sh(&path).unwrap(), brdf);
            std::fs::remove_file(&path).unwrap();
        }
    }

    #[test]
    fn a_file_that_ends_anywhere_is_refused() {
        for brdf in samples() {
            let bytes = text(&brdf);
            // Without the last line's end it is complete.
            for end in (0..bytes.len() - 1).step_by(7).chain([bytes.len() - 2, bytes.len() - 5]) {
                assert!(parse_sh(&bytes[..end], "a.sh").is_err(), "{end} of {}", bytes.len());
            }
        }
    }

    #[test]
    fn bad_files_are_refused_with_the_reason() {
        let refused = |text: &str| parse_sh(text.as_bytes(), "a.sh").unwrap_err().to_string();
        let head = "nusselt sh 1\nsymmetry isotropic\nband 2\n";
        for (text, expected) in [
            (String::new(), "a.sh:1: there is no line `nusselt sh 1`; is the file truncated?"),
            (
                "solid x\n".into(),
                "a.sh:1: it starts with `solid x` instead of `nusselt sh 1`; name a file of spherical harmonics",
            ),
            (
                "nusselt sh 2\n".into(),
                "a.sh:1: it starts with `nusselt sh 2` instead of `nusselt sh 1`; name a file of spherical harmonics",
            ),
            (
                "nusselt sh 1\nsymmetry round".into(),
                "a.sh:2: `symmetry round` should be `symmetry isotropic` or `symmetry general`",
            ),
            (
                "nusselt sh 1\nsymmetry isotropic\nband 65".into(),
                "a.sh:3: `band 65` should be `band` and a whole number to 64",
            ),
            (
                "nusselt sh 1\nsymmetry general\nband 18446744073709551616".into(),
                "a.sh:3: `band 18446744073709551616` should be `band` and a whole number to 16",
            ),
            (format!("{head}entries 15"), "a.sh:4: `entries 15` should be `entries` and a whole number to 14"),
            (
                format!("{head}entries 2\n# one\n0 0 0 1 1 1\n"),
                "a.sh:7: there is no line `entry 2 of 2`; is the file truncated?",
            ),
            (
                format!("{head}entries 1\n0 0 0 1 1 1\n0 1 1 1 1 1"),
                "a.sh:6: `0 1 1 1 1 1` should be `end` after 1 entries; correct the line `entries`",
            ),
            (format!("{head}entries 0\nend\n\n0 0 0 1 1 1"), "a.sh:7: there is more after the line `end`; remove it"),
            (
                format!("{head}entries 2\n0 0 0 1 1 1\n0 0 0 1 1 1"),
                "a.sh:6: an entry of these indices came before; leave one out",
            ),
            (format!("{head}entries 1\n0 0 1 1 1"), "a.sh:5: it has 5 fields instead of 6: m l k red green blue"),
            (format!("{head}entries 1\n1 0 1 1 1 1"), "a.sh:5: there is no harmonic m l k of 1 0 1 to band 2"),
            (format!("{head}entries 1\n0 3 0 1 1 1"), "a.sh:5: there is no harmonic m l k of 0 3 0 to band 2"),
            (format!("{head}entries 1\n0 -1 0 1 1 1"), "a.sh:5: there is no harmonic m l k of 0 -1 0 to band 2"),
            (format!("{head}entries 1\n0 x 0 1 1 1"), "a.sh:5: `x` is not a whole number"),
            (format!("{head}entries 1\n0 0 0 1 nan 1"), "a.sh:5: `nan` is not a finite number"),
            (
                format!("{head}entries 1\n0 0 0 1 1e999 1"),
                "a.sh:5: the number `1e999` is too large; the largest is about 1.8e308",
            ),
            (format!("{head}entries 1\n0 0 0 1 -1e13 1"), "a.sh:5: a coefficient may not be larger than 1e12"),
        ] {
            assert_eq!(refused(&text), expected);
        }
        let general = "nusselt sh 1\nsymmetry general\nband 1\nentries 1\n";
        assert_eq!(
            refused(&format!("{general}1 2 0 0 1 1 1")),
            "a.sh:5: there is no harmonic l m k n of 1 2 0 0 to band 1"
        );
        assert_eq!(
            refused(&format!("{general}-1 0 0 0 1 1 1")),
            "a.sh:5: there is no harmonic l m k n of -1 0 0 0 to band 1"
        );
        assert!(parse_sh(format!("{general}1 -1 0 0 1 1 1\nend").as_bytes(), "a.sh").is_ok());
        assert!(read_sh(std::path::Path::new("/")).is_err());
    }
}
