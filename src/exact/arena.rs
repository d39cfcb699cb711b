//! Integers of any width that live in one growing buffer: no allocation per number.
//!
//! A predicate takes a [`Arena::mark`], computes, reads a sign and goes back to the mark. The
//! buffer keeps its capacity, so that a warmed-up arena does not touch the heap, and there is no
//! width beyond which a result would be wrong: coordinates that span 2,000 bits just take longer.

mod double;

use super::{Approx3, Sign, U, fixed};
use glam::DVec3;
use num_bigint::BigInt;
use std::cmp::Ordering;

/// A signed integer in an [`Arena`]: sign and magnitude, least limb first, no leading zero limbs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Num {
    start: u32,
    len: u32,
    negative: bool,
}

impl Num {
    pub(crate) const ZERO: Self = Self { start: 0, len: 0, negative: false };

    pub(crate) fn sign(self) -> Sign {
        match (self.len, self.negative) {
            (0, _) => Sign::Zero,
            (_, true) => Sign::Negative,
            (_, false) => Sign::Positive,
        }
    }

    pub(crate) fn negated(self) -> Self {
        Self { negative: !self.negative, ..self }
    }

    /// The number times the sign, which is not zero.
    pub(crate) fn times_sign(self, sign: Sign) -> Self {
        debug_assert!(!sign.is_zero());
        if sign.is_negative() { self.negated() } else { self }
    }
}

/// A vector of integers.
pub(crate) type Num3 = [Num; 3];

/// A vector that stays: in digits if [`fixed::MOST_DIGITS`] hold it, in limbs if not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept3 {
    /// Where the digits start in [`Arena::digits`], one component after the other.
    start: u32,
    /// Digits a component.
    width: u32,
    /// The limbs where there are too many digits, zeros elsewhere.
    wide: Num3,
}

/// Zeros after the last digit, so that reading more digits than a number has stays within the buffer.
const PADDING: usize = fixed::MOST_DIGITS;

/// The buffer.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arena {
    limbs: Vec<u64>,
    /// The digits of vectors that stay, and [`PADDING`] zeros.
    digits: Vec<i64>,
    /// How many signs were too wide for fixed widths.
    arbitrary: u64,
}

impl Arena {
    /// The place to come back to with [`Arena::release`].
    pub(crate) fn mark(&self) -> usize {
        self.limbs.len()
    }

    /// How many signs were decided with integers of arbitrary width so far.
    pub(crate) fn arbitrary_signs(&self) -> u64 {
        self.arbitrary
    }

    /// Forgets every number made since the mark was taken.
    pub(crate) fn release(&mut self, mark: usize) {
        self.limbs.truncate(mark);
    }

    fn finish(&mut self, start: usize, negative: bool) -> Num {
        while self.limbs.len() > start && self.limbs.last() == Some(&0) {
            self.limbs.pop();
        }
        debug_assert!(u32::try_from(self.limbs.len()).is_ok(), "numbers are released long before 32 GiB");
        Num { start: start as u32, len: (self.limbs.len() - start) as u32, negative }
    }

    fn range(n: Num) -> std::ops::Range<usize> {
        n.start as usize..n.start as usize + n.len as usize
    }

    /// The number outside of the arena.
    pub(crate) fn big(&self, n: Num) -> BigInt {
        let limbs = self.limbs[Self::range(n)].iter();
        let digits: Vec<u32> = limbs.flat_map(|&limb| [limb as u32, (limb >> 32) as u32]).collect();
        BigInt::from_slice(if n.negative { num_bigint::Sign::Minus } else { num_bigint::Sign::Plus }, &digits)
    }

    pub(crate) fn integer(&mut self, value: i128) -> Num {
        let start = self.limbs.len();
        let magnitude = value.unsigned_abs();
        self.limbs.extend([magnitude as u64, (magnitude >> 64) as u64]);
        self.finish(start, value < 0)
    }

