//! A sample scene as plain data.

use super::free::{FreeSpace, Solid};
use crate::scene::{Axis, FaceSpec, Material, MaterialId, ObjectId, SceneBuilder};
use glam::DVec3;
use std::io::{self, Write};

/// A triangle or quad of a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshFace {
    corners: [u32; 4],
    count: u8,
    object: u32,
    material: u32,
}

impl MeshFace {
    /// Its three or four vertices as indices into [`Mesh::vertices`], counter-clockwise seen from
    /// its front.
    pub fn vertices(&self) -> &[u32] {
        &self.corners[..usize::from(self.count)]
    }

    /// The index of its object in [`Mesh::objects`].
    pub fn object(&self) -> usize {
        self.object as usize
    }

    /// The index of its material in [`Mesh::materials`].
    pub fn material(&self) -> usize {
        self.material as usize
    }
}

/// What a face looks like and belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) object: u32,
    pub(super) material: u32,
}

/// A sample scene: triangles and quads with objects and materials, and where it is empty.
#[derive(Clone, Debug)]
pub struct Mesh {
    vertices: Vec<[f64; 3]>,
    faces: Vec<MeshFace>,
    objects: Vec<String>,
    materials: Vec<Material>,
    free: FreeSpace,
}

impl Mesh {
    /// The vertices. Within a closed surface each position occurs once; two surfaces that touch
    /// have vertices of their own.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// The faces; face k becomes polygon k.
    pub fn faces(&self) -> &[MeshFace] {
        &self.faces
    }

    /// The names of the objects; all different.
    pub fn objects(&self) -> &[String] {
        &self.objects
    }

    /// The materials; their names are all different.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The axis along which up is positive.
    pub fn up(&self) -> Axis {
        self.free.up
    }

    /// `count` points inside the scene and outside everything that stands in it, at least
    /// [`Mesh::margin`] from every surface, spread evenly over such places. The same for the same
    /// seed on every platform.
    ///
    /// Expected cost: `count` times the number of things in the scene.
    pub fn free_points(&self, count: usize, seed: u64) -> Vec<[f64; 3]> {
        self.free.points(count, seed)
    }

    /// `count` points exactly on the floor, at least [`Mesh::margin`] from the walls and from
    /// everything that stands or hangs nearby; they may be below a table. The floor is horizontal:
    /// their coordinate along [`Mesh::up`] is exactly 0. Cost as for [`Mesh::free_points`].
    pub fn floor_points(&self, count: usize, seed: u64) -> Vec<[f64; 3]> {
        self.free.floor_points(count, seed)
    }

    /// A lower bound, up to rounding, on the distance from a point to the nearest surface; 0 inside
    /// solid things and outside the scene. It takes things as their boxes (a house with its roof),
    /// tessellated balls as balls, and the recesses of lamps as closed.
    pub fn clearance(&self, point: [f64; 3]) -> f64 {
        self.free.clearance(point)
    }

    /// How far [`Mesh::free_points`] and [`Mesh::floor_points`] keep from surfaces, in the scene's unit.
    pub fn margin(&self) -> f64 {
        self.free.margin
    }

    /// The scene's builder with everything of this mesh added: face k is polygon k.
    pub fn to_builder(&self) -> SceneBuilder {
        let mut builder = SceneBuilder::default();
        let materials: Vec<MaterialId> =
            self.materials.iter().map(|material| builder.add_material(material.clone())).collect();
        let objects: Vec<ObjectId> = self.objects.iter().map(|name| builder.add_object(name)).collect();
        let vertices: Vec<usize> = self.vertices.iter().map(|&p| builder.add_vertex(DVec3::from(p))).collect();
        for face in &self.faces {
            let ring = face.vertices().iter().map(|&k| vertices[k as usize]).collect();
            builder.add_face(FaceSpec {
                rings: vec![ring],
                object: objects[face.object()],
                material: materials[face.material()],
            });
        }
        builder
    }

