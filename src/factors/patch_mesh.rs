//! The patches that a mesh makes of a scene, and finer ones.

use super::ExchangeError;
use super::cut::{Cell, Key, Places, key};
use super::element::frames;
use super::facets::Facets;
use super::footprints::footprints;
use super::halving::Halving;
use super::mesh;
use super::outlines::{self, Outline};
use super::placement::Placement;
use super::shape::sides;
use crate::scene::{FaceSpec, PieceId, PolygonId, Scene, SceneError};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::HashMap;

/// The polygons of a scene in patches: triangles and quadrilaterals. Those of [`PatchMesh::new`] have edges where others stand on a polygon, pass through it or
/// lie on it, so that each is covered as a whole or not at all. Edges that polygons share are divided in the same places, and within a polygon there are no T-junctions.
///
/// ```
/// use nusselt::factors::{Exchange, ExchangeOptions, PatchMesh};
///
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let mesh = PatchMesh::new(&scene, 200.0)?;
/// // All patches of the floor, halved.
/// let (finer, parents) = mesh.halved(|patch| mesh.polygon(patch).0 == 0);
/// assert!(finer.len() > mesh.len() && parents.len() == finer.len());
/// let exchange = Exchange::of_mesh(&finer, ExchangeOptions::default())?;
/// assert_eq!(exchange.patches().len(), finer.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PatchMesh {
    scene: Scene,
    placement: Placement,
    pub(super) parts: Vec<MeshPart>,
}

/// One patch.
#[derive(Clone, Debug)]
pub(super) struct MeshPart {
    pub(super) polygon: PolygonId,
    pub(super) piece: PieceId,
    /// The first part that it is connected with, within its polygon, without passing below what stands on it.
    region: u32,
    /// Its corners where the scene is computed with, counter-clockwise seen from the front.
    pub(super) ring: Vec<DVec3>,
}

impl PatchMesh {
    /// Meshes every polygon into parts with edges of at most that length, in scene units; those across a cell that something stands on may be as long as its diagonal.
    /// Infinity leaves polygons as they are, but in triangles and quadrilaterals, and cut where others stand on them.
    ///
    /// # Errors
    /// If the length is not a positive number, or the mesh too fine.
    pub fn new(scene: &Scene, longest_edge: f64) -> Result<Self, ExchangeError> {
        let is_positive = longest_edge > 0.0;
        if !is_positive {
            return Err(ExchangeError::BadEdge { longest_edge });
        }
        let facets = Facets::of(scene).map_err(ExchangeError::Facets)?;
        Self::of(scene, &facets, longest_edge)
    }

    /// The same, but polygons that are beside each other in one plane, of one material and convex together, are meshed as one: fewer patches,
    /// for pictures to which patches only lend what they reflect. Also tells, for every polygon, the one that its patches are said to be part of, which is the first of those that are joined.
    ///
    /// # Errors
    /// As [`PatchMesh::new`].
    pub fn joined(scene: &Scene, longest_edge: f64) -> Result<(Self, Vec<PolygonId>), ExchangeError> {
        let is_positive = longest_edge > 0.0;
        if !is_positive {
            return Err(ExchangeError::BadEdge { longest_edge });
        }
        let facets = Facets::of(scene).map_err(ExchangeError::Facets)?;
        let (outlines, hosts) = outlines::joined(scene, &facets);
        Ok((Self::within(scene, &facets, &outlines, longest_edge)?, hosts))
    }

    pub(super) fn of(scene: &Scene, facets: &Facets, longest_edge: f64) -> Result<Self, ExchangeError> {
        Self::within(scene, facets, &outlines::pieces(scene, facets), longest_edge)
    }

    fn within(scene: &Scene, facets: &Facets, outlines: &[Outline], longest_edge: f64) -> Result<Self, ExchangeError> {
        let placement = facets.placement;
        let longest = placement.local_length(longest_edge.min(2.0 * scene.diagonal()));
        let frames = frames(facets);
        let mut cells: Vec<(PolygonId, PieceId, Vec<DVec3>)> = Vec::new();
        for Outline { polygon, piece, corners } in outlines {
            let frame = &frames[facets.of_piece[piece.index()] as usize];
            let parts = mesh::elements(corners, frame, longest)
                .map_err(|mesh::TooFine| ExchangeError::TooFine { polygon: *polygon })?;
            cells.extend(parts.into_iter().map(|ring| (*polygon, *piece, ring)));
        }
        let segments = footprints(facets, &frames, longest);
        let plan = |piece: PieceId| {
            let facet = facets.of_piece[piece.index()] as usize;
            (&frames[facet], &segments[facet][..])
        };
        let mut places = Places::default();
        for (_, piece, ring) in &cells {
            places.note(&Cell::of(plan(*piece), ring));
        }
        places.settle();
        let mut parts = Vec::with_capacity(cells.len());
        for (polygon, piece, ring) in &cells {
            let cut = Cell::of(plan(*piece), ring).cut(&places).into_iter();
            parts.extend(cut.map(|ring| MeshPart { polygon: *polygon, piece: *piece, region: 0, ring }));
        }
        let mut start = 0;
        while start < parts.len() {
            let polygon = parts[start].polygon;
            let end = start + parts[start..].partition_point(|part| part.polygon == polygon);
            let is_border = |part: &MeshPart, edge| Cell::of(plan(part.piece), &part.ring).is_along_segment(edge);
            let regions = regions(&parts[start..end], is_border);
            parts[start..end].iter_mut().zip(regions).for_each(|(part, region)| part.region = start as u32 + region);
            start = end;
        }
        Ok(Self { scene: scene.clone(), placement, parts })
    }

