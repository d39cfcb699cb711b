//! Numbers in text files.

use std::fmt;

/// Reads a finite decimal number; otherwise says what is wrong with it.
pub(super) fn parse(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) if text.bytes().any(|byte| byte.is_ascii_digit()) => {
            Err(format!("the number {} is too large; the largest is about 1.8e308", shown(text)))
        }
        Ok(_) => Err(format!("{} is not a finite number", shown(text))),
        Err(_) => Err(format!("{} is not a number", shown(text))),
    }
}

/// Text of a file in quotes, shortened and escaped for a message.
pub(super) fn shown(text: &str) -> String {
    const LENGTH: usize = 40;
    let mut end = text.chars();
    let start: String = end.by_ref().take(LENGTH).collect();
    let dots = if end.next().is_some() { "..." } else { "" };
    format!("`{}{dots}`", start.escape_debug())
}

/// A finite number with 32 bits: the largest of them where it is larger.
#[cfg(any(feature = "exr", all(feature = "gltf", feature = "json")))]
pub(super) fn single(x: f64) -> f32 {
    (x as f32).clamp(f32::MIN, f32::MAX)
}

/// A finite number as the shortest text that reads as the same number.
pub(super) struct Shortest(pub(super) f64);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e16).contains(&size) { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}
