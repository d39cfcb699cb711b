//! The f64 stage: vectors known up to a proven bound, and the filter on their dot product.
//!
//! Throughout, `u = 2^-53` is the unit roundoff. A sum or difference of two f64 is off by at most
//! `u` times its value; a product by at most `u` times its value plus `2^-1075`, where it
//! underflows. `err` is always a bound on each component.

use super::Sign;
use glam::DVec3;

/// The unit roundoff, `2^-53`.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// The largest power of two that is not above a positive number; at least 2^-1022.
pub(crate) fn power_of_two_at_most(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & (0x7ff << 52)).max(f64::MIN_POSITIVE)
}

/// A bound on what all underflows of one formula can add.
const UNDERFLOW: f64 = 1.0 / (1u64 << 48) as f64 * f64::MIN_POSITIVE;

/// A real vector `r = s (v + d)` with some `s > 0`, `|v| <= 2` and `|d| <= err` in each component.
///
/// What is stored is `slack = 8 err + 32 u`: its sum over two vectors bounds the error of their
/// computed dot product.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approx3 {
    pub(crate) v: DVec3,
    pub(crate) slack: f64,
}

impl Approx3 {
    /// Nothing is known: every filter passes the question on.
    const UNKNOWN: Self = Self { v: DVec3::ZERO, slack: f64::INFINITY };

    /// Scales `v`, known up to `err` in each component, by a power of two.
    fn normalised(v: DVec3, err: f64) -> Self {
        let most = v.abs().max_element();
        if !v.is_finite() || most < f64::MIN_POSITIVE {
            return Self::UNKNOWN;
        }
        let exponent = (most.to_bits() >> 52) as i32 - 1023;
        // A power of two, halved first where it would be a denormal number.
        let scale =
            if exponent == 1023 { f64::MIN_POSITIVE / 2.0 } else { f64::from_bits(((1023 - exponent) as u64) << 52) };
        // Exact but for components that underflow, by less than 2^-1074: the constant 32 u of the
        // slack is twice what the dot product's own rounding takes.
        let err = err * scale;
        if err <= 0.125 { Self { v: v * scale, slack: 8.0 * err + 32.0 * U } } else { Self::UNKNOWN }
    }

    /// The direction from `eye` to a point known up to `err`.
    ///
    /// The difference adds `u` times its size.
    pub(crate) fn direction(eye: DVec3, point: DVec3, err: f64) -> Self {
        let v = point - eye;
        Self::normalised(v, (err + U * v.abs().max_element()) * (1.0 + 8.0 * U))
    }

    /// A vector given exactly.
    pub(crate) fn given(v: DVec3) -> Self {
        Self::normalised(v, 0.0)
    }

    /// A vector known up to `err`.
    pub(crate) fn known(v: DVec3, err: f64) -> Self {
        Self::normalised(v, err)
    }

    /// The normal `(a - e) x (b - e)` of the plane through the eye and two points.
    ///
    /// Computed as `(a - e) x (b - a)`, which is the same and keeps its relative accuracy when `a`
    /// and `b` are close together. Either factor is off by `u` relatively, so each of the two
    /// products by `(1 + u)^3 - 1 < 3.01 u` and each difference by `8.1 u |a - e| |b - a|`.
    pub(crate) fn edge_normal(eye: DVec3, a: DVec3, b: DVec3) -> Self {
        let (p, q) = (a - eye, b - a);
        let size = p.abs().max_element() * q.abs().max_element();
        Self::normalised(p.cross(q), 9.0 * U * size + UNDERFLOW)
    }

    /// The cross product of two approximate vectors.
    #[inline]
    pub(crate) fn cross(self, other: Self) -> Self {
        let v = self.v.cross(other.v);
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let most = larger(larger(v.x.abs(), v.y.abs()), v.z.abs());
        // As `normalised`, where no component is above 8 and all are numbers.
        if most < f64::MIN_POSITIVE {
            return Self::UNKNOWN;
        }
        let scale = f64::from_bits((2046 - (most.to_bits() >> 52)) << 52);
        let err = self.cross_error(&other) * scale;
        if err <= 0.125 { Self { v: v * scale, slack: 8.0 * err + 32.0 * U } } else { Self::UNKNOWN }
    }

    /// True if the two vectors are certainly not parallel.
    pub(crate) fn not_parallel(&self, other: &Self) -> bool {
        self.v.cross(other.v).abs().max_element() > self.cross_error(other)
    }

