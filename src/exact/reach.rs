//! How far away a plane is along directions, in floating point and never too near.

use super::approx::{Approx3, U};
use super::boxes::SeenBox;
use glam::DVec3;

/// A plane seen from a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenPlane {
    normal: Approx3,
    /// At least the height of the point over the plane, in lengths of the true multiple of `normal`.
    height: f64,
}

impl SeenPlane {
    /// The plane with that normal through `on`, seen from `from`.
    pub(crate) fn new(normal: Approx3, on: DVec3, from: DVec3) -> Self {
        Self { normal, height: SeenBox::new(from, on, on).most_height(&normal) }
    }

    /// An upper bound on the distance of the plane along a direction, by the largest component; infinite if they may be parallel.
    ///
    /// With the true normal `n` and direction `x` it is `h max |x| / |n . x|`. The computed dot product is off by at most the sum of the slacks
    /// ([`Approx3::dot_sign`]), which leaves room for what the difference adds; no component of `x` is above that of `v` by more than an eighth of
    /// its slack. Products and quotient add less than `8 u`.
    pub(crate) fn distance(&self, direction: &Approx3) -> f64 {
        let rise = self.normal.v.dot(direction.v).abs() - (self.normal.slack + direction.slack);
        if rise > 0.0 {
            self.height * (direction.v.abs().max_element() + direction.slack) / rise * (1.0 + 16.0 * U)
        } else {
            f64::INFINITY
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use num_traits::{Signed, Zero};
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop_oneof![
            prop::array::uniform3(-4i8..=4).prop_map(|v| DVec3::from(v.map(f64::from))),
            prop::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from),
            (prop::array::uniform3(-1.0..1.0f64), -40i32..40).prop_map(|(v, k)| DVec3::from(v) * 2f64.powi(k)),
        ]
    }

    fn exact(v: DVec3) -> [BigRational; 3] {
        v.to_array().map(|x| BigRational::from_float(x).expect("finite"))
    }

    fn largest(v: &[BigRational; 3]) -> BigRational {
        v.iter().map(Signed::abs).max().expect("three")
    }

    fn dot(a: &[BigRational; 3], b: &[BigRational; 3]) -> BigRational {
        a.iter().zip(b).map(|(a, b)| a * b).fold(BigRational::zero(), |sum, x| sum + x)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4_000))]

        #[test]
        fn planes_are_never_farther_than_told_and_hardly_nearer(
            normal in vector(), on in vector(), from in vector(), direction in vector(), off in vector(), error in 0.0..1e-9f64,
        ) {
            prop_assume!(normal != DVec3::ZERO && direction != DVec3::ZERO);
            // Both are known up to an error.
            let near = |v: DVec3| {
                let size = v.abs().max_element();
                let moved = v + off.clamp(-DVec3::ONE, DVec3::ONE) * (error * size);
                (Approx3::known(v, error * size * 1.01 + 1e-300), exact(moved))
            };
            let ((normal, true_normal), (direction, true_direction)) = (near(normal), near(direction));
            let [exact_on, exact_from] = [on, from].map(exact);
            let height = dot(&true_normal, &[0, 1, 2].map(|k| &exact_on[k] - &exact_from[k]));
            let rise = dot(&true_normal, &true_direction);
            let bound = SeenPlane::new(normal, on, from).distance(&direction);
            prop_assert!(bound >= 0.0);
            if rise.is_zero() {
                prop_assert!(bound.is_infinite());
            } else if bound.is_finite() {
                let distance = height.abs() * largest(&true_direction) / rise.abs();
                let told = BigRational::from_float(bound).expect("finite");
                prop_assert!(told >= distance, "{bound}");
            }
            // Where nothing is nearly parallel and nothing cancels the bound is of use.
            if error == 0.0 || bound.is_infinite() {
                return Ok(());
            }
            let scale = (on.abs() + from.abs()).element_sum();
            let steep = normal.v.dot(direction.v).abs() > 0.1;
            let told = BigRational::from_float(bound).expect("finite");
            let distance = height.abs() * largest(&true_direction) / rise.abs();
            let high = &height * &height > BigRational::from_float(1e-6 * scale * scale).expect("finite") * dot(&true_normal, &true_normal);
            if steep && high {
                // Errors of 1e-9 and a height of a thousandth: far less than twice.
                prop_assert!(told <= distance * BigRational::from_integer(BigInt::from(2)), "{bound}");
            }
        }
    }
}
