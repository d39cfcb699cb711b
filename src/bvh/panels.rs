//! Panels: convex polygons that neighbouring pieces of one plane make up together, such as the tiles of a wall.
//!
//! A view puts in a panel as if it were one polygon, and cuts what is seen of it along the edges between its pieces: most of the cost
//! of a piece, which is to find its place in the image, is then that of its panel. Panels are halved by one edge, or edges that
//! continue each other, from side to side, and so are their halves, down to the pieces.

use crate::bsp::{Bounds, FragmentSide, LineId, PointId, Skeleton, bounds_of, whole_piece};
use crate::exact::{Sign, orient3d};
use crate::scene::{PieceId, PlaneId, Scene, VertexId};
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// A panel has at most so many pieces (docs/performance.md): what fills much of the image comes in parts with depths of their own.
pub(super) const MOST_PIECES: u32 = 1024;
/// Pieces with more sides are panels by themselves.
const MOST_SIDES: usize = 16;

/// A piece, or two panels side by side.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    /// The piece; of more than one the first, which stands for the plane and the side of all.
    pub(crate) piece: PieceId,
    pub(crate) parts: Parts,
    pub(crate) bounds: Bounds,
    halves: Option<Halves>,
    sides: Range<u32>,
    pieces: u32,
}

impl Panel {
    pub(super) fn piece_count(&self) -> u32 {
        self.pieces
    }
}

/// What a panel consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parts {
    One(PieceId),
    /// What is on both sides of a seam, by the number of that.
    Two(u32),
}

/// How a panel is halved. Those of the seams of one panel that are halves of it follow it: a view goes through many of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seam {
    /// What the halves consist of.
    pub(crate) halves: [Parts; 2],
    /// What is between them, as a side of the first one.
    pub(crate) side: FragmentSide,
    /// The ends of the seam.
    pub(crate) ends: [SeamEnd; 2],
}

/// How a panel is halved, by the panels that are its halves.
#[derive(Clone, Copy, Debug)]
struct Halves {
    panels: [u32; 2],
    /// What is between them, as a side of the first one.
    seam: FragmentSide,
    ends: [SeamEnd; 2],
}

/// An end of what is between two halves of a panel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeamEnd {
    pub(crate) point: PointId,
    /// The lines of the sides of the panel that meet there.
    pub(crate) lines: [LineId; 2],
}

impl Halves {
    /// Of panels with these boundaries, of which these sides are between them.
    fn new(panels: [u32; 2], [a, b]: [&[FragmentSide]; 2], [i, j]: [u32; 2]) -> Self {
        let [i, j] = [i as usize, j as usize];
        let before = |sides: &[FragmentSide], k: usize| sides[(k + sides.len() - 1) % sides.len()].line;
        let after = |sides: &[FragmentSide], k: usize| sides[next(k, sides)].line;
        let first = SeamEnd { point: a[i].point, lines: [before(a, i), after(b, j)] };
        let second = SeamEnd { point: b[j].point, lines: [after(a, i), before(b, j)] };
        Self { panels, seam: a[i], ends: [first, second] }
    }
}

/// All panels: those of one piece first, under the numbers of their pieces.
#[derive(Clone, Debug)]
pub(crate) struct Panels {
    all: Vec<Panel>,
    seams: Vec<Seam>,
    /// Of the lines that are known to be the same it is always the one that stands for them.
    sides: Vec<FragmentSide>,
}

impl Panels {
    /// The panels of groups of pieces, of at most so many each, and those that are no half of another one, by groups. `may_join` tells whether pieces may
    /// be in one panel.
    pub(super) fn of(
        scene: &Scene,
        skeleton: &Skeleton,
        groups: &[&[PieceId]],
        most_pieces: u32,
        may_join: impl Fn(PieceId, PieceId) -> bool,
    ) -> (Self, Vec<Vec<u32>>) {
        let mut panels = Self { all: Vec::with_capacity(scene.piece_count()), seams: Vec::new(), sides: Vec::new() };
        for piece in scene.pieces() {
            let sides = whole_piece(scene, piece.id()).map(|side| {
                let (line, same_way) = skeleton.representative(side.line);
                FragmentSide { line, forward: side.forward == same_way, ..side }
            });
            panels.push(skeleton, piece.id(), None, sides.collect());
        }
        let mut joiner = Joiner {
            scene,
            skeleton,
            panels,
            along: FxHashMap::default(),
            queue: BinaryHeap::new(),
            whole: FxHashSet::default(),
            most_pieces,
            may_join,
        };
        let roots: Vec<Vec<u32>> = groups.iter().map(|pieces| joiner.join(pieces)).collect();
        let mut panels = joiner.panels;
        for &root in roots.iter().flatten() {
            panels.lay_seams(root);
        }
        (panels, roots)
    }

