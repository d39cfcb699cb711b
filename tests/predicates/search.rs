//! An adversary: it moves coordinates by steps of the last place so that a determinant shrinks, past the
//! place where a filter must give up, and compares the signs on its way.

use crate::case::{Case, Class, Random, Source, nudged};
use crate::oracle::{Oracle, log2, sign};
use crate::print;
use num_bigint::BigInt;
use nusselt::exact::{Direction, Kernel, Sign, Splitter, orient3d};

/// How a walk went.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Trace {
    /// Signs that were compared.
    pub(crate) calls: u64,
    /// Walks that ended at an exact zero.
    pub(crate) zeros: u64,
    /// Signs left undecided by the filter.
    pub(crate) undecided: u64,
}

/// What a walk makes small.
#[derive(Clone, Copy, Debug)]
enum Target {
    Side(usize, usize),
    Orientation(usize, usize, usize),
    Orient3d,
}

/// The exact value, and whether the engine agrees with its sign.
fn value(case: &Case, target: Target, unit: i32, trace: &mut Trace) -> Option<BigInt> {
    let oracle = Oracle::<BigInt>::new(case.eye, unit);
    let mut kernel = Kernel::new(case.known.iter().copied(), case.eye);
    let (value, got): (BigInt, Vec<Sign>) = match target {
        Target::Side(d, s) => {
            let (d, s): (&Direction, &Splitter) = (&case.directions[d], &case.splitters[s]);
            let value = oracle.side_value(d, s)?;
            let ids = (kernel.add_direction(d), kernel.add_splitter(s));
            (value, vec![kernel.side(d, s), kernel.side_of(ids.0, ids.1)])
        }
        Target::Orientation(a, b, c) => {
            let splitters = [a, b, c].map(|k| &case.splitters[k]);
            let value = oracle.orientation_value(splitters)?;
            let ids = splitters.map(|s| kernel.add_splitter(s));
            (value, vec![kernel.orientation(splitters), kernel.orientation_of(ids)])
        }
        Target::Orient3d => {
            let [a, b, c, d] = case.corners;
            (oracle.orient3d_value(case.corners), vec![orient3d(a, b, c, d), -orient3d(b, a, c, d)])
        }
    };
    let want = sign(&value);
    assert!(got.iter().all(|s| *s == want), "{target:?} is {got:?} and not {want:?} with\n{}", print::case(case));
    trace.calls += got.len() as u64;
    trace.undecided += kernel.stats().undecided();
    Some(value)
}

/// Walks of up to 150 steps from cases of all classes.
pub(crate) fn walks(count: u64) -> Trace {
    let mut source = Random(0x5eed);
    let mut trace = Trace::default();
    for k in 0..count {
        // Numbers of any exponent are too long to take so many steps with.
        let class = Class::ALL[k as usize % 8];
        let case = Case::draw(&mut source, class);
        let target = match source.below(8) {
            0..=3 => Target::Side(source.below(3) as usize, source.below(4) as usize),
            4..=6 => Target::Orientation(0, 1, 2 + source.below(2) as usize),
            _ => Target::Orient3d,
        };
        walk(case, target, &mut source, &mut trace);
    }
    trace
}

fn walk(mut case: Case, target: Target, source: &mut Random, trace: &mut Trace) {
    // Steps of the last place may be finer than any bit of the case.
    let unit = (case.unit() - 60).max(-1074);
    let Some(start) = value(&case, target, unit, trace) else { return };
    let mut least = log2(&start);
    // How many coordinates there are to choose from: one is changed wherever it occurs.
    let mut all: Vec<u64> = Vec::new();
    case.map(&mut |x| {
        all.push(x.to_bits());
        x
    });
    all.sort_unstable();
    all.dedup();
    let mut stride = 40;
    for _ in 0..150 {
        if least == f64::NEG_INFINITY {
            trace.zeros += 1;
            return;
        }
        let chosen = (source.bits() % all.len() as u64) as usize;
        let old = all[chosen];
        let shift = source.below(stride + 1);
        let steps = if source.one_in(2) { 1i64 << shift } else { -(1i64 << shift) };
        let new = nudged(f64::from_bits(old), steps);
        let moved = case.map(&mut |x| if x.to_bits() == old { new } else { x });
        if moved.unit() < unit {
            continue;
        }
        let Some(value) = value(&moved, target, unit, trace) else { continue };
        let size = log2(&value);
        if size < least {
            (case, least) = (moved, size);
            all[chosen] = new.to_bits();
        } else {
            // Smaller steps as it gets harder to improve.
            stride = (stride - 1).max(4);
        }
    }
}
