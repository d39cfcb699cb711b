//! Two images that must agree: of one scene given in two ways, or of one view made twice.

use super::tiling::is_within;
use super::{Defect, angle_tolerance};
use crate::contour::{Cell, ContourImage, Location};
use crate::scene::{PolygonId, Side};
use glam::DVec3;
use std::collections::BTreeMap;

/// What is seen: a side of a polygon, or the background.
type Seen = Option<(PolygonId, Side)>;

/// Checks that two images show the same, where polygons may have other names and directions other coordinates.
///
/// `names` gives what each image's polygons and sides are to be called; where both give the same, the same is
/// meant (several polygons may become one). `turn` maps a direction of the first image to the second's, exactly.
/// Compared are what is shown in each of the `directions` (of the first image) that lies strictly inside of a
/// cell in both, exactly, and the solid angle of everything, up to the sum of both images'
/// [`angle_tolerance`] for the cells that show it. Gives the number of directions that had an answer.
///
/// # Errors
/// The first difference.
pub fn check_same_view(
    [first, second]: [&ContourImage; 2],
    names: [&dyn Fn(PolygonId, Side) -> (PolygonId, Side); 2],
    turn: impl Fn(DVec3) -> DVec3,
    directions: &[DVec3],
) -> Result<usize, Defect> {
    let mut compared = 0;
    for &direction in directions {
        let seen = |image: &ContourImage, d, name: &dyn Fn(PolygonId, Side) -> (PolygonId, Side)| match image.locate(d)
        {
            Location::Cell(cell) => Some(seen_in(image.cell(cell), name)),
            _ => None,
        };
        let (a, b) = (seen(first, direction, names[0]), seen(second, turn(direction), names[1]));
        if let (Some(first), Some(second)) = (a, b) {
            compared += 1;
            if first != second {
                return Err(Defect::Disagreement { direction, first, second });
            }
        }
    }
    let [first, second] = [(first, names[0]), (second, names[1])].map(|(image, name)| by_name(image, name));
    for &what in first.keys().chain(second.keys()) {
        let [a, b] = [&first, &second].map(|sums| sums.get(&what).copied().unwrap_or_default());
        let tolerance = a.tolerance + b.tolerance;
        if !is_within(a.angle, b.angle, tolerance) {
            return Err(Defect::Angles { what, first: a.angle, second: b.angle, tolerance });
        }
    }
    Ok(compared)
}

fn seen_in(cell: Cell<'_>, name: &dyn Fn(PolygonId, Side) -> (PolygonId, Side)) -> Seen {
    cell.polygon().zip(cell.side()).map(|(polygon, side)| name(polygon, side))
}

#[derive(Clone, Copy, Default)]
struct Sum {
    angle: f64,
    tolerance: f64,
}

fn by_name(image: &ContourImage, name: &dyn Fn(PolygonId, Side) -> (PolygonId, Side)) -> BTreeMap<Seen, Sum> {
    let mut sums: BTreeMap<Seen, Sum> = BTreeMap::new();
    for cell in image.cells() {
        let sum = sums.entry(seen_in(cell, name)).or_default();
        sum.angle += cell.solid_angle();
        sum.tolerance += angle_tolerance([cell]);
    }
    sums
}

/// Checks that two images are the same bit by bit: the same cells in the same order, with the same labels and the
/// same corners.
///
/// # Errors
/// The first difference.
pub fn check_same_bits(first: &ContourImage, second: &ContourImage) -> Result<(), Defect> {
    if first.cell_count() != second.cell_count() {
        let what = format!("{} and {} cells", first.cell_count(), second.cell_count());
        return Err(Defect::Bits { what });
    }
    for (a, b) in first.cells().zip(second.cells()) {
        let label = |cell: Cell<'_>| (cell.polygon(), cell.piece(), cell.side());
        let bits = |cell: Cell<'_>| -> Vec<_> { cell.boundary().map(|d| d.to_array().map(f64::to_bits)).collect() };
        let difference = if label(a) != label(b) {
            "label"
        } else if bits(a) != bits(b) {
            "corners"
        } else {
            continue;
        };
        return Err(Defect::Bits { what: format!("the {difference} of cell {}", a.id().0) });
    }
    Ok(())
}
