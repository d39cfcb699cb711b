//! Files: scenes in, contour images out.

#[cfg(feature = "cli")]
mod contour_json;
mod svg;
mod visible_obj;

#[cfg(feature = "cli")]
pub use contour_json::{CONTOUR_SCHEMA, ContourSummary, DomainRow, ObjectRow, PolygonRow, Share, write_contour_json};
pub use svg::{SvgOptions, write_svg};
pub use visible_obj::{write_fragments_obj, write_materials, write_visible_obj};
