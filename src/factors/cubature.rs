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
}

/// What is summed over the points of a rule.
const SUMS: usize = 6;
type Weights = [f64; SUMS];

/// A rule on the unit square: points, with weights for the rule itself, for two or three others of lower degrees, and for differences in either direction.
struct Rule {
    points: Vec<([f64; 2], Weights)>,
}

impl Rule {
    /// Degree 3, against the middle.
    fn first() -> Self {
        let g = 0.5 / 3.0_f64.sqrt();
        let corners = [[-g, -g], [g, -g], [-g, g], [g, g]];
        let mut points = vec![([0.5; 2], [0.0, 1.0, 1.0, 1.0, 0.0, 0.0])];
        points.extend(corners.map(|[u, v]| ([0.5 + u, 0.5 + v], [0.25, 0.0, 0.0, 0.0, 0.0, 0.0])));
        Self { points }
    }

    /// Degrees 7, 5, and 3 twice.
    fn genz_malik() -> Self {
        let (l2, l3, l5) = ((9.0_f64 / 70.0).sqrt(), 0.9_f64.sqrt(), (9.0_f64 / 19.0).sqrt());
        let ratio = l2 * l2 / (l3 * l3);
        let at = |u: f64, v: f64| [0.5 + 0.5 * u, 0.5 + 0.5 * v];
        let middle = 2.0 * (ratio - 1.0);
        // Of degree 3: four points that have a mean square of 1 / 3 with the middle.
        let (cross, square) = (1.0 / (6.0 * l3 * l3), 1.0 / (12.0 * l5 * l5));
        let weights = [-3816.0 / 19683.0, -971.0 / 729.0, 1.0 - 4.0 * cross, 1.0 - 4.0 * square, middle, middle];
        let mut points = vec![(at(0.0, 0.0), weights)];
        for sign in [-1.0, 1.0] {
            let near = [980.0 / 6561.0, 245.0 / 486.0, 0.0, 0.0];
            points.push((at(sign * l2, 0.0), [near[0], near[1], near[2], near[3], 1.0, 0.0]));
            points.push((at(0.0, sign * l2), [near[0], near[1], near[2], near[3], 0.0, 1.0]));
            let far = [1020.0 / 19683.0, 65.0 / 1458.0, cross, 0.0];
            points.push((at(sign * l3, 0.0), [far[0], far[1], far[2], far[3], -ratio, 0.0]));
            points.push((at(0.0, sign * l3), [far[0], far[1], far[2], far[3], 0.0, -ratio]));
            for other in [-1.0, 1.0] {
                points.push((at(sign * l3, other * l3), [200.0 / 19683.0, 25.0 / 729.0, 0.0, 0.0, 0.0, 0.0]));
                points.push((at(sign * l5, other * l5), [6859.0 / 19683.0 / 4.0, 0.0, 0.0, square, 0.0, 0.0]));
            }
        }
        Self { points }
    }
}

/// An estimate of a rule's error from what rules of lower degrees give (after Berntsen and Espelid, "Error estimation in automatic quadrature routines", 1991).
///
/// Where the differences fall off steeply from degree to degree the integrand is smooth, and a part of the larger ones is much more than the
/// error. Where they do not, it has a kink: all rules are about equally wrong, and one of their differences may be small by chance, along the whole of an edge's
/// shadow, but hardly two of them.
fn estimate([value, fifth, third, other]: [f64; 4]) -> f64 {
    let near = (value - fifth).abs();
    let far = (value - third).abs().max((value - other).abs());
    if near <= 0.02 * far { 0.1 * far } else { (2.0 * near).max(far) }
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
    sums: Vec<Weights>,
    is_used: Vec<bool>,
    used: Vec<u32>,
    totals: Vec<f64>,
}

impl Scratch {
    pub(super) fn new(columns: usize) -> Self {
        let (sums, is_used) = (vec![[0.0; SUMS]; columns], vec![false; columns]);
        Self { sums, is_used, used: Vec::new(), totals: vec![0.0; columns] }
    }

