//! Visible regions are their cells, merged: by plain integers, and by what else is known of the cells.

use super::tiling::is_within;
use super::{Defect, angle_tolerance};
use crate::contour::{CellId, ContourImage, RegionLoop, Splitter, VisibleRegion};
use crate::exact::Sign;
use crate::scene::{PolygonId, Side};
use crate::testing::integers::{Unit, Vector, cross, dot, sign};
use glam::DVec3;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

type Label = (Option<PolygonId>, Option<Side>);

/// A side of a cell or of a region.
struct Arc {
    inward: Vector,
    /// None of a whole great circle.
    ends: Option<[Vector; 2]>,
}

/// Whether a side is one of a region (or of a cell), whether it runs counter-clockwise about the normal of its great
/// circle, and its ends.
type OnCircle = (bool, bool, Option<[Vector; 2]>);

/// How often a stretch is covered in each direction: by cells, by regions.
#[derive(Clone, Copy, Default)]
struct Cover {
    cells: [i32; 2],
    regions: [i32; 2],
}

/// Checks the visible regions of an image, and gives their number.
///
/// - Every cell is in one region, which shows the same, and regions are connected as
///   [`Cell::neighbours`](crate::contour::Cell::neighbours) says: as far as they can be.
/// - On every stretch of every great circle, exactly, the regions that show a side of a polygon have a boundary where
///   its cells have one on one side only, once and in the same direction, and nowhere else.
/// - Loops are simple, exactly, and what is rounded in them is right.
/// - The area that the loops enclose (Gauss and Bonnet) is the cells' solid angle.
///
/// # Errors
/// The first thing that does not hold.
pub fn check_regions(image: &ContourImage) -> Result<usize, Defect> {
    let regions = image.regions();
    check_cells(image, &regions)?;
    let exact = Exact::new(image);
    let mut arcs: BTreeMap<(Label, Vector), Vec<OnCircle>> = BTreeMap::new();
    let mut add = |label: Label, is_region: bool, arc: Arc| {
        let forward = arc.inward.iter().find(|x| !x.is_zero()).is_some_and(Signed::is_positive);
        let circle = if forward { arc.inward } else { arc.inward.map(|x| -x) };
        arcs.entry((label, circle)).or_default().push((is_region, forward, arc.ends));
    };
    for cell in image.cells() {
        let label = (cell.polygon(), cell.side());
        exact.of_cell(cell.splitters()).into_iter().for_each(|arc| add(label, false, arc));
    }
    for region in &regions {
        let label = (region.polygon(), region.side());
        for boundary in region.loops() {
            exact.of_loop(boundary)?.into_iter().for_each(|arc| add(label, true, arc));
        }
        check_area(image, &exact, region)?;
    }
    for ((label, circle), arcs) in &arcs {
        for Cover { cells: [forward, backward], regions } in covers(circle, arcs) {
            let expected = [forward - forward * backward, backward - forward * backward];
            if forward > 1 || backward > 1 || regions != expected {
                let what = format!(
                    "on the great circle {circle:?} the cells of {label:?} have {forward} and {backward} sides, its regions {regions:?}"
                );
                return Err(Defect::Regions { what });
            }
        }
    }
    Ok(regions.len())
}

/// Checks that two images have the same regions, as exact loops, in whatever order.
///
/// # Errors
/// If they have not.
pub fn check_same_regions(first: &ContourImage, second: &ContourImage) -> Result<(), Defect> {
    let [a, b] = [first, second].map(|image| -> Result<Vec<_>, Defect> {
        let exact = Exact::new(image);
        let regions = image.regions();
        let mut named = Vec::with_capacity(regions.len());
        for region in &regions {
            let mut loops: Vec<_> = region.loops().iter().map(|boundary| exact.canonical(boundary)).collect();
            loops.sort();
            named.push(((region.polygon(), region.side()), loops));
        }
        named.sort();
        Ok(named)
    });
    let (a, b) = (a?, b?);
    if a == b {
        return Ok(());
    }
    let differs = a.iter().find(|region| !b.contains(region)).or_else(|| b.iter().find(|region| !a.contains(region)));
    Err(Defect::Regions { what: format!("{} and {} of them, only in one: {differs:?}", a.len(), b.len()) })
}

fn fail<T>(what: String) -> Result<T, Defect> {
    Err(Defect::Regions { what })
}

