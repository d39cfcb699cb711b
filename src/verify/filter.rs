//! The first stage of the ray oracle: `f64` with proved error bounds.
//!
//! Below, u = 2^-53, and a rounded operation on x and y gives (x op y)(1 + delta), |delta| <= u,
//! but for products and quotients that underflow, which are off by another 2^-1075 at most.
//! Sums and differences never suffer from underflow.

use crate::exact::Sign;
use glam::DVec3;
use std::cmp::Ordering;

/// A number and how far it can be from the true one; both may be infinite or not a number, which
/// tells nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    value: f64,
    error: f64,
}

impl Estimate {
    /// Estimates det[p, q, r] for three vectors each of whose components is off by a factor of
    /// 1 + delta, |delta| <= u, at most: differences of two exact vectors, or exact ones.
    ///
    /// Each of the six products of the determinant goes through 3 roundings of its factors, 2
    /// multiplications and 3 additions: 8 factors 1 + delta. So the value is off by at most ((1 + u)^8 - 1) S,
    /// S being the sum of the absolute products, and S as computed here is at least (1 - u)^8 S: together
    /// 9 u. The factor of 2^-49 = 16 u covers that. Underflow adds at most 2^-1075 to each product of q
    /// and r, which is then multiplied by a component of p, and to each of three products with
    /// p: (2 |p|_1 + 3) 2^-1075 up to a few u. The term (|p|_1 + 1) 2^-1000, itself safe from underflow,
    /// covers that. If anything overflows then so does S, which is made of the same products with no
    /// signs to cancel: the error is then infinite or not a number.
    pub(super) fn determinant(p: DVec3, q: DVec3, r: DVec3) -> Self {
        let [yz, zy] = [q.y * r.z, q.z * r.y];
        let [zx, xz] = [q.z * r.x, q.x * r.z];
        let [xy, yx] = [q.x * r.y, q.y * r.x];
        let value = p.x * (yz - zy) + p.y * (zx - xz) + p.z * (xy - yx);
        let p = p.abs();
        let sum = p.x * (yz.abs() + zy.abs()) + p.y * (zx.abs() + xz.abs()) + p.z * (xy.abs() + yx.abs());
        Self { value, error: sum * RELATIVE + (p.x + p.y + p.z + 1.0) * ABSOLUTE }
    }

    /// The sign of the true number, if it is certain. It is never found to be zero.
    pub(super) fn sign(self) -> Option<Sign> {
        // Both comparisons are false if the error is infinite or not a number.
        if self.value > self.error {
            Some(Sign::Positive)
        } else if self.value < -self.error {
            Some(Sign::Negative)
        } else {
            None
        }
    }
}

/// 2^-49 and 2^-1000.
const RELATIVE: f64 = f64::from_bits((1023 - 49) << 52);
const ABSOLUTE: f64 = f64::from_bits((1023 - 1000) << 52);

/// An interval that holds how far along a ray a plane is: t = |h| / |v| > 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    low: f64,
    high: f64,
}

impl Depth {
    /// What is known without any estimate.
    pub(super) const UNKNOWN: Self = Self { low: 0.0, high: f64::INFINITY };

    /// From estimates of the plane's height under the eye, h = N . (e - a), and v = N . d, neither of which is zero.
    ///
    /// Each end goes through four roundings, the last one in the product with 1 -+ 2^-48 = 1 -+ 32 u,
    /// which covers them. Ends below 2^-1000, where a quotient may have underflowed, are moved out
    /// to 0 or to 2^-1000.
    pub(super) fn new(h: Estimate, v: Estimate) -> Self {
        let [height, rate] = [h.value.abs(), v.value.abs()];
        let low = (height - h.error) / (rate + v.error) * (1.0 - 2.0 * RELATIVE);
        let high = (height + h.error) / (rate - v.error) * (1.0 + 2.0 * RELATIVE);
        let certain = h.sign().is_some() && v.sign().is_some();
        if !(certain && low.is_finite() && high.is_finite()) {
            return Self::UNKNOWN;
        }
        Self { low: if low > ABSOLUTE { low } else { 0.0 }, high: high.max(ABSOLUTE) }
    }

    /// No more than this far.
    pub(super) fn high(self) -> f64 {
        self.high
    }

    /// Which is nearer, if it is certain.
    pub(super) fn compare(self, other: Self) -> Option<Ordering> {
        if self.high < other.low {
            Some(Ordering::Less)
        } else if other.high < self.low {
            Some(Ordering::Greater)
        } else {
            None
        }
    }
}

/// A ball around a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    centre: DVec3,
    radius: f64,
}

impl Ball {
    /// A ball that holds the points, not the smallest one.
    ///
    /// A distance as computed is off by a few u of itself and the underflow of its squares, less than
    /// 2^-500: the radius is increased by far more.
    pub(super) fn around(points: &[DVec3]) -> Self {
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let centre = low * 0.5 + high * 0.5;
        let radius = points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        Self { centre, radius: radius * (1.0 + MARGIN) + TINY }
    }

