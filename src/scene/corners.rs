//! Telling polygons with the same corners.

use super::VertexId;

/// The rings of a polygon in a form that is the same wherever they start, in whichever direction they run, and in
/// whichever order the holes come. Linear time, but for the order of the holes.
pub(super) fn canonical(rings: &[Vec<VertexId>]) -> Vec<Vec<VertexId>> {
    let mut rings: Vec<_> = rings.iter().map(|ring| canonical_ring(ring)).collect();
    if let Some(holes) = rings.get_mut(1..) {
        holes.sort_unstable();
    }
    rings
}

fn canonical_ring(ring: &[VertexId]) -> Vec<VertexId> {
    let backward: Vec<_> = ring.iter().rev().copied().collect();
    let from_least = |ring: &[VertexId]| {
        let mut ring = ring.to_vec();
        let start = least_rotation(&ring);
        ring.rotate_left(start);
        ring
    };
    from_least(ring).min(from_least(&backward))
}

/// Where the least of all rotations of a ring starts. Vertices may come several times. Linear time: of two
/// candidates, one that loses after k equal vertices takes the k starts after it with it.
fn least_rotation(ring: &[VertexId]) -> usize {
    let n = ring.len();
    let (mut a, mut b, mut equal) = (0, 1, 0);
    while a < n && b < n && equal < n {
        match ring[(a + equal) % n].cmp(&ring[(b + equal) % n]) {
            std::cmp::Ordering::Equal => {
                equal += 1;
                continue;
            }
            std::cmp::Ordering::Greater => a += equal + 1,
            std::cmp::Ordering::Less => b += equal + 1,
        }
        b += usize::from(a == b);
        equal = 0;
    }
    a.min(b).min(n.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rotations_and_reversals_are_the_same_and_nothing_else(
            ring in prop::collection::vec(0u32..4, 1..10), start in 0usize..10, reverse: bool,
        ) {
            let ring: Vec<_> = ring.into_iter().map(VertexId).collect();
            let all = |ring: &[VertexId]| -> Vec<Vec<VertexId>> {
                let mut all = Vec::new();
                for mut ring in [ring.to_vec(), ring.iter().rev().copied().collect()] {
                    for _ in 0..ring.len() {
                        ring.rotate_left(1);
                        all.push(ring.clone());
                    }
                }
                all
            };
            let least = all(&ring).into_iter().min().unwrap_or_default();
            let mut other = ring.clone();
            other.rotate_left(start % ring.len());
            if reverse {
                other.reverse();
            }
            prop_assert_eq!(canonical(&[ring]), vec![least.clone()]);
            prop_assert_eq!(canonical(&[other]), vec![least]);
        }
    }

    #[test]
    fn the_order_of_holes_does_not_matter_but_which_is_the_outer_ring_does() {
        let ring = |first: u32| (first..first + 3).map(VertexId).collect::<Vec<_>>();
        let form = canonical(&[ring(0), ring(6), ring(3)]);
        assert_eq!(form, canonical(&[ring(0), ring(3), ring(6)]));
        assert_ne!(form, canonical(&[ring(3), ring(0), ring(6)]));
        assert!(canonical(&[]).is_empty());
    }
}
