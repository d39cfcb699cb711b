//! What is known of a row while it is computed.

use super::blockers::{Around, Hiders, Seen};
use super::cubature::Scratch;
use super::element::Elements;
use super::partly::PartlySpace;
use super::row::Share;
use super::seen::{Columns, LookSpace};
use super::shared::Told;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Memory that is used again from row to row.
pub(super) struct RowSpace {
    pub(super) look: LookSpace,
    pub(super) scratch: Scratch,
    pub(super) hidden: PartlySpace,
    pub(super) around: Option<Around>,
    /// The element in parts within which what is seen changes steadily.
    pub(super) parts: Vec<Vec<DVec3>>,
    /// Where it was cut to find what few points miss, in its frame.
    pub(super) cuts: Vec<[DVec2; 2]>,
    pub(super) found: Found,
    pub(super) hiders: Hiders,
    /// Those of which this row need not find out anything more: whose rows have told it, and which it is face to face with.
    pub(super) complete: Vec<u32>,
    /// What others may be told by this row.
    pub(super) told: Vec<(u32, Told)>,
    /// What each column gets.
    pub(super) shares: Vec<Share>,
    pub(super) columns: Vec<u32>,
}

/// How each element is seen from the one at hand.
pub(super) struct Found {
    pub(super) seen: Vec<Seen>,
    pub(super) known: Vec<u32>,
    /// Where the facets that may be between are in a list.
    pub(super) between: Vec<Range<u32>>,
    pub(super) facets: Vec<u32>,
    /// Those of which another row has told.
    pub(super) is_told: Vec<bool>,
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
            cuts: Vec::new(),
            found,
            hiders: Hiders::default(),
            complete: Vec::new(),
            told: Vec::new(),
            shares: vec![Share::default(); columns],
            columns: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, column: u32, share: Share) {
        let sum = &mut self.shares[column as usize];
        if *sum == Share::default() {
            self.columns.push(column);
        }
        sum.factor += share.factor;
        sum.error += share.error;
    }

    /// Ends a row: what its columns have got, ascending.
    pub(super) fn take(&mut self) -> Vec<(u32, Share)> {
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
