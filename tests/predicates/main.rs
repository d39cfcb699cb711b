//! Every predicate of the kernel against an oracle of its own.
//!
//! `NUSSELT_PREDICATE_CASES` sets how many calls are compared (default 100,000): see
//! docs/numerics.md for the long run.

mod case;
mod check;
mod oracle;
mod print;
mod search;

use case::{Case, Class, Random};
use check::{Reference, Tally, check};

fn calls_wanted() -> u64 {
    std::env::var("NUSSELT_PREDICATE_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(100_000)
}

/// Compares calls on cases of one class until there are enough of them.
fn run(class: Class) -> Tally {
    // Wide integers are slow to check: few such cases say as much.
    let share = match class {
        Class::Wild | Class::Chaos => 40,
        Class::Mixed => 10,
        _ => 7,
    };
    let wanted = calls_wanted() / share;
    let mut source = Random(class as u64);
    let mut tally = Tally::default();
    for number in 0u64.. {
        if tally.calls >= wanted {
            break;
        }
        let case = Case::draw(&mut source, class);
        let reference = if number % 64 == 0 { Reference::Rationals } else { Reference::Integers };
        let checked = check(&case, reference).unwrap_or_else(|wrong| panic!("{class:?}, case {number}: {wrong}"));
        tally.add(checked);
    }
    let Tally { calls, zeros, stages } = tally;
    println!("{class:?}: {calls} answers, {zeros} of them zero; {stages:?}");
    tally
}

macro_rules! classes {
    ($($name:ident: $class:ident),* $(,)?) => {$(
        #[test]
        fn $name() {
            assert!(run(Class::$class).calls > 0);
        }
    )*};
}

classes! {
    small_whole_numbers_have_their_signs: Grid,
    decimals_have_their_signs: Decimal,
    single_precision_has_its_signs: SinglePrecision,
    full_mantissas_have_their_signs: Full,
    clusters_far_out_have_their_signs: Cluster,
    denormal_numbers_have_their_signs: Denormal,
    huge_numbers_have_their_signs: Huge,
    mixed_scales_have_their_signs: Mixed,
    any_exponent_has_its_sign: Wild,
    any_finite_bits_have_their_sign: Chaos,
}

#[test]
fn walks_towards_zero_find_no_wrong_sign() {
    let walks = (calls_wanted() / 2_000).max(50);
    let tally = search::walks(walks);
    println!("{walks} walks: {tally:?}");
}
