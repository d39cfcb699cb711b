//! Measured BRDFs in the binary format of MERL.
//!
//! Three i32, 90, 90 and 180, then as many f64 for red, then green, then blue; all little-endian. Times 1 / 1500, 1.15 / 1500 and 1.66 / 1500 they are
//! sr^-1. By `theta_h`, then `theta_d`, then `phi_d`: see [`Merl`].

use super::error::{Faults, Place, ReadError};
use super::{atomic_write, open_regular};
use crate::brdf::{BrdfError, MERL_BINS, MERL_COUNT, Merl, Unmeasured, merl_bin};
use glam::DVec3;
use std::io::{BufReader, Read, Result as IoResult, Write};
use std::path::Path;

/// What the stored numbers are multiplied by.
const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
/// The only length of a file there is.
const LENGTH: u64 = 12 + 3 * 8 * MERL_COUNT as u64;

/// Reads a BRDF from a file of MERL's. 35 MB, and as much memory.
///
/// # Errors
/// If the file cannot be read or is not a regular one. [`ReadError::Invalid`] with the first fault if it has another size than such files have, other
/// numbers of bins, or a value that [`Merl::new`] refuses: one that is not finite, or negative where `unmeasured` does not accept it.
pub fn read_merl(path: &Path, unmeasured: Unmeasured) -> Result<Merl, ReadError> {
    let failed = |source| ReadError::Io { path: path.to_owned(), source };
    let file = open_regular(path).map_err(failed)?;
    // By its size first, so that nothing is read of what is something else.
    let length = file.metadata().map_err(failed)?.len();
    from_reader(BufReader::new(file), length, &path.to_string_lossy(), unmeasured).map_err(|error| match error {
        Refused::Invalid(error) => error,
        Refused::Io(source) => failed(source),
    })
}

/// Reads a BRDF from the bytes of a file. `name` is what messages call it. Takes any bytes.
///
/// # Errors
/// As [`read_merl`].
pub fn parse_merl(bytes: &[u8], name: &str, unmeasured: Unmeasured) -> Result<Merl, ReadError> {
    from_reader(bytes, bytes.len() as u64, name, unmeasured).map_err(|error| match error {
        Refused::Invalid(error) => error,
        Refused::Io(source) => ReadError::Io { path: name.into(), source },
    })
}

enum Refused {
    Invalid(ReadError),
    Io(std::io::Error),
}

