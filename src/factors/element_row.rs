//! Where what leaves one element goes.

use super::ExchangeError;
use super::blockers::{Around, Blockers, Seen};
use super::cubature::{Add, Cubature, Division, Scratch};
use super::element::{Element, Elements};
use super::partly::{Partly, PartlySpace};
use super::row::Share;
use super::seen::{Columns, LookSpace, Looker};
use super::shaft::Lies;
use super::shape::clip;
use super::shared::{Shared, Told};
use super::{Sides, contour, pair};
use glam::DVec3;
use std::ops::Range;

/// The part of the tolerance that entries which take no views may use up.
const OF_TOLERANCE: f64 = 0.05;
/// With more facets between than this, views are cheaper than cutting off shadows one by one.
const MOST_BETWEEN: usize = 64;
/// Views are taken in no more parts than 4 to this power.
const MOST_HALVINGS: u32 = 3;

/// Memory that is used again from row to row.
pub(super) struct RowSpace {
    look: LookSpace,
    scratch: Scratch,
    hidden: PartlySpace,
    around: Option<Around>,
    /// The element in parts within which what is seen changes steadily.
    parts: Vec<Vec<DVec3>>,
    found: Found,
    /// What other rows have told this one, or may yet be told by it.
    complete: Vec<u32>,
    told: Vec<Told>,
    /// What each column gets.
    shares: Vec<Share>,
    columns: Vec<u32>,
}

/// How each element is seen from the one at hand.
struct Found {
    seen: Vec<Seen>,
    known: Vec<u32>,
    /// Where the facets that may be between are in a list.
    between: Vec<Range<u32>>,
    facets: Vec<u32>,
    /// Those of which another row has told.
    is_told: Vec<bool>,
}

impl RowSpace {
    pub(super) fn new(elements: &Elements) -> Self {
        let columns = Columns { patches: elements.patches.len() as u32 }.count();
        let found = Found {
            seen: vec![Seen::Unknown; elements.all.len()],
            known: Vec::new(),
            between: vec![0..0; elements.all.len()],
            facets: Vec::new(),
            is_told: vec![false; elements.all.len()],
        };
        Self {
            look: LookSpace::default(),
            scratch: Scratch::new(columns),
            hidden: PartlySpace::default(),
            around: None,
            parts: Vec::new(),
            found,
            complete: Vec::new(),
            told: Vec::new(),
            shares: vec![Share::default(); columns],
            columns: Vec::new(),
        }
    }

    fn add(&mut self, column: u32, share: Share) {
        let sum = &mut self.shares[column as usize];
        if *sum == Share::default() {
            self.columns.push(column);
        }
        sum.factor += share.factor;
        sum.error += share.error;
    }

    /// Ends a row: what its columns have got, ascending.
    fn take(&mut self) -> Vec<(u32, Share)> {
        let Self { found, complete, told, shares, columns, .. } = self;
        found.known.drain(..).for_each(|element| found.seen[element as usize] = Seen::Unknown);
        complete.drain(..).for_each(|element| {
            found.seen[element as usize] = Seen::Unknown;
            found.is_told[element as usize] = false;
        });
        found.facets.clear();
        told.clear();
        columns.sort_unstable();
        columns.dedup();
        columns.drain(..).map(|column| (column, std::mem::take(&mut shares[column as usize]))).collect()
    }
}

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
    fn allowed(self) -> f64 {
        self.tolerance * (0.5 - OF_TOLERANCE)
    }
}

