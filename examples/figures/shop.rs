//! Things to make scenes of.

use glam::DVec3;
use nusselt::io::atomic_write;
use nusselt::scene::{FaceSpec, Material, MaterialId, ObjectId, Scene, SceneBuilder, SceneError};
use std::collections::HashMap;
use std::io::{self, Write};
use std::path::Path;

/// Makes scenes of faces, by object and material.
#[derive(Default)]
pub(crate) struct Shop {
    vertices: Vec<DVec3>,
    known: HashMap<[u64; 3], usize>,
    objects: Vec<String>,
    materials: Vec<Material>,
    /// By the numbers of its vertices, of its object and of its material.
    faces: Vec<(Vec<usize>, usize, usize)>,
}

impl Shop {
    /// What follows belongs to it.
    pub(crate) fn object(&mut self, name: &str) {
        self.objects.push(name.to_owned());
    }

    /// What follows is made of it.
    pub(crate) fn material(&mut self, material: Material) {
        self.materials.push(material);
    }

    /// Counter-clockwise seen from its front.
    pub(crate) fn face(&mut self, corners: &[DVec3]) {
        let ring = corners.iter().map(|&corner| self.vertex(corner)).collect();
        self.faces.push((ring, self.objects.len() - 1, self.materials.len() - 1));
    }

    fn vertex(&mut self, at: DVec3) -> usize {
        *self.known.entry(at.to_array().map(f64::to_bits)).or_insert_with(|| {
            self.vertices.push(at);
            self.vertices.len() - 1
        })
    }

    pub(crate) fn scene(&self) -> Result<Scene, SceneError> {
        let mut builder = SceneBuilder::default();
        let objects: Vec<ObjectId> = self.objects.iter().map(|name| builder.add_object(name)).collect();
        let materials: Vec<MaterialId> = self.materials.iter().map(|it| builder.add_material(it.clone())).collect();
        for &at in &self.vertices {
            builder.add_vertex(at);
        }
        for (ring, object, material) in &self.faces {
            let rings = vec![ring.clone()];
            builder.add_face(FaceSpec { rings, object: objects[*object], material: materials[*material] });
        }
        builder.build()
    }

    /// Writes it as `NAME.obj` and `NAME.mtl`.
    pub(crate) fn write(&self, folder: &Path, name: &str) -> io::Result<()> {
        atomic_write(&folder.join(format!("{name}.mtl")), |out| {
            for Material { name, diffuse, specular, exponent, emission, .. } in &self.materials {
                writeln!(out, "newmtl {name}")?;
                for (word, [r, g, b]) in [("Kd", diffuse), ("Ks", specular), ("Ke", emission)] {
                    writeln!(out, "{word} {r} {g} {b}")?;
                }
                writeln!(out, "Ns {exponent}")?;
            }
            Ok::<(), io::Error>(())
        })?;
        atomic_write(&folder.join(format!("{name}.obj")), |out| {
            writeln!(out, "mtllib {name}.mtl")?;
            for DVec3 { x, y, z } in &self.vertices {
                writeln!(out, "v {x} {y} {z}")?;
            }
            let mut last = (usize::MAX, usize::MAX);
            for (ring, object, material) in &self.faces {
                if last.0 != *object {
                    writeln!(out, "o {}", self.objects[*object])?;
                }
                if last.1 != *material {
                    writeln!(out, "usemtl {}", self.materials[*material].name)?;
                }
                last = (*object, *material);
                let ring: Vec<String> = ring.iter().map(|vertex| (vertex + 1).to_string()).collect();
                writeln!(out, "f {}", ring.join(" "))?;
            }
            Ok::<(), io::Error>(())
        })
    }

    /// A bar between two points, with about a square for a section: with edges in 128ths its faces are planar exactly.
    pub(crate) fn bar(&mut self, [from, to]: [DVec3; 2], thickness: f64) {
        let snap = |v: DVec3| (v * 128.0).round() / 128.0;
        let along = snap(to - from);
        let [aside, up] = {
            let aside = along.cross(DVec3::Z).normalize();
            [aside, aside.cross(along).normalize()].map(|v| snap(v * thickness))
        };
        let corner = snap(from) - (aside + up) / 2.0;
        let first = [corner, corner + aside, corner + aside + up, corner + up];
        let last = first.map(|corner| corner + along);
        self.face(&first);
        self.face(&[last[3], last[2], last[1], last[0]]);
        for k in 0..4 {
            let next = (k + 1) % 4;
            self.face(&[first[next], first[k], last[k], last[next]]);
        }
    }

    /// A block with sides along the axes.
    pub(crate) fn block(&mut self, low: [f64; 3], high: [f64; 3]) {
        let [[a, b, c], [d, e, f]] = [low, high];
        self.prism(&[[a, b], [d, b], [d, e], [a, e]], [c, f]);
    }

    /// An icosahedron, its faces divided twice, blown up: 320 triangles.
    pub(crate) fn ball(&mut self, middle: DVec3, radius: f64) {
        let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
        let mut corners = Vec::new();
        for [a, b] in [[-1.0, golden], [1.0, golden], [-1.0, -golden], [1.0, -golden]] {
            corners.extend([[a, b, 0.0], [0.0, a, b], [b, 0.0, a]].map(DVec3::from));
        }
        // Neighbours are 2 apart; those farther away are so by more than 3.
        let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 2.5;
        let mut triangles = Vec::new();
        for a in 0..12 {
            for b in a + 1..12 {
                for c in b + 1..12 {
                    if near(a, b) && near(b, c) && near(c, a) {
                        let [p, q, r] = [a, b, c].map(|k| corners[k].normalize());
                        triangles.push(if (q - p).cross(r - p).dot(p) > 0.0 { [p, q, r] } else { [p, r, q] });
                    }
                }
            }
        }
        for _ in 0..2 {
            let quarters = |[a, b, c]: [DVec3; 3]| {
                let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[p, q]| (p + q).normalize());
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            };
            triangles = triangles.into_iter().flat_map(quarters).collect();
        }
        for triangle in triangles {
            // In steps short enough to write.
            self.face(&triangle.map(|d| ((middle + d * radius) * 1e5).round() / 1e5));
        }
    }

    /// A prism over a polygon that runs counter-clockwise seen from above.
    pub(crate) fn prism(&mut self, base: &[[f64; 2]], [low, high]: [f64; 2]) {
        let at = |z: f64| base.iter().map(move |&[x, y]| DVec3::new(x, y, z)).collect::<Vec<_>>();
        let [bottom, top] = [at(low), at(high)];
        self.face(&top);
        self.face(&bottom.iter().rev().copied().collect::<Vec<_>>());
        for k in 0..base.len() {
            let next = (k + 1) % base.len();
            self.face(&[bottom[k], bottom[next], top[next], top[k]]);
        }
    }
}

/// The corners of a turned rectangle, counter-clockwise, in 128ths.
pub(crate) fn turned([x, y]: [f64; 2], [width, depth]: [f64; 2], degrees: f64) -> [[f64; 2]; 4] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let snap = |x: f64| (x * 128.0).round() / 128.0;
    let [a, b] = [[cosine * width, sine * width], [-sine * depth, cosine * depth]].map(|v| v.map(|x| snap(x / 2.0)));
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[right, up]| [snap(x) + right * a[0] + up * b[0], snap(y) + right * a[1] + up * b[1]])
}