    /// True if a ray certainly does not meet the ball, or certainly farther than at t = `end`; `square` is
    /// d . d as computed, and the answer is false unless it is from 2^-400 to 2^400.
    ///
    /// With q = c - e the ray's line is |q x d| / |d| from the centre; the ball lies behind the eye if
    /// q . d < -r |d|, and past the end if q . d - end |d|^2 > r |d|. As computed, products with q are off by
    /// less than 8 u |q| |d|, end |d|^2 by less than 8 u of itself (and it matters only if it is less than
    /// q . d), squares and the limit by less than 8 u of themselves. The limit has r increased by
    /// |q| 2^-40, that is 2^13 u |q|. If anything exceeds it then |q| is more than r, so all those
    /// errors together are less than 64 u |q| |d|, which the margin covers. The ranges keep everything but `end`
    /// from over- and underflow: the increased r is at most 2^200, so |q| <= 2^240 and no square
    /// exceeds 2^900; and products that underflow are off by 2^-1075, against a limit of 2^-400 for |q x d| and
    /// |q . d|. If end |d|^2 overflows, nothing is past the end.
    pub(super) fn is_missed(&self, eye: DVec3, direction: DVec3, square: f64, end: f64) -> bool {
        let q = self.centre - eye;
        let reach = self.radius + (q.x.abs() + q.y.abs() + q.z.abs()) * MARGIN;
        let reach = reach * reach;
        let limit = reach * square;
        let along = q.dot(direction);
        let outside = (-along).max(along - end * square);
        let missed = q.cross(direction).length_squared() > limit || (outside > 0.0 && outside * outside > limit);
        missed && SAFE.contains(&reach) && SAFE.contains(&square)
    }
}

/// 2^-40, 2^-400 and 2^-400..2^400.
const MARGIN: f64 = f64::from_bits((1023 - 40) << 52);
const TINY: f64 = f64::from_bits((1023 - 400) << 52);
const SAFE: std::ops::Range<f64> = TINY..f64::from_bits((1023 + 400) << 52);

#[cfg(test)]
mod tests {
    use super::{Ball, Depth, Estimate};
    use glam::DVec3;
    use num_rational::BigRational;
    use num_traits::Signed;
    use proptest::prelude::*;

    fn exact(x: f64) -> BigRational {
        BigRational::from_float(x).unwrap()
    }

    fn difference(a: DVec3, b: DVec3) -> [BigRational; 3] {
        std::array::from_fn(|k| exact(a[k]) - exact(b[k]))
    }

    fn determinant([a, b, c]: [[BigRational; 3]; 3]) -> BigRational {
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
    }

    /// Vectors with components from all over the range of exponents, or close to one another.
    fn vectors() -> impl Strategy<Value = [DVec3; 4]> {
        let wild = (-1.0..1.0_f64, -1074..1023_i32).prop_map(|(x, e)| x * 2_f64.powi(e));
        let tame = (0..64_u32, -1000..1000_i32)
            .prop_map(|(ulps, e)| (1.0 + f64::from(ulps) * f64::EPSILON) * 2_f64.powi(e / 997));
        let of = |coordinate| prop::array::uniform4(prop::array::uniform3(coordinate).prop_map(DVec3::from));
        // Where products of two or of three components underflow.
        let sinking = (of((-1.0..1.0_f64).boxed()), prop_oneof![-360..-350_i32, -540..-530_i32])
            .prop_map(|(vectors, e)| vectors.map(|v| v * 2_f64.powi(e)));
        prop_oneof![2 => of(prop_oneof![wild, tame.clone(), tame].boxed()), 1 => sinking]
    }

    proptest! {
        #[test]
        fn determinants_are_within_their_error([a, b, c, d] in vectors()) {
            let estimate = Estimate::determinant(a - d, b - d, c);
            if estimate.error.is_finite() {
                let truth = determinant([difference(a, d), difference(b, d), difference(c, DVec3::ZERO)]);
                prop_assert!((truth - exact(estimate.value)).abs() <= exact(estimate.error));
            }
        }

        #[test]
        fn depths_are_within_their_interval([a, b, c, e] in vectors(), direction in vectors()) {
            let direction = direction[0];
            let depth = Depth::new(
                Estimate::determinant(b - a, c - a, e - a),
                Estimate::determinant(b - a, c - a, direction),
            );
            let [height, rate] = [difference(e, a), difference(direction, DVec3::ZERO)]
                .map(|last| determinant([difference(b, a), difference(c, a), last]).abs());
            prop_assert!(exact(depth.low) * &rate <= height);
            prop_assert!(depth.high.is_infinite() || exact(depth.high) * rate >= height);
        }

        #[test]
        fn missed_balls_hold_no_point_of_the_ray(points in vectors(), eye in vectors(), t in 0.0..4.0_f64) {
            // The ray goes through a point of the piece at t = 1, exactly.
            let [eye, aim] = [eye[0], points[0]];
            let direction = aim - eye;
            let is_exact = difference(aim, eye) == difference(direction, DVec3::ZERO);
            let missed = Ball::around(&points).is_missed(eye, direction, direction.length_squared(), t);
            prop_assert!(!missed || !is_exact || t < 1.0);
        }
    }
}
