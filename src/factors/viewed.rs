//! All rows by a few exact views from each patch, for pictures: much cheaper than [`Exchange::row`], with errors that nothing bounds.

use super::element::{Element, quads};
use super::seen::{Columns, LookSpace};
use super::shared::Shared;
use super::touching::Touch;
use super::{Exchange, ExchangeError, Sides};
use crate::parallel;
use glam::DVec3;
use std::sync::{Mutex, PoisonError};

/// Gauss's rule of two points from 0 to 1.
const TWO: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
const ONE: [f64; 1] = [0.5];

/// A part that is no longer than this times the spacing takes one view, from its middle: a square's diagonal is 1.41 times its side.
const SMALL: f64 = 1.5;

/// Form factors from the fronts of all patches to all fronts, from views at a few points of each ([`Exchange::viewed_rows`]).
#[derive(Clone, Debug, PartialEq)]
pub struct ViewedRows {
    /// Where the entries of each row begin, and where the last ones end.
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
    views: usize,
}

impl ViewedRows {
    /// How many rows there are: one for each patch.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// True if there are no patches.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The factors of a row that are not zero, by ascending column.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn row(&self, patch: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[patch]..self.starts[patch + 1]]
    }

    /// How many views they took.
    pub fn views(&self) -> usize {
        self.views
    }
}

/// What is seen from one patch.
struct Seen {
    /// By ascending column, fronts of patches alone.
    entries: Vec<(u32, f64)>,
    /// What arrives at backs and leaves the scene.
    lost: f64,
    /// How far across what one view stands for is, at most.
    reach: f64,
    views: usize,
}

/// Memory that is used again.
#[derive(Default)]
struct Space {
    look: LookSpace,
    sums: Vec<f64>,
    used: Vec<u32>,
}