    /// `mantissa * 2^shift` with the sign given apart.
    pub(crate) fn shifted(&mut self, mantissa: u64, shift: u32, negative: bool) -> Num {
        let start = self.limbs.len();
        self.limbs.resize(start + shift as usize / 64, 0);
        let wide = u128::from(mantissa) << (shift % 64);
        self.limbs.extend([wide as u64, (wide >> 64) as u64]);
        self.finish(start, negative)
    }

    pub(crate) fn mul(&mut self, a: Num, b: Num) -> Num {
        if a.len == 0 || b.len == 0 {
            return Num::ZERO;
        }
        let start = self.limbs.len();
        self.limbs.resize(start + (a.len + b.len) as usize, 0);
        let (known, out) = self.limbs.split_at_mut(start);
        let (a_limbs, b_limbs) = (&known[Self::range(a)], &known[Self::range(b)]);
        for (i, &x) in a_limbs.iter().enumerate() {
            // Numbers of very different size on one grid are mostly zeros.
            if x == 0 {
                continue;
            }
            let mut carry = 0u64;
            let row = &mut out[i..=i + b_limbs.len()];
            for (o, &y) in row.iter_mut().zip(b_limbs) {
                let t = u128::from(x) * u128::from(y) + u128::from(*o) + u128::from(carry);
                *o = t as u64;
                carry = (t >> 64) as u64;
            }
            row[b_limbs.len()] = carry;
        }
        self.finish(start, a.negative != b.negative)
    }

    fn compare_magnitudes(&self, a: Num, b: Num) -> Ordering {
        a.len.cmp(&b.len).then_with(|| {
            let (a, b) = (&self.limbs[Self::range(a)], &self.limbs[Self::range(b)]);
            a.iter().rev().cmp(b.iter().rev())
        })
    }

    pub(crate) fn add(&mut self, a: Num, b: Num) -> Num {
        if a.negative == b.negative || a.len == 0 || b.len == 0 {
            let negative = if a.len == 0 { b.negative } else { a.negative };
            return self.add_magnitudes(a, b, negative);
        }
        match self.compare_magnitudes(a, b) {
            Ordering::Equal => Num::ZERO,
            Ordering::Greater => self.subtract_magnitudes(a, b, a.negative),
            Ordering::Less => self.subtract_magnitudes(b, a, b.negative),
        }
    }

    pub(crate) fn sub(&mut self, a: Num, b: Num) -> Num {
        self.add(a, b.negated())
    }

    fn add_magnitudes(&mut self, a: Num, b: Num, negative: bool) -> Num {
        let (long, short) = if a.len >= b.len { (a, b) } else { (b, a) };
        let start = self.limbs.len();
        let mut carry = false;
        for k in 0..long.len {
            let x = self.limbs[(long.start + k) as usize];
            let y = if k < short.len { self.limbs[(short.start + k) as usize] } else { 0 };
            let (t, first) = x.overflowing_add(y);
            let (t, second) = t.overflowing_add(u64::from(carry));
            carry = first || second;
            self.limbs.push(t);
        }
        self.limbs.push(u64::from(carry));
        self.finish(start, negative)
    }

    /// `|a| - |b|`, which must not be negative.
    fn subtract_magnitudes(&mut self, a: Num, b: Num, negative: bool) -> Num {
        let start = self.limbs.len();
        let mut borrow = false;
        for k in 0..a.len {
            let x = self.limbs[(a.start + k) as usize];
            let y = if k < b.len { self.limbs[(b.start + k) as usize] } else { 0 };
            let (t, first) = x.overflowing_sub(y);
            let (t, second) = t.overflowing_sub(u64::from(borrow));
            borrow = first || second;
            self.limbs.push(t);
        }
        debug_assert!(!borrow);
        self.finish(start, negative)
    }

