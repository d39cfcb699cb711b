//! What an element exchanges with those that it sees wholly, or partly with all known that is between.

use super::blockers::{Blockers, Hiders, Seen};
use super::element::Element;
use super::element_row::{Effort, ElementRows, from_one};
use super::lies::Lies;
use super::partly::{Partly, PartlySpace};
use super::row::Share;
use super::row_space::{Found, RowSpace};
use super::seen::LookSpace;
use super::shape::clip;
use super::shared::Told;
use super::{Sides, contour, pair};
use glam::DVec3;
use std::ops::Range;

/// With more facets between than this views are taken.
const MOST_BETWEEN: usize = 4096;

impl ElementRows<'_> {
    /// Integrates all patches of which all that may hide parts of them is known.
    pub(super) fn integrate_all(&self, number: u32, effort: Effort, space: &mut RowSpace) {
        let elements = self.blockers.elements;
        let partly = space.found.known.iter().filter(|&&element| space.found.seen[element as usize] == Seen::Partly);
        let mut columns: Vec<u32> = partly.map(|&element| elements.all[element as usize].patch).collect();
        columns.sort_unstable();
        columns.dedup();
        let is_shareable = self.is_shareable(number);
        for column in columns {
            match elements.of_patch[column as usize][..] {
                [other] if is_shareable && self.is_shareable(other) => {
                    self.exchange_partly(number, other, effort, space);
                }
                _ if self.is_known(column, space) => self.integrate(number, column, effort.allowed(), space),
                _ => {}
            }
        }
    }

    /// What is exchanged with an element that is partly seen, as either of the two would find.
    fn exchange_partly(&self, number: u32, other: u32, effort: Effort, space: &mut RowSpace) {
        let Range { start, end } = space.found.between[other as usize];
        if (end - start) as usize > MOST_BETWEEN {
            space.told.push((other, Told::Unknown));
            return;
        }
        let exchange = self.over_the_smaller(number, other, effort.allowed(), space);
        let [own, its] = [number, other].map(|k| &self.blockers.elements.all[k as usize]);
        space.told.push((other, Told::Exchange(exchange)));
        space.add(its.patch, from_one(exchange, own));
    }

    /// `A_i` `F_ij` of an element that is partly seen, by points on the smaller one of the two, whose factor may be off by what is allowed. Views leave it out from now on.
    ///
    /// The larger one would take fewer points, but a small element that is seen from a small part of a large one may be missed by all of them.
    fn over_the_smaller(&self, number: u32, other: u32, allowed: f64, space: &mut RowSpace) -> Share {
        let [own, its] = [number, other].map(|k| &self.blockers.elements.all[k as usize]);
        let RowSpace { found, parts, hidden, cuts, look, .. } = space;
        let Range { start, end } = found.between[other as usize];
        let between = &found.facets[start as usize..end as usize];
        found.seen[other as usize] = Seen::Integrated;
        let (smaller, share) = if (own.area, number) < (its.area, other) {
            let share = self.partly(own, parts, its, between, allowed, hidden);
            cuts.append(&mut hidden.cuts);
            (own, share)
        } else {
            (its, self.partly(its, &self.open_parts(other, look), own, between, allowed, hidden))
        };
        Share { factor: smaller.area * share.factor.max(0.0), error: smaller.area * share.error }
    }

    /// The parts of an element without what is face to face with others. (Its own row tells if a view for that fails.)
    fn open_parts(&self, number: u32, look: &mut LookSpace) -> Vec<Vec<DVec3>> {
        let element = &self.blockers.elements.all[number as usize];
        let mut parts = self.blockers.parts(element);
        if !self.touching[element.facet as usize].is_empty() {
            let frame = &self.blockers.elements.frames[element.facet as usize];
            for touch in self.touching(number, look).unwrap_or_default() {
                touch.take_out(&mut parts, element, frame);
            }
        }
        parts
    }

    /// The form factor to another element by points on this one, whatever their sizes and however well it is seen: for a check of what rows have. `None` if views
    /// are needed for it.
    pub(super) fn by_points(&self, number: u32, other: u32, effort: Effort, space: &mut RowSpace) -> Option<Share> {
        if !self.is_shareable(number) || !self.is_shareable(other) {
            return None;
        }
        let elements = self.blockers.elements;
        let [from, to] = [number, other].map(|k| &elements.all[k as usize]);
        if self.looker.shut.is_between(from.facet, to.facet) {
            return None;
        }
        let touches = self.touching(number, &mut space.look).ok()?;
        if let Some(touch) = touches.iter().find(|touch| touch.other == other) {
            return Some(from_one(touch.exchange, from));
        }
        if [number, other].into_iter().any(|element| self.looker.shut.is_whole(element)) {
            return Some(Share::default());
        }
        self.stand_on(from, space);
        space.parts = self.open_parts(number, &mut space.look);
        let RowSpace { around: Some(around), parts, hidden, .. } = space else { return None };
        let mut found = None;
        if self.is_in_front(around, to.facet) {
            self.blockers.classify(
                around,
                from,
                to.facet,
                &mut Hiders::default(),
                |element| element != other,
                |_, seen, between| {
                    found = Some((seen, between.collect::<Vec<u32>>()));
                },
            );
        }
        match found {
            None | Some((Seen::Never, _)) => Some(Share::default()),
            Some((Seen::Wholly | Seen::Partly, between)) if between.len() <= MOST_BETWEEN => {
                Some(self.partly(from, parts, to, &between, effort.allowed(), hidden))
            }
            Some(_) => None,
        }
    }

    /// The form factor from an element to what it sees of another one, with these facets between.
    fn partly(
        &self,
        from: &Element,
        parts: &[Vec<DVec3>],
        to: &Element,
        between: &[u32],
        allowed: f64,
        space: &mut PartlySpace,
    ) -> Share {
        let Blockers { facets, elements, .. } = self.blockers;
        let partly = Partly { facets, elements, from, parts, to, between };
        partly.integrate(allowed, self.most_views, space)
    }

    /// True if all that may hide parts of a patch is known, and it is seen from its front only.
    fn is_known(&self, column: u32, space: &RowSpace) -> bool {
        let elements = self.blockers.elements;
        let Some(patch) = elements.of_patch.get(column as usize) else { return false };
        patch.iter().all(|&element| {
            let Found { seen, between, .. } = &space.found;
            let facet = elements.all[element as usize].facet;
            let from_behind = || match &space.around {
                Some(around) => around.lies(self.blockers.facets, facet) != Lies::Front,
                None => true,
            };
            seen[element as usize] != Seen::Unknown
                && between[element as usize].len() <= MOST_BETWEEN
                && (self.looker.sides == Sides::Fronts || !from_behind())
        })
    }

    /// Adds the share of a patch, all that may hide parts of which is known, as far as it is not seen wholly.
    fn integrate(&self, number: u32, column: u32, allowed: f64, space: &mut RowSpace) {
        let elements = self.blockers.elements;
        let is_partly = |element: &&u32| space.found.seen[**element as usize] == Seen::Partly;
        let partly: Vec<u32> = elements.of_patch[column as usize].iter().filter(is_partly).copied().collect();
        let mut sum = Share::default();
        for &element in &partly {
            let exchange = self.over_the_smaller(number, element, allowed / partly.len() as f64, space);
            sum.factor += exchange.factor;
            sum.error += exchange.error;
        }
        space.add(column, from_one(sum, &elements.all[number as usize]));
    }

    /// `A_i` `F_ij` of an element that is seen wholly, from wherever its front is.
    pub(super) fn exchange(&self, number: u32, other: u32, tolerance: f64, space: &RowSpace) -> Share {
        let elements = self.blockers.elements;
        let [from, to] = [number, other].map(|k| &elements.all[k as usize]);
        let Some(around) = space.around.as_ref() else { return Share::default() };
        let planes = [from.facet, to.facet].map(|facet| &elements.frames[facet as usize]);
        let spanning = [from.facet, to.facet].map(|facet| self.blockers.facets.all[facet as usize].spanning);
        let lies = |whole: Lies, ring: &[_], plane: usize| match whole {
            Lies::Across => Lies::of(ring, spanning[plane]),
            whole => whole,
        };
        let facets = self.blockers.facets;
        let from_lies = lies(around.lies(facets, to.facet), &from.ring, 1);
        let to_lies = lies(around.facet_lies(facets, to.facet), &to.ring, 0);
        match (from_lies, to_lies) {
            (Lies::Front, Lies::Front) => {
                let own = (from, planes[0].normal);
                let its = (to, planes[1].normal);
                if number < other { pair::exchange(own, its, tolerance) } else { pair::exchange(its, own, tolerance) }
            }
            (Lies::Front | Lies::Across, Lies::Front | Lies::Across) => {
                let (mut own, mut its) = (Vec::new(), Vec::new());
                clip(&from.ring, |p| planes[1].height(p), &mut own);
                clip(&to.ring, |p| planes[0].height(p), &mut its);
                let allowed = tolerance * from.area.min(to.area);
                let [first, second] = if number < other { [&own, &its] } else { [&its, &own] };
                if own.len() < 3 || its.len() < 3 {
                    Share::default()
                } else {
                    contour::exchange(first, second, allowed)
                }
            }
            _ => Share::default(),
        }
    }
}
