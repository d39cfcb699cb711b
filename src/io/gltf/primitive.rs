//! Primitives: which corners make up their triangles.

use super::accessor::Elements;
use super::json::Primitive;

/// How corners follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Triangles,
    Strip,
    Fan,
}

/// A primitive whose accessors were checked.
#[derive(Debug)]
pub(super) struct Triangles<'a> {
    mode: Mode,
    indices: Option<&'a Elements<'a>>,
    positions: &'a Elements<'a>,
    /// How many triangles it has.
    pub(super) count: usize,
}

impl<'a> Triangles<'a> {
    /// Checks a primitive; `None` if it has no triangles but points or lines, or no positions.
    pub(super) fn new(primitive: &Primitive, elements: &'a [Option<Elements<'a>>]) -> Result<Option<Self>, String> {
        let mode = match primitive.mode() {
            0..=3 => return Ok(None),
            4 => Mode::Triangles,
            5 => Mode::Strip,
            6 => Mode::Fan,
            other => return Err(format!("there is no mode {other}; it is 0 to 6")),
        };
        let elements = |accessor: usize| {
            let known = elements.get(accessor).and_then(Option::as_ref);
            known.ok_or_else(|| format!("it takes accessor {accessor}, which cannot be used"))
        };
        let Some(positions) = primitive.attributes.position else { return Ok(None) };
        let positions = elements(positions)?;
        positions.check_positions()?;
        let indices = primitive.indices.map(elements).transpose()?;
        if let Some(indices) = indices {
            indices.check_indices()?;
        }
        let corners = indices.map_or(positions.count, |indices| indices.count);
        let count = match mode {
            Mode::Triangles if corners % 3 != 0 => {
                return Err(format!("triangles take three corners each, but it has {corners}"));
            }
            Mode::Triangles => corners / 3,
            Mode::Strip | Mode::Fan => corners.saturating_sub(2),
        };
        Ok(Some(Self { mode, indices, positions, count }))
    }

    /// The positions that are the corners of the k-th triangle, counter-clockwise seen from its front, there or not.
    pub(super) fn corners(&self, k: usize) -> [usize; 3] {
        let corners = match self.mode {
            Mode::Triangles => [3 * k, 3 * k + 1, 3 * k + 2],
            Mode::Strip => [k, k + 1 + k % 2, k + 2 - k % 2],
            Mode::Fan => [k + 1, k + 2, 0],
        };
        corners.map(|corner| self.indices.map_or(corner, |indices| indices.index(corner)))
    }

    pub(super) fn positions(&self) -> &'a Elements<'a> {
        self.positions
    }
}
