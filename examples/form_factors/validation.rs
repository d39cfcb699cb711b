//! Factors beside their references, to three tolerances.

use super::cases::all;
use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan};
use std::error::Error;
use std::fmt::Write;
use std::time::Instant;

const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];

pub(super) fn part() -> Result<String, Box<dyn Error>> {
    let mut table = String::from(
        "| case | reference | ours, to 1e-8 | error to 1e-4 | to 1e-6 | to 1e-8 | row sum - 1 | ms a row, to 1e-4 | 1e-6 | 1e-8 |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for case in all() {
        let (name, reference) = (&case.name, case.reference);
        let (mut errors, mut times) = (Vec::new(), Vec::new());
        let (mut finest, mut closure) = (0.0, 0.0_f64);
        for tolerance in TOLERANCES {
            let options = ExchangeOptions { tolerance, ..ExchangeOptions::default() };
            let exchange = Exchange::new(&case.scene, PatchPlan::Polygons, options)?;
            let start = Instant::now();
            let result = exchange.row(case.row)?;
            times.push(start.elapsed().as_secs_f64() * 1e3);
            finest = case.of(&result);
            errors.push((finest - reference).abs());
            closure = closure.max((result.sum() - 1.0).abs());
            if (finest - reference).abs() > case.allowed(tolerance) {
                return Err(format!("{name}: {finest} is not within {tolerance:e} of {reference}").into());
            }
        }
        write!(table, "| {name} | {reference:.12} | {finest:.12} ")?;
        errors.iter().try_for_each(|error| write!(table, "| {error:.0e} "))?;
        write!(table, "| {closure:.0e} ")?;
        times.iter().try_for_each(|ms| write!(table, "| {ms:.2} "))?;
        table.push_str("|\n");
    }
    Ok(table)
}
