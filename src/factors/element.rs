//! Elements: the flat convex parts that patches are made of, and how a scene falls into them.

use super::facets::Facets;
use super::patch_mesh::PatchMesh;
use super::placement::Placement;
use super::row::{PatchInfo, PatchShape};
use super::shape::{Frame, centre, double_area, sides, turn};
use super::{ExchangeError, PatchPlan};
use crate::scene::{PieceRef, PolygonId, Scene};
use glam::{DVec2, DVec3};

/// The normals of a patch whose mean is shorter than this have no direction together.
const CLOSED: f64 = 1e-9;

/// Parts of a scene of about 1 across are not smaller: products of two areas are numbers.
const LEAST_AREA: f64 = 1e-140;

/// A flat convex part of a patch.
pub(super) struct Element {
    pub(super) patch: u32,
    pub(super) facet: u32,
    /// Its corners, counter-clockwise seen from its front.
    pub(super) ring: Vec<DVec3>,
    /// The same in the frame of its facet.
    pub(super) flat: Vec<DVec2>,
    /// Where it is in the frame of its facet.
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    pub(super) area: f64,
    pub(super) centre: DVec3,
    /// No corner is farther from the centre.
    pub(super) radius: f64,
    /// What rounding of places on it may do to its factors: the distance between numbers there, over the size.
    pub(super) rounding: f64,
    /// Points and weights that integrate polynomials of degree 3 over a parallelogram; the weights sum to the area.
    pub(super) points: Vec<(DVec3, f64)>,
}

/// All patches and what they are made of.
pub(super) struct Elements {
    pub(super) patches: Vec<PatchInfo>,
    pub(super) all: Vec<Element>,
    /// The elements of each patch.
    pub(super) of_patch: Vec<Vec<u32>>,
    /// The elements of each facet.
    pub(super) of_facet: Vec<Vec<u32>>,
    /// The plane of each facet.
    pub(super) frames: Vec<Frame>,
}

impl Elements {
    pub(super) fn of(scene: &Scene, facets: &Facets, plan: PatchPlan) -> Result<Self, ExchangeError> {
        if let PatchPlan::Mesh { longest_edge } = plan {
            return Self::of_mesh(&PatchMesh::of(scene, facets, longest_edge)?, facets);
        }
        let mut found = Self::none(facets);
        let mut of_object: Vec<Option<u32>> = vec![None; scene.objects().len()];
        for polygon in scene.polygons() {
            let name = polygon.object_name();
            let known = of_object[polygon.object().index()].filter(|_| plan == PatchPlan::Objects);
            let patch = known.map_or_else(|| found.patch(name.to_owned(), polygon.id()), Ok)?;
            of_object[polygon.object().index()] = Some(patch);
            for piece in polygon.pieces() {
                found.add(patch, facets.of_piece[piece.id().index()], points(piece, facets.placement))?;
            }
        }
        Ok(found)
    }

    /// Of the patches of a mesh of the same scene.
    pub(super) fn of_mesh(mesh: &PatchMesh, facets: &Facets) -> Result<Self, ExchangeError> {
        let mut found = Self::none(facets);
        for part in &mesh.parts {
            let name = mesh.scene().polygon(part.polygon).object_name();
            let patch = found.patch(name.to_owned(), part.polygon)?;
            found.add(patch, facets.of_piece[part.piece.index()], part.ring.clone())?;
        }
        Ok(found)
    }

    fn none(facets: &Facets) -> Self {
        let frames = frames(facets);
        Self {
            patches: Vec::new(),
            all: Vec::new(),
            of_patch: Vec::new(),
            of_facet: vec![Vec::new(); frames.len()],
            frames,
        }
    }

    fn patch(&mut self, name: String, polygon: PolygonId) -> Result<u32, ExchangeError> {
        let number = u32::try_from(self.patches.len()).ok().filter(|&number| number < u32::MAX - 2);
        let number = number.ok_or(ExchangeError::TooManyPatches)?;
        self.patches.push(PatchInfo { name, polygon, area: 0.0, shape: None });
        self.of_patch.push(Vec::new());
        Ok(number)
    }

