//! The matrix, row by row.

use super::blockers::Blockers;
use super::closure::{TooLarge, place};
use super::element::{Element, Elements};
use super::element_row::{Effort, ElementRows, explained};
use super::facets::Facets;
use super::row::{Entry, PatchInfo, Row, Share};
use super::row_space::RowSpace;
use super::seen::{Columns, Looker};
use super::shared::{self, Shared};
use super::shut::{Shut, half_shut};
use super::touching::{on_each_other, overlap, touching_facets};
use super::tree::ElementTree;
use super::{ExchangeError, ExchangeOptions, PatchMesh, PatchPlan, Sides};
use crate::parallel;
use crate::scene::{PolygonId, Scene};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How a row is computed, and how anew as long as its residue is larger than what is allowed and the estimates of its errors: to these parts of the tolerance,
/// and with or without many views from near its sides.
const ATTEMPTS: [(f64, bool); 3] = [(1.0, false), (1.0, true), (0.1, true)];

/// Form factors between the patches of a scene.
///
/// Pairs of elements (the flat convex parts of patches) that see each other wholly, by exact tests of all that might be between them, are
/// exchanged in closed form; what is seen in part is integrated over the element from exact views, and closes at every point of it.
///
/// ```
/// use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan};
/// use nusselt::samples::{Kind, generate};
///
/// let scene = generate(Kind::Room, 200, 1)?.to_builder().build()?;
/// let exchange = Exchange::new(&scene, PatchPlan::Polygons, ExchangeOptions::default())?;
/// let row = exchange.row(7)?;
/// // Nothing leaves a closed room, and nothing is lost.
/// assert!((row.sum() - 1.0).abs() < 1e-12 && row.background.factor < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Exchange {
    pub(super) facets: Facets,
    pub(super) elements: Elements,
    pub(super) trees: Vec<ElementTree>,
    /// The facets that each is face to face with.
    touching: Vec<Vec<u32>>,
    pub(super) shut: Shut,
    pub(super) options: ExchangeOptions,
    /// Areas as they are in the scene.
    patches: Vec<PatchInfo>,
}

impl Exchange {
    /// Prepares the patches of a scene: about n log n time.
    ///
    /// # Errors
    /// If an option is out of range or a mesh too fine.
    pub fn new(scene: &Scene, plan: PatchPlan, options: ExchangeOptions) -> Result<Self, ExchangeError> {
        let is_positive = |x: f64| x.is_finite() && x > 0.0;
        if let PatchPlan::Mesh { longest_edge } = plan
            && !is_positive(longest_edge)
        {
            return Err(ExchangeError::BadEdge { longest_edge });
        }
        let facets = Facets::of(scene).map_err(ExchangeError::Facets)?;
        let elements = Elements::of(scene, &facets, plan)?;
        Self::between(facets, elements, options)
    }

    /// Prepares the patches of a mesh.
    ///
    /// # Errors
    /// If an option is out of range or there are too many patches.
    pub fn of_mesh(mesh: &PatchMesh, options: ExchangeOptions) -> Result<Self, ExchangeError> {
        let facets = Facets::of(mesh.scene()).map_err(ExchangeError::Facets)?;
        let elements = Elements::of_mesh(mesh, &facets)?;
        Self::between(facets, elements, options)
    }

