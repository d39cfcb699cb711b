//! From nodes, meshes and accessors to faces.

use super::super::draft::{Draft, Unfolding};
use super::super::error::Place;
use super::super::{Loaded, ReadError};
use super::accessor::{Elements, buffers_of};
use super::buffers::Buffers;
use super::graph::{Instance, Walk, walk};
use super::json::{Primitive, Root};
use super::material::{has_texture, material};
use super::primitive::Triangles;
use crate::exact::orient3d;
use crate::scene::{Material, MaterialId, ObjectId};
use glam::DVec3;
use std::collections::HashMap;
use std::io;

/// Builds the scene of a file of so many bytes.
pub(super) fn assemble(
    root: &Root,
    size: usize,
    chunk: Option<&[u8]>,
    mut load: impl FnMut(&str) -> io::Result<Vec<u8>>,
    mut draft: Draft<'_>,
) -> Result<Loaded, ReadError> {
    let Walk { instances, is_reached } = match walk(root) {
        Ok(walk) => walk,
        Err((item, what)) => {
            draft.fault(Place::Item(item), what);
            return Err(draft.into_error());
        }
    };
    let mut is_used = vec![false; root.meshes.len()];
    for instance in &instances {
        is_used[instance.mesh] = true;
    }
    let meshes: Vec<usize> = (0..root.meshes.len()).filter(|&mesh| is_used[mesh]).collect();
    let mut buffers = Buffers::new(root, chunk);
    let accessors = accessors(root, &meshes, &mut draft);
    load_buffers(root, &accessors, &mut buffers, &mut load, &mut draft);
    if !draft.faults.is_empty() {
        return Err(draft.into_error());
    }
    let elements = elements(root, &accessors, &buffers, &mut draft);
    if !draft.faults.is_empty() {
        return Err(draft.into_error());
    }
    let triangles = triangles(root, &meshes, &elements, &mut draft);
    let unfolding = Unfolding::of(size as u64 + buffers.size());
    if let Err((item, what)) = check_size(&instances, &triangles, unfolding) {
        draft.fault(Place::Item(item), what);
    }
    if !draft.faults.is_empty() {
        return Err(draft.into_error());
    }
    warn(root, &instances, &is_reached, &meshes, &mut draft);
    let mut builder = Builder {
        root,
        triangles: &triangles,
        draft,
        materials: HashMap::new(),
        origins: Vec::new(),
        runs: Vec::new(),
        count: 0,
    };
    for instance in &instances {
        builder.add(instance);
    }
    builder.finish()
}

/// Which accessors the meshes take.
fn accessors(root: &Root, meshes: &[usize], draft: &mut Draft<'_>) -> Vec<bool> {
    let mut is_used = vec![false; root.accessors.len()];
    for &mesh in meshes {
        for (number, primitive) in root.meshes[mesh].primitives.iter().enumerate() {
            // Points and lines are passed over.
            if primitive.mode() < 4 {
                continue;
            }
            for accessor in [primitive.attributes.position, primitive.indices].into_iter().flatten() {
                let place = || Place::Item(format!("mesh {mesh}, primitive {number}"));
                match is_used.get_mut(accessor) {
                    Some(is_used) => *is_used = true,
                    None => draft.fault(place(), format_args!("there is no accessor {accessor}")),
                }
            }
        }
    }
    is_used
}

fn load_buffers(
    root: &Root,
    accessors: &[bool],
    buffers: &mut Buffers<'_>,
    load: &mut impl FnMut(&str) -> io::Result<Vec<u8>>,
    draft: &mut Draft<'_>,
) {
    let used = root.accessors.iter().zip(accessors).filter(|(_, is_used)| **is_used);
    let mut numbers: Vec<usize> = used.flat_map(|(accessor, _)| buffers_of(root, accessor)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    for buffer in numbers {
        if let Err(what) = buffers.load(root, buffer, load) {
            draft.fault(Place::Item(format!("buffer {buffer}")), what);
        }
    }
}

/// For each accessor its elements, if it is used.
fn elements<'a>(
    root: &Root,
    accessors: &[bool],
    buffers: &'a Buffers<'_>,
    draft: &mut Draft<'_>,
) -> Vec<Option<Elements<'a>>> {
    let mut list = Vec::with_capacity(accessors.len());
    for (number, (accessor, is_used)) in root.accessors.iter().zip(accessors).enumerate() {
        let result = is_used.then(|| Elements::new(root, buffers, accessor)).transpose();
        list.push(result.unwrap_or_else(|what| {
            draft.fault(Place::Item(format!("accessor {number}")), what);
            None
        }));
    }
    list
}

