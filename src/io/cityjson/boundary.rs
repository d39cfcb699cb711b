//! Boundaries: lists of lists of indices, as deep as the type of a geometry says.

use super::json::{Geometry, Semantics};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;

/// Numbers in lists in lists. How deep they are nested can only be judged when the type is known, which may
/// come after them.
#[derive(Debug, Default)]
pub(super) enum Nested {
    #[default]
    Null,
    Index(u64),
    List(Vec<Nested>),
}

impl<'de> Deserialize<'de> for Nested {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Any;

        impl<'de> Visitor<'de> for Any {
            type Value = Nested;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("lists of indices, which are whole numbers of at least 0")
            }

            fn visit_unit<E: Error>(self) -> Result<Nested, E> {
                Ok(Nested::Null)
            }

            fn visit_u64<E: Error>(self, index: u64) -> Result<Nested, E> {
                Ok(Nested::Index(index))
            }

            // The parser limits the depth.
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Nested, A::Error> {
                let mut items = Vec::new();
                while let Some(item) = list.next_element()? {
                    items.push(item);
                }
                items.shrink_to_fit();
                Ok(Nested::List(items))
            }
        }

        from.deserialize_any(Any)
    }
}

impl Nested {
    fn list(&self) -> Option<&[Self]> {
        if let Self::List(items) = self { Some(items) } else { None }
    }

    /// The index, if this is a list of just one.
    pub(super) fn only(&self) -> Option<usize> {
        match self.list()? {
            [Self::Index(index)] => usize::try_from(*index).ok(),
            _ => None,
        }
    }

    /// The item at a place, if this is a list.
    fn get(&self, k: usize) -> Option<&Self> {
        self.list()?.get(k)
    }
}

/// How deep the surfaces of a geometry are nested; `None` if it has none.
pub(super) fn depth(kind: &str) -> Option<usize> {
    match kind {
        "MultiSurface" | "CompositeSurface" => Some(1),
        "Solid" => Some(2),
        "MultiSolid" | "CompositeSolid" => Some(3),
        _ => None,
    }
}

/// A surface of a geometry: its rings as the file has them, and what it is.
#[derive(Debug)]
pub(super) struct Surface<'a> {
    rings: &'a Nested,
    /// The type of its semantic surface, if it has one.
    pub(super) kind: Option<&'a str>,
}

/// The surfaces of a geometry, depth-first; otherwise what is wrong.
pub(super) fn surfaces(geometry: &Geometry) -> Result<Vec<Surface<'_>>, String> {
    let mut found = Vec::new();
    let Some(depth) = depth(&geometry.r#type) else { return Ok(found) };
    let semantics = geometry.semantics.as_ref();
    let values = semantics.map(|semantics| &semantics.values);
    collect(&geometry.boundaries, depth, values, semantics, &mut found)?;
    Ok(found)
}

/// `values` are the semantics of what is in `nested`; `null` or nothing stands for none in all of it.
fn collect<'a>(
    nested: &'a Nested,
    depth: usize,
    values: Option<&'a Nested>,
    semantics: Option<&'a Semantics>,
    found: &mut Vec<Surface<'a>>,
) -> Result<(), String> {
    if depth == 0 {
        let kind = match (values, semantics) {
            (Some(Nested::Index(k)), Some(semantics)) => {
                let Some(surface) = usize::try_from(*k).ok().and_then(|k| semantics.surfaces.get(k)) else {
                    let count = semantics.surfaces.len();
                    return Err(format!("there is no semantic surface {k}; it has {count}"));
                };
                Some(surface.r#type.as_str())
            }
            (Some(Nested::List(_)), _) => {
                return Err("its semantic values are nested deeper than its surfaces".to_owned());
            }
            _ => None,
        };
        found.push(Surface { rings: nested, kind });
        return Ok(());
    }
    let Some(items) = nested.list() else {
        return Err("its boundaries are not lists as deep as its type says".to_owned());
    };
    if let Some(Nested::Index(_)) = values {
        return Err("its semantic values are not nested like its surfaces".to_owned());
    }
    for (k, item) in items.iter().enumerate() {
        collect(item, depth - 1, values.and_then(|values| values.get(k)), semantics, found)?;
    }
    Ok(())
}

impl Surface<'_> {
    /// How many corners it has, or 1 if it has none.
    pub(super) fn size(&self) -> u64 {
        let rings = self.rings.list().unwrap_or_default().iter();
        rings.map(|ring| ring.list().map_or(0, <[Nested]>::len) as u64).sum::<u64>().max(1)
    }

    /// Its rings as indices below a count, as far as they are, and what is wrong with the rest.
    pub(super) fn rings(&self, count: usize) -> (Vec<Vec<usize>>, Option<String>) {
        let mut broken = None;
        let mut note = |what| {
            broken.get_or_insert(what);
        };
        let index = |corner: &Nested| match corner {
            Nested::Index(index) => {
                let known = usize::try_from(*index).ok().filter(|&index| index < count);
                known.ok_or_else(|| format!("there is no vertex {index}; there are {count}"))
            }
            _ => Err("its rings are not lists of indices".to_owned()),
        };
        let mut rings = Vec::new();
        let lists = self.rings.list().unwrap_or_default();
        if lists.is_empty() {
            note("it is not a list of rings".to_owned());
        }
        for list in lists {
            let Some(corners) = list.list() else {
                note("it is not a list of rings".to_owned());
                continue;
            };
            if corners.len() < 3 {
                note(format!("a ring takes at least 3 vertices, but here are {}", corners.len()));
            }
            let corners = corners.iter().filter_map(|corner| index(corner).map_err(&mut note).ok());
            rings.push(corners.collect());
        }
        (rings, broken)
    }
}
