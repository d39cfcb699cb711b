//! Where what leaves one element goes.

use super::ExchangeError;
use super::blockers::{Around, Blockers, Seen};
use super::cubature::{Scratch, means};
use super::element::{Element, Elements};
use super::row::Share;
use super::seen::{Columns, LookSpace, Looker};
use super::shaft::Lies;
use super::shape::clip;
use super::{contour, pair};
use std::collections::BTreeMap;

/// The part of the tolerance that entries which take no views may use up.
const OF_TOLERANCE: f64 = 0.05;

/// Memory that is used again from row to row.
pub(super) struct RowSpace {
    look: LookSpace,
    scratch: Scratch,
    around: Option<Around>,
    /// How each element is seen from the one at hand; partly unless it is known better.
    seen: Vec<Seen>,
    known: Vec<u32>,
    /// How many of the first views show each facet.
    shown: Vec<u32>,
}

impl RowSpace {
    pub(super) fn new(elements: &Elements) -> Self {
        let columns = Columns { patches: elements.patches.len() as u32 };
        Self {
            look: LookSpace::default(),
            scratch: Scratch::new(columns.count()),
            around: None,
            seen: vec![Seen::Partly; elements.elements.len()],
            known: Vec::new(),
            shown: vec![0; elements.frames.len()],
        }
    }
}

/// Computes rows of elements.
pub(super) struct ElementRows<'a> {
    pub(super) blockers: Blockers<'a>,
    pub(super) looker: Looker<'a>,
    pub(super) most_views: usize,
}

impl ElementRows<'_> {
    /// The shares of all columns that get any, with factors to this absolute tolerance, and how many views that took.
    pub(super) fn row(
        &self,
        number: u32,
        tolerance: f64,
        space: &mut RowSpace,
    ) -> Result<(BTreeMap<u32, Share>, usize), ExchangeError> {
        let elements = self.blockers.elements;
        let from = &elements.elements[number as usize];
        if space.around.as_ref().is_none_or(|around| around.facet() != from.facet) {
            space.around = Some(Around::of(from.facet, self.blockers.facets));
        }
        let mut shares: BTreeMap<u32, Share> = BTreeMap::new();
        let mut views = self.tell_apart(from, space)?;
        for element in std::mem::take(&mut space.known) {
            if space.seen[element as usize] == Seen::Wholly {
                let share = self.exchange(number, element, tolerance * OF_TOLERANCE, space);
                let sum = shares.entry(elements.elements[element as usize].patch).or_default();
                sum.factor += share.factor / from.area;
                sum.error += share.error / from.area;
            }
            space.known.push(element);
        }
        if !self.is_complete(&shares, tolerance) {
            let RowSpace { look, scratch, seen, .. } = space;
            let partly = |element: u32| seen[element as usize] == Seen::Partly;
            let means = means(
                &from.ring,
                from.area,
                tolerance * (1.0 - OF_TOLERANCE),
                self.most_views,
                scratch,
                |point, add| self.looker.look(look, from.facet, point, partly, add, |_| ()),
            )?;
            views += means.points;
            if std::env::var_os("NV").is_some() { eprintln!("views {views} known {} wholly {}", space.known.len(), space.known.iter().filter(|&&e| space.seen[e as usize]==Seen::Wholly).count()); }
            for part in means.parts {
                let sum = shares.entry(part.column).or_default();
                sum.factor += part.value.max(0.0);
                sum.error += part.error;
            }
        }
        for element in space.known.drain(..) {
            space.seen[element as usize] = Seen::Partly;
        }
        Ok((shares, views))
    }

    /// True if what is seen wholly is all there is, up to its errors and what may be neglected.
    fn is_complete(&self, shares: &BTreeMap<u32, Share>, tolerance: f64) -> bool {
        let (sum, error) =
            shares.values().fold((0.0, 0.0), |(sum, error), share| (sum + share.factor, error + share.error));
        (sum - 1.0_f64).abs() <= error.min(tolerance)
    }

    /// Finds the elements that are seen wholly or never. Looks from the middle of the element and of its parts to see which facets are worth it; the
    /// number of views.
    fn tell_apart(&self, from: &Element, space: &mut RowSpace) -> Result<usize, ExchangeError> {
        let RowSpace { look, around, seen, known, shown, .. } = space;
        let Some(around) = around.as_ref() else { return Ok(0) };
        let mut facets = Vec::new();
        let mut now = Vec::new();
        let points = [from.centre];
        for point in points {
            self.looker.look(look, from.facet, point, |_| false, |_, _| (), |facet| now.push(facet))?;
            now.sort_unstable();
            now.dedup();
            for facet in now.drain(..) {
                shown[facet as usize] += 1;
                facets.push(facet);
            }
        }
        facets.sort_unstable();
        facets.dedup();
        for facet in facets {
            shown[facet as usize] = 0;
            self.blockers.classify(around, from, facet, |element, is_seen| {
                if is_seen != Seen::Partly {
                    seen[element as usize] = is_seen;
                    known.push(element);
                }
            });
        }
        Ok(points.len())
    }

    /// A_i F_ij of an element that is seen wholly, from wherever its front is.
    fn exchange(&self, number: u32, other: u32, tolerance: f64, space: &RowSpace) -> Share {
        let elements = self.blockers.elements;
        let [from, to] = [number, other].map(|k| &elements.elements[k as usize]);
        let Some(around) = space.around.as_ref() else { return Share::default() };
        let planes = [from.facet, to.facet].map(|facet| &elements.frames[facet as usize]);
        let spanning = [from.facet, to.facet].map(|facet| self.blockers.facets.facets[facet as usize].spanning);
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
