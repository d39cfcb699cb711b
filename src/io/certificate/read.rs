//! Reading a kept certificate: any bytes may be in the file.

use super::CERTIFICATE_SCHEMA;
use super::error::CertificateError;
use super::rows::{DomainRow, SceneSize, SliverRow, SplitterRow, present};
use crate::exact::Sign;
use crate::io::read_regular;
use crate::io::told::{shortened, told};
use crate::scene::{PieceId, Scene, Splitter};
use crate::verify::{Evidence, EvidenceCell, EvidenceSliver, HalfSphere};
use glam::DVec3;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;
use std::path::Path;

/// The evidence of a contour image as it was kept in a file. That it could be read says nothing about whether it
/// holds: see [`Evidence::check`].
#[derive(Clone, Debug, PartialEq)]
pub struct KeptCertificate {
    /// The size of the scene it was made for.
    pub scene: SceneSize,
    /// What is claimed.
    pub evidence: Evidence,
}

/// Reads a kept certificate from a regular file. Time and memory are in proportion to its size.
///
/// # Errors
/// If the file cannot be read, or is not a certificate of schema `nusselt.certificate/1`: the first thing that is
/// wrong, and where.
pub fn read_certificate(path: &Path) -> Result<KeptCertificate, CertificateError> {
    let bytes = read_regular(path).map_err(|source| CertificateError::Io { path: path.to_owned(), source })?;
    KeptCertificate::from_json(&bytes, &path.display().to_string())
}

impl KeptCertificate {
    /// The same from the bytes of a file; its name is for messages.
    ///
    /// # Errors
    /// The first thing that is wrong: fields that are missing, unknown or given twice, numbers that no f64 or id can
    /// hold, sides that name no splitter.
    pub fn from_json(bytes: &[u8], file: &str) -> Result<Self, CertificateError> {
        let invalid = |what: &str| CertificateError::Invalid { file: file.to_owned(), what: shortened(what) };
        let row: FileRow = serde_json::from_slice(bytes).map_err(|error| invalid(&told(&error)))?;
        if row.epsilon < 0.0 {
            return Err(invalid("its epsilon is negative"));
        }
        let count = row.splitters.0.len();
        for (k, cell) in row.cells.0.iter().enumerate() {
            if let Some(side) = cell.sides.iter().find(|side| side.splitter as usize >= count) {
                let number = u64::from(side.splitter) + 1;
                return Err(invalid(&format!("cell {k}: there is no splitter {number}, only {count} of them")));
            }
        }
        let evidence = Evidence {
            eye: DVec3::from(row.eye),
            domain: row.domain.into(),
            epsilon: row.epsilon,
            slivers: row.slivers.0,
            splitters: row.splitters.0,
            cells: row.cells.0,
        };
        Ok(Self { scene: row.scene, evidence })
    }

    /// Compares the size of a scene with that of the scene it was made for. The name of the file is for messages.
    ///
    /// # Errors
    /// [`CertificateError::OtherScene`] if they differ.
    pub fn fit(&self, scene: &Scene, file: &str) -> Result<(), CertificateError> {
        let (made_for, found) = (self.scene, SceneSize::of(scene));
        if made_for == found {
            return Ok(());
        }
        Err(CertificateError::OtherScene { file: file.to_owned(), made_for, found })
    }
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRow {
    // Only that it can be read matters.
    #[serde(rename = "schema")]
    _schema: Schema,
    scene: SceneSize,
    eye: [f64; 3],
    domain: DomainRow,
    epsilon: f64,
    slivers: Rows<SliverRow, EvidenceSliver>,
    splitters: Rows<SplitterRow, Splitter>,
    cells: Rows<CellRow, EvidenceCell>,
}

struct Schema;

impl<'de> Deserialize<'de> for Schema {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        if name == CERTIFICATE_SCHEMA {
            return Ok(Self);
        }
        Err(D::Error::custom(format_args!("its schema is {:?}, not {CERTIFICATE_SCHEMA:?}", shortened(&name))))
    }
}

/// A list whose items are turned into what they stand for one by one; errors name the item.
struct Rows<R, T>(Vec<T>, PhantomData<R>);

/// What an item of a list is called.
trait Named {
    const NAME: &'static str;
}

impl Named for SliverRow {
    const NAME: &'static str = "sliver";
}

impl Named for SplitterRow {
    const NAME: &'static str = "splitter";
}

impl Named for CellRow {
    const NAME: &'static str = "cell";
}

impl<'de, R: Named + Deserialize<'de> + Into<T>, T> Deserialize<'de> for Rows<R, T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(Self(Vec::new(), PhantomData))
    }
}

impl<'de, R: Named + Deserialize<'de> + Into<T>, T> Visitor<'de> for Rows<R, T> {
    type Value = Self;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of {}s", R::NAME)
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut items: A) -> Result<Self, A::Error> {
        loop {
            let number = self.0.len();
            match items.next_element::<R>() {
                Ok(Some(row)) => self.0.push(row.into()),
                Ok(None) => return Ok(self),
                Err(error) => return Err(A::Error::custom(format_args!("{} {number}: {error}", R::NAME))),
            }
        }
    }
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct CellRow {
    #[serde(deserialize_with = "present")]
    piece: Option<u32>,
    sides: Sides,
}

impl From<CellRow> for EvidenceCell {
    fn from(row: CellRow) -> Self {
        Self { piece: row.piece.map(PieceId), sides: row.sides.0 }
    }
}

struct Sides(Vec<HalfSphere>);

impl<'de> Deserialize<'de> for Sides {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(Self(Vec::new()))
    }
}

impl<'de> Visitor<'de> for Sides {
    type Value = Self;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of splitters with a sign, counted from 1")
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut items: A) -> Result<Self, A::Error> {
        while let Some(number) = items.next_element::<i64>()? {
            let splitter = number.unsigned_abs().checked_sub(1).and_then(|k| u32::try_from(k).ok());
            let Some(splitter) = splitter else {
                return Err(A::Error::custom(format_args!(
                    "there is no splitter {number}; they are counted from 1, and the sign tells which side is inside"
                )));
            };
            self.0.push(HalfSphere { splitter, inside: if number < 0 { Sign::Negative } else { Sign::Positive } });
        }
        self.0.shrink_to_fit();
        Ok(self)
    }
}
