//! Coordinates: on a coarse grid, where everything coincides, or any finite number.

use glam::DVec3;
use proptest::prelude::*;

/// What coordinates look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Small whole numbers (and halves, where a point is to lie in the middle of others): all
    /// coincidences are exact, so that answers must match exactly, and zeros abound.
    Grid,
    /// Anything finite: numbers with full mantissas, whole numbers a few places off, powers of two apart,
    /// denormal, near the end of the exponents.
    Chaos,
}

/// The largest coordinate that [`grid_coordinate`] gives.
pub const GRID: i8 = 8;

/// The finite number `steps` places away in the order of all f64; the number itself if there is no
/// such finite one.
///
/// ```
/// use nusselt::testing::nudged;
/// assert_eq!(nudged(1.0, 1), 1.0 + f64::EPSILON);
/// assert_eq!(nudged(0.0, -1), -f64::from_bits(1));
/// assert_eq!(nudged(f64::MAX, 1), f64::MAX);
/// ```
pub fn nudged(x: f64, steps: i64) -> f64 {
    // Sign and magnitude to a whole number in the order of the values, and back: the map is its own inverse.
    let order = |bits: i64| if bits < 0 { i64::MIN - bits } else { bits };
    let moved = f64::from_bits(order(order(x.to_bits() as i64).saturating_add(steps)) as u64);
    if moved.is_finite() { moved } else { x }
}

/// Another finite number, or the same, up to four places away.
pub fn few_ulps_from(x: f64) -> impl Strategy<Value = f64> {
    (-4i64..=4).prop_map(move |steps| nudged(x, steps))
}

/// A whole number from -[`GRID`] to [`GRID`].
pub fn grid_coordinate() -> impl Strategy<Value = f64> {
    (-GRID..=GRID).prop_map(f64::from)
}

/// Any finite number, more often one that nearly coincides with others.
pub fn chaos_coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -f64::from(GRID)..f64::from(GRID),
        4 => (grid_coordinate(), -4i64..=4).prop_map(|(x, steps)| nudged(x, steps)),
        2 => grid_coordinate(),
        1 => (grid_coordinate(), -60i32..60).prop_map(|(x, exponent)| x * 2f64.powi(exponent)),
        1 => any::<u64>().prop_map(|bits| Some(f64::from_bits(bits)).filter(|x| x.is_finite()).unwrap_or(1.0)),
    ]
}

/// A coordinate of a mode.
pub fn coordinate(mode: Mode) -> BoxedStrategy<f64> {
    match mode {
        Mode::Grid => grid_coordinate().boxed(),
        Mode::Chaos => chaos_coordinate().boxed(),
    }
}

/// A point with coordinates of a mode.
pub fn point(mode: Mode) -> impl Strategy<Value = DVec3> {
    [coordinate(mode), coordinate(mode), coordinate(mode)].prop_map(DVec3::from)
}

/// A direction with coordinates of a mode, not zero.
pub fn direction(mode: Mode) -> impl Strategy<Value = DVec3> {
    point(mode).prop_map(|d| if d == DVec3::ZERO { DVec3::Z } else { d })
}

/// A permutation of the coordinate axes with changes of sign: exact on any coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisMap {
    /// Which coordinate of the argument becomes the k-th: a permutation of 0, 1, 2.
    pub order: [usize; 3],
    /// Which coordinates of the result change their sign.
    pub mirrored: [bool; 3],
}

impl AxisMap {
    /// The image of a point or direction.
    pub fn apply(self, p: DVec3) -> DVec3 {
        DVec3::from([0, 1, 2].map(|k| if self.mirrored[k] { -p[self.order[k]] } else { p[self.order[k]] }))
    }

    /// True if it turns right-handed into left-handed: loops must then be reversed for fronts to
    /// stay fronts.
    pub fn is_reflection(self) -> bool {
        let [x, y, z] = DVec3::AXES.map(|axis| self.apply(axis));
        x.cross(y).dot(z) < 0.0
    }
}

/// Any of the 48 axis maps.
pub fn axis_map() -> impl Strategy<Value = AxisMap> {
    (Just([0, 1, 2]).prop_shuffle(), any::<[bool; 3]>()).prop_map(|(order, mirrored)| AxisMap { order, mirrored })
}
