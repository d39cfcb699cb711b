//! The JSON of glTF, as far as it says what a scene is made of.

use super::super::absent::or_default;
use super::super::number::shown;
use super::super::told::told;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt::Formatter;
use std::marker::PhantomData;

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Root {
    asset: Asset,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) extensions_required: Vec<String>,
    pub(super) scene: Option<usize>,
    #[serde(default, deserialize_with = "bounded")]
    pub(super) scenes: Vec<Scene>,
    #[serde(default, deserialize_with = "bounded")]
    pub(super) nodes: Vec<Node>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) meshes: Vec<Mesh>,
    #[serde(default, deserialize_with = "bounded")]
    pub(super) materials: Vec<Material>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) buffer_views: Vec<View>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) buffers: Vec<Buffer>,
}

/// Of what takes a few bytes in the file, but many in memory, a file may have so many.
const MOST: usize = 1 << 20;

/// A list of at most [`MOST`] items; none if it is `null`.
fn bounded<'de, D: Deserializer<'de>, T: Deserialize<'de>>(list: D) -> Result<Vec<T>, D::Error> {
    struct Bounded<T>(PhantomData<T>);

    impl<'de, T: Deserialize<'de>> Visitor<'de> for Bounded<T> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
            f.write_str("a list")
        }

        fn visit_none<E: Error>(self) -> Result<Vec<T>, E> {
            Ok(Vec::new())
        }

        fn visit_some<D: Deserializer<'de>>(self, list: D) -> Result<Vec<T>, D::Error> {
            list.deserialize_seq(self)
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Vec<T>, A::Error> {
            let mut list = Vec::new();
            while let Some(item) = items.next_element()? {
                if list.len() == MOST {
                    return Err(Error::custom(format_args!("a list has more than {MOST} items; split the file")));
                }
                list.push(item);
            }
            Ok(list)
        }
    }

    list.deserialize_option(Bounded(PhantomData))
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: String,
    min_version: Option<String>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Scene {
    #[serde(default, deserialize_with = "or_default")]
    pub(super) nodes: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) children: Vec<usize>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) extensions: NodeExtensions,
}

impl Node {
    /// True if it is not to be seen, and what hangs on it is not.
    pub(super) fn is_hidden(&self) -> bool {
        self.extensions.visibility.as_ref().is_some_and(|visibility| visibility.visible == Some(false))
    }
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(super) instancing: Option<serde::de::IgnoredAny>,
    #[serde(rename = "KHR_node_visibility")]
    visibility: Option<Visibility>,
}

#[derive(Debug, Deserialize)]
struct Visibility {
    visible: Option<bool>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    pub(super) material: Option<usize>,
    mode: Option<u32>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) targets: Vec<serde::de::IgnoredAny>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) extensions: PrimitiveExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct PrimitiveExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub(super) draco: Option<serde::de::IgnoredAny>,
}

impl Primitive {
    /// How the corners make triangles, strips, fans, points or lines: triangles (4) if it is not said.
    pub(super) fn mode(&self) -> u32 {
        self.mode.unwrap_or(4)
    }
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) position: Option<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) normalized: bool,
    pub(super) count: usize,
    pub(super) r#type: String,
    pub(super) sparse: Option<Box<Sparse>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub(super) count: usize,
    pub(super) indices: SparseIndices,
    pub(super) values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub(super) buffer_view: usize,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub(super) buffer_view: usize,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) byte_offset: usize,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub(super) buffer: usize,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) byte_length: usize,
    pub(super) uri: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub(super) name: Option<String>,
    pub(super) pbr_metallic_roughness: Option<Surface>,
    pub(super) emissive_factor: Option<[f64; 3]>,
    pub(super) emissive_texture: Option<serde::de::IgnoredAny>,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) extensions: MaterialExtensions,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Surface {
    pub(super) base_color_factor: Option<[f64; 4]>,
    pub(super) base_color_texture: Option<serde::de::IgnoredAny>,
    pub(super) metallic_factor: Option<f64>,
    pub(super) roughness_factor: Option<f64>,
    pub(super) metallic_roughness_texture: Option<serde::de::IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub(super) emissive_strength: Option<EmissiveStrength>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    pub(super) emissive_strength: Option<f64>,
}

/// Reads it; otherwise says in which line it is wrong (0 if in none), and how.
pub(super) fn parse(text: &[u8]) -> Result<Root, (usize, String)> {
    serde_json::from_slice(text).map_err(|error| (error.line(), told(&error)))
}

/// Refuses versions other than 2, and extensions that change what the scene is.
pub(super) fn check_version(root: &Root) -> Result<(), String> {
    let is_2 = |version: &str| version.split('.').next() == Some("2");
    let Asset { version, min_version } = &root.asset;
    if !is_2(version) || min_version.as_deref().is_some_and(|least| least != "2.0") {
        let version = shown(min_version.as_deref().unwrap_or(version));
        return Err(format!("it takes version {version} of glTF to read it; convert it to 2.0"));
    }
    // What only looks are made of.
    let harmless = ["KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_", "EXT_lights_"];
    let known = ["KHR_mesh_quantization", "KHR_xmp_json_ld", "KHR_animation_pointer"];
    for extension in &root.extensions_required {
        let what = match extension.as_str() {
            "KHR_draco_mesh_compression" => "its meshes are compressed by Draco",
            "EXT_meshopt_compression" | "KHR_meshopt_compression" => "its buffers are compressed by meshoptimizer",
            _ if known.contains(&extension.as_str()) => continue,
            _ if harmless.iter().any(|start| extension.starts_with(start)) => continue,
            _ => "its scene takes an extension that is not known",
        };
        return Err(format!("{what} ({}); write it again without", shown(extension)));
    }
    Ok(())
}
