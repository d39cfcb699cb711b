//! Which edges of a scene lie on one straight line: seen from anywhere, they are one great circle.

use crate::exact::{Arena, Frame, Sign};
use crate::scene::{EdgeId, VertexId};
use glam::DVec3;

/// At vertices with more edges than this none are joined: a missed identity costs time, not exactness.
const MOST_EDGES: usize = 64;

/// For every edge the one that stands for its line, and whether the two run the same way.
#[derive(Clone, Debug)]
pub(super) struct Collinear {
    parents: Vec<(u32, bool)>,
}

impl Collinear {
    /// Joins edges that meet in a vertex and go straight on there, exactly.
    pub(super) fn new(vertices: &[DVec3], edges: &[[VertexId; 2]], frame: &Frame) -> Self {
        let mut lines = Self { parents: (0..edges.len() as u32).map(|k| (k, true)).collect() };
        lines.join_new(vertices, edges, frame, |_| true);
        lines
    }

    /// The same for a scene with objects moved: what was one line before and has not moved still is. `before` tells of each edge
    /// the number it had, if it has not moved.
    pub(super) fn moved(
        &self,
        vertices: &[DVec3],
        edges: &[[VertexId; 2]],
        frame: &Frame,
        before: &[Option<EdgeId>],
    ) -> Self {
        // The first edge of a line that is left stands for it.
        let mut first: Vec<Option<(u32, bool)>> = vec![None; self.parents.len()];
        let parents = before.iter().zip(0..).map(|(before, edge)| {
            let Some(before) = before else { return (edge, true) };
            let (line, way) = self.parents[before.index()];
            let (root, root_way) = *first[line as usize].get_or_insert((edge, way));
            (root, root_way == way)
        });
        let mut lines = Self { parents: parents.collect() };
        lines.join_new(vertices, edges, frame, |edge| before[edge as usize].is_none());
        lines
    }

    /// Joins edges, one of which at least is new, and has what stands for a line known at once.
    fn join_new(&mut self, vertices: &[DVec3], edges: &[[VertexId; 2]], frame: &Frame, is_new: impl Fn(u32) -> bool) {
        let mut arena = Arena::default();
        let around = edges_around(vertices.len(), edges, &is_new);
        for (vertex, here) in around.iter().enumerate() {
            if here.len() > MOST_EDGES {
                continue;
            }
            let away = |edge: u32| {
                let [a, b] = edges[edge as usize];
                let other = if a.index() == vertex { b } else { a };
                vertices[other.index()] - vertices[vertex]
            };
            for (k, &first) in here.iter().enumerate() {
                for &second in &here[..k] {
                    if !is_new(first) && !is_new(second) {
                        continue;
                    }
                    let (p, q) = (away(first), away(second));
                    // Rules out all but nearly opposite edges, in any scale; then exactly.
                    let opposite = p.try_normalize().zip(q.try_normalize()).is_none_or(|(p, q)| p.dot(q) < -0.999);
                    if opposite
                        && goes_straight(
                            &mut arena,
                            frame,
                            vertices,
                            [edges[first as usize], edges[second as usize]],
                            vertex,
                        )
                    {
                        let ways = [first, second].map(|edge| edges[edge as usize][0].index() == vertex);
                        self.join(first, second, ways[0] != ways[1]);
                    }
                }
            }
        }
        for edge in 0..edges.len() as u32 {
            self.parents[edge as usize] = self.root(edge);
        }
    }

    /// For edges of which it is known which stands for which.
    pub(super) fn known(parents: Vec<(u32, bool)>) -> Self {
        Self { parents }
    }

    /// The edge that stands for the line of `edge`, and whether it runs the same way.
    pub(super) fn representative(&self, edge: u32) -> (u32, bool) {
        self.parents[edge as usize]
    }

    fn root(&self, edge: u32) -> (u32, bool) {
        let (mut at, mut same) = (edge, true);
        loop {
            let (parent, way) = self.parents[at as usize];
            if parent == at {
                return (at, same);
            }
            same = same == way;
            at = parent;
        }
    }

    fn join(&mut self, first: u32, second: u32, same_way: bool) {
        let ((a, a_same), (b, b_same)) = (self.root(first), self.root(second));
        // Short paths: what was looked up hangs on its root directly.
        self.parents[first as usize] = (a, a_same);
        self.parents[second as usize] = (b, b_same);
        if a != b {
            let (low, high) = (a.min(b), a.max(b));
            self.parents[high as usize] = (low, (a_same == b_same) == same_way);
        }
    }
}

/// For every vertex at which there is a new edge the numbers of all its edges.
fn edges_around(vertices: usize, edges: &[[VertexId; 2]], is_new: impl Fn(u32) -> bool) -> Vec<Vec<u32>> {
    let mut has_new = vec![false; vertices];
    for (_, edge) in (0..).zip(edges).filter(|&(k, _)| is_new(k)) {
        for end in edge {
            has_new[end.index()] = true;
        }
    }
    let mut around = vec![Vec::new(); vertices];
    for (k, edge) in (0..).zip(edges) {
        for end in edge.iter().filter(|end| has_new[end.index()]) {
            around[end.index()].push(k);
        }
    }
    around
}

/// True if two edges that meet in a vertex point exactly away from each other.
fn goes_straight(
    arena: &mut Arena,
    frame: &Frame,
    vertices: &[DVec3],
    pair: [[VertexId; 2]; 2],
    vertex: usize,
) -> bool {
    let mark = arena.mark();
    let middle = frame.relative(arena, vertices[vertex]);
    let [p, q] = pair.map(|[a, b]| {
        let other = if a.index() == vertex { b } else { a };
        let end = frame.relative(arena, vertices[other.index()]);
        arena.sub3(end, middle)
    });
    let parallel = arena.cross(p, q).into_iter().all(|x| x.sign().is_zero());
    let straight = parallel && arena.dot(p, q).sign() == Sign::Negative;
    arena.release(mark);
    straight
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::BitRange;

    #[test]
    fn edges_in_a_row_are_one_line_and_know_their_way() {
        let vertices = [0.0, 1.0, 2.5, 4.0].map(|x| DVec3::new(x, 3.0 * x, -x));
        let bent = DVec3::new(4.0, 12.0, -3.999_999_999);
        let vertices = [vertices.as_slice(), &[bent]].concat();
        let edge = |a: u32, b: u32| [VertexId(a), VertexId(b)];
        let edges = [edge(0, 1), edge(2, 1), edge(2, 3), edge(2, 4)];
        let frame = Frame::new(BitRange::of(vertices.iter().copied()), vertices[0]);
        let lines = Collinear::new(&vertices, &edges, &frame);
        assert_eq!(lines.representative(0), (0, true));
        assert_eq!(lines.representative(1), (0, false));
        assert_eq!(lines.representative(2), (0, true));
        assert_eq!(lines.representative(3), (3, true));
    }
}
