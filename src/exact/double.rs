//! Double-double arithmetic (Dekker 1971): a number as the unevaluated sum of two `f64`.

use glam::DVec3;
use std::ops::{Add, Mul, Neg, Sub};

/// `hi + lo` with `|lo|` at most half a unit in the last place of `hi`. Sums are off by 2^-104 of the larger term, products by 2^-102 of
/// themselves, for numbers far from over- and underflow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Double {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

impl Double {
    pub(crate) const ZERO: Self = Self { hi: 0.0, lo: 0.0 };

    /// The sum of two numbers of which the first is the larger one, or 0.
    pub(crate) fn sum(hi: f64, lo: f64) -> Self {
        let [hi, lo] = fast_two_sum(hi, lo);
        Self { hi, lo }
    }

    /// The number over a whole number.
    pub(crate) fn over(self, divisor: f64) -> Self {
        let quotient = self.hi / divisor;
        let [product, error] = two_product(quotient, divisor);
        Self::sum(quotient, ((self.hi - product) - error + self.lo) / divisor)
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let [sum, error] = two_sum(self.hi, other.hi);
        let [low, low_error] = two_sum(self.lo, other.lo);
        let [sum, error] = fast_two_sum(sum, error + low);
        Self::sum(sum, error + low_error)
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let [product, error] = two_product(self.hi, other.hi);
        Self::sum(product, error + (self.hi * other.lo + self.lo * other.hi))
    }
}

/// A vector of such numbers.
pub(crate) type Double3 = [Double; 3];

/// `a - b`, exactly.
pub(crate) fn difference(a: DVec3, b: DVec3) -> Double3 {
    [0, 1, 2].map(|k| {
        let [hi, lo] = two_sum(a[k], -b[k]);
        Double { hi, lo }
    })
}

pub(crate) fn minus(a: &Double3, b: &Double3) -> Double3 {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(crate) fn dot(a: &Double3, b: &Double3) -> Double {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: &Double3, b: &Double3) -> Double3 {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

/// a + b as a rounded sum and its error (Knuth).
pub(crate) fn two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let b_part = sum - a;
    [sum, (a - (sum - b_part)) + (b - b_part)]
}

/// The same for |a| >= |b|.
pub(crate) fn fast_two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    [sum, b - (sum - a)]
}

/// a * b as a rounded product and its error (Dekker), for numbers far from over- and underflow.
pub(crate) fn two_product(a: f64, b: f64) -> [f64; 2] {
    let halves = |x: f64| {
        let c = 134_217_729.0 * x;
        let high = c - (c - x);
        [high, x - high]
    };
    let product = a * b;
    let ([ah, al], [bh, bl]) = (halves(a), halves(b));
    [product, al * bl - (((product - ah * bh) - al * bh) - ah * bl)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::Signed;
    use proptest::prelude::*;

    fn rational(x: Double) -> BigRational {
        let part = |x| BigRational::from_float(x).expect("finite");
        part(x.hi) + part(x.lo)
    }

    fn number() -> impl Strategy<Value = Double> {
        (-2.0..2.0f64, -1.0..1.0f64, -40..1).prop_map(|(hi, lo, e)| {
            let hi = hi * 2f64.powi(e);
            Double::sum(hi, lo * hi * f64::EPSILON / 2.0)
        })
    }

    proptest! {
        #[test]
        fn operations_keep_their_stated_errors(a in number(), b in number(), n in 1..10_000u32) {
            let small = |exponent| rational(Double { hi: 2f64.powi(exponent), lo: 0.0 });
            let (x, y) = (rational(a), rational(b));
            let larger = if x.abs() > y.abs() { x.abs() } else { y.abs() };
            prop_assert!((rational(a + b) - (&x + &y)).abs() <= &larger * small(-104));
            prop_assert!((rational(a - b) - (&x - &y)).abs() <= &larger * small(-104));
            prop_assert!((rational(a * b) - &x * &y).abs() <= (&x * &y).abs() * small(-102) + small(-200));
            let n = f64::from(n);
            let quotient = &x / rational(Double { hi: n, lo: 0.0 });
            prop_assert!((rational(a.over(n)) - &quotient).abs() <= quotient.abs() * small(-102) + small(-200));
        }
    }
}
