//! A digest that tells different contents apart by accident, not by intent: FNV-1a of 128 bits (Fowler, Noll and Vo 1991).

use serde::{Deserialize, Serialize};
use std::fmt;

/// 128 bits that stand for some content; equal contents have equal ones on all machines and in all versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Digest(u128);

impl Digest {
    /// Of nothing.
    pub(super) const EMPTY: Self = Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);

    /// With more content after it.
    pub(super) fn with(self, bytes: &[u8]) -> Self {
        const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
        Self(bytes.iter().fold(self.0, |hash, &byte| (hash ^ u128::from(byte)).wrapping_mul(PRIME)))
    }

    /// With a text after it, which cannot run into what follows.
    pub(super) fn with_text(self, text: &str) -> Self {
        self.with(&(text.len() as u64).to_le_bytes()).with(text.as_bytes())
    }

    /// The lower half, for checksums.
    pub(super) fn low(self) -> u64 {
        self.0 as u64
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

impl From<Digest> for String {
    fn from(digest: Digest) -> Self {
        digest.to_string()
    }
}

impl TryFrom<String> for Digest {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        let is_hexadecimal = text.len() == 32 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let number = is_hexadecimal.then(|| u128::from_str_radix(&text, 16).ok()).flatten();
        number.map(Self).ok_or("a digest is 32 hexadecimal digits")
    }
}

#[cfg(test)]
mod tests {
    use super::Digest;

    #[test]
    fn it_is_fnv_1a() {
        // Test vectors of draft-eastlake-fnv.
        assert_eq!(Digest::EMPTY.to_string(), "6c62272e07bb014262b821756295c58d");
        assert_eq!(Digest::EMPTY.with(b"a").to_string(), "d228cb696f1a8caf78912b704e4a8964");
        assert_eq!(Digest::EMPTY.with(b"foobar").to_string(), "343e1662793c64bf6f0d3597ba446f18");
    }

    #[test]
    fn it_reads_back() {
        let digest = Digest::EMPTY.with_text("x");
        assert_eq!(Digest::try_from(digest.to_string()), Ok(digest));
        for bad in ["", "12", "+2345678901234567890123456789012", &"g".repeat(32)] {
            assert!(Digest::try_from(bad.to_owned()).is_err(), "{bad}");
        }
    }
}
