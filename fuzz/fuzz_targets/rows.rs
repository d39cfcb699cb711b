//! Any bytes, as they are and with the right checksums: the reader of files of rows gives the matrix or a reason, and what was read and
//! written again reads the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nusselt::io::matrix::{MatrixError, merge, read_patches};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

const MAGIC: &[u8] = b"nusselt rows 2\r\n";

/// A folder for the files of this process, in memory where there is such a place.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let memory = Path::new("/dev/shm");
    let above = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
    let folder = above.join(format!("nusselt-fuzz-rows-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    folder
});

/// FNV-1a of 128 bits, the lower half.
fn checksum(bytes: &[u8]) -> u64 {
    let start = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128;
    let prime = 0x0000_0000_0100_0000_0000_0000_0000_013b;
    bytes.iter().fold(start, |hash, &byte| (hash ^ u128::from(byte)).wrapping_mul(prime)) as u64
}

/// The records of a file with lengths that it has, and checksums that are right.
fn mended(data: &[u8]) -> Vec<u8> {
    let mut rest = data.get(MAGIC.len()..).unwrap_or_default();
    let mut file = MAGIC.to_vec();
    while let Some((length, after)) = rest.split_first_chunk::<8>() {
        let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX).min(after.len());
        let (record, after) = after.split_at(length);
        file.extend((length as u64).to_le_bytes());
        file.extend(record);
        file.extend(checksum(record).to_le_bytes());
        rest = after.get(8..).unwrap_or_default();
    }
    file
}

fn check(bytes: &[u8]) {
    let at = |name: &str| FOLDER.join(name);
    fs::write(at("in.rows"), bytes).expect("room for it");
    match read_patches(&at("in.rows")) {
        Ok(patches) => {
            for patch in patches {
                assert!(patch.area.is_finite() && patch.area >= 0.0);
                let pieces = patch.shape.map_or_else(Vec::new, |shape| shape.pieces);
                assert!(pieces.iter().all(|piece| piece.len() > 2 && piece.iter().all(|p| p.is_finite())));
            }
        }
        Err(MatrixError::NotRows { .. } | MatrixError::Damaged { .. }) => {}
        Err(error) => panic!("{error}"),
    }
    if merge(&[at("in.rows")], &at("out.rows")).is_err() {
        return;
    }
    let written = fs::read(at("out.rows")).expect("it is there");
    merge(&[at("out.rows")], &at("again.rows")).expect("what was written is read");
    assert_eq!(fs::read(at("again.rows")).expect("it is there"), written);
    for name in ["out.csv", "out.json"] {
        merge(&[at("out.rows")], &at(name)).expect("all rows are there");
    }
}

fuzz_target!(|data: &[u8]| {
    check(data);
    check(&mended(data));
});