/// For each mesh its primitives; those without triangles are `None`.
type Meshes<'a> = Vec<Vec<Option<Triangles<'a>>>>;

fn triangles<'a>(
    root: &Root,
    meshes: &[usize],
    elements: &'a [Option<Elements<'a>>],
    draft: &mut Draft<'_>,
) -> Meshes<'a> {
    let mut list: Meshes<'a> = root.meshes.iter().map(|_| Vec::new()).collect();
    let (mut ignored, mut without_positions) = (0_usize, 0_usize);
    for &mesh in meshes {
        for (number, primitive) in root.meshes[mesh].primitives.iter().enumerate() {
            let triangles = check_form(root, primitive).and_then(|()| Triangles::new(primitive, elements));
            let triangles = triangles.unwrap_or_else(|what| {
                draft.fault(Place::Item(format!("mesh {mesh}, primitive {number}")), what);
                None
            });
            let is_known = primitive.material.is_none_or(|material| material < root.materials.len());
            if !is_known {
                let count = root.materials.len();
                let what = format!("it takes a material that is not there; the file has {count}");
                draft.fault(Place::Item(format!("mesh {mesh}, primitive {number}")), what);
            }
            *(if primitive.mode() < 4 { &mut ignored } else { &mut without_positions }) +=
                usize::from(triangles.is_none());
            list[mesh].push(triangles);
        }
    }
    if ignored > 0 && draft.faults.is_empty() {
        draft.warn(&Place::File, format_args!("{ignored} primitives of points or lines were ignored"));
    }
    if without_positions > 0 && draft.faults.is_empty() {
        let what = format_args!("{without_positions} primitives of triangles have no positions and were ignored");
        draft.warn(&Place::File, what);
    }
    list
}

/// Refuses a primitive whose triangles are there in compressed form only.
fn check_form(root: &Root, primitive: &Primitive) -> Result<(), String> {
    if primitive.extensions.draco.is_none() {
        return Ok(());
    }
    let is_there = |&accessor: &usize| {
        let accessor = root.accessors.get(accessor);
        accessor.is_none_or(|accessor| accessor.buffer_view.is_some() || accessor.sparse.is_some())
    };
    if [primitive.attributes.position, primitive.indices].iter().flatten().all(is_there) {
        return Ok(());
    }
    Err("its triangles are there only as compressed by Draco (`KHR_draco_mesh_compression`); write it again without"
        .to_owned())
}

/// Checks that the instances of meshes do not unfold to too many triangles.
fn check_size(instances: &[Instance], meshes: &Meshes<'_>, mut limit: Unfolding) -> Result<(), (String, String)> {
    let sizes: Vec<u64> = meshes
        .iter()
        .map(|mesh| {
            // A primitive without triangles takes time too.
            let sizes = mesh.iter().map(|triangles| triangles.as_ref().map_or(0, |t| t.count as u64).saturating_mul(3));
            sizes.fold(0, |sum: u64, size| sum.saturating_add(size.max(1)))
        })
        .collect();
    for Instance { node, mesh, .. } in instances {
        limit.take(sizes[*mesh]).map_err(|what| (format!("node {node}, mesh {mesh}"), what))?;
    }
    Ok(())
}

/// Says what is ignored.
fn warn(root: &Root, instances: &[Instance], is_reached: &[bool], meshes: &[usize], draft: &mut Draft<'_>) {
    let primitives = || meshes.iter().flat_map(|&mesh| &root.meshes[mesh].primitives);
    let mut is_used = vec![false; root.materials.len()];
    for material in primitives().filter_map(|primitive| primitive.material) {
        is_used[material] = true;
    }
    let textured = root.materials.iter().zip(is_used).filter(|(material, is_used)| *is_used && has_texture(material));
    let counts = [
        (textured.count(), "materials have textures, which are not read: their factors alone are taken"),
        (
            primitives().filter(|primitive| !primitive.targets.is_empty()).count(),
            "primitives have morph targets, which are not applied",
        ),
        (
            instances.iter().filter(|instance| root.nodes[instance.node].skin.is_some()).count(),
            "nodes have skins, which are not applied",
        ),
        (
            instances.iter().filter(|instance| root.nodes[instance.node].extensions.instancing.is_some()).count(),
            "nodes are instanced by EXT_mesh_gpu_instancing, which is not applied: each is there once, where it is itself",
        ),
        (
            root.nodes.iter().zip(is_reached).filter(|(node, is_reached)| **is_reached && node.is_hidden()).count(),
            "nodes are not to be visible by KHR_node_visibility, which is not applied: they are there",
        ),
    ];
    for (count, what) in counts.into_iter().filter(|(count, _)| *count > 0) {
        draft.warn(&Place::File, format_args!("{count} {what}"));
    }
}

