//! Equal vertices become one.

use super::VertexId;
use glam::DVec3;
use std::collections::HashMap;

/// The vertices that are used, each position once, in order of first appearance.
#[derive(Debug, Default)]
pub(super) struct Welded {
    pub(super) vertices: Vec<DVec3>,
    /// For every vertex of the input its id, if it is used.
    pub(super) ids: Vec<Option<VertexId>>,
}

/// Welds the vertices marked as used; -0 becomes +0.
///
/// The keys come from files, so the map is one that cannot be filled with collisions on purpose.
pub(super) fn weld(positions: &[DVec3], used: &[bool]) -> Welded {
    let mut known: HashMap<[u64; 3], VertexId> = HashMap::new();
    let mut welded = Welded::default();
    for (&position, &used) in positions.iter().zip(used) {
        // x + 0 is x, but +0 for -0.
        let position = position + DVec3::ZERO;
        welded.ids.push(used.then(|| {
            *known.entry(position.to_array().map(f64::to_bits)).or_insert_with(|| {
                welded.vertices.push(position);
                VertexId(welded.vertices.len() as u32 - 1)
            })
        }));
    }
    welded
}

/// The ids of a ring of vertices of the input, with equal neighbours merged.
pub(super) fn merged(ring: &[usize], ids: &[Option<VertexId>]) -> Vec<VertexId> {
    without_repeats(ring.iter().filter_map(|&k| ids.get(k).copied().flatten()).collect())
}

/// A ring with equal neighbours merged all around.
pub(super) fn without_repeats(mut merged: Vec<VertexId>) -> Vec<VertexId> {
    merged.dedup();
    while merged.len() > 1 && merged.first() == merged.last() {
        merged.pop();
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_zero_is_zero_and_what_is_not_used_is_left_out() {
        let positions = [DVec3::NAN, DVec3::new(0.0, -0.0, 1.0), DVec3::ONE, DVec3::new(-0.0, 0.0, 1.0)];
        let welded = weld(&positions, &[false, true, true, true]);
        assert_eq!(welded.ids, [None, Some(VertexId(0)), Some(VertexId(1)), Some(VertexId(0))]);
        assert!(welded.vertices[0].y.is_sign_positive());
    }

    #[test]
    fn equal_neighbours_merge_around_the_end_too() {
        let ids = [Some(VertexId(0)), Some(VertexId(1)), Some(VertexId(0))];
        assert_eq!(merged(&[0, 0, 1, 2, 0], &ids), [VertexId(0), VertexId(1)]);
        assert_eq!(merged(&[0, 2, 0], &ids), [VertexId(0)]);
    }
}