    fn between(facets: Facets, elements: Elements, options: ExchangeOptions) -> Result<Self, ExchangeError> {
        let tolerance = options.tolerance;
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(ExchangeError::BadTolerance { tolerance });
        }
        let trees: Vec<ElementTree> =
            elements.of_facet.iter().map(|facet| ElementTree::of(&elements.all, facet)).collect();
        let mut patches = elements.patches.clone();
        for (number, patch) in patches.iter_mut().enumerate() {
            patch.area = facets.placement.global_area(patch.area);
            patch.shape = elements.shape(number, facets.placement);
        }
        let touching = touching_facets(&facets, &elements.frames);
        // Where backs count, those of what stands there are seen.
        let shut = match options.sides {
            Sides::Fronts => {
                let (facets, elements, trees) = (&facets, &elements, &trees[..]);
                let looker = Looker { facets, elements, trees, shut: &Shut::default(), sides: options.sides };
                Shut::of(&Blockers { facets, elements, trees }, &looker, &touching)?
            }
            Sides::Both => Shut::default(),
        };
        Ok(Self { facets, elements, trees, touching, shut, options, patches })
    }

    /// The patches, in the order of their numbers: of polygons, theirs; of objects, that of the first polygons of each; of a mesh, by polygon, then
    /// by piece of the polygon, then as the mesh has them (grids along the first edge first).
    pub fn patches(&self) -> &[PatchInfo] {
        &self.patches
    }

    /// One row. Its cost is that of some views and of pairs with all that is seen.
    ///
    /// # Errors
    /// If there is no such patch, if a view has too many cells, or if the row does not close.
    pub fn row(&self, patch: usize) -> Result<Row, ExchangeError> {
        if patch >= self.patches.len() {
            return Err(ExchangeError::UnknownPatch { patch, count: self.patches.len() });
        }
        self.row_in(patch, &Shared::default(), &mut RowSpace::new(&self.elements))
    }

    /// Rows in their order, computed by the threads of the current `rayon` pool with the feature `parallel`, and handed over one by one, each as soon as
    /// all before it are there: a few hundred are in memory at a time. They do not depend on the number of threads. `take` is called by any of them.
    ///
    /// # Errors
    /// The first one that `take` gives, or as [`Exchange::row`], after all rows before that one were handed over.
    pub fn rows<E: From<ExchangeError> + Send>(
        &self,
        patches: Range<usize>,
        mut take: impl FnMut(Row) -> Result<(), E> + Send,
    ) -> Result<(), E> {
        self.timed_rows(patches, |row, _| take(row))
    }

    /// The same, with the time that a thread took for each row.
    ///
    /// # Errors
    /// As [`Exchange::rows`].
    pub fn timed_rows<E: From<ExchangeError> + Send>(
        &self,
        patches: Range<usize>,
        mut take: impl FnMut(Row, Duration) -> Result<(), E> + Send,
    ) -> Result<(), E> {
        if patches.end > self.patches.len() {
            return Err(ExchangeError::UnknownPatch { patch: patches.end - 1, count: self.patches.len() }.into());
        }
        let spaces: Mutex<Vec<RowSpace>> = Mutex::new(Vec::new());
        let free = || spaces.lock().unwrap_or_else(PoisonError::into_inner);
        for start in patches.clone().step_by(shared::BLOCK) {
            let block = start..patches.end.min(start + shared::BLOCK);
            let shared = Shared::of(&self.elements, block.clone());
            let compute = |patch: usize| {
                let start = Instant::now();
                let space = free().pop();
                let mut space = space.unwrap_or_else(|| RowSpace::new(&self.elements));
                let row = self.row_in(patch, &shared, &mut space);
                free().push(space);
                Ok((row?, start.elapsed()))
            };
            parallel::in_order(block, compute, |(row, took)| take(row, took))?;
        }
        Ok(())
    }

    /// Pairs of polygons that lie on each other face to face, as a floor and the bottom of a block do, where it is not clear whether either shuts the other one off: neither is part of a solid that is proved to be closed, and of what is before
    /// them some are backs and some are not. Bodies that are not closed are such, or that overlap. The floor sees what is before it, then, and the bottom what is below the floor. None if backs count. The cost is that of two views for each pair.
    ///
    /// # Errors
    /// If a view has too many cells.
    pub fn half_shut(&self) -> Result<Vec<[PolygonId; 2]>, ExchangeError> {
        if self.options.sides == Sides::Both {
            return Ok(Vec::new());
        }
        let alone = Shared::default();
        let ElementRows { blockers, looker, touching, .. } = self.element_rows(&alone);
        let pairs = half_shut(&blockers, &looker, touching)?;
        let polygons = |pair: [u32; 2]| on_each_other(&self.elements, pair.map(|facet| facet as usize));
        let mut found: Vec<[PolygonId; 2]> = pairs.into_iter().filter_map(polygons).collect();
        found.sort_unstable();
        found.dedup();
        Ok(found)
    }

    /// The first two polygons that show the same way and lie on each other, in one plane only within rounding, as the facades of an annex flush with the building that it reaches into do in a model that has been turned: which of them is seen is for rounding to say, from each point
    /// anew, so that rows which see them take long, and need not close. In one plane exactly, the lower number is seen.
    pub fn overlap(&self) -> Option<[PolygonId; 2]> {
        overlap(&self.facets, &self.elements, &self.shut)
    }

    /// `F[from][to]` once more, by points on the patch that it is from and to the tolerance: what rows have comes from closed forms, or from points on the smaller of the two, and
    /// is the same number from both. `None` if there is no way but views: if either patch has several flat convex parts, lies on another one, or has too much in front of
    /// it, and where backs count. The cost is that of an entry.
    ///
    /// # Errors
    /// If there are no such patches.
    pub fn by_points(&self, from: usize, to: usize) -> Result<Option<Share>, ExchangeError> {
        let count = self.patches.len();
        if let Some(patch) = [from, to].into_iter().find(|&patch| patch >= count) {
            return Err(ExchangeError::UnknownPatch { patch, count });
        }
        let [&[number], &[other]] = [from, to].map(|patch| &self.elements.of_patch[patch][..]) else {
            return Ok(None);
        };
        let effort = Effort { tolerance: self.options.tolerance, towards_sides: false, is_shared: false };
        let alone = Shared::default();
        let rows = self.element_rows(&alone);
        Ok(rows.by_points(number, other, effort, &mut RowSpace::new(&self.elements)))
    }

    pub(super) fn row_in(&self, patch: usize, shared: &Shared, space: &mut RowSpace) -> Result<Row, ExchangeError> {
        let mut failure = None;
        let explained = explained(self.options.tolerance);
        for (part, towards_sides) in ATTEMPTS {
            // Other rows are told only once.
            let is_shared = failure.is_none();
            let effort = Effort { tolerance: self.options.tolerance * part, towards_sides, is_shared };
            let mut row = self.raw_row(patch, effort, shared, space)?;
            if row.closure_raw == 0.0 {
                return Ok(row);
            }
            match place(&mut row, explained) {
                Ok(()) => {
                    row.entries.retain(|entry| entry.share.factor > 0.0);
                    return Ok(row);
                }
                Err(too_large) => failure = Some(too_large),
            }
        }
        let TooLarge { residue, estimates } = failure.unwrap_or(TooLarge { residue: 0.0, estimates: 0.0 });
        Err(ExchangeError::NotClosed { patch, residue, estimates, overlap: self.overlap() })
    }

    pub(super) fn element_rows<'a>(&'a self, shared: &'a Shared) -> ElementRows<'a> {
        let Self { facets, elements, trees, touching, shut, options, .. } = self;
        let blockers = Blockers { facets, elements, trees };
        let looker = Looker { facets, elements, trees, shut, sides: options.sides };
        ElementRows { blockers, touching, shared, looker, most_views: options.most_views }
    }

    /// The row before its residue is placed.
    fn raw_row(
        &self,
        patch: usize,
        effort: Effort,
        shared: &Shared,
        space: &mut RowSpace,
    ) -> Result<Row, ExchangeError> {
        let elements = &self.elements;
        let rows = self.element_rows(shared);
        let area = elements.patches[patch].area;
        let mut shares: Vec<(u32, Share)> = Vec::new();
        for &element in &elements.of_patch[patch] {
            let row = rows.row(element, effort, space)?;
            let Element { area: own, rounding, .. } = elements.all[element as usize];
            let weight = own / area;
            let weighted =
                |share: Share| Share { factor: weight * share.factor, error: weight * (share.error + rounding) };
            let seen = row.into_iter().filter(|&(_, share)| share != Share::default());
            shares.extend(seen.map(|(column, share)| (column, weighted(share))));
        }
        // Stable, so that sums do not depend on anything but the order of elements.
        shares.sort_by_key(|&(column, _)| column);
        let columns = Columns { patches: elements.patches.len() as u32 };
        let (mut backs, mut background) = (Share::default(), Share::default());
        let mut entries: Vec<Entry> = Vec::with_capacity(shares.len());
        for (column, share) in shares {
            let sum = if column == columns.backs() {
                &mut backs
            } else if column == columns.background() {
                &mut background
            } else {
                if entries.last().is_none_or(|entry| entry.column != column) {
                    entries.push(Entry { column, share: Share::default() });
                }
                let Some(entry) = entries.last_mut() else { continue };
                &mut entry.share
            };
            sum.factor += share.factor;
            sum.error += share.error;
        }
        let mut row = Row { patch: patch as u32, entries, backs, background, closure_raw: 0.0 };
        row.closure_raw = row.sum();
        Ok(row)
    }
}
