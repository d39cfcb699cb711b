//! Rules A, B and C: the cells tile the domain, with no gap and no overlap.

use super::checker::Checker;
use super::defect::Defect;
use super::domain::DomainCones;
use super::evidence::{EvidenceHorizon, HalfSphere};
use super::signs::Signs;
use crate::exact::Sign;
use crate::scene::Splitter;
use glam::DVec3;
use std::cmp::Ordering;

/// A side of a cell, or of a part of the domain, on a great circle, counter-clockwise about the normal that stands for the circle.
struct Arc {
    circle: u32,
    /// The cell; none for a part of the domain.
    cell: Option<u32>,
    /// Its ends: each is `circle x across`.
    ends: [HalfSphere; 2],
    /// What it bounds lies to the left of it (1) or to the right (-1).
    count: i64,
}

/// An end of an arc, as it is sorted.
#[derive(Clone, Copy)]
struct End {
    across: HalfSphere,
    arc: usize,
    is_start: bool,
    /// Half turns from the first end: at 0, within the first, at 1, within the second.
    half: u8,
    /// About where it is, counter-clockwise from the first end.
    angle: f64,
    /// It is not where the end before it is.
    is_new_place: bool,
}

impl<S: Signs> Checker<'_, S> {
    /// Rules A to C. Gives the number of great circles.
    pub(super) fn check_tiling(&mut self) -> Result<usize, Defect> {
        for cell in 0..self.cell_count() {
            self.check_convex(cell)?;
        }
        let circles = self.check_balance()?;
        self.check_witness()?;
        Ok(circles)
    }

    /// A: all corners but its own two lie strictly inside of every side, `det[n_j, n_k, n_(k+1)] > 0` for all `j` other
    /// than `k` and `k + 1`.
    ///
    /// That follows from three determinants a side, so that a cell of any number of sides costs no more than it
    /// has. Look along `n_0`: (1) `det[n_0, n_1, n_k] > 0` for `k >= 2` says that the other normals lie within half a
    /// turn about `n_0`, counter-clockwise from `n_1`; (2) `det[n_0, n_k, n_(k+1)] > 0` says that they follow each
    /// other in that half turn. So the normals are the corners of a simple polygon, a fan of triangles about `n_0`,
    /// and lie on half a sphere. (3) `det[n_(k-1), n_k, n_(k+1)] > 0` says that it turns left at every corner:
    /// a simple polygon on half a sphere that does is convex, which is what is to be shown.
    fn check_convex(&mut self, cell: u32) -> Result<(), Defect> {
        let sides = self.cell(cell).to_vec();
        let not_convex =
            |[corner, side]: [usize; 2]| Defect::NotConvex { cell, corner: corner as u32, side: side as u32 };
        self.check_cone_is_convex(&sides).map_err(not_convex)
    }

    /// The same of any list of half spheres; tells which corner is not strictly inside of which side.
    pub(super) fn check_cone_is_convex(&mut self, sides: &[HalfSphere]) -> Result<(), [usize; 2]> {
        let len = sides.len();
        if len < 3 {
            return Err([0, 0]);
        }
        // The corner where side `k` ends against side `j`.
        let mut check = |k: usize, j: usize| {
            let corner = (k + 1) % len;
            let inside = self.orientation([sides[j], sides[k], sides[corner]]).is_positive();
            if inside { Ok(()) } else { Err([corner, j]) }
        };
        for k in 1..len {
            check(k, k - 1)?;
        }
        check(0, len - 1)?;
        for k in 1..len - 1 {
            check(k, 0)?;
            check(0, k + 1)?;
        }
        Ok(())
    }

    /// B: on every stretch of every great circle as many cells lie to the left as to the right, but for the
    /// boundary of the domain, which has one more on the inside: all around a horizon, or where a side of a frustum or of windows is. These
    /// are cut into disjoint parts ([`super::domain`]), whose sides take part with the opposite sign.
    fn check_balance(&mut self) -> Result<usize, Defect> {
        let mut arcs = self.arcs();
        arcs.sort_by_key(|arc| arc.circle);
        // Where there are cones they end at the horizon themselves.
        let horizon = self.horizon.filter(|_| self.cones.is_none()).map(|half| self.on_circle(half));
        if let Some((circle, inside)) = horizon
            && arcs.binary_search_by_key(&circle, |arc| arc.circle).is_err()
        {
            let axes = [DVec3::X, DVec3::NEG_X];
            return Err(self.unbalanced(circle, axes, 0, inside as i64, Vec::new()));
        }
        let mut circles = 0;
        for on_circle in arcs.chunk_by(|a, b| a.circle == b.circle) {
            let circle = on_circle[0].circle;
            let expected = horizon.filter(|horizon| horizon.0 == circle).map_or(0, |horizon| horizon.1 as i64);
            self.check_circle(circle, on_circle, expected)?;
            circles += 1;
        }
        Ok(circles)
    }

    /// A side of a cell with the inward normal `n` runs from `n x (-n_before)` to `n x n_after`.
    fn arcs(&self) -> Vec<Arc> {
        let mut arcs = Vec::new();
        let cells = (0..self.cell_count()).map(|cell| (Some(cell), self.cell(cell)));
        let parts = self.cones.iter().flat_map(|cones| &cones.parts).map(|part| (None, part.as_slice()));
        for (cell, sides) in cells.chain(parts) {
            for (k, &side) in sides.iter().enumerate() {
                let (circle, inside) = self.on_circle(side);
                let before = sides[k.checked_sub(1).unwrap_or(sides.len() - 1)];
                let after = sides[(k + 1) % sides.len()];
                let from = HalfSphere { inside: -(inside * before.inside), ..before };
                let to = HalfSphere { inside: inside * after.inside, ..after };
                let ends = if inside.is_positive() { [from, to] } else { [to, from] };
                arcs.push(Arc { circle, cell, ends, count: inside as i64 });
            }
        }
        arcs
    }

    fn check_circle(&mut self, circle: u32, arcs: &[Arc], expected: i64) -> Result<(), Defect> {
        let first = arcs[0].ends[0];
        let mut ends = Vec::with_capacity(2 * arcs.len());
        for (arc, own) in arcs.iter().enumerate() {
            for (&across, is_start) in own.ends.iter().zip([true, false]) {
                let half = match self.ahead(circle, first, across) {
                    Sign::Positive => 1,
                    Sign::Negative => 3,
                    Sign::Zero if self.is_same_way(circle, [first, across]) => 0,
                    Sign::Zero => 2,
                };
                let angle = self.rounded_angle(circle, first, across);
                ends.push(End { across, arc, is_start, half, angle, is_new_place: true });
            }
        }
        self.sort_ends(circle, &mut ends);
        // The number of the place of each end; equal ends share one.
        let mut places = vec![[0; 2]; arcs.len()];
        // Of cells, and of parts of the domain.
        let mut deltas: Vec<(HalfSphere, [i64; 2])> = Vec::new();
        for end in &ends {
            if end.is_new_place {
                deltas.push((end.across, [0; 2]));
            }
            let place = deltas.len() - 1;
            let Arc { count, cell, .. } = arcs[end.arc];
            deltas[place].1[usize::from(cell.is_none())] += if end.is_start { count } else { -count };
            places[end.arc][usize::from(!end.is_start)] = place;
        }
        // An arc is less than half a turn long, so one that ends at a lower place than it starts at passes the
        // stretch before the first place.
        let wraps = |arc: usize| places[arc][0] > places[arc][1];
        let [mut count, mut of_domain] = [true, false].map(|is_cell| {
            let wrapping = (0..arcs.len()).filter(|&arc| wraps(arc) && arcs[arc].cell.is_some() == is_cell);
            wrapping.map(|arc| arcs[arc].count).sum::<i64>()
        });
        for (k, &(across, [delta, domain_delta])) in deltas.iter().enumerate() {
            count += delta;
            of_domain += domain_delta;
            let expected = expected + of_domain;
            if count != expected {
                let next = deltas[(k + 1) % deltas.len()].0;
                let circle_side = HalfSphere { splitter: circle, inside: Sign::Positive };
                let stretch = [across, next].map(|end| self.rounded([circle_side, end]));
                let covers = |arc: usize| {
                    let [from, to] = places[arc];
                    if from < to { (from..to).contains(&k) } else { k >= from || k < to }
                };
                let cells = (0..arcs.len()).filter(|&arc| covers(arc)).filter_map(|arc| arcs[arc].cell).collect();
                return Err(self.unbalanced(circle, stretch, count, expected, cells));
            }
        }
        Ok(())
    }

    /// Whether the direction `circle x q` is less than half a turn ahead of `circle x p`, or behind.
    fn ahead(&mut self, circle: u32, p: HalfSphere, q: HalfSphere) -> Sign {
        self.orientation([HalfSphere { splitter: circle, inside: Sign::Positive }, p, q])
    }

    /// Puts ends in their exact order and finds out which are in one place.
    ///
    /// Rounded angles nearly always give that order; only if a comparison of neighbours shows that they do not, all
    /// are sorted exactly.
    fn sort_ends(&mut self, circle: u32, ends: &mut [End]) {
        ends.sort_unstable_by(|a, b| a.half.cmp(&b.half).then(a.angle.total_cmp(&b.angle)).then(a.arc.cmp(&b.arc)));
        if !self.find_places(circle, ends) {
            ends.sort_by(|a, b| self.compare_ends(circle, a, b));
            self.find_places(circle, ends);
        }
    }

    /// False if the ends are not in order.
    fn find_places(&mut self, circle: u32, ends: &mut [End]) -> bool {
        for k in 1..ends.len() {
            let order = self.compare_ends(circle, &ends[k - 1], &ends[k]);
            if order == Ordering::Greater {
                return false;
            }
            ends[k].is_new_place = order == Ordering::Less;
        }
        true
    }

    /// An angle of about that from one end to another, counter-clockwise, in [0, 2 pi).
    fn rounded_angle(&self, circle: u32, from: HalfSphere, to: HalfSphere) -> f64 {
        let circle = HalfSphere { splitter: circle, inside: Sign::Positive };
        let [p, q] = [from, to].map(|across| self.rounded([circle, across]));
        let normal = self.signs.rounded(circle.splitter).normalize_or_zero();
        let angle = normal.dot(p.cross(q)).atan2(p.dot(q));
        if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
    }

    fn compare_ends(&mut self, circle: u32, a: &End, b: &End) -> Ordering {
        // Within a half turn no two directions are opposite.
        a.half.cmp(&b.half).then_with(|| match a.half {
            0 | 2 => Ordering::Equal,
            _ if self.on_circle(a.across) == self.on_circle(b.across) => Ordering::Equal,
            _ => match self.ahead(circle, a.across, b.across) {
                Sign::Positive => Ordering::Less,
                Sign::Zero => Ordering::Equal,
                Sign::Negative => Ordering::Greater,
            },
        })
    }

    fn unbalanced(&self, circle: u32, stretch: [DVec3; 2], count: i64, expected: i64, cells: Vec<u32>) -> Defect {
        // A circle that no splitter of the evidence is on is that of the horizon, or of another side of the domain.
        let of_cones = || self.cones.as_ref()?.splitters.get(&circle).copied();
        let of_horizon = || {
            let horizon = self.horizon.filter(|&half| self.on_circle(half).0 == circle);
            horizon.and_then(|_| self.evidence.domain.horizon()).map(|horizon| match horizon {
                EvidenceHorizon::Above(piece, _) => Splitter::Parallel(self.scene.piece(piece).plane()),
                EvidenceHorizon::Normal(normal) => Splitter::Given(normal),
            })
        };
        let known = self.evidence.splitters.get(circle as usize).copied();
        let known = known.or_else(of_horizon).or_else(of_cones);
        let circle = known.unwrap_or_else(|| Splitter::Given(self.signs.rounded(circle)));
        Defect::Unbalanced { circle: Box::new(circle), stretch, count, expected, cells }
    }

    /// C: a direction off all great circles lies in one cell, or in none if it is outside of the domain.
    fn check_witness(&mut self) -> Result<(), Defect> {
        let used: Vec<u32> = {
            let cells = (0..self.cell_count()).flat_map(|cell| self.cell(cell));
            let cones = self.cones.iter().flat_map(|cones| &cones.whole).flatten();
            let mut used: Vec<u32> = cells.chain(&self.horizon).chain(cones).map(|side| side.splitter).collect();
            used.sort_unstable();
            used.dedup();
            used
        };
        for direction in candidates() {
            let mut signs = vec![Sign::Zero; used.last().map_or(0, |&last| last as usize + 1)];
            for &splitter in &used {
                signs[splitter as usize] = self.signs.side(direction, splitter);
                if signs[splitter as usize].is_zero() {
                    break;
                }
            }
            if used.iter().any(|&splitter| signs[splitter as usize].is_zero()) {
                continue;
            }
            let inside = |side: &HalfSphere| signs[side.splitter as usize] == side.inside;
            let cells: Vec<u32> = (0..self.cell_count()).filter(|&cell| self.cell(cell).iter().all(inside)).collect();
            let in_cones = |cones: &DomainCones| cones.whole.iter().any(|cone| cone.iter().all(inside));
            let is_inside = self.horizon.as_ref().is_none_or(inside) && self.cones.as_ref().is_none_or(in_cones);
            let expected = usize::from(is_inside);
            return if cells.len() == expected { Ok(()) } else { Err(Defect::Covered { direction, cells, expected }) };
        }
        // No splitter of a convex cell has a normal of 0, so a few thousand great circles would have to be
        // aimed at all candidates.
        Err(Defect::Malformed { place: "witness".to_owned(), what: "every direction tried lies on a great circle" })
    }
}

/// Directions of small whole numbers in no particular order.
fn candidates() -> impl Iterator<Item = DVec3> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        ((state >> 32) % 2_000_003) as f64 - 1_000_001.0
    };
    (0..64).map(move |_| DVec3::new(next(), next(), next()))
}