    fn push(&mut self, skeleton: &Skeleton, piece: PieceId, halves: Option<Halves>, sides: Vec<FragmentSide>) -> u32 {
        let start = self.sides.len() as u32;
        let bounds = bounds_of(skeleton, &sides);
        self.sides.extend(sides);
        let pieces = halves.map_or(1, |halves| halves.panels.map(|half| self.panel(half).pieces).iter().sum());
        let sides = start..self.sides.len() as u32;
        self.all.push(Panel { piece, parts: Parts::One(piece), bounds, halves, sides, pieces });
        self.all.len() as u32 - 1
    }

    /// Lays the seams of a panel one after the other.
    fn lay_seams(&mut self, panel: u32) -> Parts {
        if let Some(Halves { panels, seam, ends }) = self.panel(panel).halves {
            let number = self.seams.len() as u32;
            let halves = [Parts::Two(number); 2];
            self.seams.push(Seam { halves, side: seam, ends });
            // No deeper than a panel has pieces.
            self.seams[number as usize].halves = panels.map(|half| self.lay_seams(half));
            self.all[panel as usize].parts = Parts::Two(number);
        }
        self.panel(panel).parts
    }

    pub(crate) fn seam(&self, seam: u32) -> &Seam {
        &self.seams[seam as usize]
    }

    pub(crate) fn panel(&self, panel: u32) -> &Panel {
        &self.all[panel as usize]
    }

    /// The boundary of a panel.
    pub(crate) fn sides(&self, panel: u32) -> &[FragmentSide] {
        let Range { start, end } = self.panel(panel).sides;
        &self.sides[start as usize..end as usize]
    }

    /// Tells the pieces of a panel; `rest` is room for panels to be looked at, empty before and after.
    pub(crate) fn pieces(&self, panel: u32, rest: &mut Vec<u32>, mut found: impl FnMut(PieceId)) {
        rest.push(panel);
        while let Some(panel) = rest.pop() {
            match self.panel(panel).halves {
                None => found(self.panel(panel).piece),
                Some(halves) => rest.extend(halves.panels.into_iter().rev()),
            }
        }
    }
}

/// Two panels that have a side in common. Those that make few pieces come first, then those with long sides, so that panels become compact; then
/// any order that is always the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    pieces: Reverse<u32>,
    /// The bits of the square of its length, which are in the order of the numbers.
    length: u64,
    panels: Reverse<[u32; 2]>,
    between: [u32; 2],
}

struct Joiner<'a, F> {
    scene: &'a Scene,
    skeleton: &'a Skeleton,
    panels: Panels,
    /// The side of a panel that runs from one point to another. Where there is more than one the others are not joined along it.
    along: FxHashMap<[PointId; 2], (u32, u32)>,
    queue: BinaryHeap<Pair>,
    /// Panels of the group that are no half of another one.
    whole: FxHashSet<u32>,
    most_pieces: u32,
    may_join: F,
}

