//! Moments of convex spherical polygons: integrals of powers of a cosine, in closed form.
//!
//! Arvo ("Applications of irradiance tensors to the simulation of non-Lambertian phenomena", SIGGRAPH 1995) found that
//! the integral of (w.u)^n, and of (w.u)^n (v.u), over a polygon is a sum over its arcs of integrals of powers of
//! g(x) = alpha cos x + beta sin x, which have a recurrence. With an arc from a to b of angle theta, its unit normal
//! e along a x b, t = e x a, alpha = w.a, beta = w.t and C = alpha^2 + beta^2:
//!
//! ```text
//! I_0 = theta, I_1 = (integral of g), k I_k = (k - 1) C I_(k-2) - [g^(k-1) g'] from 0 to theta;
//! M_(-1) = 0, M_0 = Omega, (n + 1) M_n = (n - 1) M_(n-2) + sum of (w.e) I_(n-1);
//! (n + 2) D_n = n (w.v) M_(n-1) + sum of (v.e) I_n.
//! ```
//!
//! The steps only ever damp what errors came before, so errors stay of the size of 1e-15: but that is *absolute*. A
//! polygon far from the axis has a moment that may be less than its error. The error is bounded along with the
//! recurrence and returned; who needs more of a small moment falls back on [`integrate`](super::integrate), as
//! reflected radiance does when the error is above its tolerance.

use super::clip::{clip, perimeter, unit_outline};
use super::solid_angle;
use super::unit::arcs;
use glam::DVec3;

/// A number and a bound on, or an estimate of, its absolute error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// How far it may be off; not negative.
    pub error: f64,
}

/// The integral of (w.u)^n over those directions u of a convex polygon with w.u >= 0, in steradians: 0 to 2 pi / (n + 1).
///
/// `boundary` as for [`solid_angle`](super::solid_angle()). `axis` is w, of any length; without a direction (zero or not
/// finite) the value is 0. `power` is n. The error is bounded along with the computation: a few 1e-15, whatever
/// the size of the value. O(vertices times n).
///
/// ```
/// use glam::DVec3;
/// let octant = [DVec3::X, DVec3::Y, DVec3::Z];
/// let moment = nusselt::integral::axial_moment(&octant, DVec3::Z, 9);
/// assert!((moment.value - std::f64::consts::PI / 20.0).abs() <= moment.error);
/// assert!(moment.error < 1e-14);
/// ```
pub fn axial_moment(boundary: &[DVec3], axis: DVec3, power: u16) -> Estimate {
    let Some(axis) = direction(axis) else { return Estimate::default() };
    let outline = clip(&unit_outline(boundary), axis);
    let mut moments = Moments::new(&outline, axis);
    moments.advance(i32::from(power));
    moments.stated(moments.moment, power)
}

/// The integral of (w.u)^n (v.u) over those directions u of a convex polygon with w.u >= 0 and v.u >= 0: what a receiver with normal
/// v gets through a lobe of exponent n about w. From 0 to 2 pi / (n + 2).
///
/// `boundary`, `axis` (w) and `power` (n) as for [`axial_moment`]; `normal` is v, of any length. Without a direction
/// of either the value is 0. The error is bounded likewise. With n = 0 this is pi times [`form_factor`](super::form_factor())
/// of the polygon cut off at both great circles, which is more precise for small polygons.
///
/// ```
/// use glam::DVec3;
/// let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
/// let lobe = nusselt::integral::double_axis_moment(&hemisphere, DVec3::Z, 98, DVec3::Z);
/// assert!((lobe.value - std::f64::consts::TAU / 100.0).abs() <= lobe.error);
/// ```
pub fn double_axis_moment(boundary: &[DVec3], axis: DVec3, power: u16, normal: DVec3) -> Estimate {
    let (Some(axis), Some(normal)) = (direction(axis), direction(normal)) else { return Estimate::default() };
    let outline = clip(&clip(&unit_outline(boundary), axis), normal);
    let mut moments = Moments::new(&outline, axis);
    let n = f64::from(power);
    moments.advance(i32::from(power) - 1);
    let mut sum = Estimate::default();
    for arc in &mut moments.arcs {
        let integral = arc.advance(i32::from(power));
        sum.add_product(normal.dot(arc.normal), integral);
    }
    sum.add_product(n * axis.dot(normal), moments.moment);
    let moment = Estimate { value: sum.value / (n + 2.0), error: sum.error / (n + 2.0) };
    moments.stated(moment, power)
}

fn direction(vector: DVec3) -> Option<DVec3> {
    (vector / vector.abs().max_element()).try_normalize()
}

/// What a computed cosine of two unit vectors may be off by: the vectors' own rounding, and that of three products.
const COSINE: f64 = 8.0 * f64::EPSILON;

