//! Where what leaves one element goes.

use super::blockers::{Around, Blockers, Seen};
use super::cubature::{Add, Cubature, Division};
use super::element::Element;
use super::lies::Lies;
use super::pieces::pieces;
use super::row::Share;
use super::row_space::{Found, RowSpace};
use super::seen::Looker;
use super::shape::double_area;
use super::shared::{Shared, Told};
use super::touching::{Touch, strip};
use super::{ExchangeError, Sides};
use glam::DVec3;

/// The part of the tolerance that entries which take no views may use up.
const OF_TOLERANCE: f64 = 0.05;
/// Views are taken in no more parts than 4 to this power.
const MOST_HALVINGS: u32 = 3;

/// How well a row is to be computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// The absolute error allowed of each factor.
    pub(super) tolerance: f64,
    /// Whether views are taken at many points near the sides.
    pub(super) towards_sides: bool,
    /// Whether other rows are told, and tell.
    pub(super) is_shared: bool,
}

impl Effort {
    /// What is placed of a residue comes on top, by as much at most.
    pub(super) fn allowed(self) -> f64 {
        self.tolerance * (0.5 - OF_TOLERANCE)
    }
}

/// A residue that is not larger says no more of any factor than that its error is within half the tolerance: it is no reason to compute a row anew.
pub(super) fn explained(tolerance: f64) -> f64 {
    0.5 * tolerance
}

/// Computes rows of elements.
pub(super) struct ElementRows<'a> {
    pub(super) blockers: Blockers<'a>,
    /// The facets that each is face to face with.
    pub(super) touching: &'a [Vec<u32>],
    pub(super) shared: &'a Shared,
    pub(super) looker: Looker<'a>,
    pub(super) most_views: usize,
}