impl<F: Fn(PieceId, PieceId) -> bool> Joiner<'_, F> {
    /// Joins pieces as far as that goes; what is left.
    fn join(&mut self, pieces: &[PieceId]) -> Vec<u32> {
        self.along.clear();
        self.whole.clear();
        for piece in pieces {
            self.offer(piece.0);
        }
        while let Some(Pair { panels: Reverse(panels), between, .. }) = self.queue.pop() {
            if panels.iter().all(|panel| self.whole.contains(panel))
                && let Some(sides) = self.joined(panels, between)
            {
                for panel in panels {
                    self.whole.remove(&panel);
                }
                let piece = self.panels.panel(panels[0]).piece;
                let halves = Halves::new(panels, panels.map(|panel| self.panels.sides(panel)), between);
                let panel = self.panels.push(self.skeleton, piece, Some(halves), sides);
                self.offer(panel);
            }
        }
        let mut whole: Vec<u32> = self.whole.drain().collect();
        whole.sort_unstable();
        whole
    }

    /// Takes a panel and pairs it with its neighbours.
    fn offer(&mut self, panel: u32) {
        self.whole.insert(panel);
        let sides = self.panels.sides(panel);
        if sides.len() > MOST_SIDES {
            return;
        }
        for (k, side) in sides.iter().enumerate() {
            let ends = [side.point, sides[next(k, sides)].point];
            self.along.insert(ends, (panel, k as u32));
            let Some(&(other, at)) = self.along.get(&[ends[1], ends[0]]) else { continue };
            let pieces = [panel, other].map(|k| self.panels.panel(k).pieces).iter().sum();
            if pieces > self.most_pieces || other == panel || !self.whole.contains(&other) {
                continue;
            }
            let [p, q] = ends.map(|end| self.position(end));
            let (panels, between) =
                if panel < other { ([panel, other], [k as u32, at]) } else { ([other, panel], [at, k as u32]) };
            let length = p.distance_squared(q).to_bits();
            self.queue.push(Pair { pieces: Reverse(pieces), length, panels: Reverse(panels), between });
        }
    }

    /// The boundary of two panels together, if they lie in one plane, turned the same way, and are convex together.
    fn joined(&self, panels: [u32; 2], between: [u32; 2]) -> Option<Vec<FragmentSide>> {
        let [a, b] = panels.map(|panel| self.panels.sides(panel));
        let [i, j] = between.map(|side| side as usize);
        let pieces = panels.map(|panel| self.panels.panel(panel).piece);
        if a[i].line != b[j].line || !(self.may_join)(pieces[0], pieces[1]) {
            return None;
        }
        let [plane, other] = pieces.map(|piece| self.scene.piece(piece).plane_id());
        let is_on = |side: &FragmentSide| self.skeleton.vertex_side(plane, vertex(side.point)).is_zero();
        if plane != other && !b.iter().all(is_on) {
            return None;
        }
        let turn = self.turns(plane, a[i].point);
        let [u, v] = [a[i].point, b[j].point];
        // Corners next to the side between them may be in line with it.
        let beside = |sides: &[FragmentSide], from: usize| {
            let corners = (0..sides.len()).filter(|&k| k != from && k != next(from, sides));
            corners.map(|k| turn([u, v, sides[k].point])).find(|sign| !sign.is_zero())
        };
        let inside = beside(a, i)?;
        if beside(b, j) != Some(-inside) {
            return None;
        }
        // From the side after the one between them, around to the one before it.
        let rest = |sides: &[FragmentSide], from: usize| -> Vec<FragmentSide> {
            (1..sides.len()).map(|k| sides[(from + k) % sides.len()]).collect()
        };
        let (mut sides, second) = (rest(a, i), rest(b, j));
        let seam = sides.len();
        sides.extend(second);
        // The corners where they meet; the later one first, so that the other keeps its place.
        for corner in [seam, 0] {
            let before = sides[if corner == 0 { sides.len() - 1 } else { corner - 1 }];
            let after = sides[corner];
            let end = sides[next(corner, &sides)].point;
            if before.line == after.line && before.forward == after.forward {
                sides.remove(corner);
            } else if turn([before.point, after.point, end]) != inside {
                return None;
            }
        }
        Some(sides)
    }

    /// Tells which way three points in a plane turn.
    fn turns(&self, plane: PlaneId, on: PointId) -> impl Fn([PointId; 3]) -> Sign {
        let axis = self.skeleton.approx_normal(plane).v.abs().max_position();
        // Any point off the plane will do: if this one were on it, all would be in line. Towards 0, so that its coordinates are numbers.
        let mut off = self.position(on);
        off[axis] -= off.abs().max_element().max(1e-100).copysign(off[axis]);
        move |points| {
            let [p, q, r] = points.map(|point| self.position(point));
            orient3d(p, q, off, r)
        }
    }

    fn position(&self, point: PointId) -> DVec3 {
        self.scene.vertex(vertex(point))
    }
}

/// The vertex that a corner of a piece is.
pub(crate) fn vertex(point: PointId) -> VertexId {
    VertexId(point.0)
}

fn next(k: usize, sides: &[FragmentSide]) -> usize {
    if k + 1 == sides.len() { 0 } else { k + 1 }
}

#[cfg(test)]
mod tests {
    use super::super::SceneBvh;
    use super::MOST_PIECES;
    use crate::exact::orient3d;
    use crate::scene::{Material, PieceRef, Scene};
    use glam::DVec3;

    type Mesh = (Vec<[f64; 3]>, Vec<Vec<usize>>);

