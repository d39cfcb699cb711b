//! Adaptive cubature over a flat convex polygon of many integrands at once, which all take the same points.
//!
//! A product of Gauss's rules of two points is tried first; where it is too far from the value at the middle, regions are halved, those with the largest
//! estimates first, with the rules of degree 7 and 5 of Genz and Malik ("Remarks on algorithm 006", 1980) in each, until every
//! integrand's estimates sum to no more than what is allowed. A region is halved in the direction in which fourth differences are larger.

use super::element::quads;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A value of one integrand, or its integral.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    pub(super) column: u32,
    pub(super) value: f64,
    pub(super) error: f64,
}

/// The integrals divided by the area, by ascending column.
#[derive(Debug, Default)]
pub(super) struct Means {
    pub(super) parts: Vec<Part>,
    /// How many points it took.
    pub(super) points: usize,
}

/// A rule on the unit square: points, and weights for the fine and the coarse rule and for the differences in either direction.
struct Rule {
    points: Vec<([f64; 2], [f64; 4])>,
}

impl Rule {
    /// Degree 3, against the middle.
    fn first() -> Self {
        let g = 0.5 / 3.0_f64.sqrt();
        let corners = [[-g, -g], [g, -g], [-g, g], [g, g]];
        let mut points = vec![([0.5; 2], [0.0, 1.0, 0.0, 0.0])];
        points.extend(corners.map(|[u, v]| ([0.5 + u, 0.5 + v], [0.25, 0.0, 0.0, 0.0])));
        Self { points }
    }

    /// Degrees 7 and 5.
    fn genz_malik() -> Self {
        let (l2, l3, l5) = ((9.0_f64 / 70.0).sqrt(), 0.9_f64.sqrt(), (9.0_f64 / 19.0).sqrt());
        let ratio = l2 * l2 / (l3 * l3);
        let at = |u: f64, v: f64| [0.5 + 0.5 * u, 0.5 + 0.5 * v];
        let middle = 2.0 * (ratio - 1.0);
        let mut points = vec![(at(0.0, 0.0), [-3816.0 / 19683.0, -971.0 / 729.0, middle, middle])];
        for sign in [-1.0, 1.0] {
            let near = [980.0 / 6561.0, 245.0 / 486.0];
            points.push((at(sign * l2, 0.0), [near[0], near[1], 1.0, 0.0]));
            points.push((at(0.0, sign * l2), [near[0], near[1], 0.0, 1.0]));
            let far = [1020.0 / 19683.0, 65.0 / 1458.0];
            points.push((at(sign * l3, 0.0), [far[0], far[1], -ratio, 0.0]));
            points.push((at(0.0, sign * l3), [far[0], far[1], 0.0, -ratio]));
            for other in [-1.0, 1.0] {
                points.push((at(sign * l3, other * l3), [200.0 / 19683.0, 25.0 / 729.0, 0.0, 0.0]));
                points.push((at(sign * l5, other * l5), [6859.0 / 19683.0 / 4.0, 0.0, 0.0, 0.0]));
            }
        }
        Self { points }
    }
}

/// A quadrilateral with its integrals.
struct Region {
    corners: [DVec3; 4],
    parts: Vec<Part>,
    /// True if it is to be halved across its first side.
    halve_first: bool,
    worst: f64,
}

impl PartialEq for Region {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Region {}

impl PartialOrd for Region {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Region {
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |region: &Self| region.corners.map(|p| p.to_array());
        // Of equal ones any order that is always the same.
        self.worst.total_cmp(&other.worst).then_with(|| {
            let (a, b) = (key(self), key(other));
            let numbers = a.as_flattened().iter().zip(b.as_flattened());
            numbers.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
        })
    }
}

/// Sums for every column, and which of them are in use.
pub(super) struct Scratch {
    sums: Vec<[f64; 4]>,
    is_used: Vec<bool>,
    used: Vec<u32>,
    totals: Vec<f64>,
}

impl Scratch {
    pub(super) fn new(columns: usize) -> Self {
        let (sums, is_used) = (vec![[0.0; 4]; columns], vec![false; columns]);
        Self { sums, is_used, used: Vec::new(), totals: vec![0.0; columns] }
    }

    fn add(&mut self, column: u32, values: [f64; 4]) {
        let place = column as usize;
        if !self.is_used[place] {
            self.is_used[place] = true;
            self.used.push(column);
        }
        for (sum, value) in self.sums[place].iter_mut().zip(values) {
            *sum += value;
        }
    }

