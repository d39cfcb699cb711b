//! The JSON of CityJSON, as far as it says what a scene is made of.

use super::super::absent::or_default;
use super::super::number::shown;
use super::super::told::told;
use super::boundary::Nested;
use super::lod::Lod;
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};
use std::fmt;

/// The whole file.
#[derive(Debug, Deserialize)]
pub(super) struct Model {
    r#type: Option<String>,
    version: Option<String>,
    pub(super) transform: Option<Transform>,
    #[serde(rename = "CityObjects", default, deserialize_with = "or_default")]
    pub(super) city_objects: CityObjects,
    #[serde(default, deserialize_with = "or_default")]
    pub(super) vertices: Vec<[f64; 3]>,
    #[serde(rename = "geometry-templates")]
    pub(super) templates: Option<Templates>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Transform {
    pub(super) scale: [f64; 3],
    pub(super) translate: [f64; 3],
}

/// City objects with their ids, in the order of the file.
#[derive(Debug, Default)]
pub(super) struct CityObjects(pub(super) Vec<(String, CityObject)>);

impl<'de> Deserialize<'de> for CityObjects {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Ordered;

        impl<'de> Visitor<'de> for Ordered {
            type Value = CityObjects;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object of city objects")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<CityObjects, A::Error> {
                let mut list = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    list.push(entry);
                }
                Ok(CityObjects(list))
            }
        }

        from.deserialize_map(Ordered)
    }
}

#[derive(Debug, Deserialize)]
pub(super) struct CityObject {
    pub(super) r#type: String,
    pub(super) geometry: Option<Vec<Geometry>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Geometry {
    pub(super) r#type: String,
    pub(super) lod: Option<Lod>,
    #[serde(default)]
    pub(super) boundaries: Nested,
    pub(super) semantics: Option<Semantics>,
    pub(super) template: Option<usize>,
    #[serde(rename = "transformationMatrix")]
    pub(super) matrix: Option<Box<[f64; 16]>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Semantics {
    #[serde(default, deserialize_with = "or_default")]
    pub(super) surfaces: Vec<SemanticSurface>,
    #[serde(default)]
    pub(super) values: Nested,
}

#[derive(Debug, Deserialize)]
pub(super) struct SemanticSurface {
    pub(super) r#type: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct Templates {
    #[serde(default, deserialize_with = "or_default")]
    pub(super) templates: Vec<Geometry>,
    #[serde(rename = "vertices-templates", default, deserialize_with = "or_default")]
    pub(super) vertices: Vec<[f64; 3]>,
}

/// Reads it; otherwise says in which line it is wrong (0 if in none), and how.
pub(super) fn parse(text: &[u8]) -> Result<Model, (usize, String)> {
    let model: Model = serde_json::from_slice(text).map_err(|error| (error.line(), told(&error)))?;
    match model.r#type.as_deref() {
        Some("CityJSON") => {}
        Some("CityJSONFeature") => {
            return Err((0, "it is a feature of a CityJSON sequence; convert it to one CityJSON file".to_owned()));
        }
        Some(other) => return Err((0, format!("its \"type\" is {}, not \"CityJSON\"", shown(other)))),
        None => return Err((0, "it has no \"type\": \"CityJSON\"".to_owned())),
    }
    match model.version.as_deref() {
        Some("1.0" | "1.1" | "2.0") => Ok(model),
        Some(version) if version.starts_with("1.0.") || version.starts_with("1.1.") || version.starts_with("2.0.") => {
            Ok(model)
        }
        Some(other) => Err((0, format!("its version is {}; convert it to 2.0", shown(other)))),
        None => Err((0, "it has no \"version\"; it takes \"2.0\", \"1.1\" or \"1.0\"".to_owned())),
    }
}
