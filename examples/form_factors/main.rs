//! The measured parts of docs/form-factors.md: `cargo run --release --example form_factors`, or only one of them: `-- validation`, `-- cities`, `-- speed`.
//!
//! `-- row box 1e-4 100` times so many rows of one scene, and `-- row box 1e-4 100 120` those from 100 to 119 (`empty`, `box`, or a number of blocks of a city), for profiles.

#[path = "../../tests/form_factors/cases.rs"]
mod cases;
mod cities;
mod city;
#[path = "../common/marks.rs"]
mod marks;
#[path = "../../tests/form_factors/references.rs"]
mod references;
mod scenes;
mod speed;
mod validation;

use marks::Page;
use std::error::Error;
use std::path::Path;

/// What measures a part of the page.
type Part = fn() -> Result<String, Box<dyn Error>>;

const PARTS: [(&str, Part); 3] = [("validation", validation::part), ("cities", cities::part), ("speed", speed::part)];

fn main() -> Result<(), Box<dyn Error>> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/form-factors.md");
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [row, scene, tolerance, ends @ ..] = &words[..]
        && let ("row", [start @ .., end]) = (&row[..], ends)
    {
        let start = start.first().map_or(Ok(0), |start| start.parse())?;
        return speed::rows_of(scene, tolerance.parse()?, start..end.parse()?);
    }
    if let Some(word) = words.iter().find(|word| PARTS.iter().all(|(name, _)| name != word)) {
        return Err(format!("there are validation, cities and speed, not {word}").into());
    }
    for (name, part) in PARTS {
        if words.is_empty() || words.iter().any(|word| word == name) {
            // Before anything is measured.
            Page::open(&page, name)?;
            let text = part()?;
            // Read anew: another part may have been written.
            Page::open(&page, name)?.write(&text)?;
        }
    }
    Ok(())
}
