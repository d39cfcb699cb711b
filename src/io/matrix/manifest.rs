//! What a file of rows belongs to.

use super::super::digest::Digest;
use super::{MatrixError, record};
use crate::factors::PatchInfo;
use crate::scene::{Scene, Shape, Side};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::Range;

/// The schema's name.
pub const MANIFEST_SCHEMA: &str = "nusselt.form-factors-rows/2";

/// What is computed: the rows of a matrix, of a scene in patches, with some options.
#[derive(Clone, Debug)]
pub struct MatrixJob<'a> {
    pub(super) patches: &'a [PatchInfo],
    scene: &'a Scene,
    options: BTreeMap<String, String>,
    rows: Option<Range<u32>>,
}

impl<'a> MatrixJob<'a> {
    /// All rows, without options.
    pub fn new(scene: &'a Scene, patches: &'a [PatchInfo]) -> Self {
        Self { patches, scene, options: BTreeMap::new(), rows: None }
    }

    /// With an option that rows depend on: a run with another value cannot be resumed with this one.
    #[must_use]
    pub fn with_option(mut self, name: &str, value: impl Display) -> Self {
        self.options.insert(name.to_owned(), value.to_string());
        self
    }

    /// Only these rows.
    #[must_use]
    pub fn with_rows(self, rows: Range<u32>) -> Self {
        Self { rows: Some(rows), ..self }
    }

    /// What a file of these rows says of itself. Takes time in proportion to the scene.
    ///
    /// # Errors
    /// If there are no such rows, more patches than 32 bits number, or an area that no number tells.
    pub fn manifest(&self) -> Result<Manifest, MatrixError> {
        let too_many = |_| MatrixError::TooManyPatches { count: self.patches.len() };
        let count = u32::try_from(self.patches.len()).map_err(too_many)?;
        let rows = self.rows.clone().unwrap_or(0..count);
        if rows.end > count || (rows.start >= rows.end && rows != (0..count)) {
            return Err(MatrixError::BadRange { rows, count });
        }
        let is_bad = |patch: &PatchInfo| !patch.area.is_finite() || (patch.area == 0.0 && patch.shape.is_some());
        if let Some(patch) = self.patches.iter().position(is_bad) {
            let PatchInfo { polygon, area, .. } = self.patches[patch];
            return Err(MatrixError::BadArea { patch, polygon, area });
        }
        Ok(Manifest {
            schema: MANIFEST_SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene_digest(self.scene),
            options: self.options.clone(),
            patches: count,
            patches_digest: patches_digest(self.patches),
            rows: [rows.start, rows.end],
        })
    }
}

/// What a file of rows says of itself; `FILE.manifest.json` holds it as JSON.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`MANIFEST_SCHEMA`].
    pub schema: String,
    /// The version of this crate.
    pub version: String,
    /// What [`scene_digest`] says.
    pub scene: Digest,
    /// The options that rows depend on.
    pub options: BTreeMap<String, String>,
    /// How many patches there are.
    pub patches: u32,
    /// A digest of their names, polygons, areas and shapes.
    pub patches_digest: Digest,
    /// The first row, and one more than the last.
    pub rows: [u32; 2],
}

impl Manifest {
    /// The rows.
    pub fn rows(&self) -> Range<u32> {
        self.rows[0]..self.rows[1]
    }

    /// True if they are all rows of the matrix.
    pub fn is_whole(&self) -> bool {
        self.rows == [0, self.patches]
    }

    /// In words, how a run with this manifest differs from one with `other`, but for the rows.
    pub(super) fn differences(&self, other: &Self) -> Vec<String> {
        let mut all = Vec::new();
        let mut note = |name: &str, a: &str, b: &str| {
            if a != b {
                all.push(format!("{name} was {a}, and is {b}"));
            }
        };
        note("the format", &self.schema, &other.schema);
        note("the version of the program", &self.version, &other.version);
        for name in self.options.keys().chain(other.options.keys().filter(|name| !self.options.contains_key(*name))) {
            let [a, b] = [self, other].map(|run| run.options.get(name).map_or("not given", String::as_str));
            note(name, a, b);
        }
        note("the number of patches", &self.patches.to_string(), &other.patches.to_string());
        if self.scene != other.scene {
            all.push("the scene is another one".to_owned());
        } else if self.patches_digest != other.patches_digest && self.patches == other.patches {
            all.push("names, polygons, areas or shapes of patches are others".to_owned());
        }
        all
    }

    /// The same with the rows.
    pub(super) fn all_differences(&self, other: &Self) -> Vec<String> {
        let mut all = self.differences(other);
        if self.rows != other.rows {
            let [[a, b], [c, d]] = [self.rows, other.rows];
            all.push(format!("the rows were {a}..{b}, and are {c}..{d}"));
        }
        all
    }
}

/// A digest of what form factors of a scene depend on: polygons with their corners, pieces and objects, and the names of objects. Materials
/// do not count.
pub fn scene_digest(scene: &Scene) -> Digest {
    let number = |digest: Digest, x: u64| digest.with(&x.to_le_bytes());
    let mut digest = number(Digest::EMPTY, scene.polygon_count() as u64);
    for name in scene.objects() {
        digest = digest.with_text(name);
    }
    for polygon in scene.polygons() {
        let shape = match polygon.shape() {
            Shape::Convex => 0,
            Shape::Concave => 1,
            Shape::NonPlanar => 2,
            Shape::Degenerate => 3,
            Shape::Dropped => 4,
        };
        digest = number(number(digest, u64::from(polygon.object().0)), shape);
        let pieces = polygon.pieces();
        digest = number(digest, pieces.len() as u64);
        for piece in pieces {
            digest = number(number(digest, u64::from(piece.facing() == Side::Front)), piece.points().len() as u64);
            for point in piece.points() {
                // -0 and 0 are the same place.
                digest = point.to_array().into_iter().fold(digest, |digest, x| number(digest, (x + 0.0).to_bits()));
            }
        }
    }
    digest
}

pub(super) fn patches_digest(patches: &[PatchInfo]) -> Digest {
    patches.iter().fold(Digest::EMPTY, |digest, patch| {
        let bytes = record::of_patch(patch);
        digest.with(&(bytes.len() as u64).to_le_bytes()).with(&bytes)
    })
}