impl Estimate {
    /// Adds a product whose first factor is a cosine, or a multiple of one.
    fn add_product(&mut self, factor: f64, other: Self) {
        self.value += factor * other.value;
        self.error += factor.abs() * other.error + (factor.abs().max(1.0)) * COSINE * other.value.abs();
    }
}

/// The integrals of g^k over one arc, for ever higher k of one parity.
struct ArcPowers {
    /// e.
    normal: DVec3,
    /// C, at most 1.
    square: f64,
    /// g at both ends.
    cosines: [f64; 2],
    /// g' at both ends.
    slopes: [f64; 2],
    /// g^(k+1) at both ends.
    powers: [f64; 2],
    /// The k of `integral`; -1 or 0 to begin with.
    reached: i32,
    integral: Estimate,
}

impl ArcPowers {
    /// For even or odd powers.
    fn new(a: DVec3, b: DVec3, axis: DVec3, is_even: bool) -> Option<Self> {
        let cross = a.cross(b - a);
        let sine = cross.length();
        if sine == 0.0 {
            return None;
        }
        let normal = cross / sine;
        let [from, to] = [a, b].map(|end| normal.cross(end));
        let cosines = [axis.dot(a), axis.dot(b)];
        let slopes = [axis.dot(from), axis.dot(to)];
        let square = (cosines[0] * cosines[0] + slopes[0] * slopes[0]).min(1.0);
        let theta = sine.atan2(a.dot(b));
        let (reached, integral, powers) = if is_even {
            (0, Estimate { value: theta, error: theta * COSINE }, cosines)
        } else {
            (-1, Estimate::default(), [1.0; 2])
        };
        Some(Self { normal, square, cosines, slopes, powers, reached, integral })
    }

    /// The integral of g^k; `k` has the parity of all powers of this and is not below one asked for.
    fn advance(&mut self, k: i32) -> Estimate {
        while self.reached < k {
            self.reached += 2;
            let k = f64::from(self.reached);
            let mut ends = [0.0; 2];
            let mut error = 0.0;
            for (end, product) in ends.iter_mut().enumerate() {
                let (cosine, slope) = (self.cosines[end], self.slopes[end]);
                *product = self.powers[end] * slope;
                // The power may be off by its own rounding and by that of its base, the slope by its own.
                let lower = if self.reached > 1 { (self.powers[end] / cosine).abs() } else { 0.0 };
                let lower = if lower.is_finite() { lower } else { 0.0 };
                error += COSINE * (self.powers[end].abs() * (1.0 + k * slope.abs()) + (k - 1.0) * lower * slope.abs());
                self.powers[end] *= cosine * cosine;
            }
            let before = self.integral;
            let damped = (k - 1.0) * self.square;
            self.integral = Estimate {
                value: (damped * before.value - (ends[1] - ends[0])) / k,
                error: (damped * before.error + (k - 1.0) * COSINE * before.value.abs() + error) / k,
            };
        }
        self.integral
    }
}

/// The axial moments of one outline, for ever higher powers of one parity.
struct Moments<'a> {
    outline: &'a [DVec3],
    axis: DVec3,
    arcs: Vec<ArcPowers>,
    moment: Estimate,
}

impl<'a> Moments<'a> {
    fn new(outline: &'a [DVec3], axis: DVec3) -> Self {
        Self { outline, axis, arcs: Vec::new(), moment: Estimate::default() }
    }

    /// To the moment of power `n`, which may be -1; leaves the arcs at the power before it.
    fn advance(&mut self, n: i32) {
        // I_(n-1) and M_n go together: odd with even.
        let is_even = n % 2 != 0;
        let axis = self.axis;
        self.arcs = arcs(self.outline).filter_map(|[&a, &b]| ArcPowers::new(a, b, axis, is_even)).collect();
        let perimeter = perimeter(self.outline);
        let mut reached = if is_even { -1 } else { 0 };
        if !is_even {
            let omega = solid_angle(self.outline);
            let diameter = perimeter.min(std::f64::consts::PI);
            self.moment = Estimate { value: omega, error: 4e-16 * (omega + perimeter * diameter) };
        }
        while reached < n {
            reached += 2;
            let k = f64::from(reached);
            let mut sum = Estimate::default();
            sum.add_product(k - 1.0, self.moment);
            for arc in &mut self.arcs {
                let integral = arc.advance(reached - 1);
                sum.add_product(axis.dot(arc.normal), integral);
            }
            self.moment = Estimate { value: sum.value / (k + 1.0), error: sum.error / (k + 1.0) };
        }
    }

    /// With what the rounding of the outline and of the axis adds: both integrands are at most 1, and the length of an axis counts n times.
    fn stated(&self, moment: Estimate, power: u16) -> Estimate {
        let value = moment.value.max(0.0);
        let outline = 2.0 * f64::EPSILON * perimeter(self.outline);
        let axis = f64::EPSILON * (4.0 + f64::from(power)) * value;
        Estimate { value, error: moment.error + outline + axis }
    }
}

#[cfg(test)]
mod tests;
