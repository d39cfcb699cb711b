//! Dunavant's rule of degree 8 and its null rules.

use super::Smoothness;
use glam::DVec3;
use std::sync::LazyLock;

/// Points of the rule.
pub(super) const POINTS: usize = 16;
/// Degrees to which there are null rules.
const DEGREES: usize = 4;
/// Polynomials of those degrees.
const BASIS: usize = (DEGREES + 1) * (DEGREES + 2) / 2;
/// What rounding may leave of a sum, as a part of it.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A rule on the triangle (0, 0), (1, 0), (0, 1) whose weights sum to 1, with the orthonormal polynomials of its own inner product.
pub(super) struct Rule {
    pub(super) points: [[f64; 2]; POINTS],
    weights: [f64; POINTS],
    /// For each polynomial, by ascending degree, its value at each point times the point's weight.
    basis: [[f64; POINTS]; BASIS],
}

/// Weight and barycentric coordinates of one point of each orbit, to 17 digits (Newton's method from the published 15).
const CENTRE: f64 = 0.144_315_607_677_787_17;
const TRIPLES: [[f64; 2]; 3] = [
    [0.095_091_634_267_284_62, 0.081_414_823_414_553_7],
    [0.103_217_370_534_718_25, 0.658_861_384_496_479_6],
    [0.032_458_497_623_198_08, 0.898_905_543_365_938],
];
const SEXTUPLE: [f64; 3] = [0.027_230_314_174_434_994, 0.263_112_829_634_638_1, 0.728_492_392_955_404_3];

impl Rule {
    pub(super) fn get() -> &'static Self {
        static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);
        &RULE
    }

    fn new() -> Self {
        let mut points = [[1.0 / 3.0; 2]; POINTS];
        let mut weights = [CENTRE; POINTS];
        let mut orbits: Vec<([f64; 2], f64)> = Vec::with_capacity(POINTS - 1);
        for [weight, a] in TRIPLES {
            let b = 0.5 * (1.0 - a);
            orbits.extend([[a, b], [b, a], [b, b]].map(|point| (point, weight)));
        }
        let [weight, a, b] = SEXTUPLE;
        let c = 1.0 - a - b;
        orbits.extend([[a, b], [b, a], [a, c], [c, a], [b, c], [c, b]].map(|point| (point, weight)));
        for (k, (point, weight)) in orbits.into_iter().enumerate() {
            (points[k + 1], weights[k + 1]) = (point, weight);
        }
        let mut basis = [[0.0; POINTS]; BASIS];
        let mut count = 0;
        for degree in 0..=DEGREES {
            for power in 0..=degree {
                // Gram and Schmidt, twice for the digits.
                let mut values =
                    points.map(|[s, t]| (s - 0.3).powi(power as i32) * (t - 0.3).powi((degree - power) as i32));
                for _ in 0..2 {
                    for other in &basis[..count] {
                        let product: f64 = (0..POINTS).map(|k| weights[k] * values[k] * other[k]).sum();
                        (0..POINTS).for_each(|k| values[k] -= product * other[k]);
                    }
                }
                let norm: f64 = (0..POINTS).map(|k| weights[k] * values[k] * values[k]).sum::<f64>().sqrt();
                basis[count] = values.map(|value| value / norm);
                count += 1;
            }
        }
        for polynomial in &mut basis {
            (0..POINTS).for_each(|k| polynomial[k] *= weights[k]);
        }
        Self { points, weights, basis }
    }

    /// The mean of a function over the triangle from its values at the points, and an estimate of its error.
    pub(super) fn apply(&self, values: &[DVec3; POINTS], smoothness: Smoothness) -> (DVec3, DVec3) {
        let mut mean = DVec3::ZERO;
        let mut size = DVec3::ZERO;
        for (&value, weight) in values.iter().zip(self.weights) {
            mean += value * weight;
            size += value.abs() * weight;
        }
        // The root mean square of what is of each degree.
        let mut levels = [DVec3::ZERO; DEGREES + 1];
        let mut polynomials = self.basis.iter();
        for (degree, level) in levels.iter_mut().enumerate() {
            for polynomial in polynomials.by_ref().take(degree + 1) {
                let mut coefficient = DVec3::ZERO;
                for (&value, &weight) in values.iter().zip(polynomial) {
                    coefficient += value * weight;
                }
                *level += coefficient * coefficient;
            }
        }
        let level = |degree: usize, k: usize| levels[degree][k].sqrt();
        let error =
            [0, 1, 2].map(|k| left_over([1, 2, 3, 4].map(|degree| level(degree, k)), smoothness) + ROUNDING * size[k]);
        (mean, DVec3::from(error))
    }
}

/// What a rule of degree 8 leaves of a function whose components of degrees 1 to 4 are of those sizes.
///
/// The slowest fall-off seen per degree is taken as that of all higher degrees. Degree 9 is the first that is left; if the fall-off
/// is steep what is of degree 8 is taken for it, else what is of degree 7, and if it is slow, as at a kink, nothing is taken to fall off. The bounds were
/// chosen on the random cases of the tests, among a dozen that keep 99% of estimates honest.
fn left_over([first, second, third, fourth]: [f64; 4], smoothness: Smoothness) -> f64 {
    if matches!(smoothness, Smoothness::Kinked | Smoothness::Tabulated) {
        // A weak kink does not show beside what is smooth: nothing falls off.
        return 2.0 * fourth;
    }
    let largest = third.max(fourth);
    if largest == 0.0 {
        return 0.0;
    }
    let ratio = (fourth / second).sqrt().max(fourth / third).max((third / first).sqrt());
    if ratio < 0.2 {
        largest * ratio.powi(4)
    } else if ratio < 0.4 {
        largest * ratio.powi(3)
    } else {
        2.0 * largest
    }
}

#[cfg(test)]
mod tests {
    use super::{BASIS, POINTS, Rule};

    #[test]
    fn polynomials_of_degree_8_are_integrated_exactly() {
        let rule = Rule::get();
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for i in 0..=8 {
            for j in 0..=8 - i {
                let sum: f64 = rule.points.iter().zip(rule.weights).map(|([s, t], w)| w * s.powi(i) * t.powi(j)).sum();
                let expected = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
                assert!((sum - expected).abs() < 1e-15, "{i} {j}: {sum} instead of {expected}");
            }
        }
        let ninth: f64 = rule.points.iter().zip(rule.weights).map(|([s, _], w)| w * s.powi(9)).sum();
        assert!((ninth - 2.0 / 110.0).abs() > 1e-9, "the rule would be of degree 9");
    }

    #[test]
    fn null_rules_are_orthonormal() {
        let rule = Rule::get();
        for i in 0..BASIS {
            for j in 0..BASIS {
                let product: f64 = (0..POINTS).map(|k| rule.basis[i][k] * rule.basis[j][k] / rule.weights[k]).sum();
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((product - expected).abs() < 1e-12, "{i} {j}: {product}");
            }
        }
    }
}
