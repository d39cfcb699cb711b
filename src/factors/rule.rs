//! Rules of cubature over a quadrilateral, and what their errors are taken to be.

use glam::DVec3;
use std::cmp::Ordering;

/// What is summed over the points of a rule: the rule itself, three others of lower degrees, differences in either direction, and what values next to the middles of
/// sides and to corners differ by from what the others foretell.
pub(super) const SUMS: usize = 14;
const SIDES: usize = 6;
const CORNERS: usize = 10;
pub(super) type Weights = [f64; SUMS];

/// Where values next to sides are taken, of -1 to 1: on the sides themselves one may be in the plane of what is seen.
const BESIDE: f64 = 0.999;

/// A rule on the unit square.
pub(super) struct Rule {
    pub(super) points: Vec<RulePoint>,
}

pub(super) struct RulePoint {
    pub(super) at: [f64; 2],
    pub(super) weights: Weights,
    /// The sum that it is for, if that compares its value with what those inside foretell.
    look: Option<usize>,
}

/// Which sides of a part of a quadrilateral are sides of that: those where the first coordinate and the second are lowest, and highest. Beside the others, other parts have points.
#[derive(Clone, Copy)]
pub(super) struct Outer {
    low: [bool; 2],
    high: [bool; 2],
}

impl Outer {
    pub(super) const ALL: Self = Self { low: [true; 2], high: [true; 2] };

    /// Of the halves of a part, see [`halves`].
    pub(super) fn halves(self, first: bool) -> [Self; 2] {
        let axis = usize::from(!first);
        let mut halves = [self; 2];
        halves[0].high[axis] = false;
        halves[1].low[axis] = false;
        halves
    }

    /// True if there is something to look for beside the side or the corner of a sum.
    fn looks(self, sum: usize) -> bool {
        const SIDES_OF: [[usize; 2]; 8] = [[0, 0], [1, 1], [2, 2], [3, 3], [0, 2], [1, 3], [0, 3], [1, 2]];
        let Self { low, high } = self;
        let sides = [low[0], high[0], low[1], high[1]];
        SIDES_OF[sum - SIDES].iter().all(|&side| sides[side])
    }
}

impl Rule {
    /// Degree 3, against the middle.
    pub(super) fn first() -> Self {
        let g = 1.0 / 3.0_f64.sqrt();
        let mut rule = Self { points: Vec::new() };
        rule.add([0.0, 0.0], &[(1, 1.0), (2, 1.0), (3, 1.0)]);
        for [u, v] in [[-g, -g], [g, -g], [-g, g], [g, g]] {
            rule.add([u, v], &[(0, 0.25)]);
        }
        rule
    }

    /// Degrees 7, 5, and 3 twice.
    pub(super) fn genz_malik() -> Self {
        let (l2, l3, l5) = ((9.0_f64 / 70.0).sqrt(), 0.9_f64.sqrt(), (9.0_f64 / 19.0).sqrt());
        let ratio = l2 * l2 / (l3 * l3);
        // Of degree 3: four points that have a mean square of 1 / 3 with the middle.
        let (cross, square) = (1.0 / (6.0 * l3 * l3), 1.0 / (12.0 * l5 * l5));
        let mut rule = Self { points: Vec::new() };
        let middle = [-3816.0 / 19683.0, -971.0 / 729.0, 1.0 - 4.0 * cross, 1.0 - 4.0 * square];
        let bend = 2.0 * (ratio - 1.0);
        rule.add([0.0, 0.0], &[(0, middle[0]), (1, middle[1]), (2, middle[2]), (3, middle[3]), (4, bend), (5, bend)]);
        for sign in [-1.0, 1.0] {
            for axis in 0..2 {
                let at = |t: f64| if axis == 0 { [t, 0.0] } else { [0.0, t] };
                rule.add(at(sign * l2), &[(0, 980.0 / 6561.0), (1, 245.0 / 486.0), (4 + axis, 1.0)]);
                rule.add(at(sign * l3), &[(0, 1020.0 / 19683.0), (1, 65.0 / 1458.0), (2, cross), (4 + axis, -ratio)]);
            }
            for other in [-1.0, 1.0] {
                rule.add([sign * l3, other * l3], &[(0, 200.0 / 19683.0), (1, 25.0 / 729.0)]);
                rule.add([sign * l5, other * l5], &[(0, 6859.0 / 19683.0 / 4.0), (3, square)]);
            }
        }
        // The fourth-degree polynomials along the axes and the diagonals, at their ends.
        for (number, sign) in [-1.0, 1.0].into_iter().enumerate() {
            rule.foretell(SIDES + number, [sign, 0.0], [l2, l3]);
            rule.foretell(SIDES + 2 + number, [0.0, sign], [l2, l3]);
            rule.foretell(CORNERS + number, [sign, sign], [l5, l3]);
            rule.foretell(CORNERS + 2 + number, [sign, -sign], [l5, l3]);
        }
        rule
    }

