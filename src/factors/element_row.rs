//! Where what leaves one element goes.

use super::ExchangeError;
use super::blockers::{Around, Blockers, Seen};
use super::contacts::parts;
use super::cubature::{Add, Cubature, Division, Scratch};
use super::element::{Element, Elements};
use super::partly::{Partly, PartlySpace};
use super::row::Share;
use super::seen::{Columns, LookSpace, Looker};
use super::shaft::Lies;
use super::shape::clip;
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
}

impl RowSpace {
    pub(super) fn new(elements: &Elements) -> Self {
        let columns = Columns { patches: elements.patches.len() as u32 }.count();
        let found = Found {
            seen: vec![Seen::Unknown; elements.all.len()],
            known: Vec::new(),
            between: vec![0..0; elements.all.len()],
            facets: Vec::new(),
        };
        Self {
            look: LookSpace::default(),
            scratch: Scratch::new(columns),
            hidden: PartlySpace::default(),
            around: None,
            parts: Vec::new(),
            found,
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
        let Self { found, shares, columns, .. } = self;
        found.known.drain(..).for_each(|element| found.seen[element as usize] = Seen::Unknown);
        found.facets.clear();
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
}

/// Computes rows of elements.
pub(super) struct ElementRows<'a> {
    pub(super) blockers: Blockers<'a>,
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
        let around = match space.around.take() {
            Some(around) if around.facet() == from.facet => around,
            _ => Around::of(from.facet, self.blockers.facets, &elements.frames[from.facet as usize]),
        };
        space.parts = parts(from, &elements.frames[from.facet as usize], around.contacts());
        space.around = Some(around);
        // What is placed of a residue comes on top, by as much at most.
        let allowed = tolerance * (0.5 - OF_TOLERANCE);
        let mut division = if effort.towards_sides { Division::TowardsSides } else { Division::None };
        self.classify(number, tolerance * OF_TOLERANCE, space);
        self.integrate_all(number, allowed, space);
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

    /// The facets whose fronts may be seen.
    fn in_front(&self, space: &RowSpace) -> Vec<u32> {
        let Some(around) = &space.around else { return Vec::new() };
        let is_in_front = |lies: Lies| matches!(lies, Lies::Front | Lies::Across);
        let facets = 0..self.blockers.facets.all.len() as u32;
        facets.filter(|&facet| is_in_front(around.lies(facet)) && is_in_front(around.facet_lies(facet))).collect()
    }

    /// Integrates all patches of which all that may hide parts of them is known.
    fn integrate_all(&self, number: u32, allowed: f64, space: &mut RowSpace) {
        let elements = self.blockers.elements;
        let partly = space.found.known.iter().filter(|&&element| space.found.seen[element as usize] == Seen::Partly);
        let mut columns: Vec<u32> = partly.map(|&element| elements.all[element as usize].patch).collect();
        columns.sort_unstable();
        columns.dedup();
        for column in columns {
            if self.is_known(column, space) {
                self.integrate(number, column, allowed, space);
            }
        }
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
            self.blockers.classify(around, from, facet, |element, seen, between| {
                let first = found.facets.len() as u32;
                found.facets.extend(between);
                found.between[element as usize] = first..found.facets.len() as u32;
                found.seen[element as usize] = seen;
                found.known.push(element);
            });
        }
        for k in 0..space.found.known.len() {
            let element = space.found.known[k];
            if space.found.seen[element as usize] == Seen::Wholly {
                let Share { factor, error } = self.exchange(number, element, tolerance, space);
                let share = Share { factor: factor / from.area, error: error / from.area };
                space.add(elements.all[element as usize].patch, share);
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
                Some(around) => around.lies(facet) != Lies::Front,
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
        let frame = &elements.frames[from.facet as usize];
        let RowSpace { hidden, around: Some(around), found, parts, .. } = &mut *space else { return };
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
            let blockers = found.facets[start as usize..end as usize]
                .iter()
                .map(|&facet| (&self.blockers.facets.all[facet as usize].ring[..], &elements.frames[facet as usize]));
            let partly = Partly {
                from,
                from_frame: frame,
                parts,
                to,
                to_frame: &elements.frames[to.facet as usize],
                has_horizon: [around.facet_lies(to.facet), around.lies(to.facet)].map(|lies| lies == Lies::Across),
                blockers: &blockers.collect::<Vec<_>>(),
            };
            let allowed = allowed / count as f64;
            let share = partly.integrate(allowed, self.most_views, hidden);
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
        let from_lies = lies(around.lies(to.facet), &from.ring, 1);
        let to_lies = lies(around.facet_lies(to.facet), &to.ring, 0);
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

/// True if what has a share is all there is, up to errors and what may be neglected.
fn is_complete(space: &RowSpace, tolerance: f64) -> bool {
    let (sum, error) = total(space.columns.iter().map(|&column| space.shares[column as usize]));
    (sum - 1.0).abs() <= error.min(tolerance)
}

/// The sums of factors and of errors.
fn total(shares: impl Iterator<Item = Share>) -> (f64, f64) {
    shares.fold((0.0, 0.0), |(sum, error), share| (sum + share.factor, error + share.error))
}
