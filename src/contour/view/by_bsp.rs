//! The report's way: fragments from the 3D BSP, exactly front to back. What is filled is final.

use super::super::domain::Domain;
use super::super::image::ContourImage;
use super::super::tree::{Filler, Verdict};
use super::super::viewpoint::Viewpoint;
use super::space::Buffers;
use super::{Sight, ViewError, ViewOptions, ViewSpace};
use crate::bsp::{FragmentId, SceneBsp, Step, Tree, bounds_of};
use crate::exact::SeenBox;

impl SceneBsp {
    /// The contour image from a viewpoint.
    ///
    /// # Errors
    /// If the eye or a normal is not finite or zero, or if the domain does not suit the viewpoint.
    pub fn view(&self, viewpoint: &Viewpoint, domain: &Domain) -> Result<ContourImage, ViewError> {
        self.view_with(viewpoint, domain, &ViewOptions::default())
    }

    /// The same with options.
    ///
    /// # Errors
    /// As [`SceneBsp::view`]; also if the quadtree is to have too many levels, or if there are too many
    /// cells.
    pub fn view_with(
        &self,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
    ) -> Result<ContourImage, ViewError> {
        self.make_view(viewpoint, domain, options, &mut ViewSpace::new())
    }

    /// The same in memory that was used for views before, which saves asking for it: the image lasts until the next one.
    ///
    /// # Errors
    /// As [`SceneBsp::view_with`].
    pub fn view_in<'s>(
        &self,
        space: &'s mut ViewSpace,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
    ) -> Result<&'s ContourImage, ViewError> {
        let image = self.make_view(viewpoint, domain, options, space)?;
        Ok(space.keep(image))
    }

    fn make_view(
        &self,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
        space: &mut ViewSpace,
    ) -> Result<ContourImage, ViewError> {
        let tree = &*self.tree;
        let mut sight = Sight::new(&tree.scene, &tree.skeleton, viewpoint, domain, options, space)?;
        walk(&mut sight, tree, options.max_cells)?;
        Ok(sight.finish(self.clone().into(), viewpoint, domain, space))
    }
}

fn walk(sight: &mut Sight<'_>, tree: &Tree, max_cells: usize) -> Result<(), ViewError> {
    let Buffers { steps, fragments, .. } = &mut sight.buffers;
    let (mut stack, mut fragments) = (std::mem::take(steps), std::mem::take(fragments));
    stack.clear();
    if !tree.nodes.is_empty() {
        stack.push(Step::Subtree(0));
    }
    while let Some(step) = stack.pop() {
        sight.check_size(max_cells)?;
        // Leaves are open or final.
        if sight.contour.far() == 0.0 {
            break;
        }
        match step {
            Step::Subtree(node) => {
                let bounds = &tree.nodes[node as usize].bounds;
                let seen = SeenBox::new(sight.eye, bounds.low, bounds.high);
                if sight.contour.hides(sight.contour.root, &seen, 0.0, &mut sight.buffers.work) {
                    sight.stats.skipped_subtrees += 1;
                } else {
                    stack.extend(tree.steps(node, sight.eye).into_iter().rev().flatten());
                }
            }
            Step::Fragments(node) => {
                fragments.clear();
                tree.nearest_first(&tree.nodes[node as usize], sight.eye, &mut fragments);
                for &id in &fragments {
                    insert(sight, tree, id);
                }
            }
        }
    }
    sight.buffers.steps = stack;
    sight.buffers.fragments = fragments;
    sight.check_size(max_cells)
}

fn insert(sight: &mut Sight<'_>, tree: &Tree, id: FragmentId) {
    let fragment = tree.fragments[id.index()];
    let piece = tree.scene.piece(fragment.piece);
    let Some(shown) = tree.skeleton.shown_side(piece, sight.eye) else { return };
    let sides = &tree.sides[fragment.range()];
    sight.look_at(piece, sides, shown);
    sight.stats.inserted += 1;
    let bounds = bounds_of(&tree.skeleton, sides);
    let seen = SeenBox::new(sight.eye, bounds.low, bounds.high);
    let filler = Filler { piece: fragment.piece, near: 0.0, far: 0.0, plane: None };
    let Sight { contour, buffers: Buffers { work, polygon, .. }, .. } = sight;
    contour.insert(&tree.skeleton, contour.root, polygon, &seen, &filler, |_, _, _, _| Verdict::Behind, work);
}
