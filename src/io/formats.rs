//! The formats of scenes: how they are told apart, and who reads them.

use super::{Loaded, ReadError, ReadOptions, obj, ply, stl};
use std::path::Path;

/// A format of scenes.
pub(super) struct Format {
    /// What it is called.
    pub(super) name: &'static str,
    /// The endings of its files, in lower case.
    endings: &'static [&'static str],
    /// True for the bytes of a file that can be of no other format.
    is_content: fn(&[u8]) -> bool,
    reader: Reader,
}

enum Reader {
    BuiltIn(fn(&Path, &[u8], &ReadOptions) -> Result<Loaded, ReadError>),
    #[cfg(not(all(feature = "gltf", feature = "cityjson")))]
    NeedsFeature(&'static str),
}

#[cfg(feature = "gltf")]
const GLTF: Reader = Reader::BuiltIn(super::gltf::read);
#[cfg(not(feature = "gltf"))]
const GLTF: Reader = Reader::NeedsFeature("gltf");
#[cfg(feature = "cityjson")]
const CITYJSON: Reader = Reader::BuiltIn(super::cityjson::read);
#[cfg(not(feature = "cityjson"))]
const CITYJSON: Reader = Reader::NeedsFeature("cityjson");

/// All of them. An ending may be part of another (`.json` of `.city.json`), as long as both are of one format.
const FORMATS: [Format; 5] = [
    // Any text may be OBJ: nothing tells it but the ending.
    Format { name: "OBJ", endings: &["obj"], is_content: |_| false, reader: Reader::BuiltIn(obj::read) },
    Format { name: "glTF", endings: &["gltf", "glb"], is_content: is_gltf, reader: GLTF },
    Format { name: "STL", endings: &["stl"], is_content: stl::is_content, reader: Reader::BuiltIn(stl::read) },
    Format { name: "PLY", endings: &["ply"], is_content: ply::is_content, reader: Reader::BuiltIn(ply::read) },
    Format { name: "CityJSON", endings: &["json", "city.json"], is_content: is_cityjson, reader: CITYJSON },
];

impl Format {
    /// The format of a file: by its ending, else by its content.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Result<&'static Self, ReadError> {
        const ALL: &[Format; 5] = &FORMATS;
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let ends = |ending: &&str| name.strip_suffix(ending).is_some_and(|stem| stem.ends_with('.'));
        let by_ending = ALL.iter().find(|format| format.endings.iter().any(ends));
        by_ending.or_else(|| ALL.iter().find(|format| (format.is_content)(bytes))).ok_or_else(|| {
            let endings = ALL.iter().flat_map(|format| format.endings).map(|ending| format!(".{ending}"));
            ReadError::UnknownFormat { path: path.to_owned(), known: endings.collect::<Vec<_>>().join(", ") }
        })
    }

    /// Reads a file of this format.
    pub(super) fn read(&self, path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, ReadError> {
        match self.reader {
            Reader::BuiltIn(read) => read(path, bytes, options),
            #[cfg(not(all(feature = "gltf", feature = "cityjson")))]
            Reader::NeedsFeature(feature) => {
                Err(ReadError::NotBuilt { path: path.to_owned(), format: self.name, feature })
            }
        }
    }
}

fn is_gltf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF") || top_level(bytes).is_some_and(|top| top.has_asset)
}

fn is_cityjson(bytes: &[u8]) -> bool {
    top_level(bytes).is_some_and(|top| top.is_cityjson)
}

/// What the object of a JSON file says about its format.
struct TopLevel {
    has_asset: bool,
    is_cityjson: bool,
}

/// Without the readers for JSON, no JSON is told apart.
#[cfg(not(any(feature = "gltf", feature = "cityjson")))]
fn top_level(_: &[u8]) -> Option<TopLevel> {
    None
}

#[cfg(any(feature = "gltf", feature = "cityjson"))]
fn top_level(bytes: &[u8]) -> Option<TopLevel> {
    use serde::de::IgnoredAny;

    #[derive(serde::Deserialize)]
    struct Keys {
        asset: Option<IgnoredAny>,
        r#type: Option<Kind>,
    }
    #[derive(serde::Deserialize)]
    #[serde(untagged)]
    enum Kind {
        Name(String),
        Other(IgnoredAny),
    }
    let bytes = without_mark(bytes);
    if bytes.iter().find(|byte| !byte.is_ascii_whitespace()) != Some(&b'{') {
        return None;
    }
    let keys: Keys = serde_json::from_slice(bytes).ok()?;
    let is_cityjson = matches!(keys.r#type, Some(Kind::Name(name)) if name == "CityJSON");
    Some(TopLevel { has_asset: keys.asset.is_some(), is_cityjson })
}

/// The bytes without a byte order mark, which JSON must not have but some files do.
#[cfg(any(feature = "gltf", feature = "cityjson"))]
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(path: &str, bytes: &[u8]) -> Option<&'static str> {
        Format::of(Path::new(path), bytes).ok().map(|format| format.name)
    }

    #[test]
    fn endings_come_first_and_content_tells_the_rest() {
        let mut stl = vec![0; 84 + 50];
        stl[80] = 1;
        stl[..5].copy_from_slice(b"solid");
        for (path, bytes, expected) in [
            ("a.OBJ", &b"ply\n"[..], Some("OBJ")),
            ("a.b.glb", b"{}", Some("glTF")),
            ("a.Gltf", b"glTF", Some("glTF")),
            ("a.city.json", b"", Some("CityJSON")),
            ("a.json", b"", Some("CityJSON")),
            ("json", b"", None),
            ("a.jsonx", b"", None),
            ("a", b"", None),
            ("a", b"glTF\x02", Some("glTF")),
            ("a.dat", b"ply\r\nformat", Some("PLY")),
            ("a.dat", b"plywood", None),
            ("a.dat", b"solid a\nfacet", Some("STL")),
            ("a.dat", b"solidarity", None),
            ("a.dat", &stl, Some("STL")),
            ("a.dat", &stl[..100], None),
            ("a.dat", b"v 0 0 0\n", None),
        ] {
            assert_eq!(name(path, bytes), expected, "{path} {:?}", String::from_utf8_lossy(bytes));
        }
    }

    #[test]
    #[cfg(feature = "gltf")]
    fn json_is_told_by_its_keys() {
        for (text, expected) in [
            ("\u{feff} {\"asset\":{}}", Some("glTF")),
            ("{\"x\":[{\"type\":\"CityJSON\"}],\"type\":\"CityJSON\"}", Some("CityJSON")),
            ("{\"type\":\"FeatureCollection\"}", None),
            ("{\"type\":7}", None),
            ("[\"CityJSON\"]", None),
            ("{\"type\":\"CityJSON\"", None),
        ] {
            assert_eq!(name("a.data", text.as_bytes()), expected, "{text}");
        }
    }
}
