//! The measured parts of docs/performance.md with figures in docs/images: `cargo run --release --example performance`, or only some of them:
//! `-- scaling`, `-- threads`, `-- overlaps`, `-- quadtree`.
//!
//! Hemisphere views, normal up, of generated scenes from points inside.

#[path = "../common/marks.rs"]
mod marks;
mod overlaps;
mod plot;
mod quadtree;
mod scaling;
mod threads;

use marks::Page;
use std::error::Error;
use std::path::Path;

/// What measures a part of the page and draws its figures in a folder.
type Part = fn(&Path) -> Result<String, Box<dyn Error>>;

const PARTS: [(&str, Part); 4] = [
    ("scaling", scaling::part),
    ("threads", threads::part),
    ("overlaps", overlaps::part),
    ("quadtree", quadtree::part),
];

fn main() -> Result<(), Box<dyn Error>> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let Some(word) = words.iter().find(|word| PARTS.iter().all(|(name, _)| name != word)) {
        return Err(format!("there are scaling, threads, overlaps and quadtree, not {word}").into());
    }
    for (name, part) in PARTS {
        if words.is_empty() || words.iter().any(|word| word == name) {
            // Before anything is measured.
            Page::open(&docs.join("performance.md"), name)?;
            let text = part(&docs.join("images"))?;
            // Read anew: another part may have been written.
            Page::open(&docs.join("performance.md"), name)?.write(&text)?;
        }
    }
    Ok(())
}
