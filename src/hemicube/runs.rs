//! Sums over the item buffer by runs of equal items.

/// Calls `add` with the item, the form factor and the length of every run of equal items in a row of at least one.
pub(super) fn for_runs(row: &[u32], antiderivative: &[f64], mut add: impl FnMut(u32, f64, usize)) {
    let mut from = 0;
    let mut end = |to: usize| {
        add(row[from], antiderivative[to] - antiderivative[from], to - from);
        from = to;
    };
    // Eight pixels at a time are compared with their neighbours: that compiles to vector instructions, and there
    // is one branch that is hard to foretell for each run.
    let [before, after] = [&row[..row.len() - 1], &row[1..]];
    let ((before, before_rest), (after, after_rest)) = (before.as_chunks::<8>(), after.as_chunks::<8>());
    for (k, (before, after)) in before.iter().zip(after).enumerate() {
        let mut differs = [0_u8; 8];
        for ((differs, a), b) in differs.iter_mut().zip(before).zip(after) {
            *differs = u8::from(a != b);
        }
        let mut bits = u64::from_le_bytes(differs);
        while bits != 0 {
            end(8 * k + bits.trailing_zeros() as usize / 8 + 1);
            bits &= bits - 1;
        }
    }
    let checked = 8 * before.len();
    for (k, (a, b)) in before_rest.iter().zip(after_rest).enumerate() {
        if a != b {
            end(checked + k + 1);
        }
    }
    end(row.len());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_every_length_are_found() {
        let mut row = Vec::new();
        let lengths = [1, 7, 1, 8, 9, 2, 16, 17, 3, 64, 1, 5];
        for (k, &length) in lengths.iter().enumerate() {
            row.extend(std::iter::repeat_n(k as u32, length));
        }
        let antiderivative: Vec<f64> = (0..=row.len()).map(|k| k as f64).collect();
        let mut found = Vec::new();
        for_runs(&row, &antiderivative, |item, factor, length| found.push((item as usize, factor as usize, length)));
        let expected: Vec<_> = lengths.iter().enumerate().map(|(k, &length)| (k, length, length)).collect();
        assert_eq!(found, expected);
    }
}
