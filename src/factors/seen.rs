//! What is seen from one point of an element, by patches.

use super::contacts::{TOUCHES, take_out};
use super::element::Elements;
use super::facets::Facets;
use super::shape::{Frame, clip, sides, turn};
use super::shut::Shut;
use super::tree::ElementTree;
use super::{ExchangeError, Sides};
use crate::contour::{Cell, ContourImage, Domain, ViewOptions, ViewSpace, Viewpoint};
use crate::integral::Receiver;
use crate::scene::{PieceId, PolygonId, Side};
use glam::{DVec2, DVec3};

/// What is shut off sees no more of anything else than gaps left by rounding show.
pub(super) const SHUT: f64 = 1e-9;

/// Takes views and tells patches apart in them.
pub(super) struct Looker<'a> {
    pub(super) facets: &'a Facets,
    pub(super) elements: &'a Elements,
    pub(super) trees: &'a [ElementTree],
    pub(super) shut: &'a Shut,
    pub(super) sides: Sides,
}

/// Memory that is used again.
#[derive(Default)]
pub(super) struct LookSpace {
    view: ViewSpace,
    flat: Vec<DVec2>,
    parts: [Vec<DVec2>; 2],
    corners: Vec<DVec3>,
    stack: Vec<u32>,
    met: Vec<u32>,
}

/// What parts of what is seen from a point shut it off.
#[derive(Clone, Copy, Default)]
pub(super) struct Before {
    /// Backs, and fronts where they are face to face with others, not all of which are others'.
    shut: f64,
    /// Of that, backs of a solid.
    inside: f64,
    /// All else.
    open: f64,
}

impl Before {
    /// True if a back of the solid is seen, or if nothing is open.
    pub(super) fn is_shut(self) -> bool {
        self.inside > SHUT || self.open <= SHUT && self.shut > SHUT
    }

    /// True if some of what is seen would shut it off, and some would not.
    pub(super) fn is_mixed(self) -> bool {
        self.inside <= SHUT && self.open > SHUT && self.shut > SHUT
    }
}

/// Columns of a row that are not patches come after them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Columns {
    pub(super) patches: u32,
}

impl Columns {
    pub(super) fn backs(self) -> u32 {
        self.patches
    }

    pub(super) fn background(self) -> u32 {
        self.patches + 1
    }

    pub(super) fn count(self) -> usize {
        self.patches as usize + 2
    }
}

