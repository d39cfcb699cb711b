//! A mesh of all surfaces with radiosities at its corners.

use super::corners::Corners;
use super::rings::{in_own_unit, length, mean_of};
use super::{Gather, RadiosityError, strength};
use crate::scene::{PieceId, PieceRef, PolygonId, Scene};
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// How far inside of a triangle, as a part of the way to its middle, a corner's radiosity is taken: on the boundary itself what stands on it
/// there would not be seen.
pub(super) const INSIDE: f64 = 1e-3;

/// Between ends that differ by more than so many times what a middle may be off, a middle on their line may be chance, as between the foot of a leg and the border of a shadow: such edges are halved as well.
const STEEP: f64 = 8.0;

/// How fine a surface is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceOptions {
    /// An edge is halved if the radiosity in its middle differs from what its ends say by more than this part of it, or of the mean of all surfaces if that
    /// is larger; also if its ends differ by more than eight times that.
    pub detail: f64,
    /// How often at most an edge of a patch is halved: 0 for the patches as they are.
    pub depth: u32,
    /// There are at most so many corners.
    pub most_corners: usize,
}

impl Default for SurfaceOptions {
    fn default() -> Self {
        Self { detail: 0.03, depth: 3, most_corners: 20_000_000 }
    }
}

/// Triangles with radiosities at their corners. Triangles of one polygon share corners, but not both sides of what stands on it; those of different polygons do not, as radiosities differ.
///
/// A point that sees nothing but backs is *covered*: it is below something that stands there, and what it receives belongs inside of that. So triangles with all corners covered keep what they receive,
/// as it is seen from inside. Those that are covered in part are seen from outside: their covered corners have the mean radiosity of those that are not, so that what stands there does not darken
/// what is beside it. Both kinds share no corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The corners.
    pub positions: Vec<DVec3>,
    /// The radiosity of the front at each corner.
    pub radiosity: Vec<DVec3>,
    /// Corners by their numbers, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// The patch that each triangle is part of: triangles of one patch follow each other.
    pub patches: Vec<PolygonId>,
}

/// What radiosities along edges are compared with.
struct Light<'a> {
    gather: &'a Gather<'a>,
    options: &'a SurfaceOptions,
    mean: f64,
    /// The radiosities of the middles of edges that have been found before; none where nothing but backs is seen.
    known: FxHashMap<[u32; 2], Option<DVec3>>,
    done: &'a (dyn Fn(usize) + Sync),
}

impl Surface {
    /// Makes the surface of a scene of patches, of which patch k is part of polygon `of[k]`: corners of patches first, then middles of edges as long as radiosities change quickly
    /// along them. The cost is that of a view for every patch, every corner and every edge.
    ///
    /// # Errors
    /// If there is no view from some point, or if there are too many corners.
    ///
    /// # Panics
    /// If `of` does not name a polygon for every patch.
    pub fn new(
        scene: &Scene,
        of: &[PolygonId],
        gather: &Gather<'_>,
        options: &SurfaceOptions,
    ) -> Result<Self, RadiosityError> {
        Self::watched(scene, of, gather, options, &|_| true, &|_| ())
    }

    /// The same of those patches alone for which `is_wanted` is true; `done` is told from any thread how many more views are made. How many there will be is not known before.
    ///
    /// # Errors
    /// As [`Surface::new`].
    ///
    /// # Panics
    /// As [`Surface::new`].
    pub fn watched(
        scene: &Scene,
        of: &[PolygonId],
        gather: &Gather<'_>,
        options: &SurfaceOptions,
        is_wanted: &dyn Fn(PolygonId) -> bool,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Self, RadiosityError> {
        let mut surface = Self::default();
        // What covers one patch and not the one beside it stands on the side between them, where both see it otherwise.
        let middles = middles_of_pieces(scene, gather, is_wanted, done)?;
        let pieces: Vec<PieceRef<'_>> = scene.pieces().filter(|piece| is_wanted(piece.polygon())).collect();
        let is_below = |piece: &PieceRef<'_>| middles[&piece.id()].is_none();
        let corners = Corners::new(scene, &pieces, |piece| (of[piece.polygon().index()], is_below(piece)));
        let Corners { positions, places, of_pieces } = corners;
        surface.positions = positions;
        surface.check_size(options)?;
        let mut known: FxHashMap<[u32; 2], Option<DVec3>> = FxHashMap::default();
        for (piece, numbers) in pieces.iter().zip(&of_pieces) {
            let ring: Vec<DVec3> = piece.points().collect();
            for triangle in fan(&ring, numbers) {
                surface.triangles.push(triangle);
                surface.patches.push(piece.polygon());
            }
            if let Some(diagonal) = diagonal_through(mean_of(&ring), &ring, numbers) {
                known.insert(diagonal, middles[&piece.id()]);
            }
        }
        let patches: Vec<PolygonId> = places.iter().map(|place| place.0).collect();
        let found = gather.uncovered_at_all(places, done)?;
        let mut is_covered: Vec<bool> = found.iter().map(Option::is_none).collect();
        let radiosity = found.into_iter().zip(patches).map(|(b, patch)| b.unwrap_or(gather.emission(patch)));
        surface.radiosity = radiosity.collect();
        let mean = surface.mean(gather);
        let light = Light { gather, options, mean, known, done };
        let mut accepted: FxHashSet<[u32; 2]> = FxHashSet::default();
        for _ in 0..options.depth {
            if !surface.refine(&light, &mut accepted, &mut is_covered)? {
                break;
            }
        }
        surface.fill(&is_covered);
        Ok(surface)
    }

    fn check_size(&self, options: &SurfaceOptions) -> Result<(), RadiosityError> {
        let limit = options.most_corners;
        if self.positions.len() > limit { Err(RadiosityError::TooManyCorners { limit }) } else { Ok(()) }
    }

    /// The area of a triangle.
    pub(crate) fn area(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|corner| self.positions[corner as usize]);
        length((b - a).cross(c - a)) / 2.0
    }