    /// A wall of tiles, by their corners' columns and rows.
    fn wall(columns: usize, rows: usize, corner: impl Fn(f64, f64) -> [f64; 3]) -> Mesh {
        let place = |k: usize| corner((k % (columns + 1)) as f64, (k / (columns + 1)) as f64);
        let tile = |k: usize| {
            let low = k / columns * (columns + 1) + k % columns;
            vec![low, low + 1, low + columns + 2, low + columns + 1]
        };
        ((0..(columns + 1) * (rows + 1)).map(place).collect(), (0..columns * rows).map(tile).collect())
    }

    fn flat(x: f64, y: f64) -> [f64; 3] {
        [x, y, 2.0]
    }

    /// How many pieces the panels of a mesh have, most first.
    fn sizes((vertices, faces): &Mesh) -> Vec<u32> {
        let scene = Scene::builder().mesh(vertices, faces, Material::new("grey")).build().expect("a scene");
        let bvh = SceneBvh::build(&scene);
        check(&bvh);
        let hierarchy = &bvh.hierarchy;
        let mut sizes: Vec<u32> = hierarchy.order.iter().map(|&panel| hierarchy.panels.panel(panel).pieces).collect();
        sizes.sort_unstable_by(|a, b| b.cmp(a));
        sizes
    }

    /// Every piece is in one panel; every panel is convex, and its halves are beside each other along its seam.
    fn check(bvh: &SceneBvh) {
        let (scene, panels) = (bvh.scene(), &bvh.hierarchy.panels);
        let mut all = Vec::new();
        let mut rest = bvh.hierarchy.order.clone();
        for &panel in &rest {
            panels.pieces(panel, &mut Vec::new(), |piece| all.push(piece));
        }
        all.sort_unstable();
        assert!(all.into_iter().eq(scene.pieces().map(PieceRef::id)));
        while let Some(panel) = rest.pop() {
            let corners = |panel: u32| panels.sides(panel).iter().map(|s| scene.vertex(super::vertex(s.point)));
            let normal = bvh.hierarchy.skeleton.approx_normal(scene.piece(panels.panel(panel).piece).plane_id()).v;
            let ring: Vec<DVec3> = corners(panel).collect();
            let turn = |p: DVec3, q: DVec3, r: DVec3| orient3d(p, q, p + normal * 8.0, r);
            let turns = (0..ring.len()).map(|k| turn(ring[k], ring[(k + 1) % ring.len()], ring[(k + 2) % ring.len()]));
            let way = turns.clone().find(|turn| !turn.is_zero()).expect("not flat");
            assert!(turns.clone().all(|turn| turn.is_zero() || turn == way), "{ring:?}");
            let Some(halves) = panels.panel(panel).halves else { continue };
            let [u, v] = halves.ends.map(|end| scene.vertex(super::vertex(end.point)));
            for (half, side) in halves.panels.into_iter().zip([way, -way]) {
                assert!(corners(half).all(|p| turn(u, v, p).is_zero() || turn(u, v, p) == side));
                assert!(corners(half).any(|p| p == u) && corners(half).any(|p| p == v));
            }
            rest.extend(halves.panels);
        }
    }

    #[test]
    fn tiles_of_a_wall_become_panels() {
        assert_eq!(sizes(&wall(4, 4, flat)), [16]);
        assert_eq!(sizes(&wall(1, 1, flat)), [1]);
        assert_eq!(sizes(&wall(3, 5, flat)), [15]);
        // Of 40 x 40 tiles no panel has more than `MOST_PIECES`, and there are few of them.
        let large = sizes(&wall(40, 40, flat));
        assert!(large.iter().sum::<u32>() == 1600 && large[0] <= MOST_PIECES && large.len() <= 6, "{large:?}");
        // Slanted, exactly in one plane; its tiles are planes of their own.
        assert_eq!(sizes(&wall(4, 4, |x, y| [x, y, 2.0 * x + 3.0 * y])), [16]);
    }

    #[test]
    fn halved_tiles_are_joined_too() {
        let (vertices, tiles) = wall(3, 3, |x, y| [x, y, x - y]);
        let halves = tiles.iter().flat_map(|t| [vec![t[0], t[1], t[2]], vec![t[0], t[2], t[3]]]).collect();
        assert_eq!(sizes(&(vertices, halves)), [18]);
    }

