//! The container of GLB files: a header and chunks, all little-endian.

/// What a GLB file starts with.
pub(super) const MAGIC: &[u8] = b"glTF";

const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BINARY: u32 = u32::from_le_bytes(*b"BIN\0");

/// The parts of a GLB file.
#[derive(Debug)]
pub(super) struct Chunks<'a> {
    pub(super) json: &'a [u8],
    pub(super) binary: Option<&'a [u8]>,
    /// So many bytes come after what it says is its length.
    pub(super) extra: usize,
}

/// Cuts a file into its chunks; chunks of other kinds are passed over.
pub(super) fn split(bytes: &[u8]) -> Result<Chunks<'_>, String> {
    let mut rest = bytes.get(MAGIC.len()..).unwrap_or_default();
    let cut = || "its header is cut off".to_owned();
    let version = take_number(&mut rest).ok_or_else(cut)?;
    let length = take_number(&mut rest).ok_or_else(cut)? as usize;
    if version != 2 {
        return Err(format!("it is version {version} of GLB; convert it to version 2"));
    }
    let header = bytes.len() - rest.len();
    let Some(inside) = length.checked_sub(header).and_then(|inside| rest.get(..inside)) else {
        return Err(format!("it says that it has {length} bytes, but {} are there; it may be cut off", bytes.len()));
    };
    let mut chunks = Chunks { json: &[], binary: None, extra: bytes.len() - length };
    let mut rest = inside;
    let mut is_first = true;
    while !rest.is_empty() {
        let (Some(size), Some(kind)) = (take_number(&mut rest), take_number(&mut rest)) else {
            return Err("the header of a chunk is cut off".to_owned());
        };
        let Some((chunk, after)) = rest.split_at_checked(size as usize) else {
            return Err(format!("a chunk says that it has {size} bytes, but only {} follow", rest.len()));
        };
        rest = after;
        match kind {
            JSON if is_first => chunks.json = chunk,
            _ if is_first => return Err("its first chunk is not JSON".to_owned()),
            BINARY if chunks.binary.is_none() => chunks.binary = Some(chunk),
            _ => {}
        }
        is_first = false;
    }
    Ok(chunks)
}

fn take_number(rest: &mut &[u8]) -> Option<u32> {
    let (number, after) = rest.split_first_chunk()?;
    *rest = after;
    Some(u32::from_le_bytes(*number))
}
