//! Nelder and Mead's method ("A simplex method for function minimization", 1965).

/// Where a function is smallest, near a start, after at most so many steps.
pub(crate) fn minimum<const N: usize>(
    f: impl Fn([f64; N]) -> f64,
    start: [f64; N],
    steps: [f64; N],
    limit: usize,
) -> [f64; N] {
    let mut corners = vec![(f(start), start)];
    for k in 0..N {
        let mut corner = start;
        corner[k] += steps[k];
        corners.push((f(corner), corner));
    }
    let mix = |from: [f64; N], to: [f64; N], share: f64| -> [f64; N] {
        std::array::from_fn(|k| from[k] + share * (to[k] - from[k]))
    };
    for _ in 0..limit {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (best, second, worst) = (corners[0], corners[N - 1], corners[N]);
        if worst.0 - best.0 <= 1e-9 * best.0.abs() {
            break;
        }
        let centre: [f64; N] =
            std::array::from_fn(|k| corners[..N].iter().map(|corner| corner.1[k]).sum::<f64>() / N as f64);
        let tried = |share: f64| {
            let corner = mix(centre, worst.1, share);
            (f(corner), corner)
        };
        let reflected = tried(-1.0);
        let next = if reflected.0 < best.0 {
            let expanded = tried(-2.0);
            Some(if expanded.0 < reflected.0 { expanded } else { reflected })
        } else if reflected.0 < second.0 {
            Some(reflected)
        } else {
            let contracted = if reflected.0 < worst.0 { tried(-0.5) } else { tried(0.5) };
            (contracted.0 < worst.0.min(reflected.0)).then_some(contracted)
        };
        if let Some(next) = next {
            corners[N] = next;
        } else {
            for corner in &mut corners[1..] {
                let nearer = mix(best.1, corner.1, 0.5);
                *corner = (f(nearer), nearer);
            }
        }
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners[0].1
}
