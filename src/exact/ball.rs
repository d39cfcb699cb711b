//! Ball arithmetic: a number and a proven bound on its error.
//!
//! Used where a quantity is computed once and then kept (planes, constructed points, creases);
//! the predicates' filters build on its bounds.

use super::approx::U;
use std::ops::{Add, Mul, Neg, Sub};

/// A real number within `rad` of `mid`. Anything not finite stands for "unknown".
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) mid: f64,
    pub(crate) rad: f64,
}

/// What the few roundings of a radius can take away is less than this factor gives.
const ROUND_UP: f64 = 1.0 + 16.0 * U;

/// Covers the underflow of a product and of its radius (each below 2^-1074).
const TINY: f64 = f64::MIN_POSITIVE;

/// The least positive number.
const LEAST: f64 = f64::from_bits(1);

impl Ball {
    pub(crate) fn exact(mid: f64) -> Self {
        Self { mid, rad: 0.0 }
    }

    pub(crate) fn new(mid: f64, rad: f64) -> Self {
        Self { mid, rad }
    }

    /// The quotient; unknown if the divisor may be 0.
    ///
    /// `|a/b - m_a/m_b| <= (r_a |m_b| + r_b |m_a|) / (|m_b| (|m_b| - r_b))`.
    pub(crate) fn div(self, divisor: Self) -> Self {
        let least = divisor.mid.abs() - divisor.rad;
        if least.partial_cmp(&TINY) != Some(std::cmp::Ordering::Greater) {
            return Self { mid: 0.0, rad: f64::INFINITY };
        }
        let mid = self.mid / divisor.mid;
        // `least` is rounded: its relative error is at most 2 u |m_b| / least.
        let least = least - 2.0 * U * divisor.mid.abs();
        if least.partial_cmp(&TINY) != Some(std::cmp::Ordering::Greater) {
            return Self { mid: 0.0, rad: f64::INFINITY };
        }
        // A product of radii that underflows loses up to 2^-1075, which the division may blow up.
        let rad = (self.rad + divisor.rad * (mid.abs() * ROUND_UP + TINY) + LEAST) / least;
        Self { mid, rad: (rad + U * mid.abs() + TINY) * ROUND_UP }
    }
}

impl Add for Ball {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let mid = self.mid + other.mid;
        Self { mid, rad: (self.rad + other.rad + U * mid.abs()) * ROUND_UP }
    }
}

impl Neg for Ball {
    type Output = Self;

    fn neg(self) -> Self {
        Self { mid: -self.mid, ..self }
    }
}

impl Sub for Ball {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Ball {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let mid = self.mid * other.mid;
        let rad = self.mid.abs() * other.rad + other.mid.abs() * self.rad + self.rad * other.rad;
        Self { mid, rad: (rad + U * mid.abs() + TINY) * ROUND_UP }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::{Signed, Zero};
    use proptest::prelude::*;

    fn rational(x: f64) -> BigRational {
        BigRational::from_float(x).unwrap()
    }

    fn holds(ball: Ball, value: &BigRational) -> bool {
        !ball.mid.is_finite() || !ball.rad.is_finite() || (value - rational(ball.mid)).abs() <= rational(ball.rad)
    }

    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![
            -10.0..10.0f64,
            any::<i8>().prop_map(f64::from),
            (-1.0..1.0f64, -1060i32..1000).prop_map(|(m, e)| m * 2f64.powi(e)),
        ]
    }

    /// A multiple of the least number, within 2^-1018.
    fn near_denormal() -> impl Strategy<Value = f64> {
        (any::<i64>(), 0..60u32).prop_map(|(m, shift)| (m >> 7 >> shift) as f64 * LEAST)
    }

    #[test]
    fn a_divisor_hardly_larger_than_its_radius_bounds_the_quotient() {
        // Between 2^-50 and 2: the quotient may be 2^50.
        let least = 2f64.powi(-50);
        let quotient = Ball::exact(1.0).div(Ball::new(1.0, 1.0 - least));
        assert!(quotient.rad.is_finite());
        for divisor in [least, 1.0, 2.0 - least] {
            assert!(holds(quotient, &(rational(1.0) / rational(divisor))), "{divisor}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn quotients_of_radii_that_underflow_hold(a in near_denormal(), b in near_denormal(), c in near_denormal()) {
            let from = Ball::exact(a) - Ball::exact(c);
            let to = Ball::exact(b) - Ball::exact(c);
            let exact = rational(a) - rational(b);
            if !exact.is_zero() {
                prop_assert!(holds(from.div(from - to), &((rational(a) - rational(c)) / exact)));
            }
        }

        #[test]
        fn balls_hold_the_true_value(a in number(), b in number(), c in number(), d in number()) {
            let (ra, rb, rc, rd) = (rational(a), rational(b), rational(c), rational(d));
            let ball = (Ball::exact(a) - Ball::exact(b)) * (Ball::exact(c) + Ball::exact(d)) * Ball::exact(c);
            let value = (&ra - &rb) * (&rc + &rd) * &rc;
            prop_assert!(holds(ball, &value));
            let divisor = Ball::exact(d) - Ball::exact(b) * Ball::exact(c);
            let exact = &rd - &rb * &rc;
            if !exact.is_zero() {
                prop_assert!(holds(ball.div(divisor), &(value / exact)));
            }
        }
    }
}
