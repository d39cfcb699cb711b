//! The exchange between two polygons that see each other wholly, by the double integral along their contours.
//!
//! By Stokes's theorem, twice (Sparrow 1963),
//!
//! ```text
//! A_i F_ij = 1/(2 pi) sum over sides p of i and q of j of (p.q) integral of integral of ln r ds dt
//! ```
//!
//! with unit vectors p, q along the sides. The inner integral has a closed form, u ln sqrt(u^2 + h^2) - u + h atan(u/h) between the ends of q, where u runs along q
//! and h is the distance from its line; the outer one is done by Gauss-Kronrod rules: of 3 and 7 points, or of 7 and 15 on halved intervals. Its
//! integrand is continuous also where polygons touch, with a term u ln u at worst, so that halving converges everywhere.
//! Logarithms are those of r over the distance of the centres: that adds nothing around a closed contour, and takes away what would cancel.

use super::row::Share;
use super::shape::{centre, sides};
use glam::DVec3;
use std::f64::consts::TAU;

/// Intervals are not halved more often than this.
const DEEPEST: u32 = 48;
/// A side falls into no more intervals than about this.
const MOST_INTERVALS: usize = 1 << 14;

/// A value, and the sum of the sizes of what it is a sum of: what rounding may do to it is a part of that.
type Sized = (f64, f64);

struct SideOf {
    start: DVec3,
    along: DVec3,
    length: f64,
}

impl SideOf {
    fn all(ring: &[DVec3]) -> Vec<Self> {
        let of = |[a, b]: [DVec3; 2]| {
            let length = a.distance(b);
            (length > 0.0).then(|| Self { start: a, along: (b - a) / length, length })
        };
        sides(ring).filter_map(of).collect()
    }

    /// The integral of ln(r / unit) along the side for the distance r from a point.
    fn logarithm(&self, x: DVec3, inverse_square_of_unit: f64) -> Sized {
        let to = self.start - x;
        let low = to.dot(self.along);
        let high = low + self.length;
        let square = to.cross(self.along).length_squared();
        let part = |u: f64| {
            let whole = u * u + square;
            if whole > 0.0 { 0.5 * u * (whole * inverse_square_of_unit).ln() } else { 0.0 }
        };
        let height = square.sqrt();
        // The difference of two arc tangents, as one.
        let angle = (height * self.length).atan2(square + low * high);
        let (high, low, turned) = (part(high), part(low), height * angle);
        (high - low - self.length + turned, high.abs() + low.abs() + self.length + turned)
    }
}

/// `A_i` `F_ij` of two flat convex polygons, each wholly in front of the other's plane and with nothing between them, and an estimate of its
/// absolute error. The rings run counter-clockwise seen from the fronts. Intervals are halved until the estimate is below `tolerance`, or as far as
/// numbers go.
pub(super) fn exchange(i: &[DVec3], j: &[DVec3], tolerance: f64) -> Share {
    let unit = centre(i).distance_squared(centre(j));
    if unit <= 0.0 || unit.is_nan() {
        return Share::default();
    }
    // Along what is small all logarithms are about the same, and their rounding falls out around it; of what is small seen from afar it would not.
    let is_larger = |a: &[DVec3], b: &[DVec3]| around(a) > around(b);
    let [outer, inner] = if is_larger(i, j) { [j, i] } else { [i, j] }.map(SideOf::all);
    let allowed = tolerance * TAU / outer.len() as f64;
    let (mut sum, mut error) = (0.0, 0.0);
    for side in &outer {
        let weights: Vec<f64> = inner.iter().map(|other| side.along.dot(other.along)).collect();
        let integrand = |s: f64| {
            let x = side.start + side.along * s;
            let terms = inner.iter().zip(&weights).filter(|&(_, &weight)| weight != 0.0);
            terms.fold((0.0, 0.0), |(sum, size): Sized, (other, weight)| {
                let (value, of_value) = other.logarithm(x, 1.0 / unit);
                (sum + weight * value, size + weight.abs() * of_value)
            })
        };
        let (value, estimate) = integrate(integrand, side.length, allowed);
        sum += value;
        error += estimate;
    }
    Share { factor: sum / TAU, error: error / TAU }
}

/// The length of a ring.
fn around(ring: &[DVec3]) -> f64 {
    sides(ring).map(|[a, b]| a.distance(b)).sum()
}

