//! The grid: finite f64 coordinates as integers relative to an origin.

use super::approx::U;
use super::arena::{Arena, Num, Num3};
use glam::DVec3;

/// The powers of two between which a set of coordinates lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BitRange {
    /// The exponent of the lowest bit that is set in any of them.
    low: i32,
    /// One more than the exponent of the highest.
    high: i32,
}

impl BitRange {
    /// The range of no coordinates at all, or of zeros only.
    pub(crate) const EMPTY: Self = Self { low: i32::MAX, high: i32::MIN };

    pub(crate) fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |range, p| p.to_array().into_iter().fold(range, Self::with))
    }

    /// The range widened to hold `x` too.
    pub(crate) fn with(self, x: f64) -> Self {
        let (mantissa, exponent, _) = decompose(x);
        if mantissa == 0 {
            return self;
        }
        let low = exponent + mantissa.trailing_zeros() as i32;
        let high = exponent + 64 - mantissa.leading_zeros() as i32;
        Self { low: self.low.min(low), high: self.high.max(high) }
    }

    /// True if `x` lies on the grid of this range and is no longer than it.
    pub(crate) fn holds(self, x: f64) -> bool {
        self.with(x) == self
    }

    pub(crate) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// `x = ±mantissa * 2^exponent`; the flag says that it is negative.
fn decompose(x: f64) -> (u64, i32, bool) {
    debug_assert!(x.is_finite());
    let bits = x.to_bits();
    let fraction = bits & ((1 << 52) - 1);
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    (mantissa, exponent, x.is_sign_negative())
}

/// An origin and the grid on which it and all coordinates it will be asked about lie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    origin: DVec3,
    /// The grid's unit is `2^unit`.
    unit: i32,
    /// The origin in grid units, where every difference of two coordinates fits.
    narrow: Option<[i128; 3]>,
}

impl Frame {
    /// A frame for points within `range`.
    pub(crate) fn new(range: BitRange, origin: DVec3) -> Self {
        let range = range.union(BitRange::of([origin]));
        if range == BitRange::EMPTY {
            return Self { origin, unit: 0, narrow: Some([0; 3]) };
        }
        let mut frame = Self { origin, unit: range.low, narrow: None };
        if range.high - range.low <= 125 {
            frame.narrow = Some(origin.to_array().map(|x| frame.narrow_coordinate(x)));
        }
        frame
    }

    fn narrow_coordinate(&self, x: f64) -> i128 {
        let (mantissa, exponent, negative) = decompose(x);
        let shift = exponent - self.unit;
        let magnitude = if shift >= 0 {
            i128::from(mantissa) << shift
        } else {
            i128::from(mantissa >> shift.unsigned_abs().min(63))
        };
        if negative { -magnitude } else { magnitude }
    }

    /// `point - origin` in grid units, where every difference is below `2^126`.
    pub(crate) fn narrow_relative(&self, point: DVec3) -> Option<[i128; 3]> {
        let origin = self.narrow?;
        Some(std::array::from_fn(|axis| self.narrow_coordinate(point[axis]) - origin[axis]))
    }

    /// A coordinate in grid units.
    fn coordinate(&self, arena: &mut Arena, x: f64) -> Num {
        let (mantissa, exponent, negative) = decompose(x);
        if mantissa == 0 {
            return Num::ZERO;
        }
        let shift = exponent - self.unit;
        if shift >= 0 {
            arena.shifted(mantissa, shift.unsigned_abs(), negative)
        } else {
            debug_assert!(mantissa.trailing_zeros() >= shift.unsigned_abs(), "the coordinate lies on the grid");
            arena.shifted(mantissa >> shift.unsigned_abs(), 0, negative)
        }
    }

    /// `value - origin[axis]` in grid units.
    pub(crate) fn relative_coordinate(&self, arena: &mut Arena, axis: usize, value: f64) -> Num {
        if let Some(origin) = self.narrow {
            return arena.integer(self.narrow_coordinate(value) - origin[axis]);
        }
        let x = self.coordinate(arena, value);
        let o = self.coordinate(arena, self.origin[axis]);
        arena.sub(x, o)
    }

