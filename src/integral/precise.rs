//! Form factors in double-double arithmetic, of what `f64` knows too poorly.
//!
//! What makes a form factor uncertain is the place of its corners (1e-16 to 1e-13 of a radian), which counts for small and for
//! thin parts, and cancellation close to the horizon, where all of it is a difference of arcs along the horizon. Both are gone with
//! corners from exact definitions and the identity of [`super::flux`] in twice the precision.

use super::unit::{UnitDirection, arcs, outline};
use crate::contour::{Cell, ContourImage, Precise};
use crate::exact::U;
use crate::exact::double::{Double, Double3, cross, dot, minus};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A form factor of cells, and a bound on its error.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounded {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Bounded {
    /// The form factor of a cell with these rounded corners, computed in `f64`.
    ///
    /// An arc whose ends are off by e changes the integral of n.u / pi by at most its length times e times n.u there. To this comes what the
    /// formula rounds: 2e-16 times the perimeter and the diameter, which is at most half the perimeter; and as much of the value. The lengths of corners are rounded, too:
    /// by a few units in the last place, which turned by 90 degrees along the arcs beside them counts fully, however low above the horizon they are.
    pub(super) fn of(cell: Cell<'_>, corners: &[DVec3], normal: DVec3, value: f64) -> Self {
        let [mut perimeter, mut moment] = [0.0f64; 2];
        let mut former = corners.last().map_or(0.0, |&a| normal.dot(a).abs());
        let mut from = corners.last().copied().unwrap_or_default();
        for &corner in corners {
            // Arcs are longer than chords, by less than pi / 2, and rise above their ends by less than the square of this length.
            let length = from.distance(corner) * (PI / 2.0);
            let height = normal.dot(corner).abs();
            perimeter += length;
            moment += length * (height.max(former) + length * length);
            (former, from) = (height, corner);
        }
        let off = cell.corner_error();
        let error = off * (moment + off * perimeter) / PI + 1e-16 * perimeter * perimeter + 4.0 * U * perimeter / PI;
        Self { value, error: error + 2e-16 * value }
    }

    pub(super) fn add(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error;
    }

    /// True if it may be off by 1e-9 of itself, or of 1e-15 if it is less than that.
    pub(super) fn is_poor(self) -> bool {
        self.error > 9e-10 * self.value.max(1e-15)
    }
}

/// Form factors of cells of an image, as `f64` that are off by about one unit in the last place.
pub(super) struct PreciseFactors<'a> {
    precise: Precise<'a>,
    normal: Double3,
}

impl<'a> PreciseFactors<'a> {
    /// `None` if the domain has no normal.
    pub(super) fn new(image: &'a ContourImage) -> Option<Self> {
        let mut precise = Precise::new(image);
        let [hi, lo] = precise.normal()?;
        let normal = UnitDirection::from_sum(hi, lo)?.doubles();
        Some(Self { precise, normal })
    }

    /// The form factor of a cell; never negative.
    pub(super) fn of(&mut self, cell: Cell<'_>) -> f64 {
        let corners = self.precise.corners(cell).filter_map(|[hi, lo]| UnitDirection::from_sum(hi, lo));
        form_factor(&outline(corners), &self.normal)
    }
}

/// The form factor of an outline, for a normal of unit length.
pub(super) fn form_factor(outline: &[UnitDirection], normal: &Double3) -> f64 {
    let mut corners = Vec::with_capacity(outline.len());
    for [a, b] in arcs(outline) {
        corners.push(a.doubles());
        split(a, b, &mut corners);
    }
    let Some(origin) = corners.first().copied() else { return 0.0 };
    let mut sum = Double::ZERO;
    for [a, b] in arcs(&corners) {
        let step = minus(b, a);
        let arc = cross(a, &step);
        let flat = dot(normal, &cross(&minus(a, &origin), &step));
        sum = sum + flat + excess(dot(&arc, &arc)) * dot(normal, &arc);
    }
    (sum.hi / TAU).max(0.0)
}