impl ElementRows<'_> {
    /// The shares of all columns that get any, ascending, with factors to this absolute tolerance.
    pub(super) fn row(
        &self,
        number: u32,
        effort: Effort,
        space: &mut RowSpace,
    ) -> Result<Vec<(u32, Share)>, ExchangeError> {
        let result = self.fill(number, effort, space);
        let shares = space.take();
        result.map(|()| shares)
    }

    fn fill(&self, number: u32, effort: Effort, space: &mut RowSpace) -> Result<(), ExchangeError> {
        let elements = self.blockers.elements;
        let tolerance = effort.tolerance;
        let from = &elements.all[number as usize];
        self.stand_on(from, space);
        if effort.is_shared {
            self.listen(number, space);
        }
        self.touch(number, space)?;
        let is_shut = self.looker.shut.is_whole(number);
        let is_covered = is_shut || space.parts.is_empty();
        if !is_covered {
            self.classify(number, tolerance * OF_TOLERANCE, space);
            self.integrate_all(number, effort, space);
        }
        // What is covered, but not shut for all, is for others to find out.
        if effort.is_shared && self.is_shareable(number) && (is_shut || !is_covered) {
            self.shared.complete(number, &space.told);
        }
        // In an order that does not depend on who has told what.
        space.columns.sort_unstable();
        space.columns.dedup();
        if is_covered || is_complete(space, tolerance) {
            return Ok(());
        }
        // What is left: backs, the background, and what too much may be in front of. Where few views miss something, more are taken.
        let mut division = effort.towards_sides.then_some(Division::TowardsSides);
        if effort.towards_sides && !space.cuts.is_empty() {
            self.cut_parts(from, space);
            division = None;
        }
        loop {
            let means = {
                let mut cubature = self.cubature(from, effort.allowed(), space);
                match division {
                    None => cubature.by_few()?,
                    Some(division) => cubature.adaptive(division, self.most_views)?,
                }
            };
            let is_rough = division.is_none() && means.parts.iter().any(|part| part.error > effort.allowed());
            let rest = means.parts.iter().map(|part| Share { factor: part.value.max(0.0), error: part.error });
            let known = space.columns.iter().map(|&column| space.shares[column as usize]);
            let (sum, error) = total(known.chain(rest.clone()));
            let is_off = (sum - 1.0).abs() > error.max(explained(tolerance));
            let Some(finer) = finer(division, effort).filter(|_| is_rough || is_off) else {
                let columns: Vec<u32> = means.parts.iter().map(|part| part.column).collect();
                columns.into_iter().zip(rest).for_each(|(column, share)| space.add(column, share));
                return Ok(());
            };
            division = Some(finer);
        }
    }

    /// Finds what all rows and pairs of an element start from.
    pub(super) fn stand_on(&self, from: &Element, space: &mut RowSpace) {
        if space.around.as_ref().is_none_or(|around| around.facet() != from.facet) {
            space.around = Some(Around::of(from.facet, self.blockers.facets));
        }
        space.parts = self.blockers.parts(from);
        space.cuts.clear();
    }

    /// Cuts the parts of an element where it was cut for what it sees partly.
    fn cut_parts(&self, from: &Element, space: &mut RowSpace) {
        let frame = &self.blockers.elements.frames[from.facet as usize];
        let cuts = std::mem::take(&mut space.cuts);
        space.parts = space.parts.iter().flat_map(|part| pieces(part, &cuts, frame, from.radius)).collect();
    }

    /// Takes what complete rows have told this one.
    fn listen(&self, number: u32, space: &mut RowSpace) {
        if !self.is_shareable(number) {
            return;
        }
        let elements = self.blockers.elements;
        for (other, told) in self.shared.told(number) {
            if told == Told::Unknown {
                continue;
            }
            space.complete.push(other);
            space.found.is_told[other as usize] = true;
            space.found.seen[other as usize] = Seen::Integrated;
            if let Told::Exchange(exchange) = told {
                space.add(elements.all[other as usize].patch, from_one(exchange, &elements.all[number as usize]));
            }
        }
    }

    /// Takes out what is face to face with others, which get what leaves it; where several are, the first of them does.
    fn touch(&self, number: u32, space: &mut RowSpace) -> Result<(), ExchangeError> {
        let elements = self.blockers.elements;
        let from = &elements.all[number as usize];
        let frame = &elements.frames[from.facet as usize];
        for touch in self.touching(number, &mut space.look)? {
            let Touch { other, exchange, .. } = touch;
            let before = area(&space.parts);
            touch.take_out(&mut space.parts, from, frame);
            let taken = before - area(&space.parts);
            let is_all = exchange.factor <= taken + strip(from);
            // The other row has all that it has in common with this one.
            let (exchange, told) = if is_all {
                (exchange, Told::Exchange(exchange))
            } else {
                (Share { factor: taken, ..exchange }, Told::Unknown)
            };
            if !std::mem::replace(&mut space.found.is_told[other as usize], true) {
                space.complete.push(other);
                space.found.seen[other as usize] = Seen::Integrated;
                space.told.push((other, told));
                space.add(elements.all[other as usize].patch, from_one(exchange, from));
            }
        }
        Ok(())
    }

    /// True if what the element exchanges with others of which that is true does not depend on which of them is asked: if it is all of a patch, and
    /// no view is needed to tell that it is seen.
    pub(super) fn is_shareable(&self, number: u32) -> bool {
        let elements = self.blockers.elements;
        let Element { patch, facet, .. } = elements.all[number as usize];
        self.looker.sides == Sides::Fronts
            && elements.of_patch[patch as usize].len() == 1
            && !self.blockers.facets.all[facet as usize].is_ranked
    }

    /// The facets whose fronts may be seen.
    fn in_front(&self, space: &RowSpace) -> Vec<u32> {
        let Some(around) = &space.around else { return Vec::new() };
        (0..self.blockers.facets.all.len() as u32).filter(|&facet| self.is_in_front(around, facet)).collect()
    }

    /// True if the front of a facet may be seen.
    pub(super) fn is_in_front(&self, around: &Around, facet: u32) -> bool {
        let facets = self.blockers.facets;
        let is_in_front = |lies: Lies| matches!(lies, Lies::Front | Lies::Across);
        is_in_front(around.lies(facets, facet)) && is_in_front(around.facet_lies(facets, facet))
    }

    /// Means of what views show that is not seen wholly or never.
    fn cubature<'s>(
        &'s self,
        from: &'s Element,
        allowed: f64,
        space: &'s mut RowSpace,
    ) -> Cubature<'s, impl FnMut(DVec3, Add<'_>) -> Result<(), ExchangeError>> {
        let RowSpace { look, scratch, found, parts, .. } = space;
        let takes_views = |element: u32| {
            matches!(found.seen[element as usize], Seen::Partly | Seen::Unknown) && !self.looker.shut.is_whole(element)
        };
        let look = move |point: DVec3, add: Add<'_>| self.looker.look(look, from.facet, point, takes_views, add);
        Cubature { parts, area: from.area, allowed, scratch, look }
    }

    /// Finds the elements that are seen wholly, which get their share, or never, and what may be between otherwise.
    fn classify(&self, number: u32, tolerance: f64, space: &mut RowSpace) {
        let elements = self.blockers.elements;
        let from = &elements.all[number as usize];
        space.hiders.clear();
        for facet in self.in_front(space) {
            let is_unknown = self.looker.shut.is_between(from.facet, facet);
            let RowSpace { around: Some(around), found, hiders, told, .. } = &mut *space else { return };
            let Found { seen: how, known, between: places, facets, is_told } = found;
            let is_told = |element: u32| is_told[element as usize] || self.looker.shut.is_whole(element);
            self.blockers.classify(around, from, facet, hiders, is_told, |element, seen, between| {
                let first = facets.len() as u32;
                facets.extend(between);
                places[element as usize] = first..facets.len() as u32;
                how[element as usize] = seen;
                if is_unknown && seen != Seen::Never {
                    how[element as usize] = Seen::Unknown;
                    told.push((element, Told::Unknown));
                }
                known.push(element);
            });
        }
        for k in 0..space.found.known.len() {
            let element = space.found.known[k];
            if space.found.seen[element as usize] == Seen::Wholly {
                let exchange = self.exchange(number, element, tolerance, space);
                space.told.push((element, Told::Exchange(exchange)));
                space.add(elements.all[element as usize].patch, from_one(exchange, from));
            }
        }
    }
}

