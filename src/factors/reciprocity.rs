//! Factors made reciprocal, by least squares.
//!
//! A row is computed apart from the others, so that `A_i F_ij` and `A_j F_ji` are two measurements of one exchange, with errors that are estimated. The exchanges
//! that fit all of these best, by squares of differences over those estimates, and make every row sum to 1, are
//!
//! ```text
//! x_ij = m_ij + v_ij (l_i + l_j)
//! ```
//!
//! with the weighted mean m and its variance v of the two, and a number l for each row, from as many linear equations (as in Larsen and Howell, "Least-squares smoothing of direct-exchange
//! areas in zonal analysis", 1986). What would become negative is 0 instead, and the rest is fitted again.

use super::row::{Entry, PatchInfo, Row, Share};
use std::collections::BTreeMap;

/// Estimates of errors are not taken to be less than this.
const LEAST_ERROR: f64 = 1e-13;
/// How often what has become negative may be left out and the rest fitted again.
const ROUNDS: usize = 50;

/// Why factors cannot be made reciprocal.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReciprocityError {
    /// Rows are missing, or not in order.
    #[error("all rows are needed to make factors reciprocal, in order: row {row} is not there")]
    MissingRow {
        /// The first one that is missing.
        row: usize,
    },
    /// There is no solution, or it takes too long.
    #[error("no reciprocal factors fit: row sums are off by {off:e}")]
    NotSolved {
        /// How far row sums are from 1 at worst.
        off: f64,
    },
}

/// A reciprocal matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Reciprocal {
    /// Its rows. Errors are not below what a factor has changed by.
    pub rows: Vec<Row>,
    /// The largest change of a factor.
    pub largest_change: f64,
    /// How many factors changed by more than the estimate of their error.
    pub beyond_estimates: usize,
}

/// An exchange between two patches: the lower one first.
#[derive(Clone, Copy, Debug)]
struct Exchange {
    between: [u32; 2],
    mean: f64,
    variance: f64,
}

/// Makes `A_i F_ij = A_j F_ji` hold, with rows that sum to 1 up to rounding, by the least change as estimates of errors weigh it. For factors from fronts to
/// fronts ([`Sides::Fronts`](super::Sides::Fronts)): others are not reciprocal. All rows are in memory.
///
/// # Errors
/// If rows are missing, or nothing fits.
pub fn make_reciprocal(patches: &[PatchInfo], rows: Vec<Row>) -> Result<Reciprocal, ReciprocityError> {
    for row in 0..patches.len() {
        if rows.get(row).is_none_or(|found| found.patch as usize != row) {
            return Err(ReciprocityError::MissingRow { row });
        }
    }
    let mut exchanges = exchanges(patches, &rows);
    // Backs and the background of each row.
    let mut apart: Vec<[Exchange; 2]> = rows
        .iter()
        .map(|row| {
            let area = patches[row.patch as usize].area;
            [row.backs, row.background].map(|share| Exchange {
                between: [row.patch; 2],
                mean: area * share.factor,
                variance: if share.factor > 0.0 { (area * share.error.max(LEAST_ERROR)).powi(2) } else { 0.0 },
            })
        })
        .collect();
    for _ in 0..ROUNDS {
        let shift = solve(patches, &exchanges, &apart)?;
        let moved = |exchange: &Exchange| {
            let [i, j] = exchange.between.map(|patch| shift[patch as usize]);
            exchange.mean + exchange.variance * if exchange.between[0] == exchange.between[1] { i } else { i + j }
        };
        let mut is_negative = false;
        for exchange in exchanges.iter_mut().chain(apart.as_flattened_mut()) {
            if moved(exchange) < 0.0 {
                is_negative = true;
                (exchange.mean, exchange.variance) = (0.0, 0.0);
            }
        }
        if !is_negative {
            for exchange in exchanges.iter_mut().chain(apart.as_flattened_mut()) {
                exchange.mean = moved(exchange);
            }
            return Ok(rebuilt(patches, rows, &exchanges, &apart));
        }
    }
    Err(ReciprocityError::NotSolved { off: worst(&lacking(patches, &exchanges, &apart), patches) })
}

/// The weighted means of both measurements of each exchange.
fn exchanges(patches: &[PatchInfo], rows: &[Row]) -> Vec<Exchange> {
    let mut measured: BTreeMap<[u32; 2], [Option<(f64, f64)>; 2]> = BTreeMap::new();
    for row in rows {
        let area = patches[row.patch as usize].area;
        for &Entry { column, share } in &row.entries {
            let (i, j) = (row.patch, column);
            let pair = measured.entry([i.min(j), i.max(j)]).or_default();
            pair[usize::from(i > j)] = Some((area * share.factor, area * share.error.max(LEAST_ERROR)));
        }
    }
    let exchange = |(between, pair): ([u32; 2], [Option<(f64, f64)>; 2])| {
        // What one of the two rows has not seen is 0 there, as surely as the other one has it.
        let [a, b] = match pair {
            [Some(a), Some(b)] => [a, b],
            [Some(a), None] if between[0] != between[1] => [a, (0.0, a.1)],
            [None, Some(b)] => [(0.0, b.1), b],
            [Some(only), None] => [only, only],
            [None, None] => [(0.0, 0.0); 2],
        };
        let weights = [a.1.powi(-2), b.1.powi(-2)];
        let sum = weights[0] + weights[1];
        Exchange { between, mean: (a.0 * weights[0] + b.0 * weights[1]) / sum, variance: 1.0 / sum }
    };
    measured.into_iter().map(exchange).collect()
}

