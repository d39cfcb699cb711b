//! All entries of dense cities beside those of a hundredth of the tolerance, which take a hundred times the samples and more.

use super::city;
use nusselt::factors::{Entry, Exchange, ExchangeError, ExchangeOptions, PatchPlan, Row};
use nusselt::scene::Scene;
use std::error::Error;
use std::fmt::Write;

const TOLERANCE: f64 = 1e-4;

pub(super) fn part() -> Result<String, Box<dyn Error>> {
    let mut table = String::from(
        "| blocks | patches | entries | worst error | above 1e-4 | above their estimate | worst raw closure | worst row sum - 1 |\n\
         | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for blocks in [4, 6, 10] {
        let scene = city::city(blocks)?;
        let [coarse, fine] = [TOLERANCE, 0.01 * TOLERANCE].map(|tolerance| rows(&scene, tolerance));
        let (coarse, fine) = (coarse?, fine?);
        let (mut entries, mut above, mut dishonest) = (0, 0, 0);
        let (mut worst, mut raw, mut sum) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (row, reference) in coarse.iter().zip(&fine) {
            raw = raw.max((row.closure_raw - 1.0).abs());
            sum = sum.max((row.sum() - 1.0).abs());
            for (found, expected) in together(row, reference, coarse.len()) {
                let error = (found.0 - expected).abs();
                entries += 1;
                worst = worst.max(error);
                above += usize::from(error > TOLERANCE);
                dishonest += usize::from(error > found.1 + 0.01 * TOLERANCE);
            }
        }
        writeln!(
            table,
            "| {blocks} x {blocks} | {} | {entries} | {worst:.1e} | {above} | {dishonest} | {raw:.1e} | {sum:.0e} |",
            coarse.len()
        )?;
    }
    Ok(table)
}

/// All rows, with every polygon a patch.
fn rows(scene: &Scene, tolerance: f64) -> Result<Vec<Row>, ExchangeError> {
    let options = ExchangeOptions { tolerance, ..ExchangeOptions::default() };
    let exchange = Exchange::new(scene, PatchPlan::Polygons, options)?;
    let mut rows = Vec::with_capacity(exchange.patches().len());
    exchange.rows(0..exchange.patches().len(), |row| {
        rows.push(row);
        Ok::<(), ExchangeError>(())
    })?;
    Ok(rows)
}

/// Factors and estimates of all entries that either row has, and the factors of the other row.
fn together(row: &Row, reference: &Row, patches: usize) -> Vec<((f64, f64), f64)> {
    let mut all = vec![((0.0, 0.0), 0.0); patches];
    for &Entry { column, share } in &row.entries {
        all[column as usize].0 = (share.factor, share.error);
    }
    for &Entry { column, share } in &reference.entries {
        all[column as usize].1 = share.factor;
    }
    all.retain(|&((found, _), expected)| found > 0.0 || expected > 0.0);
    all
}