    /// A bound on the error of each component of the computed cross product.
    ///
    /// With components below 2 and errors `e1, e2 <= 1/8`: each product is off by at most
    /// `2 e1 + 2 e2 + e1 e2` and by `4 u` of rounding, the difference by `8 u` more; in all at most
    /// `4.25 (e1 + e2) + 16.1 u`.
    fn cross_error(&self, other: &Self) -> f64 {
        4.5 * (self.slack + other.slack) / 8.0 + 20.0 * U
    }

    /// True if the bound on the error is so large that it pays to compute the vector from integers.
    pub(crate) fn is_poor(&self) -> bool {
        self.error_bound() > 1e-13
    }

    /// The bound on the error of each component, relative to a largest component of 1 to 2.
    pub(crate) fn error_bound(&self) -> f64 {
        self.slack / 8.0
    }

    /// The sign of the dot product of the two real vectors, if f64 can tell.
    ///
    /// Proof. Let `x` be the computed value of `v.w`. With `|v|, |w| <= 2` and errors `e, f <= 1/8`,
    /// `(v + d).(w + g)` differs from `v.w` by at most `6 e + 6 f + 3 e f <= 6.2 (e + f)`. Three
    /// products of at most 4 are off by `4 u` each, the two sums by `8 u` and `12 u` (and a hair):
    /// below `33 u`. The slacks add up to `8 (e + f) + 64 u`, which leaves room for the rounding of
    /// the slacks themselves.
    #[inline]
    pub(crate) fn dot_sign(&self, other: &Self) -> Option<Sign> {
        decided(self.v.dot(other.v), self.slack + other.slack)
    }

    /// Whether the dot product of the two real vectors is certainly positive, and whether it is certainly negative, as [`Approx3::dot_sign`]: 1 if so, 0 if not.
    ///
    /// The sign of a difference is never rounded away, and that of 0 is positive: so no comparison is needed, nor a branch.
    #[inline]
    pub(crate) fn dot_bits(&self, other: &Self) -> [u64; 2] {
        let (x, bound) = (self.v.dot(other.v), self.slack + other.slack);
        [bound - x, bound + x].map(|rest| rest.to_bits() >> 63)
    }

    /// The sign of the determinant `self . (b x c)` of the three real vectors, if f64 can tell.
    ///
    /// Proof. With errors `e`, `f`, `g <= 1/8`, each component of the cross product, at most 8, is off by
    /// `4.13 (f + g) + 16.1 u`: see [`Approx3::cross`]. So the dot product is off by at most
    /// `3 (2.13 (4.13 (f + g) + 16.1 u) + 8 e) < 24 e + 26.4 (f + g) + 103 u`, to which its own rounding
    /// adds `16 u` for each of the products, `32 u` and `48 u` for the sums: `129 u`. Four times the
    /// slacks are `32 (e + f + g) + 384 u`.
    #[inline]
    pub(crate) fn det_sign(&self, b: &Self, c: &Self) -> Option<Sign> {
        let x = self.v.dot(b.v.cross(c.v));
        decided(x, 4.0 * (self.slack + b.slack + c.slack))
    }
}

