//! The convex outlines that are meshed: pieces of polygons, or polygons of one plane and one material together.

use super::cut::{Key, key};
use super::facets::Facets;
use crate::scene::{PieceId, PieceRef, PolygonId, PolygonRef, Scene, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A convex polygon that is meshed.
pub(super) struct Outline {
    pub(super) polygon: PolygonId,
    pub(super) piece: PieceId,
    /// Counter-clockwise seen from the front, where the scene is computed with.
    pub(super) corners: Vec<(VertexId, DVec3)>,
}

/// All pieces, by their polygons.
pub(super) fn pieces(scene: &Scene, facets: &Facets) -> Vec<Outline> {
    let pieces = scene.polygons().flat_map(PolygonRef::pieces);
    pieces.map(|piece| of_piece(scene, facets, piece)).collect()
}

fn of_piece(scene: &Scene, facets: &Facets, piece: PieceRef<'_>) -> Outline {
    let corner = |&id: &VertexId| (id, facets.placement.local(scene.vertex(id)));
    Outline { polygon: piece.polygon(), piece: piece.id(), corners: piece.vertices().iter().map(corner).collect() }
}

/// Facets, where they are whole polygons of one material, and pieces otherwise, by their first polygons; and the first polygon of each polygon's facet.
pub(super) fn joined(scene: &Scene, facets: &Facets) -> (Vec<Outline>, Vec<PolygonId>) {
    let mut of_facet: Vec<Vec<PieceId>> = vec![Vec::new(); facets.all.len()];
    scene.pieces().for_each(|piece| of_facet[facets.of_piece[piece.id().index()] as usize].push(piece.id()));
    let facet_of = |piece: PieceRef<'_>| facets.of_piece[piece.id().index()];
    let is_joined = |facet: usize| {
        let mut polygons = of_facet[facet].iter().map(|&piece| scene.polygon(scene.piece(piece).polygon()));
        let Some(first) = polygons.next() else { return false };
        let is_alike = |other: &PolygonRef<'_>| other.material_id() == first.material_id();
        let is_whole = |polygon: PolygonRef<'_>| polygon.pieces().all(|piece| facet_of(piece) as usize == facet);
        is_whole(first) && polygons.all(|polygon| is_alike(&polygon) && is_whole(polygon))
    };
    let is_joined: Vec<bool> = (0..of_facet.len()).map(is_joined).collect();
    let vertex: FxHashMap<Key, VertexId> = scene
        .vertices()
        .iter()
        .enumerate()
        .rev()
        .map(|(number, &p)| (key(facets.placement.local(p)), VertexId(number as u32)))
        .collect();
    let mut hosts: Vec<PolygonId> = scene.polygons().map(PolygonRef::id).collect();
    let mut outlines = Vec::new();
    for piece in scene.polygons().flat_map(PolygonRef::pieces) {
        let facet = facet_of(piece) as usize;
        if !is_joined[facet] {
            outlines.push(of_piece(scene, facets, piece));
            continue;
        }
        let first = of_facet[facet][0];
        hosts[piece.polygon().index()] = scene.piece(first).polygon();
        if piece.id() == first {
            let corners = facets.all[facet].ring.iter().map(|&p| (vertex[&key(p)], p)).collect();
            outlines.push(Outline { polygon: piece.polygon(), piece: first, corners });
        }
    }
    (outlines, hosts)
}
