//! Records of a file of rows: a length, so many bytes, and their checksum.
//!
//! All numbers are little-endian. A file starts with [`MAGIC`]; then come a record with the manifest as JSON, a record for each patch and a record for
//! each row.

use super::super::digest::Digest;
use crate::factors::{Entry, PatchInfo, PatchShape, Row, Share};
use crate::scene::PolygonId;
use glam::DVec3;
use std::io::{self, Read, Write};

pub(super) const MAGIC: &[u8; 16] = b"nusselt rows 2\r\n";

/// Bytes of a row without entries, and of an entry.
const ROW: usize = 4 + 5 * 8 + 4;
const ENTRY: usize = 4 + 2 * 8;

/// Writes a record.
pub(super) fn write(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    out.write_all(&(bytes.len() as u64).to_le_bytes())?;
    out.write_all(bytes)?;
    out.write_all(&Digest::EMPTY.with(bytes).low().to_le_bytes())
}

/// Reads a record into `bytes`. No more than `left` bytes are there, whatever it says; they are counted down. `None` if it is cut off, or changed.
pub(super) fn read(input: &mut impl Read, left: &mut u64, bytes: &mut Vec<u8>) -> io::Result<Option<()>> {
    bytes.clear();
    let mut number = [0; 8];
    if *left < 16 {
        return Ok(None);
    }
    input.read_exact(&mut number)?;
    let length = u64::from_le_bytes(number);
    if length > *left - 16 {
        return Ok(None);
    }
    *left -= 16 + length;
    // As much as the file has.
    input.take(length).read_to_end(bytes)?;
    if bytes.len() as u64 != length {
        return Ok(None);
    }
    input.read_exact(&mut number)?;
    Ok((u64::from_le_bytes(number) == Digest::EMPTY.with(bytes).low()).then_some(()))
}

pub(super) fn of_patch(patch: &PatchInfo) -> Vec<u8> {
    let PatchInfo { name, polygon, area, shape } = patch;
    let mut bytes = Vec::new();
    bytes.extend(polygon.0.to_le_bytes());
    bytes.extend(area.to_bits().to_le_bytes());
    bytes.extend((name.len() as u32).to_le_bytes());
    bytes.extend(name.as_bytes());
    let Some(PatchShape { center, normal, pieces }) = shape else { return bytes };
    let point = |bytes: &mut Vec<u8>, p: DVec3| {
        bytes.extend(p.to_array().into_iter().flat_map(|x| x.to_bits().to_le_bytes()));
    };
    point(&mut bytes, *center);
    // No unit vector is 0.
    point(&mut bytes, normal.unwrap_or(DVec3::ZERO));
    bytes.extend((pieces.len() as u32).to_le_bytes());
    for piece in pieces {
        bytes.extend((piece.len() as u32).to_le_bytes());
        for &p in piece {
            point(&mut bytes, p);
        }
    }
    bytes
}

pub(super) fn to_patch(bytes: &[u8]) -> Option<PatchInfo> {
    let mut rest = bytes;
    let polygon = PolygonId(whole(&mut rest)?);
    let area = real(&mut rest).filter(|area| area.is_finite() && *area >= 0.0)?;
    let length = whole(&mut rest)? as usize;
    let (name, after) = rest.split_at_checked(length)?;
    rest = after;
    let name = std::str::from_utf8(name).ok()?.to_owned();
    if rest.is_empty() {
        return Some(PatchInfo { name, polygon, area, shape: None });
    }
    let center = point(&mut rest)?;
    let normal = Some(point(&mut rest)?).filter(|&normal| normal != DVec3::ZERO);
    // Memory grows with what is there, not with what is said.
    let mut pieces = Vec::new();
    for _ in 0..whole(&mut rest)? {
        let count = whole(&mut rest)?;
        let mut corners = Vec::new();
        for _ in 0..count {
            corners.push(point(&mut rest)?);
        }
        if corners.len() < 3 {
            return None;
        }
        pieces.push(corners);
    }
    let is_good = rest.is_empty() && !pieces.is_empty();
    is_good.then_some(PatchInfo { name, polygon, area, shape: Some(PatchShape { center, normal, pieces }) })
}

pub(super) fn of_row(row: &Row, bytes: &mut Vec<u8>) {
    let Row { patch, entries, backs, background, closure_raw } = row;
    bytes.clear();
    bytes.extend(patch.to_le_bytes());
    for number in [backs.factor, backs.error, background.factor, background.error, *closure_raw] {
        bytes.extend(number.to_bits().to_le_bytes());
    }
    bytes.extend((entries.len() as u32).to_le_bytes());
    for Entry { column, share } in entries {
        bytes.extend(column.to_le_bytes());
        bytes.extend(share.factor.to_bits().to_le_bytes());
        bytes.extend(share.error.to_bits().to_le_bytes());
    }
}

/// A row, if the bytes are one. What it says is not judged.
pub(super) fn to_row(bytes: &[u8]) -> Option<Row> {
    let mut rest = bytes;
    let patch = whole(&mut rest)?;
    let mut share = || Some(Share { factor: real(&mut rest)?, error: real(&mut rest)? });
    let (backs, background) = (share()?, share()?);
    let closure_raw = real(&mut rest)?;
    let count = whole(&mut rest)? as usize;
    if bytes.len() != ROW + ENTRY.checked_mul(count)? {
        return None;
    }
    let mut entries = Vec::with_capacity(count);
    for _ in 0..count {
        let column = whole(&mut rest)?;
        entries.push(Entry { column, share: Share { factor: real(&mut rest)?, error: real(&mut rest)? } });
    }
    Some(Row { patch, entries, backs, background, closure_raw })
}

/// What is wrong with a row of a matrix of so many columns, if something is.
pub(super) fn fault(row: &Row, columns: u32) -> Option<&'static str> {
    let is_good = |share: &Share| share.factor.is_finite() && share.error.is_finite();
    let entries = &row.entries;
    if !entries.iter().all(|entry| is_good(&entry.share)) || !is_good(&row.backs) || !is_good(&row.background) {
        return Some("a factor or its error is not a finite number");
    }
    if !row.closure_raw.is_finite() {
        return Some("its sum is not a finite number");
    }
    if !entries.is_sorted_by(|a, b| a.column < b.column) {
        return Some("its columns do not ascend");
    }
    let is_outside = entries.last().is_some_and(|entry| entry.column >= columns);
    is_outside.then_some("there is no patch of that column's number")
}

fn whole(rest: &mut &[u8]) -> Option<u32> {
    let (number, after) = rest.split_first_chunk()?;
    *rest = after;
    Some(u32::from_le_bytes(*number))
}

fn real(rest: &mut &[u8]) -> Option<f64> {
    let (number, after) = rest.split_first_chunk()?;
    *rest = after;
    Some(f64::from_bits(u64::from_le_bytes(*number)))
}

fn point(rest: &mut &[u8]) -> Option<DVec3> {
    let p = DVec3::new(real(rest)?, real(rest)?, real(rest)?);
    p.is_finite().then_some(p)
}