/// The integral from 0 to `end`, and an estimate of its error.
fn integrate(f: impl Fn(f64) -> Sized, end: f64, tolerance: f64) -> (f64, f64) {
    // Mostly few points are enough.
    let (value, estimate, size) = kronrod(&f, 0.0, end, &FEW);
    if estimate <= tolerance {
        return (value, estimate.max(rounding(size)));
    }
    let mut waiting = vec![(0.0, end, 0u32)];
    let (mut sum, mut error) = (0.0, 0.0);
    let mut intervals = 0;
    while let Some((low, high, depth)) = waiting.pop() {
        intervals += 1;
        let (value, estimate, size) = kronrod(&f, low, high, &MANY);
        if estimate <= (tolerance * (high - low) / end).max(rounding(size))
            || depth == DEEPEST
            || intervals > MOST_INTERVALS
        {
            sum += value;
            error += estimate.max(rounding(size));
        } else {
            let middle = 0.5 * (low + high);
            waiting.push((middle, high, depth + 1));
            waiting.push((low, middle, depth + 1));
        }
    }
    (sum, error)
}

/// What rounding of the terms that a value is a sum of may do, by the integral of their sizes.
fn rounding(size: f64) -> f64 {
    2.0 * f64::EPSILON * size
}

/// A rule of Kronrod (Piessens et al., QUADPACK, 1983): positive abscissae with their weights, and those in the rule of Gauss that has every other one; and
/// the weights of the middle.
struct Kronrod<const N: usize> {
    points: [(f64, f64, f64); N],
    middle: (f64, f64),
}

/// Of 7 and 3 points.
const FEW: Kronrod<3> = Kronrod {
    points: [
        (0.960_491_268_708_020_3, 0.104_656_226_026_467_3, 0.0),
        (0.774_596_669_241_483_4, 0.268_488_089_868_333_44, 0.555_555_555_555_555_6),
        (0.434_243_749_346_802_54, 0.401_397_414_775_962_2, 0.0),
    ],
    middle: (0.450_916_538_658_474_1, 0.888_888_888_888_889),
};

