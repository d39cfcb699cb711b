//! Where a view's instructions go, function by function.

use crate::callgrind::{Profile, count};
use crate::work::VIEWS;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

const SIZES: [&str; 3] = ["1000", "10000", "50000"];
/// Functions are listed that have this share of the instructions themselves, in one of the scenes ...
const OWN: f64 = 0.015;
/// ... and those of this crate that have this share with what they call.
const ALL: f64 = 0.03;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let mut profiles = Vec::new();
    for size in SIZES {
        eprintln!("profile of a room of {size} polygons");
        profiles.push(count(&["room", size, "both"], false)?);
    }
    let totals: Vec<u64> = profiles.iter().map(|profile| profile.total("Ir")).collect();
    // The shares in each of the scenes: own, and with what is called.
    let shares = |name: &str| -> Vec<[f64; 2]> {
        let of = |(profile, &total): (&Profile, &u64)| {
            profile.functions.get(name).copied().unwrap_or_default().map(|count| count as f64 / total as f64)
        };
        profiles.iter().zip(&totals).map(of).collect()
    };
    let mut names: Vec<&String> = profiles.iter().flat_map(|profile| profile.functions.keys()).collect();
    names.sort_unstable();
    names.dedup();
    let mut rows: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    for name in names {
        let shares = shares(name);
        let is_ours = name.contains("nusselt::");
        if shares.iter().any(|&[own, all]| own >= OWN || is_ours && all >= ALL) {
            rows.push((name.replace("nusselt::", ""), shares));
        }
    }
    let last = SIZES.len() - 1;
    rows.sort_by(|a, b| b.1[last][1].total_cmp(&a.1[last][1]));
    let mut text = String::from("| function |");
    for size in SIZES {
        write!(text, " {size}: own | with what it calls |")?;
    }
    text += "\n| --- |";
    text += &" ---: | ---: |".repeat(SIZES.len());
    text.push('\n');
    for (name, shares) in rows {
        write!(text, "| `{}` |", name.replace('|', "/"))?;
        for [own, all] in shares {
            write!(text, " {:.1}% | {:.1}% |", 100.0 * own, 100.0 * all)?;
        }
        text.push('\n');
    }
    let millions = totals.iter().map(|&total| format!("{:.2}", total as f64 / VIEWS as f64 / 1e6));
    let millions: Vec<_> = millions.collect();
    writeln!(text, "\nAll of it: {} million instructions a view.", millions.join(", "))?;
    Ok(text)
}
