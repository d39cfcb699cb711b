//! Triangulation of polygons in the plane, with holes, on their own vertices only.
//!
//! The vertices go into a Delaunay triangulation first, the boundary becomes constraint edges after
//! that, and a flood from the outside counts how often the outer ring and each hole wind around every triangle.
//! All decisions are exact signs. No vertex is ever made: a boundary that would need one crosses
//! itself and is refused. Vertices and edges go in in a shuffled order (always the same), so that
//! the expected number of edges flipped out of the way is O(n log n) (Shewchuk and Brown, "Fast segment insertion and
//! incremental construction of constrained Delaunay triangulations", 2015). Re-triangulating the room that an edge makes
//! can be quadratic in it, though; that work is counted, and a boundary that takes too much of it is refused.

use super::flat::spread;
use glam::DVec2;
use spade::handles::{FixedUndirectedEdgeHandle, FixedVertexHandle};
use spade::{
    ConstrainedDelaunayTriangulation, HasPosition, HierarchyHintGenerator, HintGenerator, LastUsedVertexHintGenerator,
    LineIntersectionIterator, Point2, Triangulation,
};
use std::collections::HashMap;

/// Why there is no triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// The boundary crosses itself, or goes around something more than once.
    Crossing,
    /// A hole is not inside of the outer ring.
    HoleOutside,
    /// Holes have points in common that are not on their boundaries.
    HolesOverlap,
    /// The coordinates differ by more than [`RANGE`] powers of two.
    OutOfRange,
    /// The boundary lies so that the work would grow with the square of its length.
    TooMuchWork,
}

/// The largest ratio of two coordinates (other than 0), as a power of two: exact predicates need
/// coordinates between 2^-142 and 2^201.
pub(super) const RANGE: u32 = 342;
const LEAST: i32 = -142;
const GREATEST: i32 = 200;

/// From here on, vertices are found with a hierarchy of triangulations.
const MANY: usize = 64;

/// Triangulates the polygon whose outer ring is `rings[0]` and whose holes are the others, given as
/// places in `points`.
///
/// The triangles run around the way the outer ring does. There are none if the ring has no area.
/// Points must differ from one another. Rings may touch themselves and one another in vertices and
/// along edges (a doubled edge is a slit); holes may run either way, and no two have an inner point in common.
pub(super) fn triangulate(points: &[DVec2], rings: &[Vec<u32>]) -> Result<Vec<[u32; 3]>, Fault> {
    let points = scaled(points)?;
    let space: Vec<_> = points.iter().map(|p| p.extend(0.0)).collect();
    let Some(first) = spread(&space) else { return Ok(Vec::new()) };
    if points.len() < MANY {
        Mesh::<LastUsedVertexHintGenerator>::build(&points, first, rings)?.triangles()
    } else {
        Mesh::<HierarchyHintGenerator<f64>>::build(&points, first, rings)?.triangles()
    }
}

/// The points, scaled by a power of two into the range of exact predicates.
fn scaled(points: &[DVec2]) -> Result<Vec<DVec2>, Fault> {
    let sizes = || points.iter().flat_map(|p| [p.x.abs(), p.y.abs()]).filter(|&x| x > 0.0);
    let least = exponent(sizes().fold(f64::INFINITY, f64::min));
    let greatest = exponent(sizes().fold(0.0, f64::max));
    if least >= LEAST && greatest <= GREATEST || sizes().next().is_none() {
        return Ok(points.to_vec());
    }
    let shift = GREATEST - greatest;
    if least + shift < LEAST {
        return Err(Fault::OutOfRange);
    }
    // In two steps: the whole factor may be larger than any number.
    let (half, rest) = (2.0_f64.powi(shift / 2), 2.0_f64.powi(shift - shift / 2));
    Ok(points.iter().map(|&p| p * half * rest).collect())
}

/// The exponent of a positive number: the greatest e with 2^e <= x.
fn exponent(x: f64) -> i32 {
    match (x.to_bits() >> 52) as i32 {
        0 => -1011 - x.to_bits().leading_zeros() as i32,
        biased => biased - 1023,
    }
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    position: Point2<f64>,
    index: u32,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// A ring and how often it runs along an edge or around a triangle, counted with its direction. Ring 0 is the outer one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Run {
    ring: u32,
    times: i32,
}

/// What lies around one triangle: of holes at most one does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Winding {
    outer: i32,
    hole: Option<Run>,
}

