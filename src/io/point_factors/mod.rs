//! Form factors from points as files: schema `nusselt.point-factors/1`, CSV and Parquet, written point by point.

mod csv;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "parquet")]
mod parquet;

use crate::factors::{By, PointFactors};
use crate::scene::Scene;
use glam::DVec3;
use std::io::{self, Write};

/// The schema's name.
pub const POINT_FACTORS_SCHEMA: &str = "nusselt.point-factors/1";

/// What the background is called in tables.
pub(super) const BACKGROUND: &str = "background";

/// A format of files of form factors from points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PointFactorsFormat {
    /// A table with the columns `point` (the place in the list, from 0), `name` and `factor`, one factor a line that is not zero. The name is
    /// that of the object, or the number of the polygon; the background comes last, as `background`.
    Csv,
    /// JSON.
    #[cfg(feature = "json")]
    Json,
    /// The table of [`PointFactorsFormat::Csv`] as Parquet.
    #[cfg(feature = "parquet")]
    Parquet,
}

/// Writes form factors from points one after the other: memory does not grow with their number.
///
/// ```
/// use nusselt::contour::{Domain, SceneOrder, Viewpoint};
/// use nusselt::factors::{By, PointSolver};
/// use nusselt::io::{PointFactorsFormat, PointFactorsWriter};
/// use nusselt::scene::{Material, Scene};
/// use glam::DVec3;
///
/// let square = [[0., 0., 1.], [1., 0., 1.], [1., 1., 1.], [0., 1., 1.]];
/// let scene = Scene::builder().mesh(&square, &[vec![0, 1, 2, 3]], Material::new("grey")).build()?;
/// let solver = PointSolver::new(SceneOrder::new(&scene), By::Polygon);
/// let (eye, up) = (DVec3::new(0.0, 0.0, 1.0), DVec3::Z);
/// let mut file = Vec::new();
/// let mut writer = PointFactorsWriter::new(&mut file, PointFactorsFormat::Csv, &scene, By::Polygon)?;
/// writer.write(eye, up, &solver.solve(&Viewpoint::free(eye), &Domain::Hemisphere(up))?)?;
/// writer.finish()?;
/// // On the square itself nothing of it is seen.
/// assert!(String::from_utf8(file)?.starts_with("point,name,factor\n0,background,"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PointFactorsWriter<W: Write + Send> {
    table: Table<W>,
    count: u64,
}

enum Table<W: Write + Send> {
    Csv(csv::Csv<W>),
    #[cfg(feature = "json")]
    Json(W),
    #[cfg(feature = "parquet")]
    Parquet(Box<parquet::Parquet<W>>),
}

impl<W: Write + Send> PointFactorsWriter<W> {
    /// Starts a file. `out` should be buffered.
    ///
    /// # Errors
    /// If writing fails.
    pub fn new(out: W, format: PointFactorsFormat, scene: &Scene, by: By) -> io::Result<Self> {
        let table = match format {
            PointFactorsFormat::Csv => Table::Csv(csv::Csv::new(out, names(scene, by))?),
            #[cfg(feature = "json")]
            PointFactorsFormat::Json => {
                let mut out = out;
                json::start(&mut out, scene, by)?;
                Table::Json(out)
            }
            #[cfg(feature = "parquet")]
            PointFactorsFormat::Parquet => Table::Parquet(Box::new(parquet::Parquet::new(out, names(scene, by))?)),
        };
        Ok(Self { table, count: 0 })
    }

    /// Writes the next point: where it is and its normal, as they were given, and its factors.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&mut self, point: DVec3, normal: DVec3, factors: &PointFactors) -> io::Result<()> {
        let number = self.count;
        self.count += 1;
        match &mut self.table {
            Table::Csv(csv) => {
                let _ = (point, normal);
                csv.write(number, factors)
            }
            #[cfg(feature = "json")]
            Table::Json(out) => json::write(out, number, point, normal, factors),
            #[cfg(feature = "parquet")]
            Table::Parquet(table) => table.write(number, factors),
        }
    }

    /// Hands on what was written so far.
    ///
    /// # Errors
    /// If writing fails.
    pub fn flush(&mut self) -> io::Result<()> {
        match &mut self.table {
            Table::Csv(csv) => csv.flush(),
            #[cfg(feature = "json")]
            Table::Json(out) => out.flush(),
            // In groups of rows, when they are full.
            #[cfg(feature = "parquet")]
            Table::Parquet(_) => Ok(()),
        }
    }

    /// How many points were written.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Ends the file, and gives back what it was written to, flushed.
    ///
    /// # Errors
    /// If writing fails.
    pub fn finish(self) -> io::Result<W> {
        let mut out = match self.table {
            Table::Csv(csv) => csv.finish(),
            #[cfg(feature = "json")]
            Table::Json(mut out) => {
                json::finish(&mut out, self.count)?;
                out
            }
            #[cfg(feature = "parquet")]
            Table::Parquet(table) => table.finish()?,
        };
        out.flush()?;
        Ok(out)
    }
}

/// The names of objects; `None` for polygons, which are named by their numbers.
fn names(scene: &Scene, by: By) -> Option<&[String]> {
    match by {
        By::Object => Some(scene.objects()),
        By::Polygon => None,
    }
}

#[cfg(test)]
mod tests;