    /// Writes Wavefront OBJ that refers to the material library `mtl_name`. Coordinates are the
    /// shortest decimals that read back as the same `f64`; face k of the file is face k.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_obj(&self, mtl_name: &str, mut out: impl Write) -> io::Result<()> {
        writeln!(out, "mtllib {mtl_name}")?;
        for [x, y, z] in &self.vertices {
            writeln!(out, "v {x} {y} {z}")?;
        }
        let (mut object, mut material) = (None, None);
        for face in &self.faces {
            if object.replace(face.object) != Some(face.object) {
                writeln!(out, "o {}", self.objects[face.object()])?;
            }
            if material.replace(face.material) != Some(face.material) {
                writeln!(out, "usemtl {}", self.materials[face.material()].name)?;
            }
            write!(out, "f")?;
            for &k in face.vertices() {
                write!(out, " {}", u64::from(k) + 1)?;
            }
            writeln!(out)?;
        }
        out.flush()
    }

    /// Writes the material library that belongs to [`Mesh::write_obj`]'s file.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_mtl(&self, mut out: impl Write) -> io::Result<()> {
        for material in &self.materials {
            writeln!(out, "newmtl {}", material.name)?;
            let colours = [("Kd", material.diffuse), ("Ks", material.specular), ("Ke", material.emission)];
            for (key, [r, g, b]) in colours {
                writeln!(out, "{key} {r} {g} {b}")?;
            }
            writeln!(out, "Ns {}", material.exponent)?;
        }
        out.flush()
    }

    /// An empty scene in that air.
    pub(super) fn empty(free: FreeSpace) -> Self {
        Self { vertices: Vec::new(), faces: Vec::new(), objects: Vec::new(), materials: Vec::new(), free }
    }

    /// Adds an object and gives its index; the caller sees to it that the name is new.
    pub(super) fn add_object(&mut self, name: String) -> u32 {
        self.objects.push(name);
        self.objects.len() as u32 - 1
    }

    /// The material of that name, added if there is none yet.
    pub(super) fn add_material(&mut self, material: Material) -> u32 {
        let found = self.materials.iter().position(|known| known.name == material.name);
        found.unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        }) as u32
    }

    /// Adds a vertex and gives its index. The limit on polygons keeps it within 32 bits.
    pub(super) fn add_vertex(&mut self, position: [f64; 3]) -> u32 {
        self.vertices.push(position);
        self.vertices.len() as u32 - 1
    }

    /// Adds a triangle.
    pub(super) fn add_triangle(&mut self, [a, b, c]: [u32; 3], look: Look) {
        self.push(MeshFace { corners: [a, b, c, c], count: 3, object: look.object, material: look.material });
    }

    /// Adds a quad.
    pub(super) fn add_quad(&mut self, corners: [u32; 4], look: Look) {
        self.push(MeshFace { corners, count: 4, object: look.object, material: look.material });
    }

    /// Adds something that points have to keep away from.
    pub(super) fn add_solid(&mut self, solid: Solid) {
        self.free.solids.push(solid);
    }

    /// The air and what stands in it.
    #[cfg(test)]
    pub(super) fn free_space(&self) -> &FreeSpace {
        &self.free
    }

    /// Cuts `extra` quads, spread evenly, along a diagonal: that many more faces, and no new vertex.
    ///
    /// # Panics
    /// If there are fewer quads; the generators plan for far less.
    pub(super) fn cut_quads(&mut self, extra: usize) {
        let quads = self.faces.iter().filter(|face| face.count == 4).count();
        assert!(extra <= quads, "{extra} of {quads} quads cannot be cut");
        let mut seen = 0;
        let faces = std::mem::take(&mut self.faces);
        self.faces.reserve_exact(faces.len() + extra);
        for face in faces {
            if face.count != 4 {
                self.faces.push(face);
                continue;
            }
            seen += 1;
            if seen * extra / quads == (seen - 1) * extra / quads {
                self.faces.push(face);
            } else {
                let [a, b, c, d] = face.corners;
                self.faces.push(MeshFace { corners: [a, b, c, c], count: 3, ..face });
                self.faces.push(MeshFace { corners: [a, c, d, d], count: 3, ..face });
            }
        }
    }

    fn push(&mut self, face: MeshFace) {
        self.faces.push(face);
    }
}