impl Looker<'_> {
    /// Looks from the point of a facet's front nearest to `point` and calls `share` with columns and what of the point's light they get, those of
    /// elements for which `is_wanted` is false left out.
    pub(super) fn look(
        &self,
        space: &mut LookSpace,
        facet: u32,
        point: DVec3,
        is_wanted: impl Fn(u32) -> bool,
        mut share: impl FnMut(u32, f64),
    ) -> Result<(), ExchangeError> {
        let LookSpace { view, flat, parts, corners, stack, met } = space;
        let (viewpoint, image) = self.view(view, facet, point)?;
        let receiver = Receiver::new(self.elements.frames[facet as usize].normal);
        let columns = Columns { patches: self.elements.patches.len() as u32 };
        for cell in image.cells() {
            let whole = |corners: &mut Vec<DVec3>| receiver.factor_of(cell.boundary(), corners);
            let (Some(seen), Some(side)) = (cell.polygon(), cell.side()) else {
                share(columns.background(), whole(corners));
                continue;
            };
            if side == Side::Back && self.sides == Sides::Fronts {
                share(columns.backs(), whole(corners));
                continue;
            }
            let target = seen.0;
            let of_facet = &self.elements.of_facet[target as usize];
            // What is seen from behind is never left out.
            let wanted = |element: u32| side == Side::Back || is_wanted(element);
            let patch = |element: u32| self.elements.all[element as usize].patch;
            let may_be_shut = side == Side::Front && self.shut.is_seen(facet, target);
            match of_facet[..] {
                [] => share(columns.background(), whole(corners)),
                [first, ref rest @ ..]
                    if !may_be_shut
                        && rest.iter().all(|&other| patch(other) == patch(first))
                        && of_facet.iter().all(|&k| wanted(k)) =>
                {
                    share(patch(first), whole(corners));
                }
                _ => {
                    let frame = &self.elements.frames[target as usize];
                    flatten(cell, viewpoint.eye(), frame, flat);
                    // As seen from outside of the sphere.
                    let factor = |part: &[DVec2], corners: &mut Vec<DVec3>| {
                        let towards = |&p: &DVec2| frame.lift(p) - viewpoint.eye();
                        if side == Side::Front {
                            receiver.factor_of(part.iter().rev().map(towards), corners)
                        } else {
                            receiver.factor_of(part.iter().map(towards), corners)
                        }
                    };
                    let mut divide = |flat: &[DVec2], whole: f64, corners: &mut Vec<DVec3>| {
                        let (low, high) =
                            flat.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
                        met.clear();
                        self.trees[target as usize].meeting(low, high, stack, |element| {
                            if wanted(element) {
                                met.push(element);
                            }
                        });
                        for &number in &*met {
                            let element = &self.elements.all[number as usize];
                            if flat.iter().all(|&p| element.holds(p)) {
                                share(element.patch, whole);
                                break;
                            }
                            let part = common(flat, &element.flat, parts);
                            if part.len() >= 3 {
                                share(element.patch, factor(part, corners));
                            }
                        }
                    };
                    let mut left = whole(corners);
                    if !may_be_shut {
                        divide(flat, left, corners);
                        continue;
                    }
                    for part in self.shut.open(target, frame, flat) {
                        let open = factor(&part, corners);
                        left -= open;
                        divide(&part, open, corners);
                    }
                    // What is shut is behind the back of what shuts it.
                    share(columns.backs(), left.max(0.0));
                }
            }
        }
        Ok(())
    }

    /// What shuts the point of a facet's front nearest to `point` off, and what does not. `touching` has for each facet those that it is face to face with.
    pub(super) fn before(
        &self,
        space: &mut LookSpace,
        facet: u32,
        point: DVec3,
        touching: &[Vec<u32>],
        solid: Option<u32>,
    ) -> Result<Before, ExchangeError> {
        let LookSpace { view, corners, flat, .. } = space;
        let (viewpoint, image) = self.view(view, facet, point)?;
        let receiver = Receiver::new(self.elements.frames[facet as usize].normal);
        let Before { mut shut, mut inside, mut open } = Before::default();
        for cell in image.cells() {
            let mut share = || receiver.factor_of(cell.boundary(), corners);
            match (cell.polygon(), cell.side()) {
                (Some(seen), Some(Side::Front)) => {
                    let touching = &touching[seen.index()];
                    // In one plane fronts win over the backs of what they stand on.
                    if touching.contains(&facet) {
                        shut += share();
                        continue;
                    }
                    flatten(cell, viewpoint.eye(), &self.elements.frames[seen.index()], flat);
                    if !self.cover(touching, seen.0, flat) {
                        open += share();
                    }
                }
                (Some(seen), _) => {
                    let share = share();
                    shut += share;
                    let of = self.facets.all[seen.index()].solid.map(|solid| solid.number);
                    if solid.is_some() && of == solid {
                        inside += share;
                    }
                }
                (None, _) => open += share(),
            }
        }
        Ok(Before { shut, inside, open })
    }

    /// True if facets that are face to face with another one cover all of a part of it together.
    fn cover(&self, facets: &[u32], other: u32, part: &[DVec2]) -> bool {
        let frame = &self.elements.frames[other as usize];
        let [low, high] = self.facets.all[other as usize].bounds;
        let mut left = vec![part.iter().map(|&p| frame.lift(p)).collect()];
        for &facet in facets {
            let ring: Vec<DVec2> = self.facets.all[facet as usize].ring.iter().rev().map(|&p| frame.flat(p)).collect();
            take_out(&mut left, frame, &ring, low.distance(high) * TOUCHES);
        }
        part.len() >= 3 && left.is_empty()
    }

    /// What is seen from the point of a facet's front nearest to `point`.
    fn view<'s>(
        &self,
        space: &'s mut ViewSpace,
        facet: u32,
        point: DVec3,
    ) -> Result<(Viewpoint, &'s ContourImage), ExchangeError> {
        let scene = self.facets.order.scene();
        let piece: PieceId =
            scene.polygon(PolygonId(facet)).pieces().next().map_or(PieceId(0), super::super::scene::PieceRef::id);
        let fails = |problem: String| ExchangeError::NoView { point, problem };
        let viewpoint =
            Viewpoint::on_piece(scene, piece, Side::Front, point).map_err(|error| fails(error.to_string()))?;
        let image = self.facets.order.view_in(space, &viewpoint, &Domain::Above, &ViewOptions::default());
        Ok((viewpoint, image.map_err(|error| fails(error.to_string()))?))
    }
}

/// A cell where it is in the plane of the facet that is seen in it, counter-clockwise seen from the front.
fn flatten(cell: Cell<'_>, eye: DVec3, frame: &Frame, flat: &mut Vec<DVec2>) {
    flat.clear();
    let height = frame.height(eye);
    flat.extend(cell.boundary().map(|d| frame.flat(eye - d * (height / frame.normal.dot(d)))));
    flat.retain(|p| p.is_finite());
    if height > 0.0 {
        flat.reverse();
    }
}

/// What two convex polygons have in common.
fn common<'a>(a: &[DVec2], b: &[DVec2], [part, cut]: &'a mut [Vec<DVec2>; 2]) -> &'a [DVec2] {
    part.clear();
    part.extend_from_slice(a);
    for [p, q] in sides(b) {
        clip(part, |r| turn(p, q, r), cut);
        std::mem::swap(part, cut);
        if part.len() < 3 {
            break;
        }
    }
    part
}