    /// The mean of what is reflected.
    fn mean(&self, gather: &Gather<'_>) -> f64 {
        let (mut sum, mut areas) = (0.0, 0.0);
        for (triangle, patch) in self.triangles.iter().zip(&self.patches) {
            let area = self.area(*triangle);
            let radiosity = triangle.iter().map(|&corner| self.radiosity[corner as usize]).sum::<DVec3>() / 3.0;
            sum += area * strength(radiosity - gather.emission(*patch)).max(0.0);
            areas += area;
        }
        if areas > 0.0 { sum / areas } else { 0.0 }
    }

    /// Halves edges that need it; false if none does.
    fn refine(
        &mut self,
        light: &Light<'_>,
        accepted: &mut FxHashSet<[u32; 2]>,
        is_covered: &mut Vec<bool>,
    ) -> Result<bool, RadiosityError> {
        let Light { gather, options, mean, known, done } = light;
        let mut asked: FxHashSet<[u32; 2]> = FxHashSet::default();
        let (mut edges, mut places) = (Vec::new(), Vec::new());
        for (triangle, &patch) in self.triangles.iter().zip(&self.patches) {
            let [a, b, c] = triangle.map(|corner| self.positions[corner as usize]);
            let middle = (a + b + c) / 3.0;
            for edge in sides(*triangle) {
                if !accepted.contains(&edge) && asked.insert(edge) {
                    let [p, q] = edge.map(|corner| self.positions[corner as usize]);
                    edges.push((edge, p.midpoint(q), patch));
                    if !known.contains_key(&edge) {
                        places.push((patch, p.midpoint(q).lerp(middle, INSIDE)));
                    }
                }
            }
        }
        let mut found = gather.uncovered_at_all(places, done)?.into_iter();
        let mut halves: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        for (edge, position, patch) in edges {
            let uncovered = known.get(&edge).copied().or_else(|| found.next()).flatten();
            let radiosity = uncovered.unwrap_or(gather.emission(patch));
            let [p, q] = edge.map(|corner| self.radiosity[corner as usize]);
            let off = (radiosity - p.midpoint(q)).abs().max_element() * 3.0;
            let allowed = options.detail * strength(radiosity).max(*mean);
            let apart = (p - q).abs().max_element() * 3.0;
            if off <= allowed && apart <= STEEP * allowed {
                accepted.insert(edge);
                continue;
            }
            halves.insert(edge, self.positions.len() as u32);
            self.positions.push(position);
            self.radiosity.push(radiosity);
            is_covered.push(uncovered.is_none());
        }
        self.check_size(options)?;
        let (mut triangles, mut patches) = (Vec::new(), Vec::new());
        for (triangle, &patch) in self.triangles.iter().zip(&self.patches) {
            let before = triangles.len();
            split(*triangle, sides(*triangle).map(|edge| halves.get(&edge).copied()), &mut triangles);
            patches.resize(patches.len() + triangles.len() - before, patch);
        }
        (self.triangles, self.patches) = (triangles, patches);
        Ok(!halves.is_empty())
    }

    /// Gives covered corners of triangles that are covered in part the mean radiosity of the corners that are not, as corners of their own.
    fn fill(&mut self, is_covered: &[bool]) {
        let is_partly = |triangle: &[u32; 3]| {
            let count = triangle.iter().filter(|&&corner| is_covered[corner as usize]).count();
            count == 1 || count == 2
        };
        let mut sums: FxHashMap<u32, (DVec3, f64)> = FxHashMap::default();
        for triangle in self.triangles.iter().filter(|triangle| is_partly(triangle)) {
            for edge in sides(*triangle) {
                for [from, to] in [edge, [edge[1], edge[0]]] {
                    if is_covered[to as usize] && !is_covered[from as usize] {
                        let sum = sums.entry(to).or_default();
                        *sum = (sum.0 + self.radiosity[from as usize], sum.1 + 1.0);
                    }
                }
            }
        }
        let mut outside: FxHashMap<u32, u32> = FxHashMap::default();
        for triangle in self.triangles.iter_mut().filter(|triangle| is_partly(triangle)) {
            for corner in triangle.iter_mut() {
                if let Some((sum, count)) = sums.get(corner) {
                    *corner = *outside.entry(*corner).or_insert_with(|| {
                        self.positions.push(self.positions[*corner as usize]);
                        self.radiosity.push(*sum / *count);
                        self.positions.len() as u32 - 1
                    });
                }
            }
        }
        self.drop_unused();
    }

