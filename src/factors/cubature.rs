//! Adaptive cubature over a flat convex polygon of many integrands at once, which all take the same points.
//!
//! A product of Gauss's rules of two points is tried first; where it is too far from the value at the middle, regions are halved, those with the largest
//! estimates first, with the rules of degree 7 and 5 of Genz and Malik ("Remarks on algorithm 006", 1980) in each, until every
//! integrand's estimates sum to no more than what is allowed. A region is halved in the direction in which fourth differences are larger.

use super::element::quads;
use super::rule::{Rule, RulePoint, SUMS, Weights, estimate, halves_first};
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Takes values by columns.
pub(super) type Add<'a> = &'a mut dyn FnMut(u32, f64);

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

/// Means over convex rings, parts of a polygon of that area, of what `look` finds at a point and hands over by columns.
pub(super) struct Cubature<'a, L> {
    pub(super) parts: &'a [Vec<DVec3>],
    pub(super) area: f64,
    /// The error of the mean that each column may have.
    pub(super) allowed: f64,
    pub(super) scratch: &'a mut Scratch,
    pub(super) look: L,
}

impl<L, E> Cubature<'_, L>
where
    L: FnMut(DVec3, Add<'_>) -> Result<(), E>,
{
    /// By 5 points a quadrilateral.
    pub(super) fn by_few(&mut self) -> Result<Means, E> {
        let rule = Rule::first();
        let quads = self.quads();
        let regions = quads.iter().map(|&corners| self.region(corners, &rule)).collect::<Result<Vec<_>, E>>()?;
        Ok(Means { parts: self.sum(&regions) })
    }

    /// By as many points as it takes, though not many more than `most` or than the division has: the estimates tell whether that was enough.
    pub(super) fn adaptive(&mut self, division: Division, most: usize) -> Result<Means, E> {
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
        for quad in division.of(self.quads()) {
            spent = take(self, quad, &mut totals, &mut waiting)?;
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

    fn quads(&self) -> Vec<[DVec3; 4]> {
        self.parts.iter().flat_map(|ring| quads(ring.len()).map(|quad| quad.map(|k| ring[k]))).collect()
    }

    fn region(&mut self, corners: [DVec3; 4], rule: &Rule) -> Result<Region, E> {
        let [a, b, c, d] = corners;
        let Self { area, scratch, look, .. } = self;
        for &RulePoint { at: [u, v], weights, .. } in &rule.points {
            let point = a.lerp(b, u).lerp(d.lerp(c, u), v);
            let density = (b - a).lerp(c - d, v).cross((d - a).lerp(c - b, u)).length() / *area;
            look(point, &mut |column, value| scratch.add(column, weights.map(|weight| weight * density * value)))?;
        }
        let mut differences = [0.0; 2];
        let parts = scratch.take().into_iter().map(|(column, sums)| {
            differences[0] += sums[4].abs();
            differences[1] += sums[5].abs();
            Part { column, value: sums[0], error: estimate(&sums) }
        });
        let parts: Vec<Part> = parts.collect();
        let halve_first = halves_first(corners, differences);
        let worst = parts.iter().fold(0.0, |worst: f64, part| worst.max(part.error));
        Ok(Region { corners, parts, halve_first, worst })
    }

    /// Sums over regions, by ascending column.
    fn sum(&mut self, regions: &[Region]) -> Vec<Part> {
        for part in regions.iter().flat_map(|region| &region.parts) {
            let mut sums = [0.0; SUMS];
            (sums[0], sums[1]) = (part.value, part.error);
            self.scratch.add(part.column, sums);
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

/// How a polygon is divided at first, into quadrilaterals of 25 points each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Division {
    /// Into 4 to this power.
    Alike(u32),
    /// Into layers that come closer and closer to the sides, where what is near in contact with others changes most: 10,000 points.
    TowardsSides,
}

impl Division {
    fn of(self, quads: Vec<[DVec3; 4]>) -> Vec<[DVec3; 4]> {
        match self {
            Self::Alike(halvings) => (0..2 * halvings)
                .fold(quads, |quads, k| quads.into_iter().flat_map(|quad| halves(quad, k % 2 == 0)).collect()),
            Self::TowardsSides => quads.into_iter().flat_map(layers).collect(),
        }
    }
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
pub(super) fn halves([a, b, c, d]: [DVec3; 4], first: bool) -> [[DVec3; 4]; 2] {
    if first {
        let (low, high) = (a.lerp(b, 0.5), d.lerp(c, 0.5));
        [[a, low, high, d], [low, b, c, high]]
    } else {
        let (left, right) = (a.lerp(d, 0.5), b.lerp(c, 0.5));
        [[a, b, right, left], [left, right, c, d]]
    }
}
