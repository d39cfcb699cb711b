//! The scene as views of it are taken: pieces that are convex together in one plane, such as the patches of a wall, joined to facets.
//!
//! What a view costs is what there is to tell apart in it (docs/performance.md). Between patches of one facet there is nothing to tell
//! apart for the eye: the part of a facet that is seen is divided among its patches afterwards, in its plane.

use super::bodies::{Bodies, FacetSide};
use super::element::Element;
use super::lies::Lies;
use super::placement::Placement;
use crate::bvh::{self, SceneBvh, Solid};
use crate::contour::SceneOrder;
use crate::scene::{CoplanarOverlap, FaceSpec, Material, PieceId, PieceRef, PolygonId, Scene, SceneError};
use glam::DVec3;
use std::ops::Range;

/// A scene whose polygons are the facets of another one.
pub(super) struct Facets {
    /// Takes views of the facets: polygon k is facet k.
    pub(super) order: SceneOrder,
    pub(super) all: Vec<Facet>,
    /// The facet that each piece of the scene is part of.
    pub(super) of_piece: Vec<u32>,
    /// Where they are: all coordinates here are local to it.
    pub(super) placement: Placement,
    pub(super) bodies: Bodies,
    /// The facets of the panels of the boxes, in their order, and where those of each begin.
    in_boxes: Vec<u32>,
    first_in: Vec<u32>,
    /// How each facet lies to the plane of each, row by row of planes, if there are few enough to keep that.
    lies: Vec<Lies>,
}

/// So many facets are told apart once and for all: 4 MB.
const FEW: usize = 2048;

pub(super) struct Facet {
    /// Its corners, counter-clockwise seen from its front.
    pub(super) ring: Vec<DVec3>,
    /// Three corners that are not in line, which run the same way.
    pub(super) spanning: [DVec3; 3],
    /// The box around it.
    pub(super) bounds: [DVec3; 2],
    /// True if another facet may lie on part of it in its plane.
    pub(super) is_covered: bool,
    /// True if one that shows the same way may: which of them is seen there is for numbers to say, and takes a view. (Of two that show different ways, fronts are seen.)
    pub(super) is_ranked: bool,
    /// The solid of the scene that it is part of; its box is that of the scene, not scaled.
    pub(super) solid: Option<Solid>,
}

impl Facets {
    /// Joins the pieces of a scene.
    ///
    /// Of polygons that lie on each other in one plane, numbers decide which is seen: those stay as they are, and facets are in the order of
    /// their first pieces.
    pub(super) fn of(scene: &Scene) -> Result<Self, SceneError> {
        let (overlaps, all) = scene.coplanar_overlaps();
        let mut is_covered = vec![!all; scene.polygon_count()];
        let mut is_ranked = is_covered.clone();
        let is_planar = |polygon: &PolygonId| {
            let mut planes = scene.polygon(*polygon).pieces().map(PieceRef::plane_id);
            planes.next().is_none_or(|first| planes.all(|plane| plane == first))
        };
        for CoplanarOverlap { polygons, opposed, .. } in &overlaps {
            // Of others parts may show either way.
            let is_opposed = *opposed && polygons.iter().all(is_planar);
            for polygon in polygons {
                is_covered[polygon.index()] = true;
                is_ranked[polygon.index()] |= !is_opposed;
            }
        }
        let covered = |piece: PieceId| is_covered[scene.piece(piece).polygon().index()];
        let joined = bvh::facets(scene, |a, b| !covered(a) && !covered(b));
        let placement = Placement::of(scene);
        let mut builder = Scene::builder();
        let material = builder.add_material(Material::new("facet"));
        let object = builder.add_object("facets");
        for &position in scene.vertices() {
            builder.add_vertex(placement.local(position));
        }
        let mut of_piece = vec![0; scene.piece_count()];
        let mut facets = Vec::with_capacity(joined.len());
        for (facet, joined) in joined.into_iter().enumerate() {
            for piece in &joined.pieces {
                of_piece[piece.index()] = facet as u32;
            }
            let ring: Vec<DVec3> = joined.ring.iter().map(|&vertex| placement.local(scene.vertex(vertex))).collect();
            let spanning = spanning(&ring);
            let low = ring.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let high = ring.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            let bounds = [low, high];
            let polygon = scene.piece(joined.pieces[0]).polygon().index();
            let [is_covered, is_ranked] = [is_covered[polygon], is_ranked[polygon]];
            facets.push(Facet { ring, spanning, bounds, is_covered, is_ranked, solid: joined.solid });
            let ring = joined.ring.iter().map(|vertex| vertex.index()).collect();
            builder.add_face(FaceSpec { rings: vec![ring], object, material });
        }
        let scene = builder.build()?;
        let planes = if facets.len() <= FEW { &facets[..] } else { &[] };
        let mut lies = Vec::with_capacity(planes.len() * planes.len());
        for plane in planes {
            lies.extend(facets.iter().map(|facet| Lies::of(&facet.ring, plane.spanning)));
        }
        let bodies = Bodies::of(&facets, |facet, plane| lies_in(&lies, &facets, facet, plane));
        let bvh = SceneBvh::build(&scene);
        let (in_boxes, first_in) = of_panels(&bvh);
        Ok(Self { order: bvh.into(), all: facets, of_piece, placement, bodies, in_boxes, first_in, lies })
    }
}