    pub(crate) fn sub3(&mut self, a: Num3, b: Num3) -> Num3 {
        [self.sub(a[0], b[0]), self.sub(a[1], b[1]), self.sub(a[2], b[2])]
    }

    pub(crate) fn add3(&mut self, a: Num3, b: Num3) -> Num3 {
        [self.add(a[0], b[0]), self.add(a[1], b[1]), self.add(a[2], b[2])]
    }

    pub(crate) fn scale3(&mut self, factor: Num, v: Num3) -> Num3 {
        v.map(|x| self.mul(factor, x))
    }

    pub(crate) fn cross(&mut self, a: Num3, b: Num3) -> Num3 {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
            let p = self.mul(a[i], b[j]);
            let q = self.mul(a[j], b[i]);
            self.sub(p, q)
        })
    }

    pub(crate) fn dot(&mut self, a: Num3, b: Num3) -> Num {
        let x = self.mul(a[0], b[0]);
        let y = self.mul(a[1], b[1]);
        let z = self.mul(a[2], b[2]);
        let xy = self.add(x, y);
        self.add(xy, z)
    }

    /// The sign of `a . b`; leaves nothing behind.
    pub(crate) fn dot_sign(&mut self, a: Num3, b: Num3) -> Sign {
        match self.width(a).max(self.width(b)) {
            0..=2 => fixed::dot_sign::<3, 2, 3>(&self.fixed(a), &self.fixed(b)),
            3..=4 => fixed::dot_sign::<3, 4, 7>(&self.fixed(a), &self.fixed(b)),
            5..=8 => fixed::dot_sign::<3, 8, 15>(&self.fixed(a), &self.fixed(b)),
            9..=fixed::MOST_DIGITS => fixed::dot_sign::<3, 12, 23>(&self.fixed(a), &self.fixed(b)),
            _ => self.wide_dot_sign(a, b),
        }
    }

    /// The same for vectors that were kept.
    pub(crate) fn kept_dot_sign(&mut self, a: &Kept3, b: &Kept3) -> Sign {
        macro_rules! fixed {
            ($w:literal) => {
                fixed::dot_sign::<3, $w, { 2 * $w - 1 }>(&self.digits(a), &self.digits(b))
            };
        }
        match a.width.max(b.width) as usize {
            0..=1 => fixed!(1),
            2 => fixed!(2),
            3 => fixed!(3),
            4 => fixed!(4),
            5..=6 => fixed!(6),
            7..=8 => fixed!(8),
            9..=fixed::MOST_DIGITS => fixed!(12),
            _ => {
                let mark = self.mark();
                let [a, b] = [a, b].map(|v| self.numbers(v));
                let sign = self.wide_dot_sign(a, b);
                self.release(mark);
                sign
            }
        }
    }

    /// [`Arena::parallel`] for vectors that were kept.
    pub(crate) fn kept_parallel(&mut self, a: &Kept3, b: &Kept3) -> Sign {
        macro_rules! fixed {
            ($w:literal) => {
                fixed::parallel::<$w, { 2 * $w - 1 }>(&self.digits(a), &self.digits(b))
            };
        }
        match a.width.max(b.width) as usize {
            0..=2 => fixed!(2),
            3 => fixed!(3),
            4 => fixed!(4),
            5..=8 => fixed!(8),
            9..=fixed::MOST_DIGITS => fixed!(12),
            _ => {
                let mark = self.mark();
                let [a, b] = [a, b].map(|v| self.numbers(v));
                let sign = self.parallel(a, b);
                self.release(mark);
                sign
            }
        }
    }

    #[cold]
    fn wide_dot_sign(&mut self, a: Num3, b: Num3) -> Sign {
        self.arbitrary += 1;
        let mark = self.mark();
        let sign = self.dot(a, b).sign();
        self.release(mark);
        sign
    }

    /// The sign of `a . (b x c)`; leaves nothing behind.
    pub(crate) fn det_sign(&mut self, a: Num3, b: Num3, c: Num3) -> Sign {
        macro_rules! fixed {
            ($w:literal) => {
                fixed::det_sign::<$w, { 2 * $w }, { 3 * $w - 1 }>(&self.fixed(a), &self.fixed(b), &self.fixed(c))
            };
        }
        match self.width(a).max(self.width(b)).max(self.width(c)) {
            0..=2 => fixed!(2),
            3..=4 => fixed!(4),
            5..=8 => fixed!(8),
            9..=fixed::MOST_DIGITS => fixed!(12),
            _ => self.wide_det_sign(a, b, c),
        }
    }

    /// The same for vectors that were kept.
    pub(crate) fn kept_det_sign(&mut self, a: &Kept3, b: &Kept3, c: &Kept3) -> Sign {
        macro_rules! fixed {
            ($w:literal) => {
                fixed::det_sign::<$w, { 2 * $w }, { 3 * $w - 1 }>(&self.digits(a), &self.digits(b), &self.digits(c))
            };
        }
        match a.width.max(b.width).max(c.width) as usize {
            0..=1 => fixed!(1),
            2 => fixed!(2),
            3 => fixed!(3),
            4 => fixed!(4),
            5 => fixed!(5),
            6 => fixed!(6),
            7 => fixed!(7),
            8 => fixed!(8),
            9..=fixed::MOST_DIGITS => fixed!(12),
            _ => {
                let mark = self.mark();
                let [a, b, c] = [a, b, c].map(|v| self.numbers(v));
                let sign = self.wide_det_sign(a, b, c);
                self.release(mark);
                sign
            }
        }
    }

    /// `a x b` rounded; leaves nothing behind.
    pub(crate) fn kept_cross(&mut self, a: &Kept3, b: &Kept3) -> Approx3 {
        macro_rules! fixed {
            ($w:literal) => {
                fixed::rounded_cross::<$w, { 2 * $w }>(&self.digits(a), &self.digits(b))
            };
        }
        let cross = match a.width.max(b.width) as usize {
            0..=2 => fixed!(2),
            3 => fixed!(3),
            4 => fixed!(4),
            5..=6 => fixed!(6),
            7..=8 => fixed!(8),
            9..=fixed::MOST_DIGITS => fixed!(12),
            _ => {
                let mark = self.mark();
                let [a, b] = [a, b].map(|v| self.numbers(v));
                let cross = self.cross(a, b);
                let cross = self.direction(cross);
                self.release(mark);
                cross
            }
        };
        Approx3::known(cross, 4.0 * U * cross.abs().max_element())
    }

    #[cold]
    fn wide_det_sign(&mut self, a: Num3, b: Num3, c: Num3) -> Sign {
        self.arbitrary += 1;
        let mark = self.mark();
        let cross = self.cross(b, c);
        let sign = self.dot(a, cross).sign();
        self.release(mark);
        sign
    }

    /// The sign of `normal . x + height w`; leaves nothing behind.
    pub(crate) fn height_sign(&mut self, normal: Num3, height: Num, x: Num3, w: Num) -> Sign {
        let (plane, point) = ([normal[0], normal[1], normal[2], height], [x[0], x[1], x[2], w]);
        match self.width(plane).max(self.width(point)) {
            0..=4 => fixed::dot_sign::<4, 4, 7>(&self.fixed(plane), &self.fixed(point)),
            5..=8 => fixed::dot_sign::<4, 8, 15>(&self.fixed(plane), &self.fixed(point)),
            9..=fixed::MOST_DIGITS => fixed::dot_sign::<4, 12, 23>(&self.fixed(plane), &self.fixed(point)),
            _ => {
                self.arbitrary += 1;
                let mark = self.mark();
                let along = self.dot(normal, x);
                let offset = self.mul(height, w);
                let sign = self.add(along, offset).sign();
                self.release(mark);
                sign
            }
        }
    }

    /// Positive if two vectors other than 0 point the same way, negative if they point opposite ways,
    /// zero if they are not parallel; leaves nothing behind.
    pub(crate) fn parallel(&mut self, a: Num3, b: Num3) -> Sign {
        match self.width(a).max(self.width(b)) {
            0..=4 => fixed::parallel::<4, 7>(&self.fixed(a), &self.fixed(b)),
            5..=8 => fixed::parallel::<8, 15>(&self.fixed(a), &self.fixed(b)),
            9..=fixed::MOST_DIGITS => fixed::parallel::<12, 23>(&self.fixed(a), &self.fixed(b)),
            _ => {
                self.arbitrary += 1;
                let mark = self.mark();
                let parallel = self.cross(a, b).into_iter().all(|x| x.sign().is_zero());
                let sign = if parallel { self.dot(a, b).sign() } else { Sign::Zero };
                self.release(mark);
                sign
            }
        }
    }

    /// How many digits hold each of the components.
    fn width<const N: usize>(&self, v: [Num; N]) -> usize {
        let bits = |n: Num| match self.limbs[Self::range(n)].last() {
            None => 0,
            Some(top) => n.len * 64 - top.leading_zeros(),
        };
        v.into_iter().map(bits).fold(0, u32::max).div_ceil(fixed::DIGIT) as usize
    }

    /// The digit number `k` of a number.
    fn digit(&self, n: Num, k: usize) -> i64 {
        let limbs = &self.limbs[Self::range(n)];
        let (limb, shift) = (k * fixed::DIGIT as usize / 64, k as u32 * fixed::DIGIT % 64);
        let limb_at = |i: usize| u128::from(limbs.get(i).copied().unwrap_or(0));
        let pair = limb_at(limb) | limb_at(limb + 1) << 64;
        let digit = (pair >> shift) as i64 & ((1 << fixed::DIGIT) - 1);
        if n.negative { -digit } else { digit }
    }

    /// The vector in digits; `W` must be at least its width.
    fn fixed<const N: usize, const W: usize>(&self, v: [Num; N]) -> [[i64; W]; N] {
        v.map(|n| std::array::from_fn(|k| self.digit(n, k)))
    }

    /// The copy in digits of a vector that was kept; `W` must be at least its width.
    #[inline]
    fn digits<const W: usize>(&self, v: &Kept3) -> fixed::Fixed3<W> {
        let (start, width) = (v.start as usize, v.width as usize);
        let mut digits = [[0; W]; 3];
        for (c, component) in digits.iter_mut().enumerate() {
            // Always as many as are wanted, whatever they are: a copy of a known length needs no call.
            let window = &self.digits[start + c * width..][..W];
            for k in 0..W {
                component[k] = if k < width { window[k] } else { 0 };
            }
        }
        digits
    }

    /// Forgets everything, kept or not. The memory is kept for what comes next.
    pub(crate) fn clear(&mut self) {
        self.limbs.clear();
        self.digits.clear();
    }

    /// Keeps a vector and releases all that was made since `mark`; what is kept in limbs moves down to it.
    pub(crate) fn keep3(&mut self, mark: usize, v: Num3) -> Kept3 {
        let width = self.width(v);
        if width > fixed::MOST_DIGITS {
            let tail = self.limbs.len();
            let mut wide = v;
            let mut place = mark;
            for n in &mut wide {
                self.limbs.extend_from_within(Self::range(*n));
                n.start = place as u32;
                place += n.len as usize;
            }
            self.limbs.copy_within(tail.., mark);
            self.limbs.truncate(place);
            return Kept3 { start: 0, width: width as u32, wide };
        }
        let start = self.start_digits();
        for n in v {
            for k in 0..width {
                let digit = self.digit(n, k);
                self.digits.push(digit);
            }
        }
        self.release(mark);
        self.finish_digits(start, width)
    }

    /// Keeps a vector that was made in digits.
    pub(crate) fn keep_digits<const W: usize>(&mut self, v: &fixed::Fixed3<W>) -> Kept3 {
        let width = (0..W).rev().find(|&k| v.iter().any(|digits| digits[k] != 0)).map_or(0, |k| k + 1);
        let start = self.start_digits();
        for digits in v {
            self.digits.extend_from_slice(&digits[..width]);
        }
        self.finish_digits(start, width)
    }

    fn start_digits(&mut self) -> usize {
        let start = self.digits.len().saturating_sub(PADDING);
        self.digits.truncate(start);
        debug_assert!(u32::try_from(start).is_ok(), "vectors are forgotten long before 32 GiB");
        start
    }

    fn finish_digits(&mut self, start: usize, width: usize) -> Kept3 {
        self.digits.resize(self.digits.len() + PADDING, 0);
        Kept3 { start: start as u32, width: width as u32, wide: [Num::ZERO; 3] }
    }

    /// A vector that was kept, in limbs.
    pub(crate) fn numbers(&mut self, v: &Kept3) -> Num3 {
        let (start, width) = (v.start as usize, v.width as usize);
        if width > fixed::MOST_DIGITS {
            return v.wide;
        }
        [0, 1, 2].map(|component| {
            let mut sum = Num::ZERO;
            for k in 0..width {
                let digit = self.digits[start + component * width + k];
                let term = self.shifted(digit.unsigned_abs(), k as u32 * fixed::DIGIT, digit < 0);
                sum = self.add(sum, term);
            }
            sum
        })
    }

    /// A vector that was kept, rounded; leaves nothing behind.
    pub(crate) fn kept_rounded(&mut self, v: &Kept3) -> Approx3 {
        let mark = self.mark();
        let vector = self.numbers(v);
        let approx = Approx3::rounded(self, vector);
        self.release(mark);
        approx
    }

    /// The vector scaled by a power of two to a largest component in `[0.5, 1]`, each component
    /// with a relative error below `2 u` or an absolute one below 2^-500; zero stays zero.
    pub(crate) fn direction(&self, v: Num3) -> DVec3 {
        let parts = v.map(|n| self.mantissa_and_exponent(n));
        let most = parts.iter().filter(|part| part.0 != 0.0).map(|part| part.1).max().unwrap_or(0);
        DVec3::from(parts.map(|(mantissa, exponent)| mantissa * power_of_two(exponent - most)))
    }

    /// `numerator / denominator * 2^exponent`, with a relative error below `8 u` where it does not
    /// under- or overflow.
    pub(crate) fn quotient(&self, numerator: Num, denominator: Num, exponent: i32) -> f64 {
        let (n, i) = self.mantissa_and_exponent(numerator);
        let (d, j) = self.mantissa_and_exponent(denominator);
        let exponent = i - j + i64::from(exponent);
        // In two steps: the power alone may be out of range where the result is not.
        let half = exponent / 2;
        n / d * power_of_two(half) * power_of_two(exponent - half)
    }

    /// `(m, e)` with `m 2^e` the number up to a relative error of `2 u` and `|m|` in `[0.5, 1]`; `(0, 0)`
    /// for zero.
    fn mantissa_and_exponent(&self, n: Num) -> (f64, i64) {
        let limbs = &self.limbs[Self::range(n)];
        let Some(top) = limbs.last() else { return (0.0, 0) };
        let exponent = i64::from(n.len) * 64 - i64::from(top.leading_zeros());
        // The two top limbs hold at least 65 significant bits, or all of the number.
        let low = limbs.len().saturating_sub(2);
        let pair = limbs[low..].iter().rev().fold(0u128, |sum, &limb| sum << 64 | u128::from(limb));
        let mantissa = pair as f64 * power_of_two(64 * low as i64 - exponent);
        (if n.negative { -mantissa } else { mantissa }, exponent)
    }
}