/// What each row lacks.
fn lacking(patches: &[PatchInfo], exchanges: &[Exchange], apart: &[[Exchange; 2]]) -> Vec<f64> {
    let mut rest: Vec<f64> = patches.iter().map(|patch| patch.area).collect();
    for &Exchange { between: [i, j], mean, .. } in exchanges.iter().chain(apart.as_flattened()) {
        rest[i as usize] -= mean;
        if i != j {
            rest[j as usize] -= mean;
        }
    }
    rest
}

/// How far row sums are from 1 at worst.
fn worst(lacking: &[f64], patches: &[PatchInfo]) -> f64 {
    let rows = lacking.iter().zip(patches).filter(|(_, patch)| patch.area > 0.0);
    rows.map(|(rest, patch)| (rest / patch.area).abs()).fold(0.0, f64::max)
}

/// The numbers by which rows shift their exchanges: conjugate gradients (Hestenes and Stiefel 1952), scaled by the diagonal.
fn solve(patches: &[PatchInfo], exchanges: &[Exchange], apart: &[[Exchange; 2]]) -> Result<Vec<f64>, ReciprocityError> {
    let all = || exchanges.iter().chain(apart.as_flattened());
    let mut diagonal = vec![0.0; patches.len()];
    for &Exchange { between: [i, j], variance, .. } in all() {
        diagonal[i as usize] += variance;
        if i != j {
            diagonal[j as usize] += variance;
        }
    }
    let product = |x: &[f64]| {
        let mut y = vec![0.0; x.len()];
        for &Exchange { between: [i, j], variance, .. } in all() {
            let (i, j) = (i as usize, j as usize);
            if i == j {
                y[i] += variance * x[i];
            } else {
                let both = variance * (x[i] + x[j]);
                y[i] += both;
                y[j] += both;
            }
        }
        y
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let scaled = |r: &[f64]| {
        let parts = r.iter().zip(&diagonal);
        parts.map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 }).collect::<Vec<f64>>()
    };
    let mut x = vec![0.0; patches.len()];
    let mut rest = lacking(patches, exchanges, apart);
    let mut z = scaled(&rest);
    let mut direction = z.clone();
    let mut size = dot(&rest, &z);
    for _ in 0..20 * patches.len() + 100 {
        if worst(&rest, patches) <= 1e-15 || size <= 0.0 {
            break;
        }
        let along = product(&direction);
        let step = size / dot(&direction, &along);
        if !step.is_finite() {
            break;
        }
        for k in 0..x.len() {
            x[k] += step * direction[k];
            rest[k] -= step * along[k];
        }
        z = scaled(&rest);
        let next = dot(&rest, &z);
        for k in 0..x.len() {
            direction[k] = z[k] + next / size * direction[k];
        }
        size = next;
    }
    // A few units in the last place of sums of thousands of numbers.
    let off = worst(&rest, patches);
    if off <= 1e-12 { Ok(x) } else { Err(ReciprocityError::NotSolved { off }) }
}

/// The rows with the new exchanges.
fn rebuilt(patches: &[PatchInfo], rows: Vec<Row>, exchanges: &[Exchange], apart: &[[Exchange; 2]]) -> Reciprocal {
    let mut columns: Vec<Vec<(u32, f64)>> = vec![Vec::new(); rows.len()];
    for &Exchange { between: [i, j], mean, .. } in exchanges {
        columns[i as usize].push((j, mean));
        if i != j {
            columns[j as usize].push((i, mean));
        }
    }
    let (mut largest_change, mut beyond_estimates) = (0.0_f64, 0);
    let mut change = |old: Share, factor: f64| {
        let by = (factor - old.factor).abs();
        largest_change = largest_change.max(by);
        beyond_estimates += usize::from(by > old.error.max(LEAST_ERROR));
        Share { factor, error: old.error.max(by) }
    };
    let mut results = Vec::with_capacity(rows.len());
    for (row, mut new) in rows.into_iter().zip(columns) {
        let area = patches[row.patch as usize].area;
        new.sort_unstable_by_key(|&(column, _)| column);
        let old = |column: u32| {
            let found = row.entries.binary_search_by_key(&column, |entry| entry.column);
            found.map_or(Share::default(), |place| row.entries[place].share)
        };
        let entries = new.into_iter().map(|(column, mean)| Entry { column, share: change(old(column), mean / area) });
        let entries = entries.filter(|entry| entry.share.factor > 0.0).collect();
        let [backs, background] = apart[row.patch as usize];
        let share = |old: Share, new: Exchange| if area > 0.0 { (old, new.mean / area) } else { (old, 0.0) };
        let (backs, background) = (share(row.backs, backs), share(row.background, background));
        let (backs, background) = (change(backs.0, backs.1), change(background.0, background.1));
        results.push(Row { entries, backs, background, ..row });
    }
    Reciprocal { rows: results, largest_change, beyond_estimates }
}