impl Facets {
    /// True if it is known of all facets how they lie to each other.
    pub(super) fn are_told_apart(&self) -> bool {
        !self.lies.is_empty()
    }

    /// How a facet lies to the plane of another one.
    pub(super) fn lies(&self, facet: u32, plane: u32) -> Lies {
        lies_in(&self.lies, &self.all, facet, plane)
    }

    /// How an element lies to the plane of another facet.
    pub(super) fn lies_of(&self, element: &Element, plane: u32) -> Lies {
        match self.lies(element.facet, plane) {
            Lies::Across => Lies::of(&element.ring, self.all[plane as usize].spanning),
            lies => lies,
        }
    }

    /// Those of panels of the boxes, by their places.
    pub(super) fn of_panels(&self, range: Range<u32>) -> &[u32] {
        let [start, end] = [range.start, range.end].map(|place| self.first_in[place as usize] as usize);
        &self.in_boxes[start..end]
    }

    /// The name of a side of a facet, by its place in the ring.
    pub(super) fn side(&self, facet: u32, place: u32) -> FacetSide {
        self.bodies.side(facet, place)
    }
}

/// The polygons of the panels of a scene's boxes, in their order, and where those of each begin.
fn of_panels(bvh: &SceneBvh) -> (Vec<u32>, Vec<u32>) {
    let hierarchy = &*bvh.hierarchy;
    let (mut polygons, mut first) = (Vec::new(), vec![0]);
    for &panel in &hierarchy.order {
        hierarchy
            .panels
            .pieces(panel, &mut Vec::new(), |piece| polygons.push(hierarchy.scene.piece(piece).polygon().0));
        first.push(polygons.len() as u32);
    }
    (polygons, first)
}

/// How a facet lies to the plane of another one, if all do or only those asked for are known.
fn lies_in(lies: &[Lies], facets: &[Facet], facet: u32, plane: u32) -> Lies {
    let place = plane as usize * facets.len() + facet as usize;
    let other = || Lies::of(&facets[facet as usize].ring, facets[plane as usize].spanning);
    lies.get(place).copied().unwrap_or_else(other)
}

/// The corners of a convex ring that span the largest triangle with its first edge's start, in their order.
pub(super) fn spanning(ring: &[DVec3]) -> [DVec3; 3] {
    let area = |a: usize, b: usize| (ring[a] - ring[0]).cross(ring[b] - ring[0]).length_squared();
    let pairs = (1..ring.len()).flat_map(|a| (a + 1..ring.len()).map(move |b| (a, b)));
    let best = pairs.max_by(|&(a, b), &(c, d)| area(a, b).total_cmp(&area(c, d)));
    let (a, b) = best.unwrap_or((1, 2));
    [ring[0], ring[a], ring[b]]
}