    /// Adds weights to a point of -1 to 1 squared.
    fn add(&mut self, [u, v]: [f64; 2], weights: &[(usize, f64)]) {
        let at = [0.5 + 0.5 * u, 0.5 + 0.5 * v];
        let known = self.points.iter().position(|point| point.at.map(f64::to_bits) == at.map(f64::to_bits));
        let place = known.unwrap_or_else(|| {
            self.points.push(RulePoint { at, weights: [0.0; SUMS], look: None });
            self.points.len() - 1
        });
        for &(sum, weight) in weights {
            self.points[place].weights[sum] += weight;
        }
    }

    /// Makes a sum of what the value at the end of a ray through the middle differs by from what those on its line foretell, at 0 and at these
    /// distances in both directions (Lagrange).
    fn foretell(&mut self, sum: usize, [u, v]: [f64; 2], [near, far]: [f64; 2]) {
        let nodes = [-far, -near, 0.0, near, far];
        for (k, node) in nodes.iter().enumerate() {
            let others = nodes.iter().enumerate().filter(|&(other, _)| other != k);
            let weight: f64 = others.map(|(_, other)| (BESIDE - other) / (node - other)).product();
            self.add([u * node, v * node], &[(sum, weight)]);
        }
        let known = self.points.len();
        self.add([u * BESIDE, v * BESIDE], &[(sum, -1.0)]);
        self.points.iter_mut().skip(known).for_each(|point| point.look = Some(sum));
    }
}

/// What a rule tells of one integrand over a quadrilateral.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// The integral divided by the given area.
    pub(super) value: f64,
    pub(super) error: f64,
    /// True if the quadrilateral is to be halved across its first side.
    pub(super) halve_first: bool,
    /// True if it changes about as much across both.
    pub(super) is_even: bool,
}

/// Differences along both sides are about as large if neither is below this part of the other.
const EVEN: f64 = 0.25;

impl Rule {
    /// How many points it takes.
    pub(super) fn count(&self) -> usize {
        self.points.len()
    }

    /// Of a part, with looks beside its outer sides and corners.
    pub(super) fn sample(
        &self,
        corners: [DVec3; 4],
        outer: Outer,
        area: f64,
        mut f: impl FnMut(DVec3) -> f64,
    ) -> Sample {
        let [a, b, c, d] = corners;
        let mut sums = [0.0; SUMS];
        for &RulePoint { at: [u, v], weights, .. } in
            self.points.iter().filter(|point| point.look.is_none_or(|sum| outer.looks(sum)))
        {
            let density = (b - a).lerp(c - d, v).cross((d - a).lerp(c - b, u)).length() / area;
            let value = f(a.lerp(b, u).lerp(d.lerp(c, u), v)) * density;
            sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * value);
        }
        (SIDES..SUMS).filter(|&sum| !outer.looks(sum)).for_each(|sum| sums[sum] = 0.0);
        let [first, second] = [sums[4].abs(), sums[5].abs()];
        let halve_first = halves_first(corners, [first, second]);
        let is_even = first.min(second) >= EVEN * first.max(second);
        Sample { value: sums[0], error: estimate(&sums), halve_first, is_even }
    }
}

/// Whether a quadrilateral is halved across its first side, by the differences along either.
pub(super) fn halves_first([a, b, c, d]: [DVec3; 4], differences: [f64; 2]) -> bool {
    let sizes = [a.distance(b).max(d.distance(c)), a.distance(d).max(b.distance(c))];
    // Where there are no differences, across the longer sides.
    match differences[0].total_cmp(&differences[1]) {
        Ordering::Greater => true,
        Ordering::Less => false,
        Ordering::Equal => sizes[0] >= sizes[1],
    }
}

/// An estimate of a rule's error from what rules of lower degrees give (after Berntsen and Espelid, "Error estimation in automatic quadrature routines", 1991).
///
/// Where the differences fall off steeply from degree to degree the integrand is smooth, and a part of the larger ones is much more than the
/// error. Where they do not, it has a kink: all rules are about equally wrong, and one of their differences may be small by chance, along the whole of an edge's
/// shadow, but hardly two of them.
///
/// What casts its shadow on less than a fortieth of the width along a side, or on a corner, is not seen by any of the rules' points: there the
/// integrand falls off from what they foretell, over half of that width on average.
pub(super) fn estimate(sums: &Weights) -> f64 {
    let [value, fifth, third, other, ..] = *sums;
    let near = (value - fifth).abs();
    let far = (value - third).abs().max((value - other).abs());
    let inside = if near <= 0.02 * far { 0.1 * far } else { (2.0 * near).max(far) };
    let most = |sums: &[f64]| sums.iter().fold(0.0, |most: f64, sum| most.max(sum.abs()));
    inside.max(most(&sums[SIDES..CORNERS]) / 40.0).max(most(&sums[CORNERS..]) / 200.0)
}