fn check_cells(image: &ContourImage, regions: &[VisibleRegion]) -> Result<(), Defect> {
    let mut region_of = vec![None; image.cell_count()];
    for (k, region) in regions.iter().enumerate() {
        for &id in region.cells() {
            let cell = image.cell(id);
            if region_of[id.index()].replace(k).is_some() {
                return fail(format!("{id:?} is in two regions"));
            }
            if (cell.polygon(), cell.side()) != (region.polygon(), region.side()) {
                return fail(format!("{id:?} shows something else than its region"));
            }
        }
    }
    if let Some(k) = region_of.iter().position(Option::is_none) {
        return fail(format!("cell {k} is in no region"));
    }
    for (k, region) in regions.iter().enumerate() {
        let mut reached: BTreeSet<CellId> = BTreeSet::new();
        let mut stack: Vec<CellId> = region.cells().first().copied().into_iter().collect();
        while let Some(id) = stack.pop() {
            if !reached.insert(id) {
                continue;
            }
            let across = image.cell(id).neighbours().into_iter().filter_map(|neighbour| neighbour.cell);
            stack.extend(across.filter(|&other| {
                let other = image.cell(other);
                (other.polygon(), other.side()) == (region.polygon(), region.side())
            }));
        }
        if reached.iter().copied().ne(region.cells().iter().copied()) {
            return fail(format!("region {k} has the cells {:?}, but connected are {reached:?}", region.cells()));
        }
    }
    Ok(())
}

/// The plane area of each loop by its turns, then of what is on the left of all: what is on the right of two of them is
/// apart.
fn check_area(image: &ContourImage, exact: &Exact<'_>, region: &VisibleRegion) -> Result<(), Defect> {
    let mut area = 4.0 * PI;
    let mut sides = 0;
    for boundary in region.loops() {
        let normals: Vec<DVec3> =
            boundary.sides().iter().map(|s| rounded(&exact.inward(s.splitter, s.inside))).collect();
        let turns = boundary.sides().iter().enumerate().map(|(k, side)| {
            let (m, n) = (normals[(k + normals.len() - 1) % normals.len()], normals[k]);
            match side.turn {
                Sign::Positive => m.cross(n).length().atan2(m.dot(n)),
                Sign::Negative => -m.cross(n).length().atan2(m.dot(n)),
                Sign::Zero => 0.0,
            }
        });
        area += TAU - turns.sum::<f64>() - 4.0 * PI;
        sides += normals.len();
    }
    let expected: f64 = region.cells().iter().map(|&id| image.cell(id).solid_angle()).sum();
    let tolerance = angle_tolerance(region.cells().iter().map(|&id| image.cell(id))) + 1e-14 * (sides as f64 + 8.0);
    if is_within(area, expected, tolerance) && is_within(region.solid_angle(image), expected, tolerance) {
        return Ok(());
    }
    fail(format!("the loops of {:?} enclose {area} sr, its cells have {expected} sr", region.polygon()))
}

/// Exact normals and corners of one view.
struct Exact<'a> {
    image: &'a ContourImage,
    unit: Unit,
}

impl<'a> Exact<'a> {
    fn new(image: &'a ContourImage) -> Self {
        Self { image, unit: Unit::of_image(image) }
    }

    fn inward(&self, splitter: Splitter, inside: Sign) -> Vector {
        let normal = self.unit.splitter(self.image.scene(), self.image.viewpoint().eye(), &splitter);
        primitive(if inside.is_negative() { normal.map(|x| -x) } else { normal })
    }

    /// The sides of a convex cell, those that continue each other as one.
    fn of_cell(&self, sides: impl Iterator<Item = (Splitter, Sign)>) -> Vec<Arc> {
        let mut inward: Vec<Vector> = sides.map(|(splitter, inside)| self.inward(splitter, inside)).collect();
        inward.dedup();
        while inward.len() > 1 && inward.first() == inward.last() {
            inward.pop();
        }
        let corner = |k: usize| {
            let k = k % inward.len();
            primitive(cross(&inward[(k + inward.len() - 1) % inward.len()], &inward[k]))
        };
        (0..inward.len()).map(|k| Arc { inward: inward[k].clone(), ends: Some([corner(k), corner(k + 1)]) }).collect()
    }

