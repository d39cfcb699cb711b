//! Memory that one view leaves for the next.

use super::super::CellId;
use super::super::image::ContourImage;
use super::super::polygon::PolygonArc;
use super::super::tree::{ContourTree, Workspace};
use super::by_boxes::WalkBuffers;
use crate::bsp::{FragmentId, Skeleton, Step};

/// Memory for views, used again from one to the next: have one for each thread, and pass it to
/// [`SceneBsp::view_in`](crate::bsp::SceneBsp::view_in) or [`SceneBvh::view_in`](crate::bvh::SceneBvh::view_in). It may be used for any scenes in turn.
///
/// It holds as much as the largest of its views took (some hundred bytes a cell, and eight bytes a vertex and edge of the scene) until it
/// is dropped. What is seen does not depend on it.
#[derive(Clone, Debug, Default)]
pub struct ViewSpace {
    image: Option<ContourImage>,
    buffers: Buffers,
    cells: CellBuffers,
}

/// What an image needs besides the tree: its cells by number, and the reverse.
#[derive(Clone, Debug, Default)]
pub(crate) struct CellBuffers {
    pub(crate) leaves: Vec<u32>,
    pub(crate) cell_of_leaf: Vec<Option<CellId>>,
}

/// What is needed until the view is done.
#[derive(Clone, Debug, Default)]
pub(in crate::contour) struct Buffers {
    pub(in crate::contour) work: Workspace,
    /// The great circles of lines of the scene, the directions of points, once they are needed.
    pub(super) circles: Numbers,
    pub(super) directions: Numbers,
    pub(in crate::contour) polygon: Vec<PolygonArc>,
    /// For the way by boxes.
    pub(super) walk: WalkBuffers,
    /// For the way by the 3D BSP.
    pub(super) steps: Vec<Step>,
    pub(super) fragments: Vec<FragmentId>,
}

impl ViewSpace {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Keeps the image until the next view.
    pub(super) fn keep(&mut self, image: ContourImage) -> &ContourImage {
        self.image.insert(image)
    }

    /// The tree of the last image, and all buffers, cleared.
    pub(super) fn take(&mut self, skeleton: &Skeleton) -> (Option<ContourTree>, Buffers) {
        let mut buffers = std::mem::take(&mut self.buffers);
        buffers.work.clear();
        buffers.walk.clear();
        buffers.circles.clear(skeleton.line_count());
        buffers.directions.clear(skeleton.point_count());
        let former = self.image.take().map(|image| {
            let (tree, cells) = image.into_memory();
            self.cells = cells;
            tree
        });
        (former, buffers)
    }

    /// Takes buffers back, for room for an image's cells.
    pub(super) fn give_back(&mut self, buffers: Buffers) -> CellBuffers {
        self.buffers = buffers;
        std::mem::take(&mut self.cells)
    }
}

/// Numbers given to some of many things.
#[derive(Clone, Debug, Default)]
pub(in crate::contour) struct Numbers {
    /// One more than the number, or 0: so that untouched memory costs nothing.
    of: Vec<u32>,
    used: Vec<u32>,
}

impl Numbers {
    /// Forgets all numbers, for that many things.
    fn clear(&mut self, count: usize) {
        for thing in self.used.drain(..) {
            self.of[thing as usize] = 0;
        }
        if self.of.is_empty() {
            self.of = vec![0; count];
        } else {
            self.of.resize(count, 0);
        }
    }

    /// The number of a thing, made if it has none.
    #[inline]
    pub(super) fn of(&mut self, thing: u32, make: impl FnOnce() -> u32) -> u32 {
        let place = &mut self.of[thing as usize];
        if *place == 0 {
            *place = make() + 1;
            self.used.push(thing);
        }
        *place - 1
    }
}