    /// How many patches there are.
    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// True if there are none: if the scene is empty.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// The scene that it is of.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The polygon that a patch is part of.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn polygon(&self, patch: usize) -> PolygonId {
        self.parts[patch].polygon
    }

    /// The polygon that each patch is part of.
    pub fn polygons(&self) -> Vec<PolygonId> {
        self.parts.iter().map(|part| part.polygon).collect()
    }

    /// For each patch the first one of its polygon that it is connected with without passing below what stands on it: two patches beside each other that have
    /// different ones have a wall between them, and no light in common.
    pub fn regions(&self) -> Vec<PolygonId> {
        self.parts.iter().map(|part| PolygonId(part.region)).collect()
    }

    /// The mesh with those patches halved in both directions for which `is_wanted` is true, and neighbours as far as they have to be for that to make no T-junctions; for each patch
    /// of it the one of this mesh that it is part of.
    pub fn halved(&self, is_wanted: impl Fn(usize) -> bool) -> (Self, Vec<usize>) {
        let rings: Vec<&[DVec3]> = self.parts.iter().map(|part| &part.ring[..]).collect();
        let halving = Halving::of(&rings, is_wanted);
        let (mut parts, mut parents) = (Vec::new(), Vec::new());
        for (number, part) in self.parts.iter().enumerate() {
            let rings = halving.parts(&part.ring);
            parents.resize(parents.len() + rings.len(), number);
            parts.extend(rings.into_iter().map(|ring| MeshPart { ring, ..*part }));
        }
        (Self { scene: self.scene.clone(), placement: self.placement, parts }, parents)
    }

    /// A scene of which polygon k is patch k, with the object and the material of the polygon that it is part of.
    ///
    /// Corners are rounded, so parts of polygons that are not parallel to a coordinate plane need not lie exactly in one plane.
    ///
    /// # Errors
    /// If there are more corners than a scene can have.
    pub fn patches(&self) -> Result<Scene, SceneError> {
        let scene = &self.scene;
        let mut builder = Scene::builder();
        let materials: Vec<_> =
            scene.materials().iter().map(|material| builder.add_material(material.clone())).collect();
        let objects: Vec<_> = scene.objects().iter().map(|name| builder.add_object(name)).collect();
        let mut known: HashMap<Key, usize> = HashMap::new();
        for MeshPart { polygon, ring, .. } in &self.parts {
            let polygon = scene.polygon(*polygon);
            let mut corner = |&p: &DVec3| {
                let p = self.placement.global(p);
                *known.entry(key(p)).or_insert_with(|| builder.add_vertex(p))
            };
            let rings = vec![ring.iter().map(&mut corner).collect()];
            let (object, material) = (objects[polygon.object().index()], materials[polygon.material_id().index()]);
            builder.add_face(FaceSpec { rings, object, material });
        }
        builder.build()
    }
}

/// The first part that each part of a polygon is connected with by edges that are no borders.
fn regions(parts: &[MeshPart], is_border: impl Fn(&MeshPart, [DVec3; 2]) -> bool) -> Vec<u32> {
    let mut first: Vec<u32> = (0..parts.len() as u32).collect();
    let mut known: FxHashMap<[Key; 2], u32> = FxHashMap::default();
    for (number, part) in parts.iter().enumerate() {
        for edge in sides(&part.ring) {
            let [a, b] = edge.map(key);
            match known.entry([a.min(b), a.max(b)]) {
                std::collections::hash_map::Entry::Vacant(free) => {
                    free.insert(number as u32);
                }
                std::collections::hash_map::Entry::Occupied(other) if !is_border(part, edge) => {
                    let [a, b] = [number as u32, *other.get()].map(|part| root(&mut first, part));
                    first[a.max(b) as usize] = a.min(b);
                }
                std::collections::hash_map::Entry::Occupied(_) => {}
            }
        }
    }
    (0..parts.len() as u32).map(|part| root(&mut first, part)).collect()
}

/// The first of the parts that a part is known to be connected with.
fn root(first: &mut [u32], mut part: u32) -> u32 {
    while first[part as usize] != part {
        first[part as usize] = first[first[part as usize] as usize];
        part = first[part as usize];
    }
    part
}
