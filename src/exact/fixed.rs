//! Signs of products of integer vectors of fixed widths: on the stack, without a branch on any value.
//!
//! An integer is a sum of digits `d_k 2^(60 k)` with `|d_k| < 2^60`, all of one sign: its magnitude is below
//! `2^(60 W)` for `W` digits. Products of digits are summed by columns in 128 bits and carried over once,
//! which leaves the multiplications independent of each other. That no column overflows:
//!
//! - A component of a cross product is a sum of at most `2 W` products below `2^120` a column, and below
//!   `2^(120 W + 1)` in all; carried over, its digits are in `[0, 2^60)` but for the last, number
//!   `2 W - 1`, which has the sign and at most `2^(120 W + 1 - 60 (2 W - 1)) = 2^61` in magnitude.
//! - The dot product with a third vector has at most `3 W` products below `2^121` a column: with
//!   `W <= 12`, below `2^126.2`. What is carried over from the column before is below `2^67`.

use super::Sign;
use glam::DVec3;

/// A vector of `W` digits a component.
pub(crate) type Fixed3<const W: usize> = [[i64; W]; 3];

/// Widths from 1 to this are dispatched to here.
pub(crate) const MOST_DIGITS: usize = 12;

/// The bits of a digit.
pub(crate) const DIGIT: u32 = 60;

const MASK: i128 = (1 << DIGIT) - 1;

#[inline]
fn wide(a: i64, b: i64) -> i128 {
    i128::from(a) * i128::from(b)
}

/// The sign of `a . (b x c)`. `C` is `2 W`, `R` is `3 W - 1`.
#[inline]
pub(crate) fn det_sign<const W: usize, const C: usize, const R: usize>(
    a: &Fixed3<W>,
    b: &Fixed3<W>,
    c: &Fixed3<W>,
) -> Sign {
    const { assert!(W <= MOST_DIGITS && C == 2 * W && R == 3 * W - 1) };
    let mut sums = [0; R];
    // One loop, so that there is one copy of its body, with the products inside unrolled.
    for (k, i, j) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let mut columns = [0; C];
        for p in 0..W {
            for q in 0..W {
                columns[p + q] += wide(b[i][p], c[j][q]) - wide(b[j][p], c[i][q]);
            }
        }
        let component = carried(&columns);
        for p in 0..W {
            for q in 0..C {
                sums[p + q] += wide(a[k][p], component[q]);
            }
        }
    }
    sign(&sums)
}

/// `a x b` in signs, which are 0 or -1, and magnitudes: `C` is `2 W`, and digits are in `[0, 2^60)` but for the last.
#[inline]
fn cross<const W: usize, const C: usize>(a: &Fixed3<W>, b: &Fixed3<W>) -> [(i64, [i64; C]); 3] {
    const { assert!(W <= MOST_DIGITS && C == 2 * W) };
    let mut components = [(0, [0; C]); 3];
    for (component, (i, j)) in components.iter_mut().zip([(1, 2), (2, 0), (0, 1)]) {
        let mut columns = [0; C];
        for p in 0..W {
            for q in 0..W {
                columns[p + q] += wide(a[i][p], b[j][q]) - wide(a[j][p], b[i][q]);
            }
        }
        let digits = carried(&columns);
        let sign = digits[C - 1] >> 63;
        *component = (sign, magnitude(digits, sign));
    }
    components
}

/// The number with those digits, carried over, times a sign: 0 for 1, or -1.
#[inline]
fn magnitude<const C: usize>(mut digits: [i64; C], sign: i64) -> [i64; C] {
    let mut carry = 0;
    for digit in &mut digits[..C - 1] {
        let sum = (*digit ^ sign) - sign + carry;
        *digit = sum & MASK as i64;
        carry = sum >> DIGIT;
    }
    digits[C - 1] = (digits[C - 1] ^ sign) - sign + carry;
    digits
}

/// `a x b` up to a positive factor, each component off by at most `2 u` of the largest. `C` is `2 W`.
///
/// The digit at which the largest component begins and the one below it hold at least 61 bits of it; cutting
/// off the others loses less than `2^-60` of it, and rounding what is left loses `u` of each component.
#[inline]
pub(crate) fn rounded_cross<const W: usize, const C: usize>(a: &Fixed3<W>, b: &Fixed3<W>) -> DVec3 {
    let components = cross::<W, C>(a, b);
    let top = (1..C).rev().find(|&d| components.iter().any(|(_, digits)| digits[d] != 0)).unwrap_or(1);
    let mut rounded = DVec3::ZERO;
    for (axis, (sign, digits)) in components.iter().enumerate() {
        let pair = ((digits[top] as u128) << DIGIT | digits[top - 1] as u128) as f64;
        rounded[axis] = if *sign < 0 { -pair } else { pair };
    }
    rounded
}

