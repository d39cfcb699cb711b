//! Unit directions to twice the precision of `f64`.
//!
//! A cell of angular size 1e-6 whose vertices are rounded to unit vectors of `f64` has lost ten of
//! its sixteen digits before any formula is applied: the rounding of a vertex is 1e-16 of a radian,
//! 1e-10 of the cell. So vertices are normalised in double-double arithmetic (Dekker 1971), and
//! the only thing that is taken from the low parts is the difference of two vertices.

use glam::DVec3;

/// A unit vector as an unevaluated sum of two `f64` vectors; its relative error is below 2^-98.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitDirection {
    hi: DVec3,
    lo: DVec3,
}

impl UnitDirection {
    /// The direction of a vector of any finite length; `None` if it is zero or not finite.
    pub fn new(vector: DVec3) -> Option<Self> {
        Self::from_sum(vector, DVec3::ZERO)
    }

    /// The direction of `hi + lo`, taken as an exact sum, for vertices that are known to more
    /// than `f64` precision: `lo` is at most a few units in the last place of `hi`, component by
    /// component. `None` if the sum is zero or not finite.
    pub fn from_sum(hi: DVec3, lo: DVec3) -> Option<Self> {
        let largest = (hi + lo).abs().max_element();
        if !(largest > 0.0 && hi.is_finite() && lo.is_finite()) {
            return None;
        }
        // The largest component becomes 2^-51 (from a subnormal) to 4: nothing below can overflow,
        // and what underflows is less than 2^-900 of the whole.
        let scale = power_near_inverse(largest);
        let parts = [0, 1, 2].map(|k| two_sum(hi[k] * scale, lo[k] * scale));
        let [inverse, inverse_low] = inverse_length(parts);
        let unit = parts.map(|[h, l]| {
            let [product, error] = two_product(h, inverse);
            fast_two_sum(product, error + (h * inverse_low + l * inverse))
        });
        Some(Self { hi: DVec3::from(unit.map(|[h, _]| h)), lo: DVec3::from(unit.map(|[_, l]| l)) })
    }

    /// The vector rounded to `f64`.
    pub fn rounded(&self) -> DVec3 {
        self.hi
    }

    /// `self - other`, with an error of one unit in its own last place or 1e-31, whichever is more.
    pub(super) fn minus(&self, other: &Self) -> DVec3 {
        (self.hi - other.hi) + (self.lo - other.lo)
    }

    /// The middle of the shorter arc between two directions; `None` if they are antipodal.
    pub(super) fn midpoint(&self, other: &Self) -> Option<Self> {
        let sums = [0, 1, 2].map(|k| {
            let [sum, error] = two_sum(self.hi[k], other.hi[k]);
            [sum, error + (self.lo[k] + other.lo[k])]
        });
        Self::from_sum(DVec3::from(sums.map(|[h, _]| h)), DVec3::from(sums.map(|[_, l]| l)))
    }
}

/// The vertices of a polygon, made fit for the integrals: vectors without a direction and repeated
/// vertices are dropped, and an arc of more than 90 degrees is halved.
pub(super) fn outline(vertices: impl IntoIterator<Item = UnitDirection>) -> Vec<UnitDirection> {
    let mut outline: Vec<UnitDirection> = Vec::new();
    for vertex in vertices {
        match outline.last().copied() {
            Some(last) if last == vertex => {}
            Some(last) => outline.extend(half_way(&last, &vertex).into_iter().chain([vertex])),
            None => outline.push(vertex),
        }
    }
    if let [first, .., last] = outline[..] {
        if first == last {
            outline.pop();
        } else {
            outline.extend(half_way(&last, &first));
        }
    }
    outline
}

/// The middle of an arc of more than 90 degrees.
fn half_way(a: &UnitDirection, b: &UnitDirection) -> Option<UnitDirection> {
    if a.hi.dot(b.hi) < 0.0 { a.midpoint(b) } else { None }
}

/// The arcs of an outline, each as its two ends.
pub(super) fn arcs(outline: &[UnitDirection]) -> impl Iterator<Item = [&UnitDirection; 2]> {
    let next = outline.iter().skip(1).chain(outline.first());
    outline.iter().zip(next).map(|(a, b)| [a, b])
}

/// A power of two that brings a positive finite number into 2^-51..4.
fn power_near_inverse(value: f64) -> f64 {
    let biased = (value.to_bits() >> 52).min(2045);
    f64::from_bits((2046 - biased) << 52)
}

/// 1 / |v| for a vector of double-double components: one Newton step from the `f64` value.
fn inverse_length(parts: [[f64; 2]; 3]) -> [f64; 2] {
    let mut square = 0.0;
    let mut square_low = 0.0;
    for [h, l] in parts {
        let [product, error] = two_product(h, h);
        let [sum, lost] = two_sum(square, product);
        square = sum;
        square_low += error + lost + 2.0 * h * l;
    }
    let inverse = 1.0 / square.sqrt();
    let [s, s_low] = two_product(inverse, inverse);
    let [one, one_low] = two_product(square, s);
    let residual = (1.0 - one) - (one_low + (square * s_low + square_low * s));
    [inverse, 0.5 * inverse * residual]
}

/// a + b as a rounded sum and its error (Knuth).
fn two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let b_part = sum - a;
    [sum, (a - (sum - b_part)) + (b - b_part)]
}

/// The same for |a| >= |b|.
fn fast_two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    [sum, b - (sum - a)]
}

/// a * b as a rounded product and its error (Dekker), for numbers far from over- and underflow.
fn two_product(a: f64, b: f64) -> [f64; 2] {
    let halves = |x: f64| {
        let c = 134_217_729.0 * x;
        let high = c - (c - x);
        [high, x - high]
    };
    let product = a * b;
    let ([ah, al], [bh, bl]) = (halves(a), halves(b));
    [product, al * bl - (((product - ah * bh) - al * bh) - ah * bl)]
}
