//! The matrix as an array of `NumPy`: NEP 1, version 1.0.

use super::rows::{Source, Unwritten};
use std::io::Write;

pub(super) fn write(source: &Source, out: &mut impl Write) -> Result<(), Unwritten> {
    let count = source.patches.len();
    out.write_all(&header([count, count + 2]))?;
    let mut dense = vec![0.0f64; count + 2];
    source.for_each(|row| {
        dense.fill(0.0);
        for entry in &row.entries {
            dense[entry.column as usize] = entry.share.factor;
        }
        (dense[count], dense[count + 1]) = (row.backs.factor, row.background.factor);
        dense.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
    })
}

/// What comes before the numbers: a multiple of 64 bytes.
fn header([rows, columns]: [usize; 2]) -> Vec<u8> {
    let mut text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    let start = 10;
    while (start + text.len() + 1) % 64 != 0 {
        text.push(' ');
    }
    text.push('\n');
    let length = (text.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], text.as_bytes()].concat()
}
