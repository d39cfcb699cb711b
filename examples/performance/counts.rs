//! Instructions a view, which are the same on every run, so that commits can be compared.

use crate::callgrind::{check, count};
use crate::work::VIEWS;
use nusselt::samples::Kind;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    table(&["1000", "10000", "50000"].map(str::to_owned))
}

/// The table of scenes of some sizes.
pub(crate) fn print(sizes: &[String]) -> Result<(), Box<dyn Error>> {
    check()?;
    if sizes.is_empty() {
        print!("{}", part(Path::new(""))?);
    } else {
        print!("{}", table(sizes)?);
    }
    Ok(())
}

fn table(sizes: &[String]) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "| scene | polygons | by the 3D BSP | by boxes | form factors | hemicube 512 | read misses by boxes |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for kind in Kind::ALL {
        for size in sizes {
            eprintln!("instructions in a {kind} of {size} polygons");
            write!(text, "| {kind} | {size} ")?;
            let mut misses = 0.0;
            for what in ["bsp", "boxes", "factors", "hemicube"] {
                let profile = count(&[kind.name(), size, what], what == "boxes")?;
                write!(text, "| {:.2} ", profile.total("Ir") as f64 / VIEWS as f64 / 1e6)?;
                if what == "boxes" {
                    misses = profile.total("DLmr") as f64 / VIEWS as f64;
                }
            }
            writeln!(text, "| {misses:.0} |")?;
        }
    }
    Ok(text)
}