    /// Leaves out corners that no triangle has.
    fn drop_unused(&mut self) {
        let mut is_used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&corner| is_used[corner as usize] = true);
        let mut number = 0;
        let numbers: Vec<u32> = is_used.iter().map(|&is_used| (number, number += u32::from(is_used)).0).collect();
        let mut used = is_used.iter();
        self.positions.retain(|_| used.next() == Some(&true));
        let mut used = is_used.iter();
        self.radiosity.retain(|_| used.next() == Some(&true));
        self.triangles.iter_mut().flatten().for_each(|corner| *corner = numbers[*corner as usize]);
    }
}

/// For each piece of the patches that are wanted the radiosity of its middle; none where nothing but backs is seen.
fn middles_of_pieces(
    scene: &Scene,
    gather: &Gather<'_>,
    is_wanted: &dyn Fn(PolygonId) -> bool,
    done: &(dyn Fn(usize) + Sync),
) -> Result<FxHashMap<PieceId, Option<DVec3>>, RadiosityError> {
    let pieces: Vec<PieceRef<'_>> = scene.pieces().filter(|piece| is_wanted(piece.polygon())).collect();
    let middle = |piece: &PieceRef<'_>| (piece.polygon(), mean_of(&piece.points().collect::<Vec<_>>()));
    let found = gather.uncovered_at_all(pieces.iter().map(middle).collect(), done)?;
    Ok(pieces.iter().map(|piece| piece.id()).zip(found).collect())
}

/// The side that the triangles of a quadrilateral share, if its middle is that of the ring, or as near to that as points are to the boundary that stand for those on it.
fn diagonal_through(middle: DVec3, ring: &[DVec3], numbers: &[u32]) -> Option<[u32; 2]> {
    let first = usize::from(ring.len() == 4 && is_cut_second(ring));
    let [a, b] = [first, first + 2].map(|k| ring.get(k));
    let [&a, &b] = [a?, b?];
    let is_near = ring.len() == 4 && length(a.midpoint(b) - middle) <= INSIDE * length(a - b);
    is_near.then(|| [numbers[first], numbers[first + 2]]).map(|[p, q]| [p.min(q), p.max(q)])
}

/// The sides of a triangle, from corner k to the next, each by the smaller corner first.
fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)])
}

/// The triangles that a triangle falls into where some of its sides have a corner in their middle.
fn split([a, b, c]: [u32; 3], middles: [Option<u32>; 3], out: &mut Vec<[u32; 3]>) {
    match middles {
        [None, None, None] => out.push([a, b, c]),
        [Some(p), None, None] => out.extend([[a, p, c], [p, b, c]]),
        [Some(p), Some(q), None] => out.extend([[p, b, q], [a, p, q], [a, q, c]]),
        [Some(p), Some(q), Some(r)] => out.extend([[a, p, r], [p, b, q], [r, q, c], [p, q, r]]),
        // The same with its corners turned.
        [p, q, r] => split([b, c, a], [q, r, p], out),
    }
}

/// The triangles of a convex ring; a quadrilateral is cut along its shorter diagonal.
fn fan(ring: &[DVec3], numbers: &[u32]) -> Vec<[u32; 3]> {
    let first = usize::from(is_cut_second(ring));
    let corner = |k: usize| numbers[(first + k) % numbers.len()];
    (1..ring.len() - 1).map(|k| [corner(0), corner(k), corner(k + 1)]).collect()
}

/// True if a ring is cut from its second corner and not from its first: a quadrilateral along the shorter diagonal.
fn is_cut_second(ring: &[DVec3]) -> bool {
    let &[a, b, c, d] = ring else { return false };
    let [first, second] = in_own_unit([c - a, d - b]);
    second.length_squared() < first.length_squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_fall_into_what_their_sides_say_and_stay_turned_the_same_way() {
        let at = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(glam::DVec2::from);
        for choice in 0..8 {
            let middles = [0, 1, 2].map(|k| (choice >> k & 1 == 1).then_some(3 + k));
            let mut parts = Vec::new();
            split([0, 1, 2], middles, &mut parts);
            let areas = parts.iter().map(|t| {
                let [a, b, c] = t.map(|k| at[k as usize]);
                (b - a).perp_dot(c - a)
            });
            let areas: Vec<f64> = areas.collect();
            assert!(areas.iter().all(|&area| area > 0.0), "{parts:?}");
            assert!((areas.iter().sum::<f64>() - 16.0).abs() < 1e-12, "{parts:?}");
            // No corner lies in the middle of a side.
            let used: FxHashSet<[u32; 2]> = parts.iter().flat_map(|&t| sides(t)).collect();
            for (side, middle) in sides([0, 1, 2]).into_iter().zip(middles) {
                assert_eq!(used.contains(&side), middle.is_none());
            }
        }
    }
}
