//! Every predicate of the kernel against rationals, on definitions made of points on a coarse grid, full of
//! coincidences, or of any finite coordinates. A wrong answer is printed as Rust.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[allow(dead_code, reason = "shared with tests/predicates")]
#[path = "../../tests/predicates/case.rs"]
mod case;
#[allow(dead_code, reason = "shared with tests/predicates")]
#[path = "../../tests/predicates/check.rs"]
mod check;
#[allow(dead_code, reason = "shared with tests/predicates")]
#[path = "../../tests/predicates/oracle.rs"]
mod oracle;
#[allow(dead_code, reason = "shared with tests/predicates")]
#[path = "../../tests/predicates/print.rs"]
mod print;

use case::{Case, Class, Source};
use check::{Reference, check};

/// The first byte of an input: how the rest is read. Others are passed over, so that a corpus never
/// changes its meaning.
const VERSION: u8 = 1;

/// Choices read from the input; zeros past its end.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }
}

impl Source for Bytes<'_> {
    fn below(&mut self, n: u64) -> u64 {
        u64::from(self.byte()) % n
    }

    fn bits(&mut self) -> u64 {
        u64::from_le_bytes([(); 8].map(|()| self.byte()))
    }
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    if bytes.byte() != VERSION {
        return;
    }
    // Even: a grid. Odd: chaos, where coordinates are of any class, or any bits.
    let mode = bytes.byte();
    let class = if mode % 2 == 0 {
        [Class::Grid, Class::Decimal, Class::Cluster][usize::from(mode / 2) % 3]
    } else {
        Class::ALL[usize::from(mode / 2) % Class::ALL.len()]
    };
    // Rationals take a second a case here, and more with wild exponents: some cases are worth it, the
    // others are compared with integers, which tests/predicates compares with rationals.
    let reference = if mode >= 240 { Reference::Rationals } else { Reference::Integers };
    let case = Case::draw(&mut bytes, class);
    if let Err(wrong) = check(&case, reference) {
        panic!("{wrong}");
    }
});
