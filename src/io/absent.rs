//! Optional members of JSON objects: `null` says the same as no member at all.

use serde::de::{Deserialize, Deserializer};

/// The member, or the default if it is `null`.
pub(super) fn or_default<'de, D: Deserializer<'de>, T: Deserialize<'de> + Default>(from: D) -> Result<T, D::Error> {
    Option::deserialize(from).map(Option::unwrap_or_default)
}
