//! The formats that are written, by the ending of the file's name.

use super::ends_with;
use nusselt::io::PointFactorsFormat;
use std::path::Path;

pub(super) fn format(path: &Path) -> Result<PointFactorsFormat, String> {
    if ends_with(path, "csv") {
        return Ok(PointFactorsFormat::Csv);
    }
    if ends_with(path, "json") {
        return Ok(PointFactorsFormat::Json);
    }
    if ends_with(path, "parquet") {
        #[cfg(feature = "parquet")]
        return Ok(PointFactorsFormat::Parquet);
        #[cfg(not(feature = "parquet"))]
        return Err(
            "this build is without the feature parquet; build it with --features parquet, or take .csv".to_owned()
        );
    }
    Err("its ending is none of .csv, .json, .parquet".to_owned())
}
