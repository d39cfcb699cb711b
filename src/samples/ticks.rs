//! Coordinates while a scene is being laid out: whole tenths of a millimetre.
//!
//! Lengths that are equal on paper are equal integers, so what touches in the plan touches exactly
//! in the mesh, and unturned coordinates come out as short decimals.

/// Ticks in a metre.
const TICKS_PER_METRE: i64 = 10_000;

/// Millimetres as ticks.
pub(super) const fn mm(millimetres: i64) -> i64 {
    millimetres * (TICKS_PER_METRE / 1000)
}

/// Ticks as metres, correctly rounded.
pub(super) fn metres(ticks: i64) -> f64 {
    ticks as f64 / TICKS_PER_METRE as f64
}

/// `cells + 1` lines from `low` to `high`, as evenly as ticks allow; strictly ascending if there
/// are at least as many ticks as cells.
pub(super) fn lines(low: i64, high: i64, cells: usize) -> Vec<i64> {
    let count = cells as i64;
    (0..=count).map(|k| low + ((high - low) * k + count / 2) / count).collect()
}

/// How many cells of edge `h`/64 ticks a length holds; at least 1.
pub(super) fn cells(length: i64, h: i64) -> usize {
    (length * 64 / h).max(1) as usize
}

/// The least `h` in sixty-fourths of a tick for which `fits` holds, if it holds from some `h` on;
/// otherwise some `h` for which it holds or, if there is none, a length beyond all scenes.
pub(super) fn finest(fits: impl Fn(i64) -> bool) -> i64 {
    let (mut too_fine, mut fine) = (63, 1 << 40);
    while fine - too_fine > 1 {
        let middle = too_fine + (fine - too_fine) / 2;
        if fits(middle) {
            fine = middle;
        } else {
            too_fine = middle;
        }
    }
    fine
}

/// A place to put something: a turn about the vertical, then a shift along the floor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    origin: [i64; 2],
    turn: Turn,
}

#[derive(Clone, Copy, Debug)]
enum Turn {
    None,
    /// A right angle, counter-clockwise.
    Quarter,
    By {
        cos: f64,
        sin: f64,
    },
}

impl Frame {
    /// The world's own.
    pub(super) const WORLD: Self = Self { origin: [0; 2], turn: Turn::None };

    /// Shifted, not turned: coordinates of the world are whole ticks.
    pub(super) fn at(x: i64, y: i64) -> Self {
        Self { origin: [x, y], turn: Turn::None }
    }

    /// There, but turned by a right angle: coordinates of the world are whole ticks.
    pub(super) fn turned_right(self) -> Self {
        Self { turn: Turn::Quarter, ..self }
    }

    /// There, but turned by the angle whose half has the tangent `p`/`q`. Sine and cosine are then
    /// quotients of integers, which round alike everywhere.
    pub(super) fn turned(self, p: i64, q: i64) -> Self {
        let length = (q * q + p * p) as f64;
        let (cos, sin) = ((q * q - p * p) as f64 / length, (2 * p * q) as f64 / length);
        Self { turn: Turn::By { cos, sin }, ..self }
    }

    /// A point of the frame in the world. Points above one another get the same x and y, so upright
    /// quads stay exactly planar.
    pub(super) fn world(&self, ticks: [i64; 3]) -> [f64; 3] {
        let [x, y, z] = ticks;
        let [ox, oy] = self.origin;
        match self.turn {
            Turn::None => [ox + x, oy + y, z].map(metres),
            Turn::Quarter => [ox - y, oy + x, z].map(metres),
            Turn::By { cos, sin } => {
                let [ox, oy] = self.origin.map(metres);
                let [x, y, z] = ticks.map(metres);
                [ox + (x * cos - y * sin), oy + (x * sin + y * cos), z]
            }
        }
    }

    /// A point of the world in the frame, in metres.
    pub(super) fn local(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [ox, oy] = self.origin.map(metres);
        let (x, y) = (x - ox, y - oy);
        match self.turn {
            Turn::None => [x, y, z],
            Turn::Quarter => [y, -x, z],
            Turn::By { cos, sin } => [x * cos + y * sin, y * cos - x * sin, z],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_ascend_and_keep_their_ends() {
        for (low, high, cells) in [(0, 7, 7), (-5, 100, 13), (mm(10), mm(11), 9)] {
            let lines = lines(low, high, cells);
            assert_eq!((lines[0], lines[cells], lines.len()), (low, high, cells + 1));
            assert!(lines.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }

    #[test]
    fn local_undoes_world() {
        let at = Frame::at(mm(1500), mm(-300));
        for frame in [Frame::WORLD, at, at.turned_right(), at.turned(1, 3), at.turned(-7, 2)] {
            let local = frame.local(frame.world([mm(70), mm(-20), mm(5)]));
            for (got, meant) in local.into_iter().zip([0.07, -0.02, 0.005]) {
                assert!((got - meant).abs() < 1e-14, "{frame:?}: {local:?}");
            }
        }
    }

    #[test]
    fn finest_is_the_least_that_fits() {
        assert_eq!(finest(|h| h >= 5000), 5000);
        assert_eq!(finest(|_| true), 64);
        assert_eq!(finest(|_| false), 1 << 40);
    }
}