    /// Ends a region; its sums by ascending column.
    fn take(&mut self) -> Vec<(u32, [f64; 4])> {
        self.used.sort_unstable();
        let taken = self.used.iter().map(|&column| {
            self.is_used[column as usize] = false;
            (column, std::mem::take(&mut self.sums[column as usize]))
        });
        let taken = taken.collect();
        self.used.clear();
        taken
    }
}

/// The means over a convex ring of what `look` finds at a point and hands over by columns. `allowed` is the error of the mean of each; no more than about `most` points
/// are taken, and what the estimates are then is told.
pub(super) fn means<E>(
    ring: &[DVec3],
    area: f64,
    allowed: f64,
    most: usize,
    scratch: &mut Scratch,
    mut look: impl FnMut(DVec3, &mut dyn FnMut(u32, f64)) -> Result<(), E>,
) -> Result<Means, E> {
    let whole: Vec<[DVec3; 4]> = quads(ring.len()).map(|quad| quad.map(|k| ring[k])).collect();
    let mut points = 0;
    let mut evaluate = |corners: [DVec3; 4], rule: &Rule, scratch: &mut Scratch| -> Result<Region, E> {
        let [a, b, c, d] = corners;
        for &([u, v], weights) in &rule.points {
            let point = a.lerp(b, u).lerp(d.lerp(c, u), v);
            let density = (b - a).lerp(c - d, v).cross((d - a).lerp(c - b, u)).length() / area;
            look(point, &mut |column, value| scratch.add(column, weights.map(|weight| weight * density * value)))?;
            points += 1;
        }
        let mut differences = [0.0; 2];
        let parts = scratch.take().into_iter().map(|(column, [value, coarse, first, second])| {
            differences[0] += first.abs();
            differences[1] += second.abs();
            Part { column, value, error: (value - coarse).abs() }
        });
        let parts: Vec<Part> = parts.collect();
        let worst = parts.iter().fold(0.0, |worst: f64, part| worst.max(part.error));
        let sizes = [a.distance(b).max(d.distance(c)), a.distance(d).max(b.distance(c))];
        // Where there are no differences, across the longer sides.
        let halve_first = match differences[0].total_cmp(&differences[1]) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal => sizes[0] >= sizes[1],
        };
        Ok(Region { corners, parts, halve_first, worst })
    };
    let first: Vec<Region> =
        whole.iter().map(|&corners| evaluate(corners, &Rule::first(), scratch)).collect::<Result<_, E>>()?;
    let sum = |regions: &mut dyn Iterator<Item = &Region>, scratch: &mut Scratch| {
        for part in regions.flat_map(|region| &region.parts) {
            scratch.add(part.column, [part.value, part.error, 0.0, 0.0]);
        }
        let sums = scratch.take().into_iter();
        sums.map(|(column, [value, error, ..])| Part { column, value, error }).collect::<Vec<_>>()
    };
    let parts = sum(&mut first.iter(), scratch);
    if parts.iter().all(|part| part.error <= allowed) {
        return Ok(Means { parts, points });
    }
    let rule = Rule::genz_malik();
    let mut regions = BinaryHeap::new();
    // How much is estimated for each column, and how many columns have too much.
    let mut touched = Vec::new();
    let mut over = 0usize;
    let mut change = |totals: &mut [f64], part: &Part, sign: f64, over: &mut usize| {
        let total = &mut totals[part.column as usize];
        *over -= usize::from(*total > allowed);
        *total = (*total + sign * part.error).max(0.0);
        *over += usize::from(*total > allowed);
        touched.push(part.column);
    };
    for corners in whole {
        let region = evaluate(corners, &rule, scratch)?;
        region.parts.iter().for_each(|part| change(&mut scratch.totals, part, 1.0, &mut over));
        regions.push(region);
    }
    let mut spent = regions.len() * rule.points.len();
    while over > 0 && spent < most {
        let Some(region) = regions.pop() else { break };
        region.parts.iter().for_each(|part| change(&mut scratch.totals, part, -1.0, &mut over));
        let [a, b, c, d] = region.corners;
        let halves = if region.halve_first {
            let (low, high) = (a.lerp(b, 0.5), d.lerp(c, 0.5));
            [[a, low, high, d], [low, b, c, high]]
        } else {
            let (left, right) = (a.lerp(d, 0.5), b.lerp(c, 0.5));
            [[a, b, right, left], [left, right, c, d]]
        };
        for half in halves {
            let region = evaluate(half, &rule, scratch)?;
            region.parts.iter().for_each(|part| change(&mut scratch.totals, part, 1.0, &mut over));
            regions.push(region);
            spent += rule.points.len();
        }
    }
    touched.iter().for_each(|&column| scratch.totals[column as usize] = 0.0);
    let regions = regions.into_sorted_vec();
    Ok(Means { parts: sum(&mut regions.iter(), scratch), points })
}
