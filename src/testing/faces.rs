//! Scenes as plain lists of faces, easy to make, change, print and shrink.

use super::AxisMap;
use crate::scene::{FaceSpec, Material, Scene, SceneBuilder, SceneError};
use glam::DVec3;
use std::fmt;

/// Faces of a scene, each by the positions of its corners, counter-clockwise seen from its front.
///
/// Face `k` becomes polygon `k`; corners with equal coordinates become one vertex. Printed with `{:?}` it is
/// Rust that makes it again.
///
/// ```
/// use nusselt::testing::Faces;
///
/// let mut faces = Faces::default();
/// faces.cuboid([-1.0; 3].into(), [1.0; 3].into());
/// let scene = faces.scene()?;
/// assert_eq!((scene.polygon_count(), scene.vertices().len()), (6, 8));
/// # Ok::<(), nusselt::scene::SceneError>(())
/// ```
#[derive(Clone, Default, PartialEq)]
pub struct Faces {
    loops: Vec<Vec<DVec3>>,
}

impl Faces {
    /// Adds a face; gives its number.
    pub fn push(&mut self, corners: &[DVec3]) -> usize {
        self.loops.push(corners.to_vec());
        self.loops.len() - 1
    }

    /// Adds the parallelogram `a`, `b`, `c`, `a + c - b`. If rounding puts its last corner off the plane
    /// the scene will fold it along a diagonal.
    pub fn parallelogram(&mut self, [a, b, c]: [DVec3; 3]) -> usize {
        self.push(&[a, b, c, a + c - b])
    }

    /// Adds a tetrahedron; fronts outwards if `d` sees `a`, `b`, `c` clockwise.
    pub fn tetrahedron(&mut self, [a, b, c, d]: [DVec3; 4]) {
        for face in [[a, b, c], [a, d, b], [b, d, c], [c, d, a]] {
            self.push(&face);
        }
    }

    /// Adds the six faces of an axis-aligned box, fronts outwards.
    pub fn cuboid(&mut self, low: DVec3, high: DVec3) {
        let corner =
            |k: usize| DVec3::from([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] }));
        for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            self.push(&quad.map(corner));
        }
    }

    /// Adds all faces of another list after its own.
    pub fn append(&mut self, other: &Self) {
        self.loops.extend_from_slice(&other.loops);
    }

    /// The number of faces.
    pub fn len(&self) -> usize {
        self.loops.len()
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.loops.is_empty()
    }

    /// The faces by their corners.
    pub fn loops(&self) -> &[Vec<DVec3>] {
        &self.loops
    }

    /// All corners, one face after the other.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.loops.iter().flatten().copied()
    }

    /// The scene, in one grey material.
    ///
    /// # Errors
    /// If some face is no polygon: too few corners, coordinates that are not finite, a boundary that crosses itself.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let mut builder = SceneBuilder::default();
        let material = builder.add_material(Material::new("grey"));
        let object = builder.add_object("default");
        for corners in &self.loops {
            let ring = corners.iter().map(|&p| builder.add_vertex(p)).collect();
            builder.add_face(FaceSpec { rings: vec![ring], object, material });
        }
        builder.build()
    }

    /// With every corner moved.
    #[must_use]
    pub fn mapped(&self, mut f: impl FnMut(DVec3) -> DVec3) -> Self {
        Self { loops: self.loops.iter().map(|corners| corners.iter().map(|&p| f(p)).collect()).collect() }
    }

    /// With every face seen from its other side.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { loops: self.loops.iter().map(|corners| corners.iter().rev().copied().collect()).collect() }
    }

    /// With axes permuted and mirrored, fronts staying fronts.
    #[must_use]
    pub fn turned(&self, map: AxisMap) -> Self {
        let turned = self.mapped(|p| map.apply(p));
        if map.is_reflection() { turned.reversed() } else { turned }
    }

    /// In another order: face `k` of the result is face `order[k]` of this list. Numbers past the end are
    /// left out.
    #[must_use]
    pub fn reordered(&self, order: &[usize]) -> Self {
        Self { loops: order.iter().filter_map(|&k| self.loops.get(k).cloned()).collect() }
    }

    /// With one face of at least 4 corners cut by its first diagonal, a triangle from its first corner to
    /// the middle of the opposite edge. The first part keeps the number, the second is the last face. Unchanged
    /// for a number past the end. The middle is rounded: exact on a grid.
    #[must_use]
    pub fn split(&self, face: usize) -> Self {
        let mut split = self.clone();
        let Some(corners) = split.loops.get_mut(face) else { return split };
        match *corners.as_slice() {
            [a, b, c] => {
                let middle = (b + c) * 0.5;
                *corners = vec![a, b, middle];
                split.loops.push(vec![a, middle, c]);
            }
            [a, b, c, ref rest @ ..] => {
                let rest = [&[a, c], rest].concat();
                *corners = vec![a, b, c];
                split.loops.push(rest);
            }
            _ => {}
        }
        split
    }
}

impl From<Vec<Vec<[f64; 3]>>> for Faces {
    fn from(loops: Vec<Vec<[f64; 3]>>) -> Self {
        Self { loops: loops.into_iter().map(|corners| corners.into_iter().map(DVec3::from).collect()).collect() }
    }
}

impl fmt::Debug for Faces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Faces::from(vec![")?;
        for corners in &self.loops {
            let corners: Vec<_> = corners.iter().map(DVec3::to_array).collect();
            // Not by `f`, whose `#` would spread it over many lines.
            let line = format!("{corners:?}");
            writeln!(f, "        vec!{line},")?;
        }
        write!(f, "    ])")
    }
}