impl Exchange {
    /// All rows at once, each from views at points of its patch: one from the middle of what is no longer than 1.5 times `spacing`, in scene units, else the points of Gauss's rules of one or two points along
    /// either side of it, two along sides that are longer than `spacing`. The tolerance of the exchange is of no account.
    ///
    /// What two patches exchange, `A_i F_ij = A_j F_ji`, is known from both: the mean is taken, weighed by the inverse square of how far across what one view stands for is, so that a small patch beside a large one
    /// counts for more. Then each row is scaled to sum to 1 with what arrives at backs and what leaves the scene, so that a patch in a furnace has exactly the furnace's light. Views are exact; between
    /// them nothing is known. `done` is told from any thread of every row.
    ///
    /// # Errors
    /// If a view has too many cells, or there are more than `most_entries` factors (16 bytes each, about twice while they are made).
    pub fn viewed_rows(
        &self,
        spacing: f64,
        most_entries: usize,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<ViewedRows, ExchangeError> {
        let spacing = self.facets.placement.local_length(spacing);
        let count = self.elements.patches.len();
        let spaces: Mutex<Vec<Space>> = Mutex::default();
        let free = || spaces.lock().unwrap_or_else(PoisonError::into_inner);
        let look = |patch: usize| {
            let taken = free().pop();
            let mut space = taken.unwrap_or_default();
            let seen = self.seen_from(patch, spacing, &mut space);
            free().push(space);
            done(1);
            seen
        };
        let (mut all, mut entries) = (Vec::with_capacity(count), 0);
        parallel::in_order(0..count, look, |seen: Seen| {
            entries += seen.entries.len();
            all.push(seen);
            if entries > most_entries { Err(ExchangeError::TooManyFactors { limit: most_entries }) } else { Ok(()) }
        })?;
        let views = all.iter().map(|seen| seen.views).sum();
        let lost: Vec<f64> = all.iter().map(|seen| seen.lost).collect();
        let rows = if self.options.sides == Sides::Fronts { self.met_halfway(&all) } else { one_sided(&all) };
        drop(all);
        let mut found = ViewedRows { starts: vec![0], entries: Vec::with_capacity(entries), views };
        for (row, lost) in rows.into_iter().zip(lost) {
            let sum = row.iter().map(|entry| entry.1).sum::<f64>() + lost;
            found.entries.extend(row.into_iter().map(|(column, factor)| (column, factor / sum)));
            found.starts.push(found.entries.len());
        }
        Ok(found)
    }

    fn seen_from(&self, patch: usize, spacing: f64, space: &mut Space) -> Result<Seen, ExchangeError> {
        let elements = &self.elements;
        let alone = Shared::default();
        let rows = self.element_rows(&alone);
        let columns = Columns { patches: elements.patches.len() as u32 };
        let Space { look, sums, used } = space;
        sums.resize(columns.count(), 0.0);
        let mut seen = Seen { entries: Vec::new(), lost: 0.0, reach: 0.0, views: 0 };
        let mut whole = 0.0;
        for element in elements.of_patch[patch].iter().map(|&element| &elements.all[element as usize]) {
            let (stations, reach) = stations(element, spacing);
            seen.reach = reach.max(seen.reach);
            seen.views += stations.len();
            for (point, weight) in stations {
                whole += weight;
                rows.looker.look(
                    look,
                    element.facet,
                    point,
                    |_| true,
                    |column, share| {
                        let sum = &mut sums[column as usize];
                        if *sum <= 0.0 {
                            used.push(column);
                        }
                        *sum += weight * share;
                    },
                )?;
            }
        }
        // Views see the backs of what the patch is face to face with.
        let mut shut = 0.0;
        for &element in &elements.of_patch[patch] {
            for Touch { other, exchange, .. } in rows.touching(element, look)? {
                let column = elements.all[other as usize].patch;
                used.push(column);
                sums[column as usize] += exchange.factor;
                shut += exchange.factor;
            }
        }
        used.sort_unstable();
        used.dedup();
        for column in used.drain(..) {
            let factor = std::mem::take(&mut sums[column as usize]) / whole;
            if column >= columns.patches {
                seen.lost += factor.max(0.0);
            } else if factor > 0.0 {
                seen.entries.push((column, factor));
            }
        }
        seen.lost = (seen.lost - shut / whole).max(0.0);
        Ok(seen)
    }

    /// Rows with the weighted means of what both patches of a pair have found of their exchange.
    fn met_halfway(&self, all: &[Seen]) -> Vec<Vec<(u32, f64)>> {
        let area = |patch: usize| self.elements.patches[patch].area;
        let mut rows: Vec<Vec<(u32, f64)>> = all.iter().map(|seen| Vec::with_capacity(seen.entries.len())).collect();
        for (i, seen) in all.iter().enumerate() {
            for &(column, factor) in &seen.entries {
                let j = column as usize;
                let other = &all[j];
                let found = other.entries.binary_search_by_key(&(i as u32), |entry| entry.0);
                // A pair that both have found is met from the first of them.
                if found.is_ok() && j < i {
                    continue;
                }
                let back = found.map_or(0.0, |place| other.entries[place].1);
                let [own, others] = [seen.reach, other.reach].map(|reach| reach * reach);
                let exchange = (area(i) * factor * others + area(j) * back * own) / (own + others);
                rows[i].push((column, exchange / area(i)));
                if i != j {
                    rows[j].push((i as u32, exchange / area(j)));
                }
            }
        }
        for row in &mut rows {
            row.sort_unstable_by_key(|entry| entry.0);
        }
        rows
    }
}

fn one_sided(all: &[Seen]) -> Vec<Vec<(u32, f64)>> {
    all.iter().map(|seen| seen.entries.clone()).collect()
}

/// The points of an element that views are taken from, with weights that sum to about its area, and how far across what one of them stands for is, at most.
fn stations(element: &Element, spacing: f64) -> (Vec<(DVec3, f64)>, f64) {
    if 2.0 * element.radius <= SMALL * spacing {
        return (vec![(element.centre, element.area)], 2.0 * element.radius);
    }
    let along = |length: f64| if length > spacing { &TWO[..] } else { &ONE[..] };
    let (mut stations, mut most) = (Vec::new(), 0.0_f64);
    for quad in quads(element.ring.len()) {
        let [a, b, c, d] = quad.map(|k| element.ring[k]);
        let [first, second] = [a.distance(b).max(d.distance(c)), a.distance(d).max(b.distance(c))];
        let [us, vs] = [along(first), along(second)];
        most = most.max((first / us.len() as f64).hypot(second / vs.len() as f64));
        for &u in us {
            for &v in vs {
                let density = (b - a).lerp(c - d, v).cross((d - a).lerp(c - b, u)).length();
                let point = a.lerp(b, u).lerp(d.lerp(c, u), v);
                stations.push((point, density / (us.len() * vs.len()) as f64));
            }
        }
    }
    (stations, most)
}
