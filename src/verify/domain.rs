//! Frustums and windows as the checker has them: convex cones, and their union in disjoint parts.

use super::checker::Checker;
use super::defect::Defect;
use super::evidence::{EvidenceDomain, EvidencePane, HalfSphere};
use super::signs::Signs;
use crate::exact::{self, Plane, Sign};
use crate::scene::{PolygonId, Side, Splitter};
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// So many corners are looked at, at most, to cut windows into parts that do not overlap: about a minute.
const CORNERS: usize = 1 << 26;

/// What bounds a domain that is no sphere or hemisphere. Each cone is a cyclic list of half spheres, counter-clockwise seen from outside of the
/// sphere.
#[derive(Default)]
pub(super) struct DomainCones {
    /// The cone of each window, as it is.
    pub(super) whole: Vec<Vec<HalfSphere>>,
    /// Their union above the horizon, in parts that do not overlap.
    pub(super) parts: Vec<Vec<HalfSphere>>,
    /// What the splitters are that were taken in for them.
    pub(super) splitters: FxHashMap<u32, Splitter>,
}

fn malformed(what: &'static str) -> Defect {
    Defect::Malformed { place: "domain".to_owned(), what }
}

impl<S: Signs> Checker<'_, S> {
    /// Takes in the cones of the domain, without parts.
    pub(super) fn add_cones(&mut self) -> Result<Option<DomainCones>, Defect> {
        let mut cones = DomainCones::default();
        match &self.evidence.domain {
            EvidenceDomain::Sphere | EvidenceDomain::Hemisphere(_) | EvidenceDomain::Above(..) => return Ok(None),
            EvidenceDomain::Frustum(normals) => {
                let cone = normals.map(|normal| {
                    let splitter = self.signs.add(&exact::Splitter::Given(normal));
                    cones.splitters.insert(splitter, Splitter::Given(normal));
                    HalfSphere { splitter, inside: Sign::Positive }
                });
                cones.whole.push(cone.to_vec());
            }
            EvidenceDomain::Window { panes, .. } => {
                // Each polygon once, however often it is named.
                let mut known = FxHashSet::default();
                for pane in panes {
                    match pane {
                        EvidencePane::Polygon(polygon) if !known.insert(*polygon) => {}
                        EvidencePane::Polygon(polygon) => self.add_polygon(*polygon, &mut cones),
                        EvidencePane::Ring(ring) => self.add_ring(ring, &mut cones)?,
                    }
                }
            }
        }
        Ok(Some(cones))
    }

    /// The cones of the pieces of a polygon that are not seen edge-on.
    fn add_polygon(&mut self, polygon: PolygonId, cones: &mut DomainCones) {
        for piece in self.scene.polygon(polygon).pieces() {
            if self.height(piece.id()).is_zero() {
                continue;
            }
            let mut cone = Vec::new();
            self.cone(piece.id(), &mut cone);
            for (side, edge) in cone.iter().zip(piece.edges()) {
                cones.splitters.insert(side.splitter, Splitter::Edge(self.scene.edges()[edge.index()]));
            }
            // Counter-clockwise around the front is clockwise on the sphere when the front is what is shown.
            if self.shown(piece.id()) == Side::Front {
                cone.reverse();
            }
            cones.whole.push(cone);
        }
    }

    /// The cone of a ring, if it is not seen edge-on.
    fn add_ring(&mut self, ring: &[DVec3], cones: &mut DomainCones) -> Result<(), Defect> {
        let len = ring.len();
        let mut heights = (0..len).map(|k| {
            let plane = self.signs.add_plane(&Plane::Points([ring[k], ring[(k + 1) % len], ring[(k + 2) % len]]));
            self.signs.height(self.evidence.eye, plane)
        });
        let height = heights.next().unwrap_or(Sign::Zero);
        if !heights.all(|other| other == height) {
            return Err(malformed("three corners of a window are in line, or it is not convex as it is seen"));
        }
        if height.is_zero() {
            return Ok(());
        }
        let mut cone = Vec::with_capacity(len);
        for k in 0..len {
            let ends = [ring[k], ring[(k + 1) % len]];
            let splitter = self.signs.add(&exact::Splitter::Edge(ends));
            cones.splitters.insert(splitter, Splitter::Points(ends));
            cone.push(HalfSphere { splitter, inside: -height });
        }
        if height.is_positive() {
            cone.reverse();
        }
        cones.whole.push(cone);
        Ok(())
    }

    /// Checks that the cones are convex, and cuts their union into parts; great circles are known by now.
    pub(super) fn finish_cones(&mut self) -> Result<(), Defect> {
        let Some(mut cones) = self.cones.take() else { return Ok(()) };
        for cone in &mut cones.whole {
            let mut sides = Vec::with_capacity(cone.len());
            self.without_repeats(cone, &mut sides);
            if self.check_cone_is_convex(&sides).is_err() {
                return Err(malformed("a frustum or a window is not a convex cone, as it is seen"));
            }
            *cone = sides;
        }
        let mut left = CORNERS;
        for cone in &cones.whole {
            let mut rest = vec![cone.clone()];
            for earlier in &cones.parts {
                let mut next = Vec::new();
                for part in rest {
                    let cost = (part.len() + earlier.len()) * earlier.len();
                    left = left
                        .checked_sub(cost)
                        .ok_or_else(|| malformed("its windows are too many to be told apart in reasonable time"))?;
                    self.subtract(part, earlier, &mut next);
                }
                rest = next;
            }
            cones.parts.append(&mut rest);
        }
        if let Some(horizon) = self.horizon {
            cones.parts.retain_mut(|part| self.clip(part, horizon));
        }
        self.cones = Some(cones);
        Ok(())
    }

    /// What one convex cone has outside of another one, in convex parts.
    fn subtract(&mut self, mut part: Vec<HalfSphere>, other: &[HalfSphere], found: &mut Vec<Vec<HalfSphere>>) {
        let mut shared = part.clone();
        if !other.iter().all(|&side| self.clip(&mut shared, side)) {
            found.push(part);
            return;
        }
        for &side in other {
            let mut outside = part.clone();
            if self.clip(&mut outside, HalfSphere { inside: -side.inside, ..side }) {
                found.push(outside);
            }
            // Both share an interior, which is inside of every side.
            let _ = self.clip(&mut part, side);
        }
    }
}
