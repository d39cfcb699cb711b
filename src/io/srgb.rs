//! Colours as screens have them.

/// A linear value as sRGB encodes it (IEC 61966-2-1), from 0 to 255; what is below 0 or above 1 is cut off.
pub(super) fn encoded(linear: f64) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}
