//! Scenes of our own: the Cornell box, and rooms, offices and cities of any size.
//!
//! All are plain data ([`Mesh`]) and the same on every platform: their coordinates come from
//! integers by the four operations and the square root.
//!
//! ```
//! use nusselt::samples::{Kind, generate};
//!
//! let mesh = generate(Kind::Room, 1000, 1)?;
//! assert_eq!(mesh.faces().len(), 1000);
//! let eyes = mesh.free_points(100, 7);
//! assert!(eyes.iter().all(|&eye| mesh.clearance(eye) > 0.0));
//! # Ok::<(), nusselt::samples::GenerateError>(())
//! ```

mod city;
mod cornell;
mod free;
mod furniture;
mod mesh;
mod office;
mod paint;
mod parts;
mod rng;
mod room;
mod shell;
mod sphere;
mod surface;
mod ticks;

pub use cornell::cornell_box;
pub use mesh::{Mesh, MeshFace};

use std::fmt;
use std::str::FromStr;

/// The fewest polygons [`generate`] makes a scene of.
pub const MIN_POLYGONS: usize = 64;
/// The most polygons [`generate`] makes a scene of.
pub const MAX_POLYGONS: usize = 20_000_000;

/// A kind of generated scene. All are in metres, z up, with the floor at z = 0, and closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A room with recessed lamps, furniture and balls, mostly turned by arbitrary angles.
    Room,
    /// A wide, low floor of cubicles below many lamps: mostly axis-aligned boxes at round coordinates.
    Office,
    /// Buildings with flat, pointed and gabled roofs between streets, below a luminous sky.
    City,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Room, Self::Office, Self::City];

    /// Its name in small letters, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Room => "room",
            Self::Office => "office",
            Self::City => "city",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Kind {
    type Err = UnknownKind;

    fn from_str(name: &str) -> Result<Self, UnknownKind> {
        let found = Self::ALL.into_iter().find(|kind| kind.name() == name);
        found.ok_or_else(|| UnknownKind { name: name.to_owned() })
    }
}

/// A name that no [`Kind`] has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no kind of scene called {name:?}; there are room, office and city")]
pub struct UnknownKind {
    /// The name.
    pub name: String,
}

/// A number of polygons that no scene is made of.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// Less than [`MIN_POLYGONS`].
    #[error("no {kind} has only {polygons} polygons; ask for at least {MIN_POLYGONS}")]
    TooFew {
        /// The kind of scene.
        kind: Kind,
        /// The number asked for.
        polygons: usize,
    },
    /// More than [`MAX_POLYGONS`].
    #[error("{polygons} polygons are too many for a generated {kind}; ask for at most {MAX_POLYGONS}")]
    TooMany {
        /// The kind of scene.
        kind: Kind,
        /// The number asked for.
        polygons: usize,
    },
}

/// Generates a scene of exactly `polygons` triangles and quads; the same for the same seed.
///
/// Its surfaces are closed: within each, every edge joins exactly two faces, and no vertex lies
/// inside an edge. Fronts face the air. The room's and the office's shell (with the recesses of the
/// lamps) is one surface, every box and ball of the furniture is another; they do not overlap, but
/// may touch where one lies flat on another or on the floor. The city is one surface. All quads are
/// exactly planar and convex. Lamps and sky emit.
///
/// Cost: linear in the number of polygons; about 100 bytes each at the peak.
///
/// # Errors
/// If there are fewer polygons than [`MIN_POLYGONS`] or more than [`MAX_POLYGONS`].
pub fn generate(kind: Kind, polygons: usize, seed: u64) -> Result<Mesh, GenerateError> {
    if polygons < MIN_POLYGONS {
        return Err(GenerateError::TooFew { kind, polygons });
    }
    if polygons > MAX_POLYGONS {
        return Err(GenerateError::TooMany { kind, polygons });
    }
    let mut mesh = match kind {
        Kind::Room => room::room(polygons, seed),
        Kind::Office => office::office(polygons, seed),
        Kind::City => city::city(polygons, seed),
    };
    mesh.cut_quads(polygons - mesh.faces().len());
    Ok(mesh)
}
