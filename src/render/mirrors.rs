//! What a camera sees in flat mirrors: the image of an eye behind each.

use super::before::before;
use super::leaves::{ASLANT, Leaves, is_mirrored};
use super::{RenderError, Shader, Spot};
use crate::contour::{Cell, CellId, ContourImage, Domain, Frustum, SceneOrder, Viewpoint};
use crate::parallel;
use crate::picture::{ReflectedPart, Reflections};
use crate::scene::{PieceId, PlaneId};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// So many planes of mirrors have an image of their own, those that take most of the view: each costs what a scene and a view do. In others what is seen is found point by point.
const MOST_PLANES: usize = 16;
/// So many pieces all copies of the scene have together, or there is one copy: some 700 bytes each.
const MOST_PIECES: usize = 2_000_000;

/// What is seen in the mirrors of a camera's image.
#[derive(Default)]
pub(super) struct Mirrors {
    views: Vec<MirrorView>,
    /// For each cell of the camera's image the view that it shows.
    of_cells: Vec<Option<usize>>,
}

/// What the mirrored camera sees of what is before a mirror.
struct MirrorView {
    image: ContourImage,
    /// The piece of the scene that each polygon of the image is part of.
    pieces: Vec<PieceId>,
}

/// What a ray from a mirror meets: a point on a surface, or background; and its unit direction.
#[derive(Clone, Copy)]
pub(super) struct Meets {
    pub(super) spot: Option<Spot>,
    pub(super) direction: DVec3,
}

impl Mirrors {
    /// Of the image of a camera of a shader's scene.
    pub(super) fn new(shader: &Shader, image: &ContourImage, camera: &Frustum) -> Result<Self, RenderError> {
        let is_mirror = shader.mirrors();
        if shader.options.mirrors == 0 || !is_mirror.contains(&true) {
            return Ok(Self::default());
        }
        let scene = shader.scene();
        let is_mirror = |cell: &Cell<'_>| {
            cell.polygon().is_some_and(|polygon| is_mirror[scene.polygon(polygon).material_id().index()])
        };
        // By planes, with a cell that shows each.
        let mut planes: FxHashMap<PlaneId, (f64, CellId)> = FxHashMap::default();
        for cell in image.cells().filter(is_mirror) {
            if let Some(piece) = cell.piece() {
                planes.entry(scene.piece(piece).plane_id()).or_insert((0.0, cell.id())).0 += cell.solid_angle();
            }
        }
        let mut planes: Vec<(PlaneId, f64, CellId)> =
            planes.into_iter().map(|(plane, (size, cell))| (plane, size, cell)).collect();
        planes.sort_unstable_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        planes.truncate(MOST_PLANES.min(MOST_PIECES / scene.piece_count().max(1)).max(1));
        let found = parallel::map(planes, |(plane, _, cell)| {
            let view = MirrorView::new(shader, image.cell(cell), camera);
            view.map(|view| view.map(|view| (plane, view)))
        });
        let mut mirrors = Self::default();
        let mut numbers = FxHashMap::default();
        for found in found {
            if let Some((plane, view)) = found? {
                numbers.insert(plane, mirrors.views.len());
                mirrors.views.push(view);
            }
        }
        let number = |cell: Cell<'_>| {
            let piece = cell.piece().filter(|_| is_mirror(&cell))?;
            numbers.get(&scene.piece(piece).plane_id()).copied()
        };
        mirrors.of_cells = image.cells().map(number).collect();
        Ok(mirrors)
    }

    /// What is seen in them.
    pub(super) fn reflections(&self) -> Reflections<'_> {
        Reflections { images: self.views.iter().map(|view| &view.image).collect(), of_cells: &self.of_cells }
    }

    /// What is seen in a part of a mirror.
    pub(super) fn meets(&self, part: ReflectedPart) -> Meets {
        let MirrorView { image, pieces } = &self.views[part.mirror];
        let cell = image.cell(part.cell);
        let spot = cell.polygon().zip(cell.side()).map(|(polygon, side)| {
            // Of a plane that is seen edge-on: the nearest point of the piece will do.
            let near = cell.point_at(part.direction).unwrap_or(image.viewpoint().eye());
            Spot { piece: pieces[polygon.index()], side, near }
        });
        Meets { spot, direction: part.direction }
    }
}

impl MirrorView {
    /// Of the mirror that a cell of a camera's image shows; none if numbers do not hold the eye behind it.
    fn new(shader: &Shader, cell: Cell<'_>, camera: &Frustum) -> Result<Option<Self>, RenderError> {
        let (scene, eye) = (shader.scene(), cell.image().viewpoint().eye());
        let Some((piece, side)) = cell.piece().zip(cell.side()) else { return Ok(None) };
        let corner = scene.vertex(scene.piece(piece).vertices()[0]);
        let on_mirror = Viewpoint::on_piece(scene, piece, side, corner)?;
        let Some(normal) = on_mirror.surface_normal(scene, shader.order.skeleton()) else { return Ok(None) };
        let mirrored = |v: DVec3| v - 2.0 * normal.dot(v) * normal;
        let behind = eye - 2.0 * normal.dot(eye - corner) * normal;
        let frame = camera.frame();
        let mirrored_camera =
            Frustum::new(mirrored(frame.towards()), mirrored(frame.up()), camera.degrees(), camera.aspect());
        let (Ok(mirrored_camera), true) = (mirrored_camera, behind.is_finite()) else { return Ok(None) };
        let piece = scene.piece(piece);
        let Some((front, pieces)) = before(scene, piece.plane(), side == piece.facing()) else {
            return Ok(None);
        };
        let image = SceneOrder::new(&front).view(&Viewpoint::free(behind), &Domain::Frustum(mirrored_camera));
        let image = image.map_err(|source| RenderError::View { from: "the eye behind a mirror", source })?;
        Ok(Some(Self { image, pieces }))
    }
}

impl Shader {
    /// For each material whether it is a mirror.
    pub(super) fn mirrors(&self) -> Vec<bool> {
        let is_mirror = |leaves: Leaves<'_>| leaves.mirrors.iter().any(|&(way, _)| is_mirrored(ASLANT, way));
        self.brdfs.iter().map(|brdf| is_mirror(Leaves::new(&**brdf, ASLANT))).collect()
    }
}
