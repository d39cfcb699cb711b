//! scratch
mod scenes;
use nusselt::factors::*;
use std::time::Instant;
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let tolerance: f64 = words.get(1).map_or(1e-4, |w| w.parse().unwrap());
    let scene = match words[0].as_str() {
        "empty" => scenes::room(false)?,
        "box" => scenes::room(true)?,
        k => scenes::city(k.parse()?)?,
    };
    let start = Instant::now();
    let exchange = Exchange::new(&scene, PatchPlan::Polygons, ExchangeOptions { tolerance, ..Default::default() })?;
    println!("{} patches, set-up {:.3}", exchange.patches().len(), start.elapsed().as_secs_f64());
    if words.get(2).is_some_and(|w| w == "check") {
        let tight = Exchange::new(
            &scene,
            PatchPlan::Polygons,
            ExchangeOptions { tolerance: tolerance * 1e-3, ..Default::default() },
        )?;
        check(&exchange, &tight, &[0, 3, 10, 20, 30, 40, 50]);
        return Ok(());
    }
    let n = exchange.patches().len();
    let m = words.get(2).map_or(n, |w| w.parse().unwrap());
    let start = Instant::now();
    let (mut worst, mut entries, mut error) = (0.0f64, 0, 0.0f64);
    let mut sum = 0.0f64;
    exchange.rows::<ExchangeError>(0..m, |row| {
        worst = worst.max((row.closure_raw - 1.0).abs());
        sum = sum.max((row.sum() - 1.0).abs());
        entries += row.entries.len();
        error = row.entries.iter().map(|e| e.share.error).fold(error, f64::max);
        Ok(())
    })?;
    println!(
        "rows {:.3} s, raw closure {worst:.2e}, closure {sum:.2e}, {entries} entries, worst estimate {error:.2e}",
        start.elapsed().as_secs_f64()
    );
    Ok(())
}
fn check(exchange: &Exchange, tight: &Exchange, rows: &[usize]) {
    for &r in rows {
        let (a, b) = (exchange.row(r).unwrap(), tight.row(r).unwrap());
        let mut ratios: Vec<(f64, f64)> = Vec::new();
        for e in &a.entries {
            let t = b.entries.iter().find(|t| t.column == e.column).map_or(0.0, |t| t.share.factor);
            ratios.push(((e.share.factor - t).abs(), e.share.error));
        }
        ratios.sort_by(|x, y| y.0.total_cmp(&x.0));
        println!("row {r}: worst {:?}", &ratios[..4.min(ratios.len())]);
    }
}