    /// Where a patch is in the scene; `None` if it has no area.
    pub(super) fn shape(&self, patch: usize, placement: Placement) -> Option<PatchShape> {
        let (mut area, mut moment, mut vector) = (0.0, DVec3::ZERO, DVec3::ZERO);
        let mut pieces = Vec::with_capacity(self.of_patch[patch].len());
        for element in self.of_patch[patch].iter().map(|&element| &self.all[element as usize]) {
            area += element.area;
            moment += element.area * element.centre;
            vector += element.area * self.frames[element.facet as usize].normal;
            pieces.push(element.ring.iter().map(|&p| placement.global(p)).collect());
        }
        // Without -0.
        let normal = (vector.length() > CLOSED * area).then(|| vector.normalize() + DVec3::ZERO);
        let center = placement.global(moment / area) + DVec3::ZERO;
        (area > 0.0).then_some(PatchShape { center, normal, pieces })
    }

    fn add(&mut self, patch: u32, facet: u32, ring: Vec<DVec3>) -> Result<(), ExchangeError> {
        let frame = &self.frames[facet as usize];
        let flat: Vec<DVec2> = ring.iter().map(|&p| frame.flat(p)).collect();
        let twice_area = double_area(&ring);
        let area = 0.5 * twice_area.length();
        if twice_area == DVec3::ZERO {
            return Ok(());
        }
        if area < LEAST_AREA {
            return Err(ExchangeError::TooSmall { polygon: self.patches[patch as usize].polygon });
        }
        let centre = centre(&ring);
        let element = Element {
            patch,
            facet,
            low: flat.iter().fold(DVec2::INFINITY, |low, &p| low.min(p)),
            high: flat.iter().fold(DVec2::NEG_INFINITY, |high, &p| high.max(p)),
            area,
            centre,
            radius: ring.iter().fold(0.0, |radius, p| p.distance(centre).max(radius)),
            rounding: rounding(&ring, area),
            points: points_of_degree_3(&ring, &flat),
            ring,
            flat,
        };
        let number = self.all.len() as u32;
        self.all.push(element);
        self.of_patch[patch as usize].push(number);
        self.of_facet[facet as usize].push(number);
        self.patches[patch as usize].area += area;
        Ok(())
    }
}

/// The plane of each facet.
pub(super) fn frames(facets: &Facets) -> Vec<Frame> {
    facets.all.iter().map(|facet| Frame::through(facet.spanning)).collect()
}

fn points(piece: PieceRef<'_>, placement: Placement) -> Vec<DVec3> {
    piece.points().map(|p| placement.local(p)).collect()
}

/// Moved by so much, a ring with that area gains and loses a strip along its perimeter.
fn rounding(ring: &[DVec3], area: f64) -> f64 {
    let most = ring.iter().fold(0.0, |most: f64, p| p.abs().max_element().max(most));
    let perimeter: f64 = sides(ring).map(|[a, b]| a.distance(b)).sum();
    f64::EPSILON * most * perimeter / area
}

/// Four points for each quadrilateral (the product of Gauss's rule of two points, in the bilinear chart) that a convex ring falls into.
fn points_of_degree_3(ring: &[DVec3], flat: &[DVec2]) -> Vec<(DVec3, f64)> {
    const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
    let mut points = Vec::new();
    for quad in quads(ring.len()) {
        let [a, b, c, d] = quad.map(|k| ring[k]);
        let [p, q, r, s] = quad.map(|k| flat[k]);
        for u in GAUSS {
            for v in GAUSS {
                let at = a.lerp(b, u).lerp(d.lerp(c, u), v);
                let along_u = (q - p).lerp(r - s, v);
                let along_v = (s - p).lerp(r - q, u);
                points.push((at, 0.25 * along_u.perp_dot(along_v).abs()));
            }
        }
    }
    points
}

/// The quadrilaterals that a convex ring of so many corners falls into, as their corners; a triangle is one with its last corner twice.
pub(super) fn quads(corners: usize) -> impl Iterator<Item = [usize; 4]> {
    (1..corners.saturating_sub(1)).step_by(2).map(move |k| [0, k, k + 1, (k + 2).min(corners - 1)])
}

impl Element {
    /// True if a point of the plane of its facet is in it.
    pub(super) fn holds(&self, p: DVec2) -> bool {
        sides(&self.flat).all(|[a, b]| turn(a, b, p) >= 0.0)
    }
}
