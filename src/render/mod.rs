//! Pictures of a scene as a camera sees it: exact visibility from the eye, and at each point that is seen exact visibility again.
//!
//! [`render`] cuts the contour image of a camera along the borders of pixels ([`PixelParts`](crate::picture::PixelParts)): which polygon is seen in a pixel, and in what part
//! of it, is not sampled. A [`Shader`] tells the radiance that each part sends to the eye: light of lamps from what is seen of them through windows, so that shadows are
//! soft without noise; lights without extent by exact shadow tests; interreflection from a solution of the radiosity ([`Indirect`]); gloss by the integral of the
//! BRDF over all that is seen; mirrors by what is seen in them, cut along pixels in the same way where the camera sees a flat mirror.
//!
//! In place of the contour image a shader can take a hemicube (Meyer, *Hemi-Cube Ray-Tracing: A Method for Generating Soft Shadows*, 1990) or random rays at each
//! point ([`Shading`]), for comparisons.
//!
//! ```
//! use glam::{DVec3, UVec2};
//! use nusselt::brdf::Lighting;
//! use nusselt::contour::{Frustum, SceneOrder};
//! use nusselt::render::{Shader, ShaderOptions, render};
//!
//! let scene = nusselt::samples::cornell_box().to_builder().build()?;
//! let shader = Shader::new(SceneOrder::new(&scene), Lighting::default(), ShaderOptions::default())?;
//! let camera = Frustum::new(DVec3::Z, DVec3::Y, 40.0, 1.0)?;
//! let rendered = render(&shader, DVec3::new(278.0, 273.0, -800.0), &camera, UVec2::new(16, 16), &|_| ())?;
//! assert!(rendered.picture.pixels().iter().any(|pixel| pixel.x > 0.1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod before;
mod contour;
mod error;
mod indirect;
mod leaves;
mod lights;
mod mirrors;
mod mixed;
mod patch_index;
mod picture;
mod sampled;
mod shader;
mod shown;

pub use error::RenderError;
pub use indirect::Indirect;
pub use picture::{Band, Rendered, render, render_bands};
pub use shader::{Shader, ShaderOptions, Shading, Spot};