    /// `point - origin` in grid units.
    pub(crate) fn relative(&self, arena: &mut Arena, point: DVec3) -> Num3 {
        [0, 1, 2].map(|axis| self.relative_coordinate(arena, axis, point[axis]))
    }

    /// The position `origin + x / w` in scene units with a bound on the error of each coordinate.
    pub(crate) fn position(&self, arena: &mut Arena, x: Num3, w: Num) -> (DVec3, DVec3) {
        let mark = arena.mark();
        let position = DVec3::from([0, 1, 2].map(|axis| {
            let origin = self.coordinate(arena, self.origin[axis]);
            let scaled = arena.mul(origin, w);
            let sum = arena.add(scaled, x[axis]);
            arena.quotient(sum, w, self.unit)
        }));
        arena.release(mark);
        (position, position.abs() * (10.0 * U) + f64::MIN_POSITIVE)
    }
}

/// A vector of three f64 as integers in units of its own.
pub(crate) fn given_vector(arena: &mut Arena, v: DVec3) -> Num3 {
    Frame::new(BitRange::of([v]), DVec3::ZERO).relative(arena, v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Sign;

    #[test]
    fn a_range_holds_what_is_on_its_grid_and_no_longer() {
        let range = BitRange::of([DVec3::new(2.5, -0.25, 0.0)]);
        assert!([0.0, 0.75, -3.75, 2.25].into_iter().all(|x| range.holds(x)));
        assert!(![0.125, 4.0, -2.125, 1e-300].into_iter().any(|x| range.holds(x)));
    }

    #[test]
    fn narrow_and_wide_frames_agree() {
        let mut arena = Arena::default();
        let points = [DVec3::new(1.5, -3.25, 0.1), DVec3::new(-0.0, 7e-9, 1e4), DVec3::new(0.3, 0.3, -0.3)];
        let frame = Frame::new(BitRange::of(points), points[2]);
        assert!(frame.narrow.is_some());
        let wide = Frame { narrow: None, ..frame };
        for p in points {
            let (a, b) = (frame.relative(&mut arena, p), wide.relative(&mut arena, p));
            for (a, b) in a.into_iter().zip(b) {
                assert_eq!(arena.sub(a, b).sign(), Sign::Zero);
            }
        }
    }

    #[test]
    fn a_grid_from_the_least_denormal_to_the_largest_number_is_wide_and_right() {
        let mut arena = Arena::default();
        let p = DVec3::new(f64::from_bits(1), f64::MAX, -f64::from_bits(3));
        let frame = Frame::new(BitRange::of([p]), DVec3::ZERO);
        assert!(frame.narrow.is_none());
        let v = frame.relative(&mut arena, p);
        let three = arena.integer(3);
        let x3 = arena.mul(v[0], three);
        assert_eq!(arena.add(x3, v[2]).sign(), Sign::Zero);
        assert_eq!(v[1].sign(), Sign::Positive);
    }

    #[test]
    fn positions_are_known_up_to_a_few_roundings() {
        let origin = DVec3::new(3.0, -0.5, 1e-3);
        let frame = Frame::new(BitRange::of([origin, DVec3::splat(0.25)]), origin);
        let mut arena = Arena::default();
        let (three, x) = (arena.integer(3), frame.relative(&mut arena, DVec3::new(4.0, -2.0, 7.0)));
        let (position, err) = frame.position(&mut arena, x, three);
        // A third of the way.
        let exact = DVec3::new(10.0 / 3.0, -1.0, (2e-3 + 7.0) / 3.0);
        assert!((position - exact).abs().cmple(err + 1e-15).all(), "{position} {err}");
        assert!(err.cmpgt(DVec3::ZERO).all() && err.cmple(exact.abs() * 2e-15).all(), "{err}");
    }
}
