//! The cells tile the domain: by their sums, and direction by direction.

use super::Defect;
use super::labels::inner_directions;
use crate::contour::{Cell, CellId, ContourImage, Domain, Location};
use crate::exact::Sign;
use crate::scene::Side;
use crate::testing::integers::{Unit, Vector, dot, free_vector, resolved, sign};
use glam::DVec3;
use std::f64::consts::PI;

/// A bound on what rounding may do to a sum of the solid angles of cells.
///
/// Corners are rounded to within 1e-13 in each component of a vector whose largest is at least 1, so within
/// 2e-13 radians, which moves the sides next to them: a cell gains or loses at most its perimeter times
/// that. The formula itself is off by 4e-16 times (the value + the perimeter times the diameter), with
/// values up to 2 pi and diameters up to pi: below 1e-14, whatever the perimeter.
pub fn angle_tolerance<'a>(cells: impl IntoIterator<Item = Cell<'a>>) -> f64 {
    let of_cell = |cell: Cell<'a>| {
        let corners: Vec<DVec3> = cell.boundary().collect();
        let sides = (0..corners.len()).map(|k| corners[k].angle_between(corners[(k + 1) % corners.len()]));
        2e-13 * sides.sum::<f64>() + 1e-14
    };
    cells.into_iter().map(of_cell).sum()
}

/// NaN is not.
pub(super) fn is_within(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

/// Checks that the solid angles sum to the domain's, and the form factors, if the domain has a normal,
/// to 1; up to [`angle_tolerance`], which divided by pi also bounds what moving the same corners does to form factors.
///
/// # Errors
/// If they do not.
pub fn check_sums(image: &ContourImage) -> Result<(), Defect> {
    let tolerance = angle_tolerance(image.cells());
    let expected = if *image.domain() == Domain::Sphere { 4.0 * PI } else { 2.0 * PI };
    let total = image.solid_angles().total();
    if !is_within(total, expected, tolerance) {
        return Err(Defect::SolidAngles { total, expected, tolerance });
    }
    if let Some(factors) = image.form_factors() {
        let (total, tolerance) = (factors.total(), tolerance / PI);
        if !is_within(total, 1.0, tolerance) {
            return Err(Defect::FormFactors { total, tolerance });
        }
    }
    Ok(())
}

/// Checks that no cell shows the background, exactly, as in a closed scene seen from within.
///
/// # Errors
/// The first cell that does.
pub fn check_closed(image: &ContourImage) -> Result<(), Defect> {
    match image.cells().find(|cell| cell.polygon().is_none()) {
        Some(cell) => Err(Defect::Background { cell: cell.id() }),
        None => Ok(()),
    }
}

/// Checks of each direction, exactly and against every cell: if it lies strictly inside of the domain it
/// is strictly inside of exactly one cell, or on the boundary of at least two; outside of the domain it is in none.
/// And [`ContourImage::locate`] must name that cell.
///
/// # Errors
/// The first direction for which it is not so.
pub fn check_tiling(image: &ContourImage, directions: &[DVec3]) -> Result<(), Defect> {
    let scene = image.scene();
    let eye = image.viewpoint().eye();
    let unit = Unit::of(scene.vertices().iter().copied().chain([eye]));
    let cells: Vec<(CellId, Vec<Vector>)> = image
        .cells()
        .map(|cell| {
            let inward = cell.splitters().map(|(splitter, inside)| {
                let normal = unit.splitter(scene, eye, &splitter);
                if inside == Sign::Negative { normal.map(|x| -x) } else { normal }
            });
            (cell.id(), inward.collect())
        })
        .collect();
    let horizon = horizon(image, unit);
    for &direction in directions {
        let exact = free_vector(direction);
        let mut inside = Vec::new();
        let mut touched = 0;
        for (id, sides) in &cells {
            match sides.iter().map(|normal| sign(&dot(normal, &exact))).min() {
                Some(1) => inside.push(*id),
                Some(0) => touched += 1,
                _ => {}
            }
        }
        let is_tiled = match horizon.as_ref().map_or(1, |up| sign(&dot(up, &exact))) {
            1 => (inside.len() == 1 && touched == 0) || (inside.is_empty() && touched >= 2),
            0 => inside.is_empty(),
            _ => inside.is_empty() && touched == 0,
        };
        if !is_tiled {
            return Err(Defect::NotTiled { direction, cells: inside, touched });
        }
        let located = match image.locate(direction) {
            Location::Cell(cell) => Some(cell),
            _ => None,
        };
        let inside = inside.first().copied();
        if located != inside {
            return Err(Defect::Location { direction, inside, located });
        }
    }
    Ok(())
}

/// The normal of the domain's horizon, upwards.
fn horizon(image: &ContourImage, unit: Unit) -> Option<Vector> {
    match *image.domain() {
        Domain::Sphere => None,
        Domain::Hemisphere(normal) => Some(free_vector(normal)),
        Domain::Above => {
            let scene = image.scene();
            let (piece, side) = image.viewpoint().surface_piece()?;
            let piece = scene.piece(piece);
            let (normal, _) = unit.plane(&resolved(scene, piece.plane()));
            let is_up = (piece.facing() == Side::Front) == (side == Side::Front);
            Some(if is_up { normal } else { normal.map(|x| -x) })
        }
    }
}

/// Up to 34 directions that are likely to tell whether cells tile: in cells, through vertices, between two vertices, along
/// the axes.
pub fn telling_directions(image: &ContourImage) -> Vec<DVec3> {
    const OF_A_KIND: usize = 10;
    let eye = image.viewpoint().eye();
    let cells = image.cells().step_by(image.cell_count().div_ceil(OF_A_KIND).max(1));
    let vertices = image.scene().vertices();
    let stride = vertices.len().div_ceil(OF_A_KIND).max(1);
    let towards = vertices.iter().step_by(stride).map(|&v| v - eye);
    let between =
        vertices.iter().zip(vertices.iter().skip(1)).step_by(stride).map(|(&a, &b)| (a - eye) * 0.5 + (b - eye) * 0.5);
    let axes = [DVec3::Z, DVec3::new(1.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 0.0), DVec3::new(3.0, -1.0, 2.0)];
    let all = cells.flat_map(|cell| inner_directions(cell).take(1)).chain(towards).chain(between).chain(axes);
    all.filter(|d| d.is_finite() && *d != DVec3::ZERO).collect()
}