/// Faces that follow each other: the triangles of one primitive of one node.
struct Run {
    first: usize,
    node: usize,
    mesh: usize,
    primitive: usize,
}

impl Run {
    fn place(&self, face: usize) -> Place {
        let Self { first, node, mesh, primitive } = self;
        Place::Item(format!("node {node}, mesh {mesh}, primitive {primitive}, triangle {}", face - first))
    }
}

struct Builder<'a, 'd> {
    root: &'a Root,
    triangles: &'a Meshes<'a>,
    draft: Draft<'d>,
    materials: HashMap<Option<usize>, MaterialId>,
    /// For each material that was added its number in the file.
    origins: Vec<Option<usize>>,
    runs: Vec<Run>,
    /// How many faces there are.
    count: usize,
}

impl Builder<'_, '_> {
    fn add(&mut self, instance: &Instance) {
        let Instance { node, mesh, transform } = instance;
        let all = self.triangles;
        for (number, triangles) in all[*mesh].iter().enumerate() {
            let Some(triangles) = triangles else { continue };
            let object = self.object(*node, *mesh);
            let material = self.material(self.root.meshes[*mesh].primitives[number].material);
            let run = Run { first: self.count, node: *node, mesh: *mesh, primitive: number };
            let axes = transform.matrix3;
            let is_mirrored = orient3d(DVec3::ZERO, axes.x_axis, axes.y_axis, axes.z_axis).is_negative();
            for k in 0..triangles.count {
                let place = || run.place(run.first + k);
                let mut corners = triangles.corners(k);
                if is_mirrored {
                    corners.swap(0, 1);
                }
                let count = triangles.positions().count;
                let position = |corner| transform.transform_point3(triangles.positions().position(corner));
                let known = corners.into_iter().filter(|&corner| corner < count);
                let ring = known.map(|corner| self.draft.add_vertex(position(corner), place)).collect();
                match corners.into_iter().find(|&corner| corner >= count) {
                    None => self.draft.add_face(vec![ring], object, material),
                    Some(unknown) => {
                        let what = format!("there is no vertex {unknown}; the primitive has {count}");
                        self.draft.refuse_face(place(), &what);
                        self.draft.add_broken_face(what, vec![ring], object, material);
                    }
                }
            }
            self.count += triangles.count;
            self.runs.push(run);
        }
    }

    fn object(&mut self, node: usize, mesh: usize) -> ObjectId {
        let named = self.root.nodes[node].name.as_ref().or(self.root.meshes[mesh].name.as_ref());
        match named {
            Some(name) => self.draft.builder.add_object(name),
            None => self.draft.builder.add_object(&format!("node_{node}")),
        }
    }

    fn material(&mut self, number: Option<usize>) -> MaterialId {
        if let Some(&known) = self.materials.get(&number) {
            return known;
        }
        let from = number.and_then(|number| Some(material(number, self.root.materials.get(number)?)));
        let id = self.draft.builder.add_material(from.unwrap_or_else(|| Material::new("default")));
        self.origins.push(number);
        self.materials.insert(number, id);
        id
    }

    fn finish(self) -> Result<Loaded, ReadError> {
        let (runs, origins) = (self.runs, self.origins);
        let face = |k: usize| {
            let run = runs.partition_point(|run| run.first <= k).checked_sub(1).and_then(|run| runs.get(run));
            run.map_or(Place::File, |run| run.place(k))
        };
        let name = self.draft.name().to_owned();
        let material = |k: usize| {
            let number = origins.get(k).copied().flatten()?;
            Some((name.clone(), Place::Item(format!("material {number}"))))
        };
        self.draft.finish(face, material)
    }
}
