//! Shadows of a point light: the polygons of a scene, cut exactly into what the light sees and what it does not (Crow 1977; by
//! a contour image of the whole sphere around the light, as [`SceneBvh::view`] makes it).
//!
//! Every piece is sent down the finished contour tree, and falls into convex parts within which it is what is seen, or is not. Which corners lie on the
//! sides of other parts, and in which order, is decided by exact signs, so that all parts together are watertight wherever the scene is.

mod cast;
mod merge;
mod weave;

use crate::bvh::SceneBvh;
use crate::contour::{Domain, ViewError, ViewOptions, ViewSpace, Viewpoint};
use crate::scene::{PieceId, PolygonId, Scene, unit_scale};
use glam::DVec3;

/// The polygons of a scene in parts that a point light reaches, and parts that it does not. See [`SceneBvh::shadows`].
#[derive(Clone, Debug)]
pub struct Shadows {
    scene: Scene,
    light: DVec3,
    vertices: Vec<DVec3>,
    parts: Vec<Part>,
    corners: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Part {
    piece: PieceId,
    is_lit: bool,
    /// Where its corners start.
    start: u32,
}

/// A convex part of a polygon, all lit or all in shadow.
#[derive(Clone, Copy, Debug)]
pub struct ShadowPart<'a> {
    shadows: &'a Shadows,
    number: usize,
}

impl SceneBvh {
    /// Cuts all polygons into what is lit by a point light and what is in shadow. Lit is what the light sees, on either side; where polygons lie
    /// on each other, that is the one that a contour image shows. A polygon whose plane holds the light is in shadow.
    ///
    /// Parts are decided exactly; their corners are rounded, to a few units in the last place. Where two polygons have an edge in common, and where parts of
    /// one polygon meet, they have the same vertices in common, those of shadows that end on the edge included: if the scene is watertight, so are all
    /// parts together. A corner in the middle of a straight side of its own polygon may be left out.
    ///
    /// It takes a view of the whole sphere, and the way of every polygon down the contour tree.
    ///
    /// # Errors
    /// If the light has a coordinate that is not finite, or if what is seen, or all parts, are more than `options.max_cells`.
    ///
    /// ```
    /// # use nusselt::bvh::SceneBvh;
    /// # use nusselt::contour::ViewOptions;
    /// # use nusselt::scene::{Material, Scene};
    /// // A square of 2 x 2 half way between a light and a wall of 10 x 10 has a shadow of 4 x 4 on it.
    /// let vertices = [
    ///     [-5.0, -5.0, 0.0], [5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [-5.0, 5.0, 0.0],
    ///     [-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [1.0, 1.0, 2.0], [-1.0, 1.0, 2.0],
    /// ];
    /// let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
    /// let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build()?;
    /// let shadows = SceneBvh::build(&scene).shadows(glam::DVec3::new(0.0, 0.0, 4.0), &ViewOptions::default())?;
    /// assert_eq!(shadows.areas(), [[84.0, 16.0], [4.0, 0.0]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn shadows(&self, light: DVec3, options: &ViewOptions) -> Result<Shadows, ViewError> {
        let mut space = ViewSpace::new();
        let sight = self.sight(&Viewpoint::free(light), &Domain::Sphere, options, &mut space)?;
        let cast = cast::Cast::new(&self.hierarchy, sight, options.max_cells)?;
        Ok(weave::weave(&self.hierarchy, cast))
    }
}

impl Shadows {
    /// The scene that was cut.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where the light is.
    pub fn light(&self) -> DVec3 {
        self.light
    }

    /// All corners of parts, each once.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// All parts, ascending by polygon.
    pub fn parts(&self) -> impl ExactSizeIterator<Item = ShadowPart<'_>> {
        (0..self.parts.len()).map(|number| ShadowPart { shadows: self, number })
    }

    /// For every polygon the area that is lit and the area that is not, in the square of the scene's unit, by the rounded corners: they
    /// add up to the area of the polygon but for rounding. Infinite where numbers do not hold an area.
    pub fn areas(&self) -> Vec<[f64; 2]> {
        let mut areas = vec![[0.0; 2]; self.scene.polygon_count()];
        for part in self.parts() {
            areas[part.polygon().index()][usize::from(!part.is_lit())] += part.area();
        }
        areas
    }
}

impl<'a> ShadowPart<'a> {
    fn part(self) -> Part {
        self.shadows.parts[self.number]
    }

    /// The polygon that it is part of.
    pub fn polygon(self) -> PolygonId {
        self.shadows.scene.piece(self.piece()).polygon()
    }

    /// The piece of the polygon that it is part of.
    pub fn piece(self) -> PieceId {
        self.part().piece
    }

    /// The light sees it.
    pub fn is_lit(self) -> bool {
        self.part().is_lit
    }

    /// The numbers of its corners among all vertices, counter-clockwise around the polygon's front. Some may lie in the middle of a straight
    /// side, where other parts have a corner; parts thinner than rounding may repeat a position.
    pub fn corners(self) -> &'a [u32] {
        let Shadows { parts, corners, .. } = self.shadows;
        let end = parts.get(self.number + 1).map_or(corners.len(), |next| next.start as usize);
        &corners[self.part().start as usize..end]
    }

    /// Its area in the square of the scene's unit, never below 0; infinite where numbers do not hold it, with sides above 1e154.
    pub fn area(self) -> f64 {
        let corners = self.corners();
        let rounded = |corner: u32| self.shadows.vertices[corner as usize];
        // A power of two, so that products neither overflow nor vanish before the area does.
        let scale = unit_scale(corners.iter().map(|&corner| rounded(corner)));
        let at = |corner: u32| rounded(corner) * scale;
        let first = at(corners[0]);
        let doubled: DVec3 =
            corners[1..].windows(2).map(|pair| (at(pair[0]) - first).cross(at(pair[1]) - at(pair[0]))).sum();
        doubled.length() / 2.0 / scale / scale
    }
}
