//! The patches apart from the matrix: which row is where.

use super::MatrixError;
use super::rows::RowsReader;
use crate::factors::PatchInfo;
use crate::io::number::Shortest;
use crate::io::obj;
use crate::io::quoted::quoted;
use std::io::{self, Write};
use std::path::Path;

/// A format of files of patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PatchesFormat {
    /// `.csv`: a line for each patch, in the order of rows and columns: `row`, `name`, `polygon`, `area`, the center and the normal; these are empty where
    /// there are none.
    Csv,
    /// `.obj`: a group `patch_I` for each patch, in the same order, with its pieces; without any for a patch without area.
    Obj,
}

impl PatchesFormat {
    /// The format of a file, by the ending of its name, in upper or lower case; `None` if it is not known.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_string_lossy().to_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "obj" => Some(Self::Obj),
            _ => None,
        }
    }

    /// Writes patches in the order of their numbers. `out` should be buffered.
    ///
    /// ```
    /// use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan};
    /// use nusselt::io::matrix::PatchesFormat;
    ///
    /// let square = [[0., 0., 1.], [2., 0., 1.], [2., 2., 1.], [0., 2., 1.]];
    /// let scene = nusselt::scene::Scene::builder()
    ///     .mesh(&square, &[vec![0, 1, 2, 3]], nusselt::scene::Material::new("grey"))
    ///     .build()?;
    /// let exchange = Exchange::new(&scene, PatchPlan::Polygons, ExchangeOptions::default())?;
    /// let mut table = Vec::new();
    /// PatchesFormat::Csv.write(exchange.patches(), &mut table)?;
    /// let table = String::from_utf8(table)?;
    /// assert_eq!(table.lines().nth(1), Some("0,default,0,4,1,1,1,0,0,1"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(self, patches: &[PatchInfo], out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Csv => csv(patches, out),
            Self::Obj => {
                let groups = patches.iter().enumerate().map(|(row, patch)| obj::Group {
                    name: format!("patch_{row}"),
                    material: None,
                    polygons: patch.shape.as_ref().map_or_else(Vec::new, |shape| shape.pieces.clone()),
                });
                obj::write(out, &groups.collect::<Vec<_>>(), None)
            }
        }
    }
}

fn csv(patches: &[PatchInfo], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "row,name,polygon,area,center_x,center_y,center_z,normal_x,normal_y,normal_z")?;
    for (row, PatchInfo { name, polygon, area, shape }) in patches.iter().enumerate() {
        write!(out, "{row},{},{},{}", quoted(name), polygon.0, Shortest(*area))?;
        for place in [shape.as_ref().map(|shape| shape.center), shape.as_ref().and_then(|shape| shape.normal)] {
            match place {
                Some(p) => write!(out, ",{},{},{}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?,
                None => write!(out, ",,,")?,
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

/// The patches of a file of rows (`.rows`, `.partial`), in the order of their numbers.
///
/// # Errors
/// If it cannot be read, is no file of rows, or is damaged.
pub fn read_patches(path: &Path) -> Result<Vec<PatchInfo>, MatrixError> {
    Ok(RowsReader::open(path)?.patches)
}