impl From<std::io::Error> for Refused {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

fn from_reader(mut bytes: impl Read, length: u64, name: &str, unmeasured: Unmeasured) -> Result<Merl, Refused> {
    let refuse = |place: Place, what: &str| {
        let mut faults = Faults::default();
        faults.note(name, place, what);
        Refused::Invalid(ReadError::Invalid(faults))
    };
    if length < 12 {
        return Err(refuse(Place::File, &format!("it has {length} bytes; a MERL file has {LENGTH}")));
    }
    let mut sizes = [0_i32; 3];
    for size in &mut sizes {
        let mut field = [0; 4];
        bytes.read_exact(&mut field)?;
        *size = i32::from_le_bytes(field);
    }
    if sizes.map(i64::from) != MERL_BINS.map(|bins| bins as i64) {
        let [a, b, c] = sizes;
        let what = format!(
            "its bins are {a} x {b} x {c} instead of 90 x 90 x 180: it is no MERL file of an isotropic surface"
        );
        return Err(refuse(Place::Item("header".to_owned()), &what));
    }
    if length != LENGTH {
        let what = if length < LENGTH {
            "it is truncated; get it again"
        } else {
            "there is something after its values; remove that"
        };
        return Err(refuse(Place::File, &format!("it has {length} bytes instead of {LENGTH}: {what}")));
    }
    let mut values = vec![DVec3::ZERO; MERL_COUNT];
    for (colour, scale) in SCALES.into_iter().enumerate() {
        for value in &mut values {
            let mut field = [0; 8];
            bytes.read_exact(&mut field)?;
            value[colour] = f64::from_le_bytes(field) * scale;
        }
    }
    let item = |[h, d, phi]: [usize; 3]| Place::Item(format!("bin theta_h {h}, theta_d {d}, phi_d {phi}"));
    Merl::new(values, unmeasured).map_err(|error| match error {
        BrdfError::BadCoefficient { index, value } => refuse(
            item(merl_bin(index)),
            &format!("the values {:?} are not finite numbers up to 1e12", value.to_array()),
        ),
        BrdfError::BadMeasurement { bin, value } => {
            let what = if bin[1] == 0 {
                "there is no bin of a smaller theta_d to take it from"
            } else {
                "its directions are above the surface; it can be read with unmeasured bins filled from smaller theta_d"
            };
            refuse(item(bin), &format!("the values {value} are negative: {what}"))
        }
        other => refuse(Place::File, &other.to_string()),
    })
}

/// Writes a BRDF to a file in MERL's format.
///
/// # Errors
/// If the file cannot be written.
pub fn write_merl(path: &Path, brdf: &Merl) -> IoResult<()> {
    atomic_write(path, |file| write_to(file, brdf))
}

fn write_to(out: &mut impl Write, brdf: &Merl) -> IoResult<()> {
    for bins in MERL_BINS {
        out.write_all(&(bins as i32).to_le_bytes())?;
    }
    for (colour, scale) in SCALES.into_iter().enumerate() {
        for value in brdf.values() {
            out.write_all(&(value[colour] / scale).to_le_bytes())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{LENGTH, parse_merl, read_merl, write_merl, write_to};
    use crate::brdf::{Blinn, Brdf, MERL_COUNT, Merl, Unmeasured};
    use glam::DVec3;

    fn sample() -> (Blinn, Merl) {
        let blinn = Blinn::new(DVec3::new(0.9, 0.5, 0.1), 30.0).unwrap();
        (blinn, Merl::tabulate(&blinn).unwrap())
    }

    #[test]
    fn what_is_written_is_read_again() {
        let (blinn, table) = sample();
        let path = std::env::temp_dir().join(format!("nusselt-merl-{}.binary", std::process::id()));
        write_merl(&path, &table).unwrap();
        assert_eq!(std::fs::metadata(&path).unwrap().len(), LENGTH);
        let read = read_merl(&path, Unmeasured::Refuse).unwrap();
        std::fs::remove_file(&path).unwrap();
        // Scaled there and back again.
        for (one, other) in read.values().iter().zip(table.values()) {
            assert!((*one - *other).abs().max_element() <= 4e-16 * other.max_element());
        }
        let (u, v) = (DVec3::new(0.3, 0.1, 0.8).normalize(), DVec3::new(-0.4, 0.1, 0.7).normalize());
        let [expected, found] = [blinn.eval(u, v), read.eval(u, v)];
        assert!((expected - found).abs().max_element() < 1e-2 * expected.max_element(), "{expected} {found}");
    }

    /// As the format is described, with nothing of the writer.
    fn bytes(value: impl Fn(usize, usize) -> f64) -> Vec<u8> {
        let mut bytes: Vec<u8> = [90_i32, 90, 180].into_iter().flat_map(i32::to_le_bytes).collect();
        for colour in 0..3 {
            bytes.extend((0..MERL_COUNT).flat_map(|k| value(colour, k).to_le_bytes()));
        }
        bytes
    }

    #[test]
    fn the_format_is_as_described() {
        // 300 (h 90 + d) 180 + phi: the value tells its place.
        let read =
            parse_merl(&bytes(|colour, k| 1500.0 * (k as f64 + colour as f64)), "a", Unmeasured::Refuse).unwrap();
        assert!((read.values()[(7 * 90 + 5) * 180 + 3].x - 114_303.0).abs() < 1e-9);
        assert!((read.values()[1].y - 1.15 * 2.0).abs() < 1e-12);
        assert!((read.values()[1].z - 1.66 * 3.0).abs() < 1e-12);
        let mut written = Vec::new();
        write_to(&mut written, &read).unwrap();
        assert_eq!(written.len(), LENGTH as usize);
    }

    #[test]
    fn bad_files_are_refused_with_the_reason() {
        let refused = |bytes: &[u8]| parse_merl(bytes, "a.binary", Unmeasured::Refuse).unwrap_err().to_string();
        let good = bytes(|_, _| 1.0);
        assert!(parse_merl(&good, "a.binary", Unmeasured::Refuse).is_ok());
        assert_eq!(refused(b"short"), "a.binary: it has 5 bytes; a MERL file has 34992012");
        let truncated = "a.binary: it has 34992011 bytes instead of 34992012: it is truncated; get it again";
        assert_eq!(refused(&good[..good.len() - 1]), truncated);
        assert!(refused(&[&good[..], b"x"].concat()).ends_with("there is something after its values; remove that"));
        let mut sizes = good.clone();
        sizes[8..12].copy_from_slice(&360_i32.to_le_bytes());
        assert!(refused(&sizes).starts_with("a.binary: header: its bins are 90 x 90 x 360 instead of 90 x 90 x 180"));
        sizes[8..12].copy_from_slice(&(-1_i32).to_le_bytes());
        assert!(refused(&sizes).contains("90 x 90 x -1"));
        for bad in [f64::NAN, f64::INFINITY, 1e300] {
            let text = refused(&bytes(|colour, k| if colour == 2 && k == 181 { bad } else { 1.0 }));
            assert!(text.starts_with("a.binary: bin theta_h 0, theta_d 1, phi_d 1: the values"), "{text}");
            assert!(text.ends_with("are not finite numbers up to 1e12") && text.len() < 200, "{text}");
        }
        let negative = bytes(|_, k| if k == 181 { -1.0 } else { 1.0 });
        let text = refused(&negative);
        assert!(text.starts_with("a.binary: bin theta_h 0, theta_d 1, phi_d 1: the values [-0.000"), "{text}");
        assert!(text.contains("are negative: its directions are above the surface"), "{text}");
        assert!(parse_merl(&negative, "a", Unmeasured::Fill).is_ok());
        assert!(refused(&bytes(|_, k| if k == 3 { -1.0 } else { 1.0 })).contains("no bin of a smaller theta_d"));
        // Something large that is no such file is not read.
        assert!(read_merl(std::path::Path::new("/dev/zero"), Unmeasured::Refuse).is_err());
    }
}
