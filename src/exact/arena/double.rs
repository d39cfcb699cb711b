//! Vectors of integers rounded to twice the precision of `f64`.

use super::{Arena, Kept3, Num, Num3, power_of_two};
use glam::DVec3;

impl Arena {
    /// A vector that was kept as an unevaluated sum of two vectors, scaled by a power of two to a largest component in `[0.5, 1]`: each
    /// component with a relative error below 2^-103, or an absolute one below 2^-500; zero stays zero. Leaves nothing behind.
    pub(crate) fn kept_sum(&mut self, v: &Kept3) -> [DVec3; 2] {
        let mark = self.mark();
        let vector = self.numbers(v);
        let sum = self.sum(vector);
        self.release(mark);
        sum
    }

    /// The same of `a x b`.
    pub(crate) fn kept_cross_sum(&mut self, a: &Kept3, b: &Kept3) -> [DVec3; 2] {
        let mark = self.mark();
        let [a, b] = [a, b].map(|v| self.numbers(v));
        let cross = self.cross(a, b);
        let sum = self.sum(cross);
        self.release(mark);
        sum
    }

    fn sum(&mut self, v: Num3) -> [DVec3; 2] {
        let parts = v.map(|n| {
            let high = self.mantissa_and_exponent(n);
            let rest = self.less(n, high);
            [high, self.mantissa_and_exponent(rest)]
        });
        let most = parts.iter().filter(|[high, _]| high.0 != 0.0).map(|[high, _]| high.1).max().unwrap_or(0);
        [0, 1].map(|k| DVec3::from(parts.map(|part| part[k].0 * power_of_two(part[k].1 - most))))
    }

    /// `n - mantissa 2^exponent` for the two of [`Arena::mantissa_and_exponent`].
    fn less(&mut self, n: Num, (mantissa, exponent): (f64, i64)) -> Num {
        // A number of 53 bits is its own mantissa.
        let shift = exponent - 53;
        if shift <= 0 {
            return Num::ZERO;
        }
        // A whole number, of at most 2^53.
        let whole = (mantissa.abs() * (1u64 << 53) as f64) as u64;
        let rounded = self.shifted(whole, shift as u32, mantissa < 0.0);
        self.sub(n, rounded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use num_traits::{Signed, Zero};
    use proptest::prelude::*;

    fn rational(x: f64) -> BigRational {
        BigRational::from_float(x).expect("finite")
    }

    proptest! {
        #[test]
        fn sums_are_right_to_twice_the_precision(
            a in prop::array::uniform3(any::<i128>()), b in prop::array::uniform3(any::<i64>()), shift in 0u32..200,
        ) {
            let mut arena = Arena::default();
            let long = a.map(|x| arena.integer(x));
            let short = b.map(|x| arena.shifted(x.unsigned_abs(), shift, x < 0));
            let cross = arena.cross(long, short);
            let exact = cross.map(|n| BigRational::from(arena.big(n)));
            let [long, short] = [long, short].map(|v| {
                let mark = arena.mark();
                let one = arena.integer(1);
                let copy = arena.scale3(one, v);
                arena.keep3(mark, copy)
            });
            let mark = arena.mark();
            let [high, low] = arena.kept_cross_sum(&long, &short);
            prop_assert_eq!(arena.mark(), mark);
            prop_assume!(exact.iter().any(|x| !x.is_zero()));
            let most = high.abs().max_element();
            prop_assert!((0.5..=1.0).contains(&most), "{most}");
            // The power of two is that of the largest component.
            let axis = high.abs().max_position();
            let ratio = (&exact[axis] / rational(high[axis])).abs();
            let power = ratio.to_integer().bits();
            let near = [power.saturating_sub(1), power].map(|p| BigRational::from(BigInt::from(1) << p));
            let is_close = |power: &BigRational| (0..3).all(|k| {
                let off = (rational(high[k]) + rational(low[k])) * power - &exact[k];
                off.abs() <= exact[k].abs() * rational(2f64.powi(-103))
            });
            prop_assert!(near.iter().any(is_close), "{high} {low}");
        }
    }
}
