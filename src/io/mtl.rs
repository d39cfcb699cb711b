//! Materials in MTL files: `newmtl`, `Kd`, `Ks`, `Ns` and `Ke`; everything else is ignored.
//! A material without a name is `default`, as for `usemtl`.

use super::error::{Faults, Place};
use super::lines::{is_blank, lines};
use super::number::{self, Shortest};
use crate::scene::Material;
use std::collections::{HashMap, HashSet};
use std::io::{self, Write};

/// A material and the line that defines it.
#[derive(Clone, Debug)]
pub(super) struct Definition {
    pub(super) material: Material,
    pub(super) line: usize,
}

/// The materials of a file, in order. Colours that are given by a spectrum or as CIE XYZ keep their
/// defaults, with a warning.
pub(super) fn parse(bytes: &[u8], file: &str, faults: &mut Faults, warnings: &mut Vec<String>) -> Vec<Definition> {
    let mut definitions: Vec<Definition> = Vec::new();
    let mut spectra = 0_usize;
    for line in lines(bytes) {
        let (keyword, rest) = line.split();
        if keyword == "newmtl" {
            let name = if rest.is_empty() { "default" } else { rest };
            definitions.push(Definition { material: Material::new(name), line: line.number });
            continue;
        }
        let Some(Definition { material, .. }) = definitions.last_mut() else { continue };
        let result = match keyword {
            "Kd" | "Ks" | "Ke" if rest.starts_with("spectral") || rest.starts_with("xyz") => {
                spectra += 1;
                Ok(())
            }
            "Kd" => colour(rest).map(|colour| material.diffuse = colour),
            "Ks" => colour(rest).map(|colour| material.specular = colour),
            "Ke" => colour(rest).map(|colour| material.emission = colour),
            "Ns" => number::parse(rest.split(is_blank).next().unwrap_or_default())
                .map(|exponent| material.exponent = exponent),
            _ => Ok(()),
        };
        if let Err(what) = result {
            faults.note(file, Place::Line(line.number), format_args!("{keyword}: {what}"));
        }
    }
    if spectra > 0 {
        warnings
            .push(format!("{file}: {spectra} colours given as spectrum or XYZ keep their defaults; give them as RGB"));
    }
    definitions
}

/// Three numbers, or one for all three.
fn colour(text: &str) -> Result<[f64; 3], String> {
    let mut numbers = text.split(is_blank).filter(|token| !token.is_empty()).map(number::parse);
    let red = numbers.next().ok_or("a colour takes 3 numbers, red, green and blue")??;
    let Some(green) = numbers.next() else { return Ok([red; 3]) };
    let blue = numbers.next().ok_or("a colour takes 3 numbers, red, green and blue, or one for all")??;
    Ok([red, green?, blue])
}

/// The names that materials have in an MTL file, in their order: as one can write them, and different from each other. Of materials
/// with one name the first keeps it, and the others get a number.
pub fn names(materials: &[Material]) -> Vec<String> {
    let mut taken: HashSet<String> = HashSet::new();
    let mut counts: HashMap<String, usize> = HashMap::new();
    let unique = materials.iter().map(|material| {
        let name = super::obj::printable(&material.name);
        let mut unique = name.clone();
        while !taken.insert(unique.clone()) {
            let count = counts.entry(name.clone()).or_insert(1);
            unique = format!("{name}.{count}");
            *count += 1;
        }
        unique
    });
    unique.collect()
}

/// Writes materials as an MTL file, under their [`names`]. Numbers are the shortest that read as the same.
///
/// # Errors
/// If writing fails.
pub fn write(out: &mut impl Write, materials: &[Material]) -> io::Result<()> {
    for (material, name) in materials.iter().zip(names(materials)) {
        writeln!(out, "newmtl {name}")?;
        for (keyword, [r, g, b]) in [("Kd", material.diffuse), ("Ks", material.specular), ("Ke", material.emission)] {
            writeln!(out, "{keyword} {} {} {}", Shortest(r), Shortest(g), Shortest(b))?;
        }
        writeln!(out, "Ns {}", Shortest(material.exponent))?;
    }
    Ok(())
}
