//! What the rules share: the evidence in one arithmetic, with great circles known by identity.

use super::certificate::Certificate;
use super::clip::clip;
use super::defect::{Defect, rounded_crossing};
use super::domain::DomainCones;
use super::evidence::{Evidence, EvidenceHorizon, EvidenceSliver, HalfSphere};
use super::signs::Signs;
use crate::exact;
use crate::exact::Sign;
use crate::scene::{PieceId, Scene, Side, Splitter, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;

const NONE: u32 = u32::MAX;

pub(super) struct Checker<'a, S> {
    pub(super) scene: &'a Scene,
    pub(super) evidence: &'a Evidence,
    pub(super) signs: S,
    /// For each splitter the one that stands for its great circle, and how it is oriented against that.
    circles: Vec<(u32, Sign)>,
    /// The splitters of the coordinate planes.
    axes: [u32; 3],
    /// The horizon, if the domain has one.
    pub(super) horizon: Option<HalfSphere>,
    /// What else bounds the domain, if that is not all there is.
    pub(super) cones: Option<DomainCones>,
    /// The sides of all cells, without those that go on along the great circle of the one before.
    sides: Vec<HalfSphere>,
    starts: Vec<usize>,
    /// The splitter of each edge of the scene, once it was needed.
    edges: Vec<u32>,
    /// On which side of each plane of the scene the eye is.
    pub(super) heights: Vec<Sign>,
    /// The slivers of the evidence, by their piece.
    slivers: Vec<u32>,
    /// So many slivers may still be looked at.
    excuses_left: u64,
}

/// So many slivers are looked at, at most, for excuses: about a minute. An honest image needs a few for each place
/// where it shows what is hidden.
const EXCUSES: u64 = 1 << 26;

impl<'a, S: Signs> Checker<'a, S> {
    /// Takes in evidence whose form was checked.
    pub(super) fn new(scene: &'a Scene, evidence: &'a Evidence, mut signs: S) -> Result<Self, Defect> {
        let mut along: FxHashMap<[VertexId; 2], u32> = FxHashMap::default();
        for splitter in &evidence.splitters {
            let id = signs.add(&scene.resolve_splitter(*splitter));
            if let Splitter::Edge(ends) = splitter {
                along.insert(*ends, id);
            }
        }
        let edges = scene.edges().iter().map(|ends| along.get(ends).copied().unwrap_or(NONE)).collect();
        for plane in scene.planes() {
            signs.add_plane(&scene.resolve_plane(*plane));
        }
        let heights = (0..scene.planes().len() as u32).map(|plane| signs.height(evidence.eye, plane)).collect();
        let axes = DVec3::AXES.map(|axis| signs.add(&exact::Splitter::Given(axis)));
        let mut checker = Self {
            scene,
            evidence,
            signs,
            circles: Vec::new(),
            axes,
            horizon: None,
            cones: None,
            sides: Vec::new(),
            starts: vec![0],
            edges,
            heights,
            slivers: (0..evidence.slivers.len() as u32).collect(),
            excuses_left: EXCUSES,
        };
        checker.horizon = checker.add_horizon()?;
        checker.cones = checker.add_cones()?;
        let seen = evidence.cells.iter().filter_map(|cell| cell.piece);
        for piece in seen {
            for edge in scene.piece(piece).edges() {
                checker.edge(edge.index());
            }
        }
        checker.circles = checker.signs.great_circles().ok_or_else(|| Defect::Malformed {
            place: "splitters".to_owned(),
            what: "too many of them nearly coincide to be told apart in reasonable time",
        })?;
        let slivers = &evidence.slivers;
        checker.slivers.sort_by_key(|&k| slivers[k as usize].piece);
        for cell in &evidence.cells {
            let mut sides = std::mem::take(&mut checker.sides);
            checker.without_repeats(&cell.sides, &mut sides);
            checker.sides = sides;
            checker.starts.push(checker.sides.len());
        }
        checker.finish_cones()?;
        Ok(checker)
    }

    fn add_horizon(&mut self) -> Result<Option<HalfSphere>, Defect> {
        let (splitter, inside) = match self.evidence.domain.horizon() {
            None => return Ok(None),
            Some(EvidenceHorizon::Normal(normal)) => (exact::Splitter::Given(normal), Sign::Positive),
            Some(EvidenceHorizon::Above(id, side)) => {
                let piece = self.scene.piece(id);
                let up = if piece.facing() == side { Sign::Positive } else { Sign::Negative };
                if self.heights[piece.plane_id().index()] * up == Sign::Negative {
                    return Err(Defect::BehindSurface { piece: id });
                }
                (exact::Splitter::Parallel(self.scene.resolve_plane(piece.plane())), up)
            }
        };
        Ok(Some(HalfSphere { splitter: self.signs.add(&splitter), inside }))
    }

    /// Adds sides without those that go on along the great circle of the one before.
    pub(super) fn without_repeats(&self, sides: &[HalfSphere], found: &mut Vec<HalfSphere>) {
        for (k, &side) in sides.iter().enumerate() {
            let before = sides[k.checked_sub(1).unwrap_or(sides.len() - 1)];
            if self.on_circle(side) != self.on_circle(before) {
                found.push(side);
            }
        }
    }

