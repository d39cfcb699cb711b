//! Convex faces that tile the sphere, each with what is seen in it: the cells of an image, or parts of them.

use crate::bsp::Skeleton;
use crate::contour::directions::{CircleId, Directions};
use crate::contour::image::{CellId, ContourImage};
use crate::contour::polygon::{Knife, PolygonArc, Sides, Span};
use crate::exact::Sign;
use crate::scene::{PolygonId, Side};
use glam::DVec3;
use std::borrow::Cow;

/// What is seen somewhere in the domain: a side of a polygon, or background.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Label {
    pub(crate) polygon: Option<PolygonId>,
    pub(crate) side: Option<Side>,
}

/// Where a face lies as to the seam of a panorama: half a great circle behind the eye, from pole to pole. Faces that touch it
/// lie on one side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Part {
    /// Away from it, or there is none.
    #[default]
    Front,
    /// On the side that is the picture's left end.
    Left,
    /// On the side that is the picture's right end.
    Right,
}

/// A convex face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    /// What is seen; `None` outside of the domain.
    pub(crate) label: Option<Label>,
    /// The cell that it is, or is part of.
    pub(crate) cell: Option<CellId>,
    pub(crate) part: Part,
    boundary: Span,
}

impl Face {
    /// True if the two, which are neighbours, belong to one region.
    pub(super) fn joins(&self, other: &Self) -> bool {
        self.label == other.label && (self.label.is_none() || !self.meets_at_seam(other))
    }

    pub(super) fn meets_at_seam(&self, other: &Self) -> bool {
        self.part != other.part && self.part != Part::Front && other.part != Part::Front
    }
}

/// Faces that tile the sphere.
pub(crate) struct Mosaic<'a> {
    pub(crate) skeleton: &'a Skeleton,
    /// Those of the image, or, once something was cut, a copy with more of them.
    pub(crate) directions: Cow<'a, Directions>,
    pub(crate) faces: Vec<Face>,
    arcs: Vec<PolygonArc>,
    pub(crate) knife: Knife,
}

impl<'a> Mosaic<'a> {
    /// The cells of an image, and what is outside of its domain.
    pub(crate) fn new(image: &'a ContourImage) -> Self {
        let mut faces = Vec::with_capacity(image.tree.leaves.len());
        let mut arcs = Vec::new();
        for leaf in 0..image.tree.leaves.len() as u32 {
            let cell = image.cell_of_leaf[leaf as usize];
            let label = cell.map(|id| {
                let cell = image.cell(id);
                Label { polygon: cell.polygon(), side: cell.side() }
            });
            let boundary = Span::keep(image.tree.boundary(leaf), &mut arcs);
            faces.push(Face { label, cell, part: Part::Front, boundary });
        }
        let skeleton = image.skeleton();
        Self { skeleton, directions: Cow::Borrowed(&image.tree.directions), faces, arcs, knife: Knife::default() }
    }

    /// Polygons that need not tile the sphere, with nothing said of what is seen in them.
    pub(crate) fn of_polygons(
        skeleton: &'a Skeleton,
        directions: Directions,
        arcs: Vec<PolygonArc>,
        polygons: &[Span],
    ) -> Self {
        let face = |&boundary: &Span| Face { label: None, cell: None, part: Part::Front, boundary };
        let faces = polygons.iter().map(face).collect();
        Self { skeleton, directions: Cow::Owned(directions), faces, arcs, knife: Knife::default() }
    }

    /// The sides of a face, counter-clockwise seen from outside of the sphere.
    pub(crate) fn boundary(&self, face: &Face) -> &[PolygonArc] {
        &self.arcs[face.boundary.range()]
    }

    /// Takes in the great circle that is perpendicular to `normal`, as it is.
    pub(crate) fn push_circle(&mut self, normal: DVec3) -> CircleId {
        self.directions.to_mut().push_given(self.skeleton, normal, &mut self.knife.cache)
    }

    /// Cuts faces at a great circle, exactly; `mark` is told on which side each of the selected ones, or each part of
    /// them, lies.
    pub(crate) fn cut(&mut self, circle: CircleId, selected: impl Fn(&Face) -> bool, mark: impl Fn(&mut Face, Sign)) {
        for k in 0..self.faces.len() {
            let face = self.faces[k];
            if !selected(&face) {
                continue;
            }
            match self.knife.classify(self.skeleton, &self.directions, &self.arcs[face.boundary.range()], circle) {
                Sides { negative: false, .. } => mark(&mut self.faces[k], Sign::Positive),
                Sides { positive: false, .. } => mark(&mut self.faces[k], Sign::Negative),
                Sides { .. } => {
                    let directions = self.directions.to_mut();
                    let none = |_: &mut _, _: &mut _, _| None;
                    let parts = self.knife.cut(self.skeleton, directions, &mut self.arcs, face.boundary, circle, none);
                    let [mut below, mut above] = parts.map(|boundary| Face { boundary, ..face });
                    mark(&mut below, Sign::Negative);
                    mark(&mut above, Sign::Positive);
                    self.faces[k] = below;
                    self.faces.push(above);
                }
            }
        }
    }
}
