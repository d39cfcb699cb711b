//! The words for policies.

use super::{DuplicatePolicy, NonPlanarPolicy, OrDrop, Repair, ZeroAreaPolicy};
use std::fmt;
use std::str::FromStr;

/// Why a text is no [`Repair`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RepairSpecError {
    /// A part that is no `what=policy`.
    #[error("{part:?} is not of the form what=policy; there are {}", Keys)]
    Form {
        /// The part.
        part: String,
    },
    /// A name that is not known.
    #[error("{key:?} cannot be repaired; there are {}", Keys)]
    UnknownKey {
        /// The name.
        key: String,
    },
    /// A policy that does not go with what is to be repaired.
    #[error("{key} takes {known}, not {policy:?}")]
    UnknownPolicy {
        /// What is to be repaired.
        key: &'static str,
        /// The policy.
        policy: String,
        /// What it takes.
        known: String,
    },
    /// The same name twice.
    #[error("{key} is given twice")]
    Twice {
        /// The name.
        key: &'static str,
    },
}

const KEYS: [&str; 6] = ["non-planar", "zero-area", "self-crossing", "malformed", "duplicate", "weld"];

/// Lists the names.
struct Keys;

impl fmt::Display for Keys {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&KEYS.join(", "))
    }
}

const NON_PLANAR: [(&str, NonPlanarPolicy); 3] = [
    ("triangulate", NonPlanarPolicy::Triangulate),
    ("reject", NonPlanarPolicy::Reject),
    ("drop", NonPlanarPolicy::Drop),
];
const ZERO_AREA: [(&str, ZeroAreaPolicy); 2] = [("keep", ZeroAreaPolicy::Keep), ("reject", ZeroAreaPolicy::Reject)];
const OR_DROP: [(&str, OrDrop); 2] = [("reject", OrDrop::Reject), ("drop", OrDrop::Drop)];
const DUPLICATES: [(&str, DuplicatePolicy); 3] =
    [("keep", DuplicatePolicy::Keep), ("reject", DuplicatePolicy::Reject), ("drop", DuplicatePolicy::Drop)];

/// The policy of that word.
fn policy<P: Copy>(words: &[(&str, P)], key: &'static str, word: &str) -> Result<P, RepairSpecError> {
    let known = words.iter().find(|(name, _)| *name == word);
    known.map(|&(_, policy)| policy).ok_or_else(|| {
        let known = words.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(" or ");
        RepairSpecError::UnknownPolicy { key, policy: word.to_owned(), known }
    })
}

/// The word of a policy.
fn word<P: Copy + PartialEq>(words: &[(&'static str, P)], policy: P) -> &'static str {
    words.iter().find(|(_, known)| *known == policy).map_or("", |(name, _)| name)
}

impl FromStr for Repair {
    type Err = RepairSpecError;

    /// Reads a list of `what=policy`, separated by commas, each at most once; the empty text is the default.
    fn from_str(text: &str) -> Result<Self, RepairSpecError> {
        let mut repair = Self::default();
        let mut given = Vec::new();
        for part in text.split(',').filter(|_| !text.trim().is_empty()) {
            let Some((key, value)) = part.split_once('=') else {
                return Err(RepairSpecError::Form { part: part.to_owned() });
            };
            let (key, value) = (key.trim(), value.trim());
            let Some(&key) = KEYS.iter().find(|&&known| known == key) else {
                return Err(RepairSpecError::UnknownKey { key: key.to_owned() });
            };
            if given.contains(&key) {
                return Err(RepairSpecError::Twice { key });
            }
            given.push(key);
            match key {
                "non-planar" => repair.non_planar = policy(&NON_PLANAR, key, value)?,
                "zero-area" => repair.zero_area = policy(&ZERO_AREA, key, value)?,
                "self-crossing" => repair.self_crossing = policy(&OR_DROP, key, value)?,
                "malformed" => repair.malformed = policy(&OR_DROP, key, value)?,
                "duplicate" => repair.duplicates = policy(&DUPLICATES, key, value)?,
                _ => repair.weld = Some(tolerance(key, value)?),
            }
        }
        Ok(repair)
    }
}

fn tolerance(key: &'static str, word: &str) -> Result<f64, RepairSpecError> {
    let number = word.parse().ok().filter(|&x: &f64| x.is_finite() && x >= 0.0);
    number.ok_or_else(|| {
        let known = "a distance of at least 0".to_owned();
        RepairSpecError::UnknownPolicy { key, policy: word.to_owned(), known }
    })
}

impl fmt::Display for Repair {
    /// What is not the default, as [`FromStr`] reads it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let default = Self::default();
        let mut parts = Vec::new();
        if self.non_planar != default.non_planar {
            parts.push(format!("non-planar={}", word(&NON_PLANAR, self.non_planar)));
        }
        if self.zero_area != default.zero_area {
            parts.push(format!("zero-area={}", word(&ZERO_AREA, self.zero_area)));
        }
        if self.self_crossing != default.self_crossing {
            parts.push(format!("self-crossing={}", word(&OR_DROP, self.self_crossing)));
        }
        if self.malformed != default.malformed {
            parts.push(format!("malformed={}", word(&OR_DROP, self.malformed)));
        }
        if self.duplicates != default.duplicates {
            parts.push(format!("duplicate={}", word(&DUPLICATES, self.duplicates)));
        }
        if let Some(tolerance) = self.weld {
            parts.push(format!("weld={tolerance:?}"));
        }
        f.write_str(&parts.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_policy_is_read_as_it_is_shown() {
        let mut count = 0;
        for (_, non_planar) in NON_PLANAR {
            for (_, zero_area) in ZERO_AREA {
                for (_, self_crossing) in OR_DROP {
                    for (_, malformed) in OR_DROP {
                        for (_, duplicates) in DUPLICATES {
                            for weld in [None, Some(0.0), Some(1e-300), Some(0.1 + 0.2), Some(1e308)] {
                                let repair =
                                    Repair { non_planar, zero_area, self_crossing, malformed, duplicates, weld };
                                assert_eq!(repair.to_string().parse(), Ok(repair));
                                count += 1;
                            }
                        }
                    }
                }
            }
        }
        assert_eq!(count, 3 * 2 * 2 * 2 * 3 * 5);
    }

    #[test]
    fn what_is_no_policy_is_named() {
        let error = |text: &str| text.parse::<Repair>().expect_err(text).to_string();
        assert!(error("weld").contains("\"weld\" is not of the form"));
        assert!(error("holes=drop").contains("non-planar, zero-area, self-crossing, malformed, duplicate, weld"));
        assert_eq!(error("zero-area=drop"), "zero-area takes keep or reject, not \"drop\"");
        assert_eq!(error("weld=1,weld=2"), "weld is given twice");
        for bad in ["weld=-1", "weld=nan", "weld=inf", "weld=1e400", "weld=", "weld=1 mm"] {
            assert!(error(bad).contains("a distance of at least 0"), "{bad}");
        }
        assert!(error("weld=1,").contains("\"\" is not of the form"));
        assert_eq!("".parse(), Ok(Repair::default()));
        assert_eq!(" weld = 0.5 , duplicate=drop".parse::<Repair>().map(|repair| repair.weld), Ok(Some(0.5)));
    }
}