/// The sign of a number that is off by at most `bound`, if that tells.
#[inline]
pub(super) fn decided(x: f64, bound: f64) -> Option<Sign> {
    if x > bound {
        Some(Sign::Positive)
    } else if x < -bound {
        Some(Sign::Negative)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::construct::Constructor;
    use super::super::definition::{Direction, Point, Splitter};
    use super::super::frame::{BitRange, Frame};
    use super::super::{Arena, Kept3};
    use super::*;
    use proptest::prelude::*;

    /// The true vector, rounded from integers: `2 u` off in each component.
    fn exact(points: &[DVec3], eye: DVec3, make: impl FnOnce(&mut Constructor<'_>) -> Kept3) -> DVec3 {
        let frame = Frame::new(BitRange::of(points.iter().copied()), eye);
        let mut arena = Arena::default();
        let kept = make(&mut Constructor { frame: &frame, arena: &mut arena });
        arena.kept_rounded(&kept).v
    }

    /// True if some multiple of the exact vector is about as close as the bound says.
    fn holds(approx: &Approx3, exact: DVec3) -> bool {
        if approx.slack.is_infinite() || exact == DVec3::ZERO {
            return true;
        }
        let off = exact * (approx.v.dot(exact) / exact.length_squared()) - approx.v;
        // The closest multiple is up to 3 times as far off in one component as the one that is meant.
        off.abs().max_element() <= 3.0 * approx.error_bound() + 16.0 * U
    }

    fn coordinates() -> impl Strategy<Value = DVec3> {
        (prop::array::uniform3(-1.0..1.0f64), prop_oneof![3 => -30i32..30, 1 => -500i32..300])
            .prop_map(|(v, e)| DVec3::from(v) * 2f64.powi(e))
    }

    proptest! {
        #[test]
        fn vectors_are_as_close_as_their_bounds_say(
            eye in coordinates(), a in coordinates(), b in coordinates(), c in coordinates(), near: bool,
        ) {
            // Where the eye is close to the line of the edge, much is lost.
            let b = if near { a + (a - eye) * 0.7 + b * 1e-12 } else { b };
            let points = [eye, a, b, c];
            let direction = Approx3::direction(eye, a, 0.0);
            let true_direction = exact(&points, eye, |exact| exact.keep_direction(&Direction::Point(Point::Given(a))));
            prop_assert!(holds(&direction, true_direction), "{direction:?} {true_direction}");
            let edges = [Splitter::Edge([a, b]), Splitter::Edge([b, c])];
            let normals = edges.map(|edge| Approx3::splitter(&edge, eye));
            for (normal, edge) in normals.iter().zip(&edges) {
                let true_normal = exact(&points, eye, |exact| exact.keep_splitter(edge));
                prop_assert!(holds(normal, true_normal), "{normal:?} {true_normal}");
            }
            let crossing = normals[0].cross(normals[1]);
            let true_crossing = exact(&points, eye, |exact| exact.keep_direction(&Direction::Crossing(edges)));
            prop_assert!(holds(&crossing, true_crossing), "{crossing:?} {true_crossing}");
        }

        #[test]
        fn ordinary_vectors_are_known_well(
            a in prop::array::uniform3(0.5..1.0f64), b in prop::array::uniform3(-1.0..-0.5f64), e in -300i32..300,
        ) {
            let scale = 2f64.powi(e / 2);
            let (p, q) = (DVec3::from(a) * scale, DVec3::new(b[0], a[1], b[2]) * scale);
            let known = [
                (Approx3::given(p), 0.0),
                (Approx3::direction(DVec3::ZERO, p, 0.0), 2.0),
                // The cross product is at least an eighth of the product of the sizes.
                (Approx3::edge_normal(DVec3::ZERO, p, q), 300.0),
                (Approx3::given(p).cross(Approx3::given(q)), 400.0),
            ];
            for (k, (vector, units)) in known.into_iter().enumerate() {
                let most = vector.v.abs().max_element();
                prop_assert!((1.0..2.0).contains(&most), "{k}: {vector:?}");
                prop_assert!(vector.error_bound() <= (units + 4.0) * U && !vector.is_poor(), "{k}: {vector:?}");
            }
            prop_assert!(known[0].0.not_parallel(&known[2].0));
            prop_assert!(!known[0].0.not_parallel(&known[1].0));
            prop_assert_eq!(known[0].0.dot_sign(&known[1].0), Some(Sign::Positive));
            prop_assert_eq!(Approx3::given(-p).dot_sign(&known[1].0), Some(Sign::Negative));
            prop_assert_eq!(known[0].0.dot_sign(&known[2].0), None);
            let (x, y) = (Approx3::given(p), Approx3::given(q));
            prop_assert_eq!(known[3].0.det_sign(&x, &y), Some(Sign::Positive));
            prop_assert_eq!(known[3].0.det_sign(&y, &x), Some(Sign::Negative));
            prop_assert_eq!(x.det_sign(&x, &y), None);
        }
    }

    #[test]
    fn the_unit_roundoff_is_half_of_the_step_from_1() {
        let next = |x: f64| (1.0 + x).to_bits() - 1.0_f64.to_bits();
        assert_eq!((next(U), next(U * (1.0 + f64::EPSILON))), (0, 1));
    }

    #[test]
    fn what_is_not_a_vector_is_unknown() {
        for v in [DVec3::ZERO, DVec3::NAN, DVec3::new(1.0, f64::INFINITY, 0.0), DVec3::splat(f64::MIN_POSITIVE / 2.0)] {
            assert!(Approx3::given(v).slack.is_infinite(), "{v}");
        }
        assert!(Approx3::known(DVec3::X, 0.13).slack.is_infinite());
        let least = Approx3::known(DVec3::X, 0.125);
        assert!(least.is_poor() && least.error_bound() >= 0.125);
        for v in [DVec3::X * f64::MAX, DVec3::Y * f64::MIN_POSITIVE, DVec3::NEG_Z] {
            let given = Approx3::given(v);
            assert!((1.0..2.0).contains(&given.v.abs().max_element()) && !given.is_poor(), "{v}: {given:?}");
        }
    }
}
