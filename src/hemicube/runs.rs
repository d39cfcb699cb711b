//! Sums over the item buffer by runs of equal items.

/// Calls `add` with the item, the form factor and the length of every run of equal items in a row.
pub(super) fn for_runs(row: &[u32], antiderivative: &[f64], mut add: impl FnMut(u32, f64, usize)) {
    let mut from = 0;
    while let Some(&item) = row.get(from) {
        let to = from + run_length(&row[from..], item);
        add(item, antiderivative[to] - antiderivative[from], to - from);
        from = to;
    }
}

/// How many items at the start of `items` equal `item`. Eight at a time: that compiles to vector instructions.
fn run_length(items: &[u32], item: u32) -> usize {
    let (chunks, rest) = items.as_chunks::<8>();
    for (k, chunk) in chunks.iter().enumerate() {
        if chunk.iter().fold(0, |differing, &other| differing | (other ^ item)) != 0 {
            let same = chunk.iter().position(|&other| other != item);
            return 8 * k + same.unwrap_or(8);
        }
    }
    let same = rest.iter().position(|&other| other != item);
    8 * chunks.len() + same.unwrap_or(rest.len())
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
