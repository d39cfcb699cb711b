//! Levels of detail, which are written as `"2"`, `"2.2"`, or `2` in old files.

use serde::de::{Deserialize, Deserializer, Error, Visitor};
use std::cmp::Ordering;
use std::fmt;

/// A level of detail: its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lod(f64);

impl Lod {
    /// The level that a text names.
    pub(super) fn named(text: &str) -> Option<Self> {
        text.trim().parse().ok().filter(|number: &f64| number.is_finite()).map(Self)
    }

    pub(super) fn compare(self, other: Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl fmt::Display for Lod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<'de> Deserialize<'de> for Lod {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Level;

        impl Visitor<'_> for Level {
            type Value = Lod;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a level of detail like \"2.2\"")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Lod, E> {
                Lod::named(text).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(text), &self))
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<Lod, E> {
                Ok(Lod(number))
            }

            fn visit_u64<E: Error>(self, number: u64) -> Result<Lod, E> {
                Ok(Lod(number as f64))
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Lod, E> {
                Ok(Lod(number as f64))
            }
        }

        from.deserialize_any(Level)
    }
}
