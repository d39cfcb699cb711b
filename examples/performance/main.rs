//! The measured parts of docs/performance.md with figures in docs/images: `cargo run --release --example performance -- all`, or only some of them
//! by their names, such as `-- views regions`. `--docs FOLDER` writes to a copy of the page in another folder instead.
//!
//! `counts` and `profile` run this program under callgrind and need valgrind; nothing else does. `-- count [POLYGONS ...]` prints the table of `counts`,
//! of scenes of other sizes too, and `-- work` does what is counted (see `work.rs`).
//!
//! Hemisphere views, normal up, of generated scenes from points inside.

mod callgrind;
mod counts;
#[path = "../common/machine.rs"]
mod machine;
#[path = "../common/marks.rs"]
mod marks;
mod moved;
mod overlaps;
mod plot;
mod profile;
mod quadtree;
mod regions;
mod scaling;
mod threads;
mod views;
mod windows;
mod work;

use marks::Page;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What measures a part of the page and draws its figures in a folder.
type Part = fn(&Path) -> Result<String, Box<dyn Error>>;

const PARTS: [(&str, Part); 10] = [
    ("views", views::part),
    ("scaling", scaling::part),
    ("threads", threads::part),
    ("overlaps", overlaps::part),
    ("quadtree", quadtree::part),
    ("regions", regions::part),
    ("moved", moved::part),
    ("windows", windows::part),
    ("counts", counts::part),
    ("profile", profile::part),
];

fn main() -> Result<(), Box<dyn Error>> {
    // But where threads are what is measured, which has its own.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.first().map(String::as_str) {
        Some("work") => work::run(&words[1..]),
        Some("count") => counts::print(&words[1..]),
        Some("--docs") => {
            let folder = words.get(1).ok_or("--docs takes a folder with a performance.md in it")?;
            write(&PathBuf::from(folder), &words[2..])
        }
        _ => write(&Path::new(env!("CARGO_MANIFEST_DIR")).join("docs"), &words),
    }
}

/// Measures parts and writes them.
fn write(docs: &Path, words: &[String]) -> Result<(), Box<dyn Error>> {
    let all = PARTS.map(|(name, _)| name);
    if words.is_empty() || words.iter().any(|word| word != "all" && !all.contains(&word.as_str())) {
        return Err(format!("name some of all, {}", all.join(", ")).into());
    }
    let is_wanted = |name: &str| words.iter().any(|word| word == "all" || word == name);
    let page = docs.join("performance.md");
    // Before anything is measured.
    for (name, _) in PARTS {
        Page::open(&page, name)?;
    }
    if is_wanted("counts") || is_wanted("profile") {
        callgrind::check()?;
    }
    std::fs::create_dir_all(docs.join("images"))?;
    for (name, part) in PARTS.into_iter().filter(|(name, _)| is_wanted(name)) {
        let start = Instant::now();
        let text = part(&docs.join("images"))?;
        // Read anew: another part may have been written.
        Page::open(&page, name)?.write(&format!("{text}\n{}\n", machine::sentence()))?;
        eprintln!("{name}: {:.0} s", start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// The range of some numbers, as one writes it.
fn range(numbers: impl IntoIterator<Item = f64>) -> String {
    let (low, high) =
        numbers.into_iter().fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
    format!("{low:.2} to {high:.2}")
}
