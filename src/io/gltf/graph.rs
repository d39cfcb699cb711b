//! The nodes of the default scene, with their transforms.

use super::json::{Node, Root};
use glam::{DAffine3, DMat3, DQuat, DVec3, DVec4};

/// A mesh at a place.
#[derive(Debug)]
pub(super) struct Instance {
    pub(super) node: usize,
    pub(super) mesh: usize,
    /// From the coordinates of the mesh to those of the scene.
    pub(super) transform: DAffine3,
}

/// What is in the default scene.
#[derive(Debug)]
pub(super) struct Walk {
    pub(super) instances: Vec<Instance>,
    /// For every node of the file whether it is part of the scene.
    pub(super) is_reached: Vec<bool>,
}

/// Every mesh of the default scene, depth-first; otherwise the node that is at fault, and why.
///
/// The default scene is `scene`, else the first. Every node may be reached once, so that this takes time in
/// proportion to the number of nodes.
pub(super) fn walk(root: &Root) -> Result<Walk, (String, String)> {
    let number = root.scene.unwrap_or(0);
    let Some(scene) = root.scenes.get(number) else {
        if root.scene.is_none() {
            return Err(("scenes".to_owned(), "there is no scene; write the file with one".to_owned()));
        }
        return Err(("scene".to_owned(), format!("there is no scene {number}; the file has {}", root.scenes.len())));
    };
    let mut instances = Vec::new();
    let mut is_reached = vec![false; root.nodes.len()];
    let mut pending: Vec<_> = scene.nodes.iter().rev().map(|&node| (node, DAffine3::IDENTITY)).collect();
    while let Some((number, parent)) = pending.pop() {
        let fault = |what: String| Err((format!("node {number}"), what));
        let Some(node) = root.nodes.get(number) else {
            return fault(format!("there is no such node; the file has {}", root.nodes.len()));
        };
        if std::mem::replace(&mut is_reached[number], true) {
            return fault("it is reached twice; a node takes one parent, and no cycle".to_owned());
        }
        let transform = match local(node) {
            Ok(local) => parent * local,
            Err(what) => return fault(what),
        };
        if !transform.is_finite() {
            return fault("its transform is not finite".to_owned());
        }
        if let Some(mesh) = node.mesh {
            if mesh >= root.meshes.len() {
                return fault(format!("there is no mesh {mesh}; the file has {}", root.meshes.len()));
            }
            instances.push(Instance { node: number, mesh, transform });
        }
        pending.extend(node.children.iter().rev().map(|&child| (child, transform)));
    }
    Ok(Walk { instances, is_reached })
}

/// The transform of a node in its parent.
#[expect(clippy::float_cmp, reason = "the last row of an affine matrix is 0 0 0 1 exactly")]
fn local(node: &Node) -> Result<DAffine3, String> {
    let has_parts = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    if let Some(matrix) = &node.matrix {
        if has_parts {
            return Err("it has a matrix and a translation, rotation or scale; it takes one or the other".to_owned());
        }
        let column = |k: usize| DVec4::from_slice(&matrix[4 * k..][..4]);
        let columns = [0, 1, 2, 3].map(column);
        if columns.map(|column| column.w) != [0.0, 0.0, 0.0, 1.0] {
            return Err("the last row of its matrix is not 0 0 0 1".to_owned());
        }
        let [x, y, z, translation] = columns.map(DVec4::truncate);
        return Ok(DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation });
    }
    let rotation = match node.rotation {
        None => DMat3::IDENTITY,
        Some(quaternion) => {
            // It is one of length 1, but for rounding.
            let unit = DVec4::from(quaternion).try_normalize().ok_or("its rotation has no length")?;
            DMat3::from_quat(DQuat::from_vec4(unit))
        }
    };
    let scale = DMat3::from_diagonal(node.scale.map_or(DVec3::ONE, DVec3::from));
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from);
    Ok(DAffine3 { matrix3: rotation * scale, translation })
}
