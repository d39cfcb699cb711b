//! Certificates as JSON: schema `nusselt.certificate/1`, what a contour image claims and how it can be proved.
//!
//! ```json
//! {"schema": "nusselt.certificate/1",
//! "scene": {"vertices": 8, "polygons": 6, "pieces": 6},
//! "eye": [0.5, 0.5, 0.5],
//! "domain": {"kind": "hemisphere", "normal": [0.0, 0.0, 1.0]},
//! "epsilon": 0.0,
//! "slivers": [],
//! "splitters": [
//! {"given": [0.0, 0.0, 1.0]},
//! {"edge": [4, 5]},
//! {"crease": [{"points": [0, 1, 2]}, {"x": 0.5}]},
//! {"parallel": {"z": 0.0}}
//! ],
//! "cells": [
//! {"piece": 5, "sides": [1, 2, -3]},
//! {"piece": null, "sides": [-2, 4, 3]}
//! ]}
//! ```
//!
//! *Scene*: how many vertices, polygons and convex pieces there are, so that another scene is told plainly. *Domain*:
//! `sphere`, `hemisphere` with its `normal`, `above` with a `piece` and its `side`, `frustum` with its four `normals` to the inside, or `window`
//! with its `panes`, each a `polygon` of the scene or a `ring` of points, and its `horizon`, a `normal`, `above` a piece, or `null`. *Splitters*: great circles by
//! what defines them, an `edge` by its vertices, a line through two `points`, a `crease` by two planes, a `given` normal, or a plane moved
//! to the eye (`parallel`); planes are `points`, three vertices, or one coordinate (`x`, `y`, `z`). *Cells*: the piece
//! that is seen (`null` for background), and the sides counter-clockwise from outside of the sphere: splitters,
//! counted from 1, with the sign that directions inside have. *Slivers*: what epsilon left uncut, as `piece`,
//! `plane` and `beyond` (`front`, `back` or, for both, `null`). Vertices and pieces are numbered as in
//! [`Scene`](crate::scene::Scene), from 0; messages count all items from 0. Nothing in it is rounded: numbers read back as the same f64.

mod error;
mod read;
mod rows;
mod write;

pub use error::CertificateError;
pub use read::{KeptCertificate, read_certificate};
pub use rows::SceneSize;
pub use write::write_certificate;

/// The schema's name.
pub const CERTIFICATE_SCHEMA: &str = "nusselt.certificate/1";

#[cfg(test)]
mod tests;
