//! The BRDF in the plane of the normal and the viewer.

use super::super::{Number, PathData};
use super::{Seen, arrow, begin, label, round_step, short, word};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_PI_2;
use std::io::{self, Write};

const SIZE: DVec2 = DVec2::new(820.0, 500.0);
const ORIGIN: DVec2 = DVec2::new(410.0, 440.0);
const RADIUS: f64 = 320.0;

const COLOURS: [(&str, &str); 3] = [("red", "#c62828"), ("green", "#1b8a3a"), ("blue", "#1f4fc0")];

pub(super) fn write(seen: &Seen<'_>, out: &mut impl Write) -> io::Result<()> {
    begin(
        SIZE,
        "BRDF in the plane of normal and viewer",
        ".curve{fill:none;stroke-width:2;stroke-linejoin:round}\n",
        out,
    )?;
    let away = seen.away();
    let curve: Vec<(f64, DVec3)> =
        angles(seen).into_iter().map(|angle| (angle, seen.eval(away * angle.sin() + DVec3::Z * angle.cos()))).collect();
    let most = curve.iter().fold(0.0_f64, |most, (_, value)| most.max(value.max_element()));
    let scale = if most > 0.0 { RADIUS / most } else { 0.0 };
    grid(most, scale, out)?;
    let is_grey = curve.iter().all(|(_, value)| value.max_element() - value.min_element() <= 1e-9 * most);
    let curves: &[(&str, &str)] = if is_grey { &[("all colours", "#222")] } else { &COLOURS };
    for (k, (name, colour)) in curves.iter().enumerate() {
        let mut data = PathData::default();
        data.add(curve.iter().map(|&(angle, value)| at(angle, value[k] * scale)), false);
        if !data.is_empty() {
            writeln!(out, r#"<path class="curve" stroke="{colour}" d="{data}"/>"#)?;
        }
        let y = 58.0 + 22.0 * k as f64;
        writeln!(out, r#"<path class="curve" stroke="{colour}" d="M24,{}h26"/>"#, y - 5.0)?;
        word(DVec2::new(58.0, y), "start", "small", name, out)?;
    }
    let mirror = seen.outgoing.z.clamp(0.0, 1.0).acos();
    arrow(at(-mirror, RADIUS * 0.72), at(-mirror, RADIUS * 1.1), "arrow", out)?;
    label(at(-mirror, RADIUS * 1.1 + 14.0), "end", "", "viewer", out)?;
    let class = if seen.has_mirror() { "arrow" } else { "dashed" };
    let from = if seen.has_mirror() { 0.0 } else { RADIUS };
    arrow(at(mirror, from), at(mirror, RADIUS * 1.1), class, out)?;
    let what = if seen.has_mirror() { "mirror" } else { "r" };
    label(at(mirror, RADIUS * 1.1 + 10.0), "start", "", what, out)
}

/// The place of a radius at an angle to the normal, positive away from the viewer.
fn at(angle: f64, radius: f64) -> DVec2 {
    ORIGIN + DVec2::new(angle.sin(), -angle.cos()) * radius
}

/// From horizon to horizon, closer together about the peaks.
fn angles(seen: &Seen<'_>) -> Vec<f64> {
    let mut angles: Vec<f64> = (-1799..=1799).map(|k| f64::from(k) * 0.05).map(f64::to_radians).collect();
    for axis in seen.axes() {
        let peak = axis.dot(seen.away()).atan2(axis.z);
        let steps = (0..60).map(|k| 1e-5 * 1.15_f64.powi(k));
        angles.extend(steps.flat_map(|step| [peak - step, peak + step]));
    }
    angles.retain(|angle| angle.abs() < 0.9999 * FRAC_PI_2);
    angles.sort_by(f64::total_cmp);
    angles
}

fn grid(most: f64, scale: f64, out: &mut impl Write) -> io::Result<()> {
    for k in -6_i32..=6 {
        let angle = f64::from(k) * 15.0_f64;
        let [from, to] = [0.0, RADIUS].map(|radius| at(angle.to_radians(), radius));
        let [a, b, c, d] = [from.x, from.y, to.x, to.y].map(Number);
        writeln!(out, r#"<path class="thin" d="M{a},{b} {c},{d}"/>"#)?;
        if k % 2 == 0 {
            let anchor = match k.signum() {
                -1 => "end",
                0 => "middle",
                _ => "start",
            };
            let text = if k == 0 { "n".to_owned() } else { format!("{}\u{b0}", angle.abs()) };
            word(at(angle.to_radians(), RADIUS + 10.0) + DVec2::new(0.0, 4.0), anchor, "small", &text, out)?;
        }
    }
    if most > 0.0 {
        let step = round_step(most, 3.0);
        let mut value = step;
        while value * scale <= RADIUS * (1.0 + 1e-9) {
            let [left, right, radius] = [ORIGIN.x - value * scale, ORIGIN.x + value * scale, value * scale].map(Number);
            let y = Number(ORIGIN.y);
            writeln!(out, r#"<path class="thin" d="M{left},{y}A{radius},{radius} 0 0 1 {right},{y}"/>"#)?;
            word(DVec2::new(ORIGIN.x + value * scale, ORIGIN.y + 18.0), "middle", "small", &short(value), out)?;
            value += step;
        }
    }
    word(
        DVec2::new(ORIGIN.x, ORIGIN.y + 40.0),
        "middle",
        "small",
        "BRDF by the direction that light comes from, in sr\u{207b}\u{b9}",
        out,
    )?;
    let [left, right, y] = [ORIGIN.x - RADIUS, ORIGIN.x + RADIUS, ORIGIN.y].map(Number);
    writeln!(out, r#"<path class="axis" d="M{left},{y} {right},{y}"/>"#)
}