    fn add(&mut self, column: u32, values: Weights) {
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
    fn take(&mut self) -> Vec<(u32, Weights)> {
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

/// Means over a convex ring of what `look` finds at a point and hands over by columns.
pub(super) struct Cubature<'a, L> {
    pub(super) ring: &'a [DVec3],
    pub(super) area: f64,
    /// The error of the mean that each column may have.
    pub(super) allowed: f64,
    pub(super) scratch: &'a mut Scratch,
    pub(super) look: L,
}

impl<L, E> Cubature<'_, L>
where
    L: FnMut(DVec3, &mut dyn FnMut(u32, f64)) -> Result<(), E>,
{
    /// By a fixed number of points.
    pub(super) fn fixed(&mut self, division: Division) -> Result<Means, E> {
        let mut parts: Vec<[DVec3; 4]> = quads(self.ring.len()).map(|quad| quad.map(|k| self.ring[k])).collect();
        let rule = if matches!(division, Division::None) { Rule::first() } else { Rule::genz_malik() };
        match division {
            Division::None => {}
            Division::Alike(halvings) => {
                for _ in 0..halvings {
                    for first in [true, false] {
                        parts = parts.into_iter().flat_map(|part| halves(part, first)).collect();
                    }
                }
            }
            Division::TowardsSides => parts = parts.into_iter().flat_map(layers).collect(),
        }
        let regions = parts.iter().map(|&corners| self.region(corners, &rule)).collect::<Result<Vec<_>, E>>()?;
        Ok(Means { parts: self.sum(&regions) })
    }

    /// By as many points as it takes, though not many more than `most`: the estimates tell whether that was enough.
    pub(super) fn adaptive(&mut self, most: usize) -> Result<Means, E> {
        let rule = Rule::genz_malik();
        let mut waiting = BinaryHeap::new();
        let mut totals = Totals { allowed: self.allowed, over: 0, touched: Vec::new() };
        let mut points = 0;
        let mut take = |this: &mut Self, corners: [DVec3; 4], totals: &mut Totals, waiting: &mut BinaryHeap<Region>| {
            let region = this.region(corners, &rule)?;
            region.parts.iter().for_each(|part| totals.add(&mut this.scratch.totals, part.column, part.error));
            waiting.push(region);
            points += rule.points.len();
            Ok::<usize, E>(points)
        };
        let mut spent = 0;
        for quad in quads(self.ring.len()) {
            spent = take(self, quad.map(|k| self.ring[k]), &mut totals, &mut waiting)?;
        }
        while totals.over > 0 && spent < most {
            let Some(region) = waiting.pop() else { break };
            region.parts.iter().for_each(|part| totals.add(&mut self.scratch.totals, part.column, -part.error));
            for half in halves(region.corners, region.halve_first) {
                spent = take(self, half, &mut totals, &mut waiting)?;
            }
        }
        totals.touched.iter().for_each(|&column| self.scratch.totals[column as usize] = 0.0);
        let regions = waiting.into_sorted_vec();
        Ok(Means { parts: self.sum(&regions) })
    }

    fn region(&mut self, corners: [DVec3; 4], rule: &Rule) -> Result<Region, E> {
        let [a, b, c, d] = corners;
        let Self { area, scratch, look, .. } = self;
        for &([u, v], weights) in &rule.points {
            let point = a.lerp(b, u).lerp(d.lerp(c, u), v);
            let density = (b - a).lerp(c - d, v).cross((d - a).lerp(c - b, u)).length() / *area;
            look(point, &mut |column, value| scratch.add(column, weights.map(|weight| weight * density * value)))?;
        }
        let mut differences = [0.0; 2];
        let parts = scratch.take().into_iter().map(|(column, [value, fifth, third, other, first, second])| {
            differences[0] += first.abs();
            differences[1] += second.abs();
            Part { column, value, error: estimate([value, fifth, third, other]) }
        });
        let parts: Vec<Part> = parts.collect();
        let sizes = [a.distance(b).max(d.distance(c)), a.distance(d).max(b.distance(c))];
        // Where there are no differences, across the longer sides.
        let halve_first = match differences[0].total_cmp(&differences[1]) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal => sizes[0] >= sizes[1],
        };
        let worst = parts.iter().fold(0.0, |worst: f64, part| worst.max(part.error));
        Ok(Region { corners, parts, halve_first, worst })
    }

    /// Sums over regions, by ascending column.
    fn sum(&mut self, regions: &[Region]) -> Vec<Part> {
        for part in regions.iter().flat_map(|region| &region.parts) {
            self.scratch.add(part.column, [part.value, part.error, 0.0, 0.0, 0.0, 0.0]);
        }
        let sums = self.scratch.take().into_iter();
        sums.map(|(column, [value, error, ..])| Part { column, value, error }).collect()
    }
}

/// Counts the columns whose estimates sum to more than what is allowed.
struct Totals {
    allowed: f64,
    over: usize,
    touched: Vec<u32>,
}

impl Totals {
    fn add(&mut self, totals: &mut [f64], column: u32, error: f64) {
        let total = &mut totals[column as usize];
        self.over -= usize::from(*total > self.allowed);
        *total = (*total + error).max(0.0);
        self.over += usize::from(*total > self.allowed);
        self.touched.push(column);
    }
}

/// How a polygon is divided for a fixed number of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Division {
    /// Not at all: 5 points a quadrilateral.
    None,
    /// Into 4 to this power: 17 points each.
    Alike(u32),
    /// Into layers that come closer and closer to the sides, where what is near in contact with others changes most: some 8,000 points.
    TowardsSides,
}

/// A quadrilateral in layers towards its sides, each half as thick as the one before.
fn layers([a, b, c, d]: [DVec3; 4]) -> Vec<[DVec3; 4]> {
    const LAYERS: i32 = 10;
    let low: Vec<f64> = std::iter::once(0.0).chain((1..=LAYERS).rev().map(|k| 0.5_f64.powi(k))).collect();
    let high = low.iter().rev().skip(1).map(|x| 1.0 - x);
    let places: Vec<f64> = low.iter().copied().chain(high).collect();
    let at = |u: f64, v: f64| a.lerp(b, u).lerp(d.lerp(c, u), v);
    let cells = places.windows(2).flat_map(|v| places.windows(2).map(move |u| (u, v)));
    cells.map(|(u, v)| [at(u[0], v[0]), at(u[1], v[0]), at(u[1], v[1]), at(u[0], v[1])]).collect()
}

/// The halves of a quadrilateral, cut across its first or its second side.
fn halves([a, b, c, d]: [DVec3; 4], first: bool) -> [[DVec3; 4]; 2] {
    if first {
        let (low, high) = (a.lerp(b, 0.5), d.lerp(c, 0.5));
        [[a, low, high, d], [low, b, c, high]]
    } else {
        let (left, right) = (a.lerp(d, 0.5), b.lerp(c, 0.5));
        [[a, b, right, left], [left, right, c, d]]
    }
}
