//! Halving patches of a mesh without T-junctions, in the manner of red and green triangles (Bank, Sherman and Weiser 1983): what is wanted is halved in both
//! directions, and what has halved edges only because of its neighbours is cut from their middles.

use super::cut::{Key, key};
use super::shape::sides;
use glam::DVec3;
use rustc_hash::FxHashSet;

/// The edges that are halved.
pub(super) struct Halving {
    edges: FxHashSet<[Key; 2]>,
}

fn edge([a, b]: [DVec3; 2]) -> [Key; 2] {
    let [a, b] = [a, b].map(key);
    [a.min(b), a.max(b)]
}

impl Halving {
    /// All edges of wanted rings, and of those that would get two halved edges which are not opposite to each other: so shapes stay good.
    pub(super) fn of(rings: &[&[DVec3]], is_wanted: impl Fn(usize) -> bool) -> Self {
        let mut halving = Self { edges: FxHashSet::default() };
        let mut left: Vec<usize> = (0..rings.len()).collect();
        for (number, ring) in rings.iter().enumerate() {
            if is_wanted(number) {
                halving.edges.extend(sides(ring).map(edge));
            }
        }
        loop {
            let before = halving.edges.len();
            left.retain(|&number| {
                let ring = rings[number];
                let is_halved = halving.of_ring(ring);
                let count = is_halved.iter().filter(|is| **is).count();
                let is_opposite = ring.len() == 4 && (is_halved[0] == is_halved[2]);
                if count >= 2 && !(count == 2 && is_opposite) {
                    halving.edges.extend(sides(ring).map(edge));
                    return false;
                }
                count < ring.len()
            });
            if halving.edges.len() == before {
                return halving;
            }
        }
    }

    fn of_ring(&self, ring: &[DVec3]) -> Vec<bool> {
        sides(ring).map(|side| self.edges.contains(&edge(side))).collect()
    }

    /// What a convex ring falls into.
    pub(super) fn parts(&self, ring: &[DVec3]) -> Vec<Vec<DVec3>> {
        let middles: Vec<Option<DVec3>> =
            sides(ring).map(|side| self.edges.contains(&edge(side)).then(|| side[0].midpoint(side[1]))).collect();
        match (ring, &middles[..]) {
            (_, middles) if middles.iter().all(Option::is_none) => vec![ring.to_vec()],
            (&[a, b, c], &[Some(p), Some(q), Some(r)]) => {
                vec![vec![a, p, r], vec![p, b, q], vec![r, q, c], vec![p, q, r]]
            }
            (&[a, b, c, d], &[Some(p), Some(q), Some(r), Some(s)]) => {
                let middle = p.midpoint(r);
                vec![vec![a, p, middle, s], vec![p, b, q, middle], vec![middle, q, c, r], vec![s, middle, r, d]]
            }
            (&[a, b, c, d], &[Some(p), None, Some(r), None]) => vec![vec![a, p, r, d], vec![p, b, c, r]],
            (&[a, b, c, d], &[None, Some(q), None, Some(s)]) => vec![vec![a, b, q, s], vec![s, q, c, d]],
            _ => fan(ring, &middles),
        }
    }
}

/// Triangles from the middle of the first halved side.
fn fan(ring: &[DVec3], middles: &[Option<DVec3>]) -> Vec<Vec<DVec3>> {
    let outline: Vec<(DVec3, usize)> = ring
        .iter()
        .zip(middles)
        .enumerate()
        .flat_map(|(side, (&corner, middle))| [Some((corner, usize::MAX)), middle.map(|p| (p, side))])
        .flatten()
        .collect();
    let first = outline.iter().position(|&(_, side)| side != usize::MAX).unwrap_or(0);
    let at = |k: usize| outline[(first + k) % outline.len()].0;
    (1..outline.len() - 1).map(|k| vec![at(0), at(k), at(k + 1)]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::shape::{centre, double_area};
    use super::*;

    /// A grid of squares with one triangle pair, halved again and again around a place.
    #[test]
    fn halved_meshes_keep_their_area_and_have_no_t_junctions() {
        let at = |i: usize, j: usize| DVec3::new(i as f64, j as f64, 0.0);
        let mut rings: Vec<Vec<DVec3>> = Vec::new();
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if (i + j) % 3 == 0 { rings.extend([vec![a, b, c], vec![a, c, d]]) } else { rings.push(vec![a, b, c, d]) }
        }
        for round in 0..5 {
            let list: Vec<&[DVec3]> = rings.iter().map(Vec::as_slice).collect();
            let wanted: Vec<bool> = rings
                .iter()
                .map(|ring| centre(ring).distance(DVec3::new(1.7, 2.3, 0.0)) < 0.9 / f64::from(1 << round))
                .collect();
            assert!(wanted.iter().any(|is| *is));
            let halving = Halving::of(&list, |k| wanted[k]);
            let next: Vec<Vec<DVec3>> = rings.iter().flat_map(|ring| halving.parts(ring)).collect();
            assert!(next.len() > rings.len());
            rings = next;
            let sum: f64 = rings.iter().map(|ring| 0.5 * double_area(ring).length()).sum();
            // Places are multiples of a power of two.
            assert!((sum - 25.0).abs() < 1e-12, "{sum}");
            let edges: FxHashSet<[Key; 2]> = rings.iter().flat_map(|ring| sides(ring)).map(edge).collect();
            for [a, b] in rings.iter().flat_map(|ring| sides(ring)) {
                // Every side is one of another ring, or on the outline.
                let count = rings.iter().flat_map(|ring| sides(ring)).filter(|&side| side == [b, a]).count();
                let on = |side: f64, axis: usize| [a, b].iter().all(|p| (p[axis] - side).abs() <= 0.0);
                let is_outline = [0, 1].iter().any(|&axis| on(0.0, axis) || on(5.0, axis));
                assert_eq!(count, usize::from(!is_outline), "{a} {b}");
            }
            assert!(edges.len() > rings.len());
        }
    }
}