/// `a x b` for vectors of 126 bits: below `2^253`, so that the last digit is one like the others. With 119 bits, which most scenes do with, below
/// `2^239`: four digits hold it.
pub(crate) fn narrow_cross(a: [i128; 3], b: [i128; 3]) -> Fixed3<6> {
    let most = a.iter().chain(&b).fold(0, |most, x| most | x.unsigned_abs());
    let mut digits = [[0; 6]; 3];
    if most >> 119 == 0 {
        let two = |v: [i128; 3]| v.map(of_i128).map(|[low, high, _]| [low, high]);
        for (component, (sign, four)) in digits.iter_mut().zip(cross::<2, 4>(&two(a), &two(b))) {
            component[..4].copy_from_slice(&four.map(|digit| (digit ^ sign) - sign));
        }
    } else {
        for (component, (sign, six)) in digits.iter_mut().zip(cross::<3, 6>(&a.map(of_i128), &b.map(of_i128))) {
            *component = six.map(|digit| (digit ^ sign) - sign);
        }
    }
    digits
}

/// The sign of `a . b` for vectors of up to four components. `C` is `2 W - 1`.
#[inline]
pub(crate) fn dot_sign<const N: usize, const W: usize, const C: usize>(a: &[[i64; W]; N], b: &[[i64; W]; N]) -> Sign {
    const { assert!(N <= 4 && W <= MOST_DIGITS && C == 2 * W - 1) };
    let mut columns = [0; C];
    for (x, y) in a.iter().zip(b) {
        for p in 0..W {
            for q in 0..W {
                columns[p + q] += wide(x[p], y[q]);
            }
        }
    }
    sign(&columns)
}

/// The sign of `a . b` for parallel vectors, zero for others. `C` is `2 W - 1`.
#[inline]
pub(crate) fn parallel<const W: usize, const C: usize>(a: &Fixed3<W>, b: &Fixed3<W>) -> Sign {
    const { assert!(W <= MOST_DIGITS && C == 2 * W - 1) };
    let alike = |i: usize, j: usize| {
        let mut columns = [0; C];
        for p in 0..W {
            for q in 0..W {
                columns[p + q] += wide(a[i][p], b[j][q]) - wide(a[j][p], b[i][q]);
            }
        }
        sign(&columns).is_zero()
    };
    if alike(1, 2) && alike(2, 0) && alike(0, 1) { dot_sign::<3, W, C>(a, b) } else { Sign::Zero }
}

/// An integer below `2^127` in three digits.
#[inline]
pub(crate) fn of_i128(x: i128) -> [i64; 3] {
    let (magnitude, sign) = (x.unsigned_abs(), if x < 0 { -1 } else { 1 });
    let digit = |k: u32| ((magnitude >> (DIGIT * k)) & MASK as u128) as i64 * sign;
    [digit(0), digit(1), digit(2)]
}

/// Columns carried over to digits.
#[inline]
fn carried<const C: usize>(columns: &[i128; C]) -> [i64; C] {
    let mut digits = [0; C];
    let mut carry = 0;
    for (digit, column) in digits.iter_mut().zip(columns) {
        let sum = column + carry;
        *digit = (sum & MASK) as i64;
        carry = sum >> DIGIT;
    }
    // The last digit keeps what is left, with the sign.
    digits[C - 1] += (carry << DIGIT) as i64;
    digits
}

/// The sign of the number that columns stand for.
#[inline]
fn sign<const C: usize>(columns: &[i128; C]) -> Sign {
    let (mut sum, mut below) = (0, 0);
    for column in columns {
        below |= sum & MASK;
        sum = (sum >> DIGIT) + column;
    }
    // What lies below is not negative, and less than one unit of the last column.
    if sum < 0 {
        Sign::Negative
    } else if sum == 0 && below == 0 {
        Sign::Zero
    } else {
        Sign::Positive
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;

    #[test]
    fn narrow_cross_products_are_exact_in_digits_of_one_sign() {
        let mut state = 1u64;
        let mut random = |bits: u32| {
            let mut word = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                u128::from(state >> 32)
            };
            let magnitude = word() << 96 | word() << 64 | word() << 32 | word();
            let most = (1i128 << bits) - 1;
            match word() % 4 {
                0 => most,
                1 => -most,
                2 => (magnitude >> 2) as i128 & most,
                _ => -((magnitude >> 2) as i128 & most),
            }
        };
        // On both sides of where two digits are enough, and up to the widest.
        for bits in [1, 53, 59, 60, 61, 118, 119, 120, 125, 126] {
            for _ in 0..100 {
                let [a, b] = [0, 1].map(|_| [0, 1, 2].map(|_| random(bits)));
                let digits = narrow_cross(a, b);
                for (component, (i, j)) in digits.iter().zip([(1, 2), (2, 0), (0, 1)]) {
                    let expected = BigInt::from(a[i]) * b[j] - BigInt::from(a[j]) * b[i];
                    let sum = component.iter().rev().fold(BigInt::ZERO, |sum, &digit| (sum << DIGIT) + digit);
                    assert_eq!(sum, expected, "{a:?} {b:?}");
                    assert!(component.iter().all(|digit| digit.abs() >> DIGIT == 0), "{component:?}");
                    let has = |sign: i64| component.iter().any(|digit| digit.signum() == sign);
                    assert!(!(has(1) && has(-1)), "{component:?}");
                }
            }
        }
    }
}
