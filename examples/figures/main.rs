//! Makes the figures of docs/figures.md that the program `nusselt` does not make by itself: all, or those named,
//! such as `cargo run --release --example figures -- fragments tree`. `--docs FOLDER` writes to another folder than docs/images.

mod field;
mod fragments;
mod quadtree;
mod receiver;
mod shop;
mod studio;
mod table;
mod tree;

use std::error::Error;
use std::path::{Path, PathBuf};

/// Where a figure is written, by its name.
type Figure = fn(&Path) -> Result<(), Box<dyn Error>>;

const FIGURES: [(&str, Figure); 6] = [
    ("fragments", fragments::draw),
    ("tree", tree::draw),
    ("quadtree", quadtree::draw),
    ("receiver", receiver::draw),
    ("studio", studio::write),
    ("field", field::draw),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/images"));
    let mut names = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--docs" {
            folder = arguments.next().ok_or("--docs needs a folder")?.into();
        } else if FIGURES.iter().any(|(name, _)| *name == argument) {
            names.push(argument);
        } else {
            let known: Vec<&str> = FIGURES.iter().map(|figure| figure.0).collect();
            return Err(format!("there is no figure {argument}; there are {}", known.join(", ")).into());
        }
    }
    for (name, draw) in FIGURES {
        if names.is_empty() || names.iter().any(|wanted| wanted == name) {
            draw(&folder)?;
        }
    }
    Ok(())
}