impl Winding {
    /// What lies around the triangle on the other side of an edge along which these rings run.
    fn beyond(self, along: &[(usize, Run)], forwards: bool) -> Result<Self, Fault> {
        let mut there = Self { outer: self.outer, hole: None };
        let (passed, kept) = match self.hole {
            Some(hole) if along.iter().any(|(_, run)| run.ring == hole.ring) => (self.hole, None),
            hole => (None, hole),
        };
        let along = along.iter().map(|&(_, run)| Run { times: if forwards { -run.times } else { run.times }, ..run });
        for Run { ring, times } in along.chain(kept) {
            if ring == 0 {
                there.outer += times;
                continue;
            }
            let times = times + passed.filter(|hole| hole.ring == ring).map_or(0, |hole| hole.times);
            if times.abs() > 1 {
                return Err(Fault::Crossing);
            }
            if times != 0 && there.hole.replace(Run { ring, times }).is_some() {
                return Err(Fault::HolesOverlap);
            }
        }
        Ok(there)
    }
}

struct Mesh<L: HintGenerator<f64>> {
    cdt: ConstrainedDelaunayTriangulation<Corner, (), (), (), L>,
    /// What runs along the normal direction of undirected edges, in ascending order of the edges.
    along: Vec<(usize, Run)>,
}

impl<L: HintGenerator<f64>> Mesh<L> {
    /// Builds the mesh, starting from three vertices that are not collinear (adding to a triangulation
    /// of collinear vertices takes linear time).
    fn build(points: &[DVec2], first: [usize; 3], rings: &[Vec<u32>]) -> Result<Self, Fault> {
        let mut cdt = ConstrainedDelaunayTriangulation::<Corner, (), (), (), L>::default();
        let mut handles = vec![FixedVertexHandle::from_index(0); points.len()];
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        for (place, vertex) in first.into_iter().enumerate() {
            order.swap(place, vertex);
        }
        shuffle(&mut order[3..]);
        for index in order {
            let p = points[index as usize];
            let corner = Corner { position: Point2::new(p.x, p.y), index };
            handles[index as usize] = cdt.insert(corner).map_err(|_| Fault::OutOfRange)?;
        }
        // Two points in one place: only rounding can do that.
        if cdt.num_vertices() != points.len() {
            return Err(Fault::Crossing);
        }
        let mut mesh = Self { cdt, along: Vec::new() };
        mesh.add_boundary(&handles, rings)?;
        mesh.sum_up();
        Ok(mesh)
    }

    fn add_boundary(&mut self, handles: &[FixedVertexHandle], rings: &[Vec<u32>]) -> Result<(), Fault> {
        let mut visits = vec![0_u32; handles.len()];
        let mut edges = Vec::new();
        for (number, ring) in rings.iter().enumerate() {
            for (k, &from) in ring.iter().enumerate() {
                visits[from as usize] += 1;
                edges.push((from, ring[(k + 1) % ring.len()], number as u32));
            }
        }
        shuffle(&mut edges);
        let mut trace = Trace { passed: vec![None; handles.len()], budget: 1024 * edges.len() + (1 << 24) };
        for (from, to, ring) in edges {
            // An edge is searched by turning around its first vertex: take the less busy one.
            let (from, to, times) =
                if visits[from as usize] <= visits[to as usize] { (from, to, 1) } else { (to, from, -1) };
            let ends = [handles[from as usize], handles[to as usize]];
            self.add_edge(ends, Run { ring, times }, &mut trace)?;
        }
        Ok(())
    }

    /// Adds one edge of the boundary; it becomes several if it runs through vertices.
    fn add_edge(&mut self, [from, to]: [FixedVertexHandle; 2], run: Run, trace: &mut Trace) -> Result<(), Fault> {
        let mut at = from;
        let mut before = None;
        while at != to {
            let crossed = LineIntersectionIterator::new_from_handles(&self.cdt, at, to).count();
            trace.spend(crossed.saturating_mul(crossed))?;
            let chain = self.cdt.try_add_constraint(at, to);
            if chain.is_empty() {
                return Err(Fault::Crossing);
            }
            for edge in chain {
                trace.spend(1)?;
                let handle = self.cdt.directed_edge(edge);
                let next = if handle.from().fix() == at { handle.to().fix() } else { handle.from().fix() };
                if let Some(before) = before {
                    trace.pass(at, [before, next])?;
                }
                let undirected = edge.as_undirected();
                let forwards = self.cdt.directed_edge(undirected.as_directed()).from().fix() == at;
                let times = if forwards { run.times } else { -run.times };
                self.along.push((undirected.index(), Run { times, ..run }));
                before = Some(at);
                at = next;
            }
        }
        Ok(())
    }

