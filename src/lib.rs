//! Exact from-point visibility: the *contour image* of a scene of planar polygons.
//!
//! Seen from a point, a scene divides the directions around that point into convex cells, in each of
//! which one polygon is seen, or nothing. This crate computes that subdivision exactly: no sampling, no
//! resolution, no epsilon. From the cells follow solid angles and form factors (view factors), sky view
//! factors, and drawings of what is seen.
//!
//! ```
//! use nusselt::contour::{Domain, SceneOrder, Viewpoint};
//! use nusselt::samples::{Kind, generate};
//! use nusselt::scene::{PolygonId, Side};
//!
//! let scene = generate(Kind::Room, 1_000, 1)?.to_builder().build()?; // or io::read_scene(path)
//! let order = SceneOrder::new(&scene); // once a scene, shared by threads
//! let viewpoint = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, glam::DVec3::ZERO)?;
//! let image = order.view(&viewpoint, &Domain::Above)?;
//! let factors = image.form_factors().expect("a hemisphere has a normal");
//! assert!((factors.total() - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The modules, from the lowest to the highest; none uses a higher one:
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`exact`] | signs of real numbers, never rounded |
//! | [`scene`] | polygons, objects, materials; building and checking them |
//! | [`verify`] | proofs of contour images, an exact ray oracle, outside opinions; shares nothing with what follows |
//! | [`bsp`] | the 3D BSP: front-to-back order from any point |
//! | [`bvh`] | a hierarchy of boxes: the second way to a view, without cutting polygons |
//! | [`contour`] | the 2D BSP on the sphere of directions, contour images and their cells |
//! | [`integral`] | solid angles and form factors of cells; moments and cubature over spherical polygons |
//! | [`brdf`] | reflection: BRDFs, and the radiance reflected from what is seen |
//! | [`factors`] | form factors from points, and between patches: the matrix, row by row |
//! | [`radiosity`] | diffuse interreflection: progressive refinement, and radiosities of points |
//! | [`hemicube`] | baselines to compare with: the hemicube, with analytic form factors too, and rays |
//! | [`picture`] | pictures in pixels, by exact areas |
//! | [`render`] | pictures of what a camera sees, shaded by contour images, hemicubes or rays |
//! | [`samples`] | scenes of our own: a Cornell box and a generator |
//! | [`io`] | reading scenes, writing results |
//! | `testing` | with the feature of that name: strategies, degenerate scenes and checks for property tests |
//!
//! Source: P. Jacob, *Evaluation of a BRDF using BSP Trees*, Interner Bericht 272/95, University of
//! Kaiserslautern, 1995.

pub mod brdf;
pub mod bsp;
pub mod bvh;
pub mod contour;
pub mod exact;
pub mod factors;
pub mod hemicube;
pub mod integral;
pub mod io;
mod parallel;
pub mod picture;
pub mod radiosity;
pub mod render;
pub mod samples;
pub mod scene;
#[cfg(feature = "testing")]
pub mod testing;
pub mod verify;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
