//! Radiosities as files: meshes with colours for viewers, tables, a page that shows them, and states to go on from.

mod html;
mod json;
mod mesh;
mod state;

pub use html::write_radiosity_html;
pub use json::{RADIOSITY_SCHEMA, RadiosityTable, write_radiosity_json};
pub use mesh::{auto_exposure, radiosity_meshes, write_radiosity_ply};
pub use state::{HalvingKey, KeptState, STATE_SCHEMA, StateError, StateKey, read_state, write_state};