    /// Counts together what one ring does along one edge, and leaves out what it takes back.
    fn sum_up(&mut self) {
        self.along.sort_unstable_by_key(|&(edge, run)| (edge, run.ring));
        self.along.dedup_by(|(edge, run), (known, sum)| {
            let same = (*edge, run.ring) == (*known, sum.ring);
            sum.times += if same { run.times } else { 0 };
            same
        });
        self.along.retain(|(_, run)| run.times != 0);
    }

    /// How the boundary lies around each triangle, by index of the face.
    fn windings(&self) -> Result<Vec<Option<Winding>>, Fault> {
        let mut windings: Vec<Option<Winding>> = vec![None; self.cdt.num_all_faces()];
        let outside = self.cdt.outer_face().fix();
        windings[outside.index()] = Some(Winding::default());
        let mut pending: Vec<_> = self.cdt.convex_hull().map(|edge| edge.fix()).collect();
        pending.extend(self.cdt.convex_hull().map(|edge| edge.rev().fix()));
        while let Some(edge) = pending.pop() {
            let edge = self.cdt.directed_edge(edge);
            let Some(here) = windings[edge.face().fix().index()] else { continue };
            let beyond = edge.rev().face();
            let undirected = edge.fix().as_undirected();
            let there = here.beyond(self.runs_along(undirected), undirected.as_directed() == edge.fix())?;
            match &mut windings[beyond.fix().index()] {
                Some(known) if *known == there => {}
                Some(_) => return Err(Fault::Crossing),
                unknown => {
                    *unknown = Some(there);
                    pending.push(edge.rev().next().fix());
                    pending.push(edge.rev().prev().fix());
                }
            }
        }
        Ok(windings)
    }

    fn runs_along(&self, edge: FixedUndirectedEdgeHandle) -> &[(usize, Run)] {
        let start = self.along.partition_point(|&(known, _)| known < edge.index());
        let rest = &self.along[start..];
        &rest[..rest.iter().take_while(|&&(known, _)| known == edge.index()).count()]
    }

    fn triangles(&self) -> Result<Vec<[u32; 3]>, Fault> {
        let windings = self.windings()?;
        let mut side = 0;
        let mut sides_of_holes = HashMap::new();
        let mut triangles = Vec::new();
        for face in self.cdt.inner_faces() {
            let Some(winding) = windings[face.fix().index()] else { continue };
            if let Some(Run { ring, times }) = winding.hole
                && *sides_of_holes.entry(ring).or_insert(times) != times
            {
                return Err(Fault::Crossing);
            }
            if winding.outer == 0 {
                if winding.hole.is_some() {
                    return Err(Fault::HoleOutside);
                }
                continue;
            }
            if winding.outer.abs() > 1 || winding.outer == -side {
                return Err(Fault::Crossing);
            }
            side = winding.outer;
            if winding.hole.is_none() {
                triangles.push(face.vertices().map(|corner| corner.data().index));
            }
        }
        if side < 0 {
            for triangle in &mut triangles {
                triangle.swap(1, 2);
            }
        }
        Ok(triangles)
    }
}

/// What the edges of the boundary have run through so far.
struct Trace {
    /// For every vertex the neighbours on the straight edges that run through it.
    passed: Vec<Option<[FixedVertexHandle; 2]>>,
    /// How much more work is taken. Re-triangulating around an edge that crosses k others can take
    /// k^2 flips.
    budget: usize,
}

impl Trace {
    fn spend(&mut self, work: usize) -> Result<(), Fault> {
        self.budget = self.budget.checked_sub(work).ok_or(Fault::TooMuchWork)?;
        Ok(())
    }

    /// Notes an edge that runs straight through a vertex. Two that do so in different directions cross.
    fn pass(&mut self, through: FixedVertexHandle, mut neighbours: [FixedVertexHandle; 2]) -> Result<(), Fault> {
        neighbours.sort_unstable();
        match self.passed[through.index()].replace(neighbours) {
            Some(known) if known != neighbours => Err(Fault::Crossing),
            _ => Ok(()),
        }
    }
}

/// Shuffles, always the same way (Fisher and Yates, with the generator `SplitMix64`).
fn shuffle<T>(items: &mut [T]) {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for k in (1..items.len()).rev() {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        items.swap(k, (bits % (k as u64 + 1)) as usize);
    }
}