/// The area of convex parts.
fn area(parts: &[Vec<DVec3>]) -> f64 {
    parts.iter().map(|part| 0.5 * double_area(part).length()).sum()
}

/// The share of what leaves an element that an exchange is.
pub(super) fn from_one(exchange: Share, from: &Element) -> Share {
    Share { factor: exchange.factor / from.area, error: exchange.error / from.area }
}

/// How an element is divided next, to find what has been missed.
fn finer(division: Option<Division>, effort: Effort) -> Option<Division> {
    match division {
        None => Some(Division::Alike(0)),
        Some(Division::Alike(halvings)) if halvings < MOST_HALVINGS => Some(Division::Alike(halvings + 1)),
        Some(Division::Alike(_)) if effort.towards_sides => Some(Division::TowardsSides),
        Some(_) => None,
    }
}

/// True if what has a share is all there is, up to errors and what may be neglected.
fn is_complete(space: &RowSpace, tolerance: f64) -> bool {
    let (sum, error) = total(space.columns.iter().map(|&column| space.shares[column as usize]));
    (sum - 1.0).abs() <= error.min(tolerance)
}

/// The sums of factors and of errors.
fn total(shares: impl Iterator<Item = Share>) -> (f64, f64) {
    shares.fold((0.0, 0.0), |(sum, error), share| (sum + share.factor, error + share.error))
}
