//! The cells tile the domain: by their sums, and direction by direction.

use super::Defect;
use super::labels::inner_directions;
use crate::contour::{Cell, CellId, ContourImage, Domain, Frustum, Horizon, Location, Pane};
use crate::exact::Sign;
use crate::scene::Side;
use crate::testing::integers::{Unit, Vector, cross, dot, free_vector, minus, resolved, sign};
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

/// Checks that the solid angles sum to the domain's, if that is no windows, and the form factors, if the domain is a hemisphere,
/// to 1; up to [`angle_tolerance`], which divided by pi also bounds what moving the same corners does to form factors.
///
/// # Errors
/// If they do not.
pub fn check_sums(image: &ContourImage) -> Result<(), Defect> {
    let tolerance = angle_tolerance(image.cells());
    let expected = match image.domain() {
        Domain::Sphere => 4.0 * PI,
        Domain::Hemisphere(_) | Domain::Above => 2.0 * PI,
        Domain::Frustum(frustum) => frustum_angle(frustum),
        // Their union has no simple formula.
        Domain::Window(_) => return Ok(()),
    };
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
    let unit = Unit::of_image(image);
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
    let outline = Outline::new(image, unit);
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
        let is_tiled = match outline.side(&exact) {
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

/// The solid angle between the four planes of a camera: a rectangular pyramid with half angles a and b has 4 asin(sin a sin b), where the
/// sines are those of the angles between opposite planes.
fn frustum_angle(frustum: &Frustum) -> f64 {
    let (sine, cosine) = (frustum.degrees() / 2.0).to_radians().sin_cos();
    let across = frustum.aspect() * sine;
    4.0 * (sine * across / across.hypot(cosine)).asin()
}

/// What bounds the domain, in exact integers: normals to the inside.
struct Outline {
    horizon: Option<Vector>,
    /// One list for each window; none at all if there are neither windows nor a frustum.
    cones: Option<Vec<Vec<Vector>>>,
}

impl Outline {
    fn new(image: &ContourImage, unit: Unit) -> Self {
        let cones = match image.domain() {
            Domain::Frustum(frustum) => Some(vec![frustum.normals().map(free_vector).to_vec()]),
            Domain::Window(windows) => {
                let rings = windows.panes().iter().flat_map(|pane| match pane {
                    Pane::Polygon(polygon) => {
                        let pieces = image.scene().polygon(*polygon).pieces();
                        pieces.map(|piece| piece.points().collect()).collect()
                    }
                    Pane::Ring(ring) => vec![ring.clone()],
                });
                let eye = unit.vector(image.viewpoint().eye());
                Some(rings.filter_map(|ring| cone_of(&ring, &eye, unit)).collect())
            }
            _ => None,
        };
        Self { horizon: horizon(image, unit), cones }
    }

    /// 1 for a direction inside, -1 for one outside, 0 for one that may be on the boundary.
    fn side(&self, direction: &Vector) -> i32 {
        let of = |normal: &Vector| sign(&dot(normal, direction));
        let cones = self.cones.as_ref().map(|cones| {
            let sides = cones.iter().map(|cone| cone.iter().map(of).min().unwrap_or(1));
            sides.max().unwrap_or(-1)
        });
        self.horizon.iter().map(of).chain(cones).min().unwrap_or(1)
    }
}

/// The normals to the inside of a convex ring's cone; `None` if it is seen edge-on.
fn cone_of(ring: &[DVec3], eye: &Vector, unit: Unit) -> Option<Vec<Vector>> {
    let from_eye: Vec<Vector> = ring.iter().map(|&p| minus(&unit.vector(p), eye)).collect();
    let normals: Vec<Vector> = (0..ring.len()).map(|k| cross(&from_eye[k], &from_eye[(k + 1) % ring.len()])).collect();
    // All corners are on one side of every side of a convex ring.
    let heights = normals.iter().flat_map(|normal| from_eye.iter().map(|p| sign(&dot(normal, p))));
    match heights.into_iter().find(|&height| height != 0)? {
        1 => Some(normals),
        _ => Some(normals.into_iter().map(|normal| normal.map(|x| -x)).collect()),
    }
}

/// The normal of the domain's horizon, upwards.
fn horizon(image: &ContourImage, unit: Unit) -> Option<Vector> {
    match image.domain().horizon()? {
        Horizon::Normal(normal) => Some(free_vector(normal)),
        Horizon::Surface => {
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
