//! Fields of tables as text (RFC 4180).

use std::borrow::Cow;

/// A field as it is written between commas: in quotes if it has a comma, a quote, a line's end or blanks at an end, with its
/// quotes doubled.
pub(super) fn quoted(field: &str) -> Cow<'_, str> {
    let is_plain = !field.contains([',', '"', '\n', '\r']) && field.trim() == field && !field.is_empty();
    if is_plain { Cow::Borrowed(field) } else { Cow::Owned(format!("\"{}\"", field.replace('"', "\"\""))) }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn only_what_needs_quotes_has_them() {
        for (field, expected) in [
            ("wall", "wall"),
            ("a b", "a b"),
            ("a,b", "\"a,b\""),
            ("a\"b", "\"a\"\"b\""),
            ("", "\"\""),
            (" a", "\" a\""),
            ("a\n", "\"a\n\""),
        ] {
            assert_eq!(quoted(field), expected);
        }
    }
}