    /// The splitter of an edge of the scene.
    fn edge(&mut self, edge: usize) -> u32 {
        if self.edges[edge] == NONE {
            let ends = self.scene.edges()[edge].map(|v| self.scene.vertex(v));
            self.edges[edge] = self.signs.add(&exact::Splitter::Edge(ends));
        }
        self.edges[edge]
    }

    /// The number of cells.
    pub(super) fn cell_count(&self) -> u32 {
        self.evidence.cells.len() as u32
    }

    /// The sides of a cell, no two neighbours on one great circle.
    pub(super) fn cell(&self, cell: u32) -> &[HalfSphere] {
        &self.sides[self.starts[cell as usize]..self.starts[cell as usize + 1]]
    }

    /// The splitter that stands for a side's great circle, and the sign of it that is inside.
    pub(super) fn on_circle(&self, side: HalfSphere) -> (u32, Sign) {
        // Splitters taken in later stand for themselves.
        let (circle, alike) =
            self.circles.get(side.splitter as usize).copied().unwrap_or((side.splitter, Sign::Positive));
        (circle, alike * side.inside)
    }

    /// The sign of `n_1 . (n_2 x n_3)` for the normals to the inside.
    #[inline]
    pub(super) fn orientation(&mut self, sides: [HalfSphere; 3]) -> Sign {
        let [a, b, c] = sides.map(|side| self.on_circle(side).0);
        if a == b || b == c || c == a {
            return Sign::Zero;
        }
        let [p, q, r] = sides;
        self.signs.orientation(sides.map(|side| side.splitter)) * (p.inside * q.inside * r.inside)
    }

    /// True if two directions that are the same or opposite are the same. Each is given by the circle they
    /// are on and a normal across: `circle x across`.
    pub(super) fn is_same_way(&mut self, circle: u32, across: [HalfSphere; 2]) -> bool {
        let circle = HalfSphere { splitter: circle, inside: Sign::Positive };
        self.axes.into_iter().any(|axis| {
            let axis = HalfSphere { splitter: axis, inside: Sign::Positive };
            let [p, q] = across.map(|side| self.orientation([axis, circle, side]));
            p * q == Sign::Positive
        })
    }

    /// The cone of a piece: one half sphere an edge. The eye is not in its plane.
    pub(super) fn cone(&mut self, piece: PieceId, out: &mut Vec<HalfSphere>) {
        out.clear();
        let piece = self.scene.piece(piece);
        // `(a - e) x (b - e)` points inwards where the boundary runs from a to b clockwise, seen from the eye.
        let front_seen = self.shown(piece.id()) == Side::Front;
        for (edge, from) in piece.edges().iter().zip(piece.vertices()) {
            let forward = self.scene.edges()[edge.index()][0] == *from;
            let inside = if forward == front_seen { Sign::Negative } else { Sign::Positive };
            out.push(HalfSphere { splitter: self.edge(edge.index()), inside });
        }
    }

    /// The slivers recorded of a piece; fewer, if too many were looked at already.
    pub(super) fn slivers_of(&mut self, piece: PieceId) -> Vec<&'a EvidenceSliver> {
        let evidence = self.evidence;
        let of = |k: &u32| evidence.slivers[*k as usize].piece;
        let first = self.slivers.partition_point(|k| of(k) < piece);
        let own = self.slivers[first..].iter().take_while(|k| of(k) == piece).take(self.excuses_left as usize);
        let own: Vec<_> = own.map(|&k| &evidence.slivers[k as usize]).collect();
        self.excuses_left -= own.len() as u64;
        own
    }

    /// On which side of its plane, as that is oriented, a piece has the eye.
    pub(super) fn height(&self, piece: PieceId) -> Sign {
        self.heights[self.scene.piece(piece).plane_id().index()]
    }

    /// The side that a piece shows to the eye, which is not in its plane.
    pub(super) fn shown(&self, piece: PieceId) -> Side {
        let facing = self.scene.piece(piece).facing();
        if self.height(piece) == Sign::Positive { facing } else { facing.opposite() }
    }

    /// The corner between two neighbouring sides, rounded.
    pub(super) fn rounded(&self, [before, after]: [HalfSphere; 2]) -> DVec3 {
        let normals = [before, after].map(|side| self.signs.rounded(side.splitter));
        rounded_crossing(normals, [before.inside, after.inside])
    }

    /// Cuts what is outside of a half sphere off a convex polygon; false if nothing with an interior is left.
    pub(super) fn clip(&mut self, polygon: &mut Vec<HalfSphere>, half: HalfSphere) -> bool {
        clip(polygon, &half, |sides| self.orientation(sides.map(|side| *side)))
    }

    pub(super) fn certificate(&self, great_circles: usize) -> Certificate {
        Certificate { cells: self.evidence.cells.len(), great_circles, exact_decisions: self.signs.decisions() }
    }
}
