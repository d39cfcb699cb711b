//! Front-to-back and back-to-front order from any point.

use super::{FragmentId, FragmentRef, Node, SceneBsp, Tree};
use crate::exact::Sign;
use crate::scene::Side;
use glam::DVec3;

impl SceneBsp {
    /// The fragments so that none is hidden, even in part, by a later one. Fragments whose plane
    /// holds the eye hide nothing and are left out.
    pub fn front_to_back(&self, eye: DVec3) -> FrontToBack<'_> {
        FrontToBack { walk: Walk::new(&self.tree, eye, Order::FrontToBack) }
    }

    /// The same in reverse.
    pub fn back_to_front(&self, eye: DVec3) -> BackToFront<'_> {
        BackToFront { walk: Walk::new(&self.tree, eye, Order::BackToFront) }
    }
}

/// Iterator made by [`SceneBsp::front_to_back`].
#[derive(Debug)]
pub struct FrontToBack<'a> {
    walk: Walk<'a>,
}

/// Iterator made by [`SceneBsp::back_to_front`].
#[derive(Debug)]
pub struct BackToFront<'a> {
    walk: Walk<'a>,
}

impl<'a> Iterator for FrontToBack<'a> {
    type Item = FragmentRef<'a>;

    fn next(&mut self) -> Option<FragmentRef<'a>> {
        self.walk.next()
    }
}

impl<'a> Iterator for BackToFront<'a> {
    type Item = FragmentRef<'a>;

    fn next(&mut self) -> Option<FragmentRef<'a>> {
        self.walk.next()
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Order {
    FrontToBack,
    BackToFront,
}

#[derive(Debug)]
struct Walk<'a> {
    tree: &'a Tree,
    eye: DVec3,
    order: Order,
    stack: Vec<Step>,
    /// The fragments of the current node, last one first.
    ready: Vec<FragmentId>,
}

/// What is left to do: a whole subtree, or the fragments of one node.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Step {
    Subtree(u32),
    Fragments(u32),
}

impl<'a> Walk<'a> {
    fn new(tree: &'a Tree, eye: DVec3, order: Order) -> Self {
        let stack = if tree.nodes.is_empty() { Vec::new() } else { vec![Step::Subtree(0)] };
        Self { tree, eye, order, stack, ready: Vec::new() }
    }

    fn next(&mut self) -> Option<FragmentRef<'a>> {
        loop {
            if let Some(id) = self.ready.pop() {
                return Some(FragmentRef::new(self.tree, id));
            }
            match self.stack.pop()? {
                Step::Subtree(node) => {
                    let [first, middle, last] = self.tree.steps(node, self.eye);
                    let order = match self.order {
                        Order::FrontToBack => [last, middle, first],
                        Order::BackToFront => [first, middle, last],
                    };
                    self.stack.extend(order.into_iter().flatten());
                }
                Step::Fragments(node) => {
                    let node = &self.tree.nodes[node as usize];
                    self.tree.nearest_first(node, self.eye, &mut self.ready);
                    if self.order == Order::FrontToBack {
                        self.ready.reverse();
                    }
                }
            }
        }
    }
}

impl Tree {
    /// What is to be done at a node, nearest first: the eye's side, the node's own fragments, the
    /// far side.
    pub(crate) fn steps(&self, node: u32, eye: DVec3) -> [Option<Step>; 3] {
        let Node { plane, back, front, fragments, .. } = &self.nodes[node as usize];
        let (near, far) = match self.skeleton.position_side(*plane, eye) {
            Sign::Negative => (back, front),
            Sign::Zero | Sign::Positive => (front, back),
        };
        let own = (!fragments.is_empty()).then_some(Step::Fragments(node));
        [near.map(Step::Subtree), own, far.map(Step::Subtree)]
    }

    /// The fragments of one node: those that show the eye their front first, then those that show
    /// their back, by ascending number; those whose own plane holds the eye are left out.
    pub(crate) fn nearest_first(&self, node: &Node, eye: DVec3, out: &mut Vec<FragmentId>) {
        let mut backs = Vec::new();
        for k in node.fragments.clone() {
            match self.skeleton.shown_side(self.scene.piece(self.fragments[k as usize].piece), eye) {
                None => {}
                Some(Side::Front) => out.push(FragmentId(k)),
                Some(Side::Back) => backs.push(FragmentId(k)),
            }
        }
        out.append(&mut backs);
    }
}
