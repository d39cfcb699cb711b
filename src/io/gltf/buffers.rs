//! The bytes of buffers: in the file, or beside it.

use super::super::error::advice;
use super::super::number::shown;
use super::json::{Buffer, Root};
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;
use std::collections::HashMap;
use std::io;

/// Data URIs come with padding and without.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The buffers that were asked for.
pub(super) struct Buffers<'a> {
    chunk: Option<&'a [u8]>,
    /// For each buffer where it is, once it is known, and its length.
    places: Vec<Option<(Source, usize)>>,
    loaded: Vec<Vec<u8>>,
    by_name: HashMap<String, usize>,
}

#[derive(Clone, Copy)]
enum Source {
    Chunk,
    Loaded(usize),
}

impl<'a> Buffers<'a> {
    /// None yet; `chunk` is the binary chunk of a GLB file.
    pub(super) fn new(root: &Root, chunk: Option<&'a [u8]>) -> Self {
        Self { chunk, places: vec![None; root.buffers.len()], loaded: Vec::new(), by_name: HashMap::new() }
    }

    /// Makes the bytes of a buffer available; otherwise says what is wrong with it.
    pub(super) fn load(
        &mut self,
        root: &Root,
        buffer: usize,
        load: &mut impl FnMut(&str) -> io::Result<Vec<u8>>,
    ) -> Result<(), String> {
        let Some(Buffer { byte_length, uri }) = root.buffers.get(buffer) else {
            return Err(format!("there is no buffer {buffer}; the file has {}", root.buffers.len()));
        };
        if self.places[buffer].is_some() {
            return Ok(());
        }
        let source = match uri {
            None if buffer == 0 && self.chunk.is_some() => Source::Chunk,
            None => {
                return Err("it has no `uri`, and there is no chunk of a GLB file for it (it may be a stand-in for \
                            compressed data)"
                    .to_owned());
            }
            Some(uri) => Source::Loaded(match uri.strip_prefix("data:") {
                Some(data) => {
                    self.loaded.push(decoded(data)?);
                    self.loaded.len() - 1
                }
                None => self.load_file(uri, load)?,
            }),
        };
        self.places[buffer] = Some((source, *byte_length));
        let there = self.bytes_of(source).len();
        if there < *byte_length {
            return Err(format!("it says that it has {byte_length} bytes, but {there} are there"));
        }
        Ok(())
    }

    /// Reads a file, once.
    fn load_file(&mut self, uri: &str, load: &mut impl FnMut(&str) -> io::Result<Vec<u8>>) -> Result<usize, String> {
        let path = relative_path(uri)?;
        if let Some(&known) = self.by_name.get(&path) {
            return Ok(known);
        }
        let bytes = load(&path).map_err(|error| format!("cannot read {}: {error}{}", shown(&path), advice(&error)))?;
        self.loaded.push(bytes);
        self.by_name.insert(path, self.loaded.len() - 1);
        Ok(self.loaded.len() - 1)
    }

    fn bytes_of(&self, source: Source) -> &[u8] {
        match source {
            Source::Chunk => self.chunk.unwrap_or_default(),
            Source::Loaded(place) => &self.loaded[place],
        }
    }

    /// The bytes of a buffer that was loaded, as many as it says it has.
    pub(super) fn bytes(&self, buffer: usize) -> Option<&[u8]> {
        let (source, length) = (*self.places.get(buffer)?)?;
        self.bytes_of(source).get(..length)
    }

    /// How many bytes were loaded beside the file.
    pub(super) fn size(&self) -> u64 {
        self.loaded.iter().map(|bytes| bytes.len() as u64).sum()
    }
}

/// The bytes of a data URI, after `data:`.
fn decoded(data: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = data.split_once(',') else {
        return Err("its data URI has no comma before the data".to_owned());
    };
    if kind.ends_with(";base64") {
        BASE64.decode(data).map_err(|error| format!("its data URI is not base64: {error}"))
    } else {
        Ok(percent_decode_str(data).collect())
    }
}

/// The path that a URI names, relative to the folder of the file.
fn relative_path(uri: &str) -> Result<String, String> {
    let refuse = |why| Err(format!("its URI {} {why}; put the buffer into a file beside", shown(uri)));
    let scheme = uri.split(['/', '?', '#']).next().unwrap_or_default();
    if scheme.contains(':') {
        return refuse("is no relative path");
    }
    let Ok(path) = percent_decode_str(uri).decode_utf8() else {
        return refuse("does not decode to UTF-8");
    };
    if path.starts_with(['/', '\\']) || path.contains('\0') || path.is_empty() {
        return refuse("is no relative path");
    }
    let parts: Vec<&str> = path.split('/').filter(|part| *part != ".").collect();
    Ok(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_paths_beside_the_file_or_refused() {
        for (uri, path) in [("a%20b.bin", "a b.bin"), ("./x/./%C3%A4.bin", "x/ä.bin"), ("../a:b.bin", "../a:b.bin")] {
            assert_eq!(relative_path(uri).as_deref(), Ok(path));
        }
        for uri in ["", "/etc/x", "%2Fetc/x", "\\x", "http://x/y", "file:x", "a:b.bin", "%ff", "a%00b"] {
            assert!(relative_path(uri).is_err(), "{uri}");
        }
    }

    #[test]
    fn data_comes_as_base64_or_percent_encoded() {
        assert_eq!(decoded("application/octet-stream;base64,AAEC/w=="), Ok(vec![0, 1, 2, 255]));
        assert_eq!(decoded(";base64,AAEC/w"), Ok(vec![0, 1, 2, 255]));
        assert_eq!(decoded(",a%00b"), Ok(b"a\0b".to_vec()));
        assert!(decoded(";base64,A").is_err() && decoded("abc").is_err());
    }
}