    /// The sides of a loop, which is simple and has its rounded numbers right.
    fn of_loop(&self, boundary: &RegionLoop) -> Result<Vec<Arc>, Defect> {
        let sides = boundary.sides();
        let inward: Vec<Vector> = sides.iter().map(|side| self.inward(side.splitter, side.inside)).collect();
        if let ([inward], [side]) = (inward.as_slice(), sides) {
            if side.turn != Sign::Zero || !is_within(side.length, TAU, 1e-9) {
                return fail(format!("a whole great circle has a corner, or the length {}", side.length));
            }
            return Ok(vec![Arc { inward: inward.clone(), ends: None }]);
        }
        let mut corners = Vec::with_capacity(sides.len());
        for (k, side) in sides.iter().enumerate() {
            let (m, n) = (&inward[(k + sides.len() - 1) % sides.len()], &inward[k]);
            let corner = primitive(match side.turn {
                Sign::Positive => cross(m, n),
                Sign::Negative => cross(n, m),
                Sign::Zero => return fail(format!("no turn at side {k} of {boundary:?}")),
            });
            if rounded(&corner).distance(side.from) > 1e-12 {
                return fail(format!("side {k} starts at {}, not at {}", rounded(&corner), side.from));
            }
            corners.push(corner);
        }
        if corners.iter().collect::<BTreeSet<_>>().len() < corners.len() {
            return fail(format!("a loop passes a point twice: {boundary:?}"));
        }
        let arcs = (0..sides.len()).map(|k| Arc {
            inward: inward[k].clone(),
            ends: Some([corners[k].clone(), corners[(k + 1) % corners.len()].clone()]),
        });
        let arcs: Vec<Arc> = arcs.collect();
        for (arc, side) in arcs.iter().zip(sides) {
            let Some(ends) = &arc.ends else { continue };
            let [p, q] = ends.each_ref().map(rounded);
            let angle = rounded(&arc.inward).dot(p.cross(q)).atan2(p.dot(q));
            let off = (side.length - angle).rem_euclid(TAU);
            // A side may go all around but for less than the rounding of the sum of its stretches.
            if off.min(TAU - off) > 1e-9 || side.length > TAU + 1e-9 {
                return fail(format!("a side is {} long, not {angle} or a turn more", side.length));
            }
        }
        Ok(arcs)
    }

    /// The inward normals and turns of a loop, from the least on.
    fn canonical(&self, boundary: &RegionLoop) -> Vec<(Vector, i32)> {
        let turn = |sign: Sign| i32::from(sign.is_positive()) - i32::from(sign.is_negative());
        let sides = boundary.sides().iter().map(|side| (self.inward(side.splitter, side.inside), turn(side.turn)));
        let sides: Vec<_> = sides.collect();
        let rotated = (0..sides.len()).map(|k| [&sides[k..], &sides[..k]].concat());
        rotated.min().unwrap_or_default()
    }
}

/// Without a common divisor: vectors of one direction become equal.
fn primitive(v: Vector) -> Vector {
    let divisor = v.iter().fold(BigInt::zero(), |all, x| all.gcd(x));
    if divisor.is_zero() { v } else { v.map(|x| x / &divisor) }
}

/// The unit vector.
fn rounded(v: &Vector) -> DVec3 {
    let bits = v.iter().map(BigInt::bits).max().unwrap_or(0);
    let shifted = |x: &BigInt| if bits > 900 { x >> (bits - 900) } else { x.clone() };
    let v = DVec3::from(v.each_ref().map(|x| shifted(x).to_f64().unwrap_or(0.0)));
    (v / v.abs().max_element()).normalize_or_zero()
}

/// Counts for every stretch between neighbouring ends.
fn covers(circle: &Vector, arcs: &[OnCircle]) -> Vec<Cover> {
    let mut places: Vec<&Vector> = arcs.iter().filter_map(|arc| arc.2.as_ref()).flatten().collect();
    let Some(&first) = places.first() else {
        let mut cover = Cover::default();
        for &(is_region, forward, _) in arcs {
            count(&mut cover, is_region, forward);
        }
        return vec![cover];
    };
    let ahead = |p: &Vector, q: &Vector| sign(&dot(circle, &cross(p, q)));
    let half = |q: &Vector| match ahead(first, q) {
        1 => 1,
        -1 => 3,
        _ if dot(first, q).is_positive() => 0,
        _ => 2,
    };
    places.sort_by(|p, q| half(p).cmp(&half(q)).then_with(|| 0.cmp(&ahead(p, q))));
    places.dedup();
    let mut covers = vec![Cover::default(); places.len()];
    for (is_region, forward, ends) in arcs {
        let Some([from, to]) = ends else {
            for cover in &mut covers {
                count(cover, *is_region, *forward);
            }
            continue;
        };
        let place = |p: &Vector| {
            let order = |q: &&Vector| half(q).cmp(&half(p)).then_with(|| 0.cmp(&ahead(q, p)));
            places.binary_search_by(order).unwrap_or_else(|k| k)
        };
        let [from, to] = if *forward { [from, to] } else { [to, from] }.map(place);
        let mut k = from;
        while k != to {
            count(&mut covers[k], *is_region, *forward);
            k = (k + 1) % covers.len();
        }
    }
    covers
}

fn count(cover: &mut Cover, is_region: bool, forward: bool) {
    let counts = if is_region { &mut cover.regions } else { &mut cover.cells };
    counts[usize::from(!forward)] += 1;
}