    #[test]
    fn panels_are_convex_flat_and_turned_one_way() {
        // An L of three tiles.
        let (vertices, mut tiles) = wall(2, 2, flat);
        tiles.pop();
        assert_eq!(sizes(&(vertices, tiles)), [2, 1]);
        // A roof, one tile of which is higher by as little as can be at its far side.
        let ridge = |height: f64| wall(2, 1, move |x, y| [x, y, if x > 1.5 { height } else { 1.0 }]);
        assert_eq!(sizes(&ridge(1.0)), [2]);
        assert_eq!(sizes(&ridge(1.0_f64.next_up())), [1, 1]);
        // The corner in the middle of a side off its line by as little, outwards and inwards; or right on it.
        let bent =
            |y: f64| wall(2, 1, move |x, row| [x, if (0.5..1.5).contains(&x) && row > 0.5 { y } else { row }, 1.0]);
        assert_eq!(sizes(&bent(1.0)), [2]);
        assert_eq!(sizes(&bent(1.0_f64.next_up())), [2]);
        assert_eq!(sizes(&bent(1.0_f64.next_down())), [1, 1]);
        // One tile turned over; and one folded back onto the other.
        let (vertices, mut tiles) = wall(2, 1, flat);
        tiles[1].reverse();
        assert_eq!(sizes(&(vertices.clone(), tiles)), [1, 1]);
        let folded = vec![vec![0, 1, 4, 3], vec![4, 1, 0, 3]];
        assert_eq!(sizes(&(vertices, folded)), [1, 1]);
    }

    #[test]
    fn tiles_twice_in_one_place_are_not_joined_with_each_other() {
        let (vertices, tiles) = wall(2, 1, flat);
        let twice = tiles.iter().chain(&tiles).cloned().collect();
        let sizes = sizes(&(vertices, twice));
        assert_eq!(sizes.iter().sum::<u32>(), 4);
        assert!(sizes[0] <= 2, "{sizes:?}");
    }

    #[test]
    fn corners_on_the_side_of_a_neighbour_keep_panels_apart() {
        // Two tiles beside one that is as high as both: their common side has a corner of its own, but they are one panel first.
        let vertices = vec![
            [0.; 3],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [1., 2., 0.],
            [0., 2., 0.],
            [3., 0., 0.],
            [3., 2., 0.],
        ];
        let faces = vec![vec![0, 1, 2, 3], vec![3, 2, 4, 5], vec![1, 6, 7, 4]];
        assert_eq!(sizes(&(vertices.clone(), faces)), [2, 1]);
        let faces = vec![vec![0, 1, 2, 3], vec![3, 2, 4, 5], vec![1, 6, 7, 4, 2]];
        assert_eq!(sizes(&(vertices, faces)), [2, 1]);
    }

    #[test]
    fn what_is_hidden_from_outside_is_not_joined_with_what_is_not() {
        // A box of tiles, and a tile that goes on beside one of its faces.
        let mut vertices = Vec::new();
        let mut faces = Vec::new();
        let mut add = |mesh: Mesh| {
            let first = vertices.len();
            vertices.extend(mesh.0);
            faces.extend(mesh.1.iter().map(|face| face.iter().map(|k| k + first).collect::<Vec<_>>()));
        };
        add(wall(2, 2, |x, y| [y, x, 0.0]));
        add(wall(2, 2, |x, y| [x, y, 2.0]));
        add(wall(2, 2, |x, y| [x, 0.0, y]));
        add(wall(2, 2, |x, y| [y, 2.0, x]));
        add(wall(2, 2, |x, y| [0.0, y, x]));
        add(wall(2, 2, |x, y| [2.0, x, y]));
        assert_eq!(sizes(&(vertices.clone(), faces.clone())), [4; 6]);
        let more = vertices.len();
        vertices.extend([[2., 0., 2.], [4., 0., 2.], [4., 2., 2.], [2., 2., 2.]]);
        faces.push((more..more + 4).collect());
        let with_flap = sizes(&(vertices, faces));
        assert_eq!(with_flap, [4, 4, 4, 4, 4, 4, 1]);
    }

    /// Points off a plane have to be found where numbers end, too.
    #[test]
    fn pieces_are_joined_where_numbers_end() {
        let far = f64::MAX;
        let corners = [[-1.0, -2.0, far], [0.0, -2.0, far], [0.0, -1.0, far], [-1.0, -1.0, far]];
        let faces = [vec![0, 1, 2], vec![0, 2, 3]];
        let scene = Scene::builder().mesh(&corners, &faces, Material::new("far")).build().expect("a scene");
        assert_eq!(SceneBvh::build(&scene).hierarchy.order.len(), 1);
    }
}