/// Computes rows of elements.
pub(super) struct ElementRows<'a> {
    pub(super) blockers: Blockers<'a>,
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
        if space.around.as_ref().is_none_or(|around| around.facet() != from.facet) {
            space.around = Some(Around::of(from.facet, self.blockers.facets));
        }
        space.parts = self.blockers.parts(from);
        let allowed = effort.allowed();
        let mut division = if effort.towards_sides { Division::TowardsSides } else { Division::None };
        if effort.is_shared {
            self.listen(number, space);
        }
        self.classify(number, tolerance * OF_TOLERANCE, space);
        self.integrate_all(number, effort, space);
        if effort.is_shared && self.is_shareable(number) {
            self.shared.complete(number, &space.told);
        }
        // In an order that does not depend on who has told what.
        space.columns.sort_unstable();
        space.columns.dedup();
        if is_complete(space, tolerance) {
            return Ok(());
        }
        // What is left: backs, the background, and what too much may be in front of.
        loop {
            let mut means = self.cubature(from, allowed, space).fixed(division)?;
            if means.parts.iter().any(|part| part.error > allowed) {
                means = self.cubature(from, allowed, space).adaptive(self.most_views)?;
            }
            let rest = means.parts.iter().map(|part| Share { factor: part.value.max(0.0), error: part.error });
            let known = space.columns.iter().map(|&column| space.shares[column as usize]);
            let (sum, error) = total(known.chain(rest.clone()));
            let next = match division {
                Division::None => Some(Division::Alike(0)),
                Division::Alike(halvings) if halvings < MOST_HALVINGS => Some(Division::Alike(halvings + 1)),
                Division::Alike(_) | Division::TowardsSides => None,
            };
            let Some(finer) = next.filter(|_| (sum - 1.0).abs() > error) else {
                let columns: Vec<u32> = means.parts.iter().map(|part| part.column).collect();
                columns.into_iter().zip(rest).for_each(|(column, share)| space.add(column, share));
                return Ok(());
            };
            // Few views have missed something.
            division = finer;
        }
    }

    /// Takes what complete rows have told this one.
    fn listen(&self, number: u32, space: &mut RowSpace) {
        if !self.is_shareable(number) {
            return;
        }
        let elements = self.blockers.elements;
        let told = self.shared.begin(number, &mut space.complete);
        space.complete.retain(|&other| self.is_shareable(other));
        for &other in &space.complete {
            space.found.is_told[other as usize] = true;
            space.found.seen[other as usize] = Seen::Integrated;
        }
        for told in told {
            let other = told.element as usize;
            if let Some(exchange) = told.exchange() {
                space.add(elements.all[other].patch, from_one(exchange, &elements.all[number as usize]));
            } else {
                space.found.is_told[other] = false;
                space.found.seen[other] = Seen::Unknown;
            }
        }
    }

    /// True if what the element exchanges with others of which that is true does not depend on which of them is asked: if it is all of a patch, and
    /// no view is needed to tell that it is seen.
    fn is_shareable(&self, number: u32) -> bool {
        let elements = self.blockers.elements;
        let Element { patch, facet, .. } = elements.all[number as usize];
        self.looker.sides == Sides::Fronts
            && elements.of_patch[patch as usize].len() == 1
            && !self.blockers.facets.all[facet as usize].is_covered
    }

    /// The facets whose fronts may be seen.
    fn in_front(&self, space: &RowSpace) -> Vec<u32> {
        let Some(around) = &space.around else { return Vec::new() };
        let is_in_front = |lies: Lies| matches!(lies, Lies::Front | Lies::Across);
        let facets = self.blockers.facets;
        let all = 0..facets.all.len() as u32;
        let may_be_seen =
            |&facet: &u32| is_in_front(around.lies(facets, facet)) && is_in_front(around.facet_lies(facets, facet));
        all.filter(may_be_seen).collect()
    }

    /// Integrates all patches of which all that may hide parts of them is known.
    fn integrate_all(&self, number: u32, effort: Effort, space: &mut RowSpace) {
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
    ///
    /// It is integrated over the smaller one. The larger one would take fewer points, but a small patch that is seen from a small part of a large one may be
    /// missed by all of them.
    fn exchange_partly(&self, number: u32, other: u32, effort: Effort, space: &mut RowSpace) {
        let elements = self.blockers.elements;
        let [own, its] = [number, other].map(|k| &elements.all[k as usize]);
        let Range { start, end } = space.found.between[other as usize].clone();
        let between = &space.found.facets[start as usize..end as usize];
        if between.len() > MOST_BETWEEN {
            space.told.push(Told::of(other, None));
            return;
        }
        let is_own = (own.area, number) < (its.area, other);
        let (from, to) = if is_own { (own, its) } else { (its, own) };
        let its_parts = if is_own { Vec::new() } else { self.blockers.parts(its) };
        let parts = if is_own { &space.parts } else { &its_parts };
        let share = self.partly(from, parts, to, between, effort.allowed(), &mut space.hidden);
        let exchange = Share { factor: from.area * share.factor.max(0.0), error: from.area * share.error };
        space.told.push(Told::of(other, Some(exchange)));
        space.found.seen[other as usize] = Seen::Integrated;
        space.add(its.patch, from_one(exchange, own));
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

    /// Means of what views show that is not seen wholly or never.
    fn cubature<'s>(
        &'s self,
        from: &'s Element,
        allowed: f64,
        space: &'s mut RowSpace,
    ) -> Cubature<'s, impl FnMut(DVec3, Add<'_>) -> Result<(), ExchangeError>> {
        let RowSpace { look, scratch, found, parts, .. } = space;
        let takes_views = |element: u32| matches!(found.seen[element as usize], Seen::Partly | Seen::Unknown);
        let look = move |point: DVec3, add: Add<'_>| self.looker.look(look, from.facet, point, takes_views, add);
        Cubature { parts, area: from.area, allowed, scratch, look }
    }

    /// Finds the elements that are seen wholly, which get their share, or never, and what may be between otherwise.
    fn classify(&self, number: u32, tolerance: f64, space: &mut RowSpace) {
        let elements = self.blockers.elements;
        let from = &elements.all[number as usize];
        for facet in self.in_front(space) {
            let RowSpace { around: Some(around), found, .. } = &mut *space else { return };
            let Found { seen: how, known, between: places, facets, is_told } = found;
            let is_told = |element: u32| is_told[element as usize];
            self.blockers.classify(around, from, facet, is_told, |element, seen, between| {
                let first = facets.len() as u32;
                facets.extend(between);
                places[element as usize] = first..facets.len() as u32;
                how[element as usize] = seen;
                known.push(element);
            });
        }
        for k in 0..space.found.known.len() {
            let element = space.found.known[k];
            if space.found.seen[element as usize] == Seen::Wholly {
                let exchange = self.exchange(number, element, tolerance, space);
                space.told.push(Told::of(element, Some(exchange)));
                space.add(elements.all[element as usize].patch, from_one(exchange, from));
            }
        }
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

    /// Adds the share of a patch, all that may hide parts of which is known, as far as it is not seen wholly. Views leave it out from now on.
    fn integrate(&self, number: u32, column: u32, allowed: f64, space: &mut RowSpace) {
        let elements = self.blockers.elements;
        let from = &elements.all[number as usize];
        let RowSpace { hidden, found, parts, .. } = &mut *space;
        let partly: Vec<u32> = elements.of_patch[column as usize]
            .iter()
            .copied()
            .filter(|&element| found.seen[element as usize] == Seen::Partly)
            .collect();
        let count = partly.len();
        let mut sum = Share::default();
        for &element in &partly {
            let to = &elements.all[element as usize];
            let Range { start, end } = found.between[element as usize];
            let between = &found.facets[start as usize..end as usize];
            let share = self.partly(from, parts, to, between, allowed / count as f64, hidden);
            found.seen[element as usize] = Seen::Integrated;
            sum.factor += share.factor.max(0.0);
            sum.error += share.error;
        }
        space.add(column, sum);
    }

    /// `A_i` `F_ij` of an element that is seen wholly, from wherever its front is.
    fn exchange(&self, number: u32, other: u32, tolerance: f64, space: &RowSpace) -> Share {
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

/// The share of what leaves an element that an exchange is.
fn from_one(exchange: Share, from: &Element) -> Share {
    Share { factor: exchange.factor / from.area, error: exchange.error / from.area }
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