/// Of 15 and 7 points.
const MANY: Kronrod<7> = Kronrod {
    points: [
        (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
        (0.949_107_912_342_758_5, 0.063_092_092_629_978_56, 0.129_484_966_168_869_7),
        (0.864_864_423_359_769_1, 0.104_790_010_322_250_19, 0.0),
        (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64),
        (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
        (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
        (0.207_784_955_007_898_47, 0.204_432_940_075_298_89, 0.0),
    ],
    middle: (0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
};

/// By a rule, how far that of Gauss is from it, and the integral of the sizes.
fn kronrod<const N: usize>(f: impl Fn(f64) -> Sized, low: f64, high: f64, rule: &Kronrod<N>) -> (f64, f64, f64) {
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let (value, of_value) = f(centre);
    let (mut fine, mut coarse, mut size) = (rule.middle.0 * value, rule.middle.1 * value, rule.middle.0 * of_value);
    for (x, weight, weight_of_gauss) in rule.points {
        let [(a, of_a), (b, of_b)] = [f(centre - half * x), f(centre + half * x)];
        fine += weight * (a + b);
        coarse += weight_of_gauss * (a + b);
        size += weight * (of_a + of_b);
    }
    (fine * half, (fine - coarse).abs() * half, size * half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn rectangle(origin: [f64; 3], u: [f64; 3], v: [f64; 3]) -> [DVec3; 4] {
        let [o, u, v] = [origin, u, v].map(DVec3::from);
        [o, o + u, o + u + v, o + v]
    }

    /// Directly opposed rectangles a x b at distance c (Howell's catalogue, C-11).
    fn opposed(a: f64, b: f64, c: f64) -> f64 {
        let (x, y) = (a / c, b / c);
        let (x1, y1) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        2.0 / (PI * x * y)
            * ((x1 * y1 / (1.0 + x * x + y * y).sqrt()).ln() + x * y1 * (x / y1).atan() + y * x1 * (y / x1).atan()
                - x * x.atan()
                - y * y.atan())
    }

    #[test]
    fn opposed_rectangles_match_the_closed_form_however_near() {
        // Relative to 1: the closed form itself loses digits as the gap gets small.
        for (c, error) in [(10.0, 1e-14), (1.0, 1e-14), (0.1, 1e-13), (1e-3, 1e-12)] {
            let i = rectangle([0.; 3], [1., 0., 0.], [0., 0.5, 0.]);
            let j = rectangle([0., 0., c], [0., 0.5, 0.], [1., 0., 0.]);
            let share = exchange(&i, &j, 1e-14);
            let expected = 0.5 * opposed(1.0, 0.5, c);
            assert!((share.factor - expected).abs() < error, "{c}: {} {expected} {:e}", share.factor, share.error);
        }
    }

    #[test]
    fn the_error_is_below_the_estimate() {
        let i = rectangle([0.; 3], [1., 0., 0.], [0., 0.5, 0.]);
        for c in [3.0, 0.5, 0.02] {
            let j = rectangle([0., 0., c], [0., 0.5, 0.], [1., 0., 0.]);
            for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
                let share = exchange(&i, &j, tolerance);
                let off = (share.factor - 0.5 * opposed(1.0, 0.5, c)).abs();
                assert!(off <= share.error + 1e-14 && share.error <= tolerance, "{c} {tolerance:e}: {off:e} {share:?}");
            }
        }
    }

    /// From a place that looks up to a square of 1 x 1 that is 1 above, at the place under it: four times the formula for what is under a corner.
    fn to_square_around(x: f64, y: f64) -> f64 {
        let part = |a: f64, b: f64| {
            let (p, q) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
            (a / p * (b / p).atan() + b / q * (a / q).atan()) / (2.0 * PI)
        };
        part(x, y) + part(1.0 - x, y) + part(x, 1.0 - y) + part(1.0 - x, 1.0 - y)
    }

    #[test]
    fn what_is_tiny_has_its_digits_from_both() {
        let large = rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.]);
        for size in [1e-3, 1e-5, 1e-7] {
            let tiny = rectangle([0.3, 0.6, 0.], [size, 0., 0.], [0., size, 0.]);
            let allowed = 1e-6 * size * size;
            let [there, back] = [exchange(&tiny, &large, allowed), exchange(&large, &tiny, allowed)];
            assert!((there.factor - back.factor).abs() <= 0.0, "{there:?} {back:?}");
            // The middle is 1 / 24 times size^2 times second derivatives off, which are below 10.
            let expected = to_square_around(0.3 + 0.5 * size, 0.6 + 0.5 * size);
            let off = (there.factor / (size * size) - expected).abs();
            let told = there.error / (size * size);
            assert!(off <= told + size * size && told <= 1e-5, "{size:e}: off by {off:e}, told {told:e}");
        }
    }

    #[test]
    fn slivers_end_with_what_rounding_leaves() {
        let large = rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.]);
        for width in [1e-9, 1e-11, 1e-13] {
            let sliver = rectangle([0.1, 0.6, 0.], [0.7, 0., 0.], [0., width, 0.]);
            // It has the width that its rounded corners leave.
            let area = 0.7 * (sliver[2].y - sliver[1].y);
            let share = exchange(&sliver, &large, 1e-9 * area);
            let steps = 1000;
            let places = (0..steps).map(|k| 0.1 + 0.7 * (f64::from(k) + 0.5) / f64::from(steps));
            let expected = places.map(|x| to_square_around(x, 0.6)).sum::<f64>() / f64::from(steps);
            let off = (share.factor / area - expected).abs();
            // The midpoint rule's own error is below 1e-6 of the second derivative.
            assert!(off <= share.error / area + 1e-6, "{width:e}: off by {off:e}, told {:e}", share.error / area);
        }
    }

    #[test]
    fn rules_have_their_degrees() {
        // Odd powers vanish; Gauss has degree 2n - 1, Kronrod at least 3n + 1.
        for degree in (0..=22).step_by(2) {
            let exact = 2.0 / f64::from(degree + 1);
            let power = |x: f64| (x.powi(degree), x.powi(degree).abs());
            let (few, off_few, _) = kronrod(power, -1.0, 1.0, &FEW);
            let (many, off_many, _) = kronrod(power, -1.0, 1.0, &MANY);
            assert!(degree > 10 || (few - exact).abs() < 1e-15, "{degree}: {few}");
            assert!((many - exact).abs() < 1e-15, "{degree}: {many}");
            assert!(
                (degree > 4) == (off_few > 1e-14) && (degree > 12) == (off_many > 1e-14),
                "{degree}: {off_few:e} {off_many:e}"
            );
        }
    }

    #[test]
    fn nothing_is_exchanged_by_what_has_no_size() {
        let i = rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]);
        assert_eq!(exchange(&i, &i, 1e-9), Share::default());
        assert!(exchange(&i, &[DVec3::Z; 3], 1e-9).factor.abs() <= 0.0);
    }
}