/// `2^exponent`, 0 or infinite where f64 cannot hold it.
fn power_of_two(exponent: i64) -> f64 {
    match exponent {
        -1022..=1023 => f64::from_bits(((exponent + 1023) as u64) << 52),
        _ => 2f64.powi(exponent.clamp(-1100, 1100) as i32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use proptest::prelude::*;

    fn big(arena: &Arena, n: Num) -> BigInt {
        let mut value = BigInt::from(0);
        for &limb in arena.limbs[Arena::range(n)].iter().rev() {
            value = (value << 64) + BigInt::from(limb);
        }
        if n.negative { -value } else { value }
    }

    /// The largest component of a vector has so many bits.
    fn of_bits(arena: &mut Arena, bits: u32) -> Num3 {
        let top = arena.shifted(1, bits - 1, false);
        [top, arena.integer(-3), arena.integer(5)]
    }

    fn kept(arena: &mut Arena, v: Num3) -> Kept3 {
        let mark = arena.mark();
        let one = arena.integer(1);
        let copy = arena.scale3(one, v);
        arena.keep3(mark, copy)
    }

    #[test]
    fn only_signs_beyond_the_fixed_widths_are_counted_as_arbitrary() {
        let most = fixed::MOST_DIGITS as u32 * fixed::DIGIT;
        for (bits, wide) in
            [(3, 0), (61, 0), (120, 0), (121, 0), (241, 0), (481, 0), (most, 0), (most + 1, 1), (3000, 1)]
        {
            let mut arena = Arena::default();
            let long = of_bits(&mut arena, bits);
            let short = [2, 7, 1].map(|x| arena.integer(x));
            let other = [0, 1, -1].map(|x| arena.integer(x));
            let [kept_long, kept_short, kept_other] = [long, short, other].map(|v| kept(&mut arena, v));
            let mut counted = |what: &str, times: u64, sign: Sign, work: &dyn Fn(&mut Arena) -> Sign| {
                let (before, mark) = (arena.arbitrary_signs(), arena.mark());
                assert_eq!(work(&mut arena), sign, "{what} of {bits} bits");
                assert_eq!(arena.arbitrary_signs() - before, times * wide, "{what} of {bits} bits");
                assert_eq!(arena.mark(), mark, "{what} of {bits} bits leaves something behind");
            };
            // long = (2^k, -3, 5), short = (2, 7, 1), other = (0, 1, -1): short x other = (-8, 2, 2).
            counted("dot", 1, if bits > 3 { Sign::Positive } else { Sign::Negative }, &|a| a.dot_sign(long, short));
            counted("dot", 1, Sign::Negative, &|a| a.dot_sign(other, long));
            counted("det", 1, Sign::Negative, &|a| a.det_sign(long, short, other));
            counted("det", 1, Sign::Positive, &|a| a.det_sign(short, long, other));
            counted("det", 1, Sign::Negative, &|a| a.det_sign(short, other, long));
            counted("height", 1, Sign::Positive, &|a| a.height_sign(other, short[0], long, short[1]));
            counted("height", 1, Sign::Negative, &|a| a.height_sign(other, short[0].negated(), long, short[1]));
            counted("height", 1, Sign::Positive, &|a| a.height_sign(other, long[0], short, short[1]));
            counted("parallel", 1, Sign::Zero, &|a| a.parallel(long, short));
            counted("parallel", 1, Sign::Positive, &|a| a.parallel(long, long));
            counted("kept dot", 1, Sign::Negative, &|a| a.kept_dot_sign(&kept_other, &kept_long));
            counted("kept det", 1, Sign::Negative, &|a| a.kept_det_sign(&kept_long, &kept_short, &kept_other));
            counted("kept det", 1, Sign::Positive, &|a| a.kept_det_sign(&kept_short, &kept_long, &kept_other));
            counted("kept det", 1, Sign::Negative, &|a| a.kept_det_sign(&kept_short, &kept_other, &kept_long));
            counted("kept parallel", 1, Sign::Zero, &|a| a.kept_parallel(&kept_short, &kept_long));
            counted("kept parallel", 1, Sign::Positive, &|a| a.kept_parallel(&kept_long, &kept_long));
        }
    }

    proptest! {
        #[test]
        fn arithmetic_agrees_with_big_integers(
            a in any::<i128>(), b in any::<i128>(), c in any::<i64>(), shift in prop_oneof![3 => 0u32..300, 1 => 300u32..2200],
            m in any::<u64>(), negative: bool,
        ) {
            let mut arena = Arena::default();
            let (x, y, z) = (arena.integer(a), arena.integer(b), arena.integer(i128::from(c)));
            let w = arena.shifted(m, shift, negative);
            let bw: BigInt = (BigInt::from(m) << shift) * if negative { -1 } else { 1 };
            prop_assert_eq!(big(&arena, w), bw.clone());
            let xy = arena.mul(x, y);
            let xyw = arena.mul(xy, w);
            let sum = arena.add(xyw, z);
            let difference = arena.sub(z, xyw);
            let exact = BigInt::from(a) * BigInt::from(b) * &bw;
            prop_assert_eq!(big(&arena, sum), &exact + BigInt::from(c));
            prop_assert_eq!(big(&arena, difference), BigInt::from(c) - &exact);
            let zero = arena.sub(sum, sum);
            prop_assert_eq!(zero.sign(), Sign::Zero);
            let vectors = [[x, y, w], [z, xyw, y], [sum, x, z], [difference, w, zero]];
            for v in vectors {
                for w in vectors {
                    let exact = arena.dot(v, w).sign();
                    prop_assert_eq!(arena.dot_sign(v, w), exact);
                    let (along, offset) = (arena.dot(v, w), arena.mul(v[0], w[2]));
                    let height = arena.add(along, offset).sign();
                    prop_assert_eq!(arena.height_sign(v, v[0], w, w[2]), height);
                    let parallel = arena.cross(v, w).into_iter().all(|x| x.sign().is_zero());
                    prop_assert_eq!(arena.parallel(v, w), if parallel { exact } else { Sign::Zero });
                    for u in vectors {
                        let cross = arena.cross(v, w);
                        let exact = arena.dot(u, cross).sign();
                        prop_assert_eq!(arena.det_sign(u, v, w), exact);
                    }
                }
            }
            let kept = vectors.map(|v| {
                let mark = arena.mark();
                let one = arena.integer(1);
                let copy = arena.scale3(one, v);
                (v, arena.keep3(mark, copy))
            });
            for (v, kept_v) in &kept {
                let back = arena.numbers(kept_v);
                for (n, m) in v.iter().zip(back) {
                    prop_assert_eq!(big(&arena, *n), big(&arena, m));
                }
                for (w, kept_w) in &kept {
                    prop_assert_eq!(arena.kept_dot_sign(kept_v, kept_w), arena.dot_sign(*v, *w));
                    prop_assert_eq!(arena.kept_parallel(kept_v, kept_w), arena.parallel(*v, *w));
                    let cross = arena.cross(*v, *w);
                    let (exact, approx) = (Approx3::rounded(&arena, cross), arena.kept_cross(kept_v, kept_w));
                    let off = (exact.v - approx.v).abs().max_element();
                    prop_assert!(off <= exact.error_bound() + approx.error_bound(), "{} {}", exact.v, approx.v);
                    for (u, kept_u) in &kept {
                        prop_assert_eq!(arena.kept_det_sign(kept_u, kept_v, kept_w), arena.det_sign(*u, *v, *w));
                    }
                }
            }
            let direction = arena.direction([x, y, xyw]);
            prop_assert!(direction.abs().max_element() <= 1.0);
            prop_assert_eq!(Sign::of(direction.z), xyw.sign());
        }
    }
}