/// Halves an arc until its parts are short enough for the series: adds the points between the ends.
fn split(a: &UnitDirection, b: &UnitDirection, corners: &mut Vec<Double3>) {
    // The sine of the arc is below 1/4 then. Arcs of an outline are at most 90 degrees: three times will do.
    if a.rounded().dot(b.rounded()) > 0.97 {
        return;
    }
    let Some(middle) = a.midpoint(b) else { return };
    if middle == *a || middle == *b {
        return;
    }
    split(a, &middle, corners);
    corners.push(middle.doubles());
    split(&middle, b, corners);
}

/// asin(s) / s - 1 for s^2 = `x` below 1/16: x / 6 + 3 x^2 / 40 + ...
fn excess(x: Double) -> Double {
    let mut term = Double { hi: 1.0, lo: 0.0 };
    let mut sum = Double::ZERO;
    for k in 1..60 {
        // binomial(2k, k) / 4^k from the one before; the term has a further 1 / (2k + 1).
        let two_k = f64::from(2 * k);
        let odd = Double { hi: two_k - 1.0, lo: 0.0 };
        term = (term * x * odd).over(two_k);
        let next = term.over(two_k + 1.0);
        sum = sum + next;
        if next.hi <= sum.hi * 1e-33 {
            break;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integral::form_factor_of_units;

    fn units(corners: &[DVec3]) -> Vec<UnitDirection> {
        corners.iter().map(|&v| UnitDirection::new(v).expect("a direction")).collect()
    }

    fn precise(corners: &[DVec3], normal: DVec3) -> f64 {
        let normal = UnitDirection::new(normal).expect("a direction").doubles();
        form_factor(&outline(units(corners)), &normal)
    }

    #[test]
    fn it_is_what_f64_says_where_f64_is_good() {
        let octant = [DVec3::X, DVec3::Y, DVec3::Z];
        assert!((precise(&octant, DVec3::Z) - 0.25).abs() < 1e-16);
        let halves = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::Z];
        assert!((precise(&halves, DVec3::Z) - 0.5).abs() < 2e-16);
        let quad = [[0.1, 0.2, 1.0], [0.3, 0.25, 1.1], [0.35, 0.4, 0.9], [0.05, 0.3, 1.0]].map(DVec3::from);
        let normal = DVec3::new(0.3, -0.1, 0.8);
        let plain = form_factor_of_units(&units(&quad), normal);
        assert!((precise(&quad, normal) / plain - 1.0).abs() < 2e-15 && plain > 0.0);
    }

    #[test]
    fn what_just_rises_above_the_horizon_keeps_its_digits() {
        // A rectangle in the plane x = 1, from the horizon to height h, of width w: with the axis of the height
        // along the normal, F = (1 / 2 pi) (atan w - A atan(w A)) with A = 1 / sqrt(1 + h^2).
        // For h^2 below 1e-12 this is (h^2 / 4 pi) (atan w + w / (1 + w^2)) (1 + O(h^2)).
        for height in [1e-6, 1e-7, 1e-8, 1e-10] {
            for width in [1.0, 1e-2, 1e-4, 30.0] {
                let at = |y: f64, z: f64| DVec3::new(1.0, y, z);
                let wall = [at(0.0, 0.0), at(width, 0.0), at(width, height), at(0.0, height)];
                let expected = height * height / (2.0 * TAU) * (f64::atan(width) + width / (1.0 + width * width));
                let factor = precise(&wall, DVec3::Z);
                assert!(
                    (factor / expected - 1.0).abs() < 2e-12 + height * height,
                    "{height} {width}: {factor:e} {expected:e}"
                );
            }
        }
    }

    #[test]
    fn the_series_meets_the_arc_sine() {
        for s in [0.01, 0.1, 0.2, 0.249f64] {
            let x = Double { hi: s, lo: 0.0 } * Double { hi: s, lo: 0.0 };
            assert!((excess(x).hi - (s.asin() / s - 1.0)).abs() < 4e-16, "{s}");
        }
        assert!(excess(Double::ZERO) == Double::ZERO);
    }
}
