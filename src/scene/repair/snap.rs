//! Welding within a tolerance.
//!
//! The vertices that stay are at least about the tolerance apart from each other, so a cell of a grid
//! a few tolerances wide holds a bounded number of them, however many vertices there are in it: the time is
//! linear, with a factor of a thousand at worst. The grid's step is a power of two, so that cells are told exactly. Where
//! coordinates are so large that their spacing is coarser than the grid, only equal ones can be near.

use super::MovedVertex;
use glam::DVec3;
use std::borrow::Cow;
use std::collections::HashMap;

/// The positions after the vertices marked as used have moved by the rule of [`Repair::weld`](super::Repair::weld), and
/// which did. The used ones must be finite, and so must the tolerance.
pub(in super::super) fn snap<'a>(
    positions: &'a [DVec3],
    used: &[bool],
    tolerance: f64,
) -> (Cow<'a, [DVec3]>, Vec<MovedVertex>) {
    let mut moved = Vec::new();
    if tolerance <= 0.0 {
        return (Cow::Borrowed(positions), moved);
    }
    let mut positions = positions.to_vec();
    let grid = Grid::new(tolerance);
    // The keys come from files, so the map is one that cannot be filled with collisions on purpose.
    let mut staying: HashMap<[u64; 3], Vec<(usize, DVec3)>> = HashMap::new();
    for (vertex, (position, _)) in positions.iter_mut().zip(used).enumerate().filter(|(_, (_, used))| **used) {
        let from = *position;
        let near = grid.cells_near(from).filter_map(|cell| staying.get(&cell)).flatten();
        let near = near.filter_map(|&(place, other)| Some((grid.distance_squared(from, other)?, place, other)));
        let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        match nearest {
            Some((_, _, to)) => {
                *position = to;
                if from != to {
                    moved.push(MovedVertex { vertex, from, to });
                }
            }
            None => staying.entry(grid.cell(from)).or_default().push((vertex, from)),
        }
    }
    (Cow::Owned(positions), moved)
}

/// Cubes with edges of a power of two, between 2 and 4 times the tolerance.
struct Grid {
    /// Multiplying by both divides by the edge; one number alone may not be representable.
    scale: [f64; 2],
    /// The square of the tolerance over the edge.
    reach_squared: f64,
}

impl Grid {
    fn new(tolerance: f64) -> Self {
        // More than 2 and at most 4 times the tolerance.
        let exponent = ilogb(tolerance) + 2;
        let half = exponent / 2;
        let scale = [2f64.powi(-half), 2f64.powi(half - exponent)];
        let reach = tolerance * scale[0] * scale[1];
        Self { scale, reach_squared: reach * reach }
    }

    fn scaled(&self, x: f64) -> f64 {
        x * self.scale[0] * self.scale[1]
    }

    /// The cell's place on one axis.
    fn place(&self, x: f64) -> u64 {
        let q = self.scaled(x);
        // x + 0 is x, but +0 for -0.
        if is_fine(q) { (q.floor() + 0.0).to_bits() } else { x.to_bits() }
    }

    fn cell(&self, p: DVec3) -> [u64; 3] {
        p.to_array().map(|x| self.place(x))
    }

    /// The cells in which there may be something within the tolerance.
    fn cells_near(&self, p: DVec3) -> impl Iterator<Item = [u64; 3]> {
        let own = self.cell(p);
        // On each axis the one beyond the nearer wall, as the tolerance is at most half an edge.
        let other = p.to_array().map(|x| {
            let q = self.scaled(x);
            let step = if q - q.floor() < 0.5 { -1.0 } else { 1.0 };
            if is_fine(q) { Some((q.floor() + step + 0.0).to_bits()) } else { None }
        });
        (0..8).filter_map(move |k| {
            let place = |axis: usize| if k >> axis & 1 == 0 { Some(own[axis]) } else { other[axis] };
            Some([place(0)?, place(1)?, place(2)?])
        })
    }

    /// The square of the distance in edges, if it is certainly less than the tolerance.
    fn distance_squared(&self, p: DVec3, q: DVec3) -> Option<f64> {
        let mut sum = 0.0;
        for (x, y) in p.to_array().into_iter().zip(q.to_array()) {
            #[expect(clippy::float_cmp, reason = "what is equal has no distance, even where scaling overflows")]
            let step = if x == y { 0.0 } else { self.scaled(x) - self.scaled(y) };
            sum += step * step;
        }
        // Off by 4 units in the last place at most, as is the square of the reach by one.
        (sum * (1.0 + 8.0 * f64::EPSILON) < self.reach_squared).then_some(sum)
    }
}

/// Whether numbers of that size are closer than 1 to their neighbours.
fn is_fine(q: f64) -> bool {
    q.abs() < 9_007_199_254_740_992.0
}

/// The exponent e with 2^e <= x < 2^(e + 1), of a positive number.
fn ilogb(x: f64) -> i32 {
    match (x.to_bits() >> 52) as i32 {
        0 => -1011 - x.to_bits().leading_zeros() as i32,
        biased => biased - 1023,
    }
}
