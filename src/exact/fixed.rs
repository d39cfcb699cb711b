//! Signs of products of integer vectors of fixed widths: on the stack, without a branch on any value.
//!
//! Integers are two's complement, least limb first. A vector of width `W` has components below
//! `2^(64 W - 1)` in magnitude. Then a component of a cross product of two such vectors is below
//! `2 * 2^(128 W - 2) = 2^(128 W - 1)` and fits `2 W` limbs; the three terms of its dot product with a
//! third are below `2^(192 W - 2)` each, and their sum fits `3 W + 1` limbs. Four products of two components
//! are below `2^(128 W - 2)` each, and their sum fits `2 W + 1`.

use super::Sign;

/// A vector of `W` limbs a component.
pub(crate) type Fixed3<const W: usize> = [[u64; W]; 3];

/// Widths from 1 to this are dispatched to here.
pub(crate) const MOST_LIMBS: usize = 12;

/// The sign of `a . (b x c)`. `W2` is `2 W`, `W3` is `3 W + 1`.
#[inline]
pub(crate) fn det_sign<const W: usize, const W2: usize, const W3: usize>(
    a: &Fixed3<W>,
    b: &Fixed3<W>,
    c: &Fixed3<W>,
) -> Sign {
    let component = |i: usize, j: usize| sub(&mul::<W, W, W2>(&b[i], &c[j]), &mul::<W, W, W2>(&b[j], &c[i]));
    let mut sum = mul::<W, W2, W3>(&a[0], &component(1, 2));
    sum = add(&sum, &mul::<W, W2, W3>(&a[1], &component(2, 0)));
    sum = add(&sum, &mul::<W, W2, W3>(&a[2], &component(0, 1)));
    sign(&sum)
}

/// The sign of `a . b` for vectors of up to four components. `W2` is `2 W + 1`.
#[inline]
pub(crate) fn dot_sign<const N: usize, const W: usize, const W2: usize>(a: &[[u64; W]; N], b: &[[u64; W]; N]) -> Sign {
    const { assert!(N <= 4) };
    let mut sum = [0; W2];
    for (x, y) in a.iter().zip(b) {
        sum = add(&sum, &mul::<W, W, W2>(x, y));
    }
    sign(&sum)
}

/// The sign of `a . b` for parallel vectors, zero for others. `W2` is `2 W`, `W3` is `2 W + 1`.
#[inline]
pub(crate) fn parallel<const W: usize, const W2: usize, const W3: usize>(a: &Fixed3<W>, b: &Fixed3<W>) -> Sign {
    let alike = |i: usize, j: usize| mul::<W, W, W2>(&a[i], &b[j]) == mul::<W, W, W2>(&a[j], &b[i]);
    if alike(1, 2) && alike(2, 0) && alike(0, 1) { dot_sign::<3, W, W3>(a, b) } else { Sign::Zero }
}

/// An integer in two limbs.
#[inline]
pub(crate) fn of_i128(x: i128) -> [u64; 2] {
    [x as u64, (x >> 64) as u64]
}

/// The product, sign-extended to `C >= A + B` limbs.
#[inline]
fn mul<const A: usize, const B: usize, const C: usize>(a: &[u64; A], b: &[u64; B]) -> [u64; C] {
    let mut out = [0; C];
    for i in 0..A {
        let mut carry = 0;
        for j in 0..B {
            let t = u128::from(a[i]) * u128::from(b[j]) + u128::from(out[i + j]) + u128::from(carry);
            out[i + j] = t as u64;
            carry = (t >> 64) as u64;
        }
        out[i + B] = carry;
    }
    // The limbs of a negative number stand for the number plus 2^(64 A): take that part off again.
    let (a_mask, b_mask) = (mask(a), mask(b));
    let mut borrow = false;
    for j in 0..B {
        (out[A + j], borrow) = sub_with_borrow(out[A + j], b[j] & a_mask, borrow);
    }
    borrow = false;
    for i in 0..A {
        (out[B + i], borrow) = sub_with_borrow(out[B + i], a[i] & b_mask, borrow);
    }
    let fill = if out[A + B - 1] >> 63 == 1 { u64::MAX } else { 0 };
    out[A + B..].fill(fill);
    out
}

/// All ones for a negative number, else 0.
#[inline]
fn mask<const N: usize>(a: &[u64; N]) -> u64 {
    0u64.wrapping_sub(a[N - 1] >> 63)
}

#[inline]
fn sub_with_borrow(x: u64, y: u64, borrow: bool) -> (u64, bool) {
    let (t, first) = x.overflowing_sub(y);
    let (t, second) = t.overflowing_sub(u64::from(borrow));
    (t, first | second)
}

#[inline]
fn sub<const N: usize>(a: &[u64; N], b: &[u64; N]) -> [u64; N] {
    let mut out = [0; N];
    let mut borrow = false;
    for k in 0..N {
        (out[k], borrow) = sub_with_borrow(a[k], b[k], borrow);
    }
    out
}

#[inline]
fn add<const N: usize>(a: &[u64; N], b: &[u64; N]) -> [u64; N] {
    let mut out = [0; N];
    let mut carry = false;
    for k in 0..N {
        let (t, first) = a[k].overflowing_add(b[k]);
        let (t, second) = t.overflowing_add(u64::from(carry));
        (out[k], carry) = (t, first | second);
    }
    out
}

#[inline]
fn sign<const N: usize>(a: &[u64; N]) -> Sign {
    if a[N - 1] >> 63 == 1 {
        Sign::Negative
    } else if a.iter().all(|&limb| limb == 0) {
        Sign::Zero
    } else {
        Sign::Positive
    }
}
