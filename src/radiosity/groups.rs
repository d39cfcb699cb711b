//! Groups of patches that exchange light, directly or through others: rooms without a door between them.
//!
//! Each is solved to the same part of what is emitted in it, as if it were alone: beside a bright room a dim one is no rounding.

/// Gaps that rounding leaves where polygons meet show no larger factors: what is seen through them joins no groups.
pub(super) const GAPS: f64 = 1e-9;

/// Every patch alone, as patches of lower numbers, or themselves, that they are grouped with.
pub(super) fn alone(count: usize) -> Vec<u32> {
    (0..count as u32).collect()
}

/// Puts two patches into one group.
pub(super) fn join(groups: &mut [u32], a: u32, b: u32) {
    let (a, b) = (first(groups, a), first(groups, b));
    groups[a.max(b) as usize] = a.min(b);
}

/// The first patch of the group of another one.
fn first(groups: &mut [u32], mut patch: u32) -> u32 {
    while groups[patch as usize] != patch {
        groups[patch as usize] = groups[groups[patch as usize] as usize];
        patch = groups[patch as usize];
    }
    patch
}

/// For each patch the first one of its group.
pub(super) fn firsts(groups: &[u32]) -> Vec<u32> {
    let mut found: Vec<u32> = Vec::with_capacity(groups.len());
    for (patch, &other) in (0..).zip(groups) {
        found.push(if other == patch { patch } else { found[other as usize] });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_is_one_group() {
        let mut groups = alone(7);
        for [a, b] in [[5, 3], [1, 6], [3, 4], [6, 5]] {
            join(&mut groups, a, b);
        }
        assert_eq!(firsts(&groups), [0, 1, 2, 1, 1, 1, 1]);
    }
}
