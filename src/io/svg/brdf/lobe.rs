//! The BRDF as a lobe in space.

use super::super::{Number, PathData};
use super::{Seen, arrow, begin, label, round_step, short, word};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::{self, Write};

const SIZE: DVec2 = DVec2::new(820.0, 560.0);
const ORIGIN: DVec2 = DVec2::new(400.0, 420.0);
/// The largest value, in the picture's units.
const RADIUS: f64 = 330.0;
/// Meridians about the mirror direction, and steps along them.
const MERIDIANS: u32 = 72;
const STEPS: u32 = 44;

const STYLE: &str = "\
.quad{stroke:#6b3a10;stroke-width:.3;stroke-opacity:.55;stroke-linejoin:round}
.ground{fill:#eef1f4;stroke:#999;stroke-width:.8}
";

/// Looks at the surface from the side and a little from above.
struct Camera {
    right: DVec3,
    up: DVec3,
    towards: DVec3,
}

impl Camera {
    fn new(away: DVec3) -> Self {
        let across = DVec3::Z.cross(away);
        let (sin, cos) = 28_f64.to_radians().sin_cos();
        // From in front of the plane of incidence, turned so that the viewer comes from the left.
        let back = (away * (0.45 * cos) - across * (0.893 * cos) + DVec3::Z * sin).normalize();
        let right = DVec3::Z.cross(back).normalize();
        Self { right, up: back.cross(right), towards: -back }
    }

    fn place(&self, p: DVec3) -> DVec2 {
        ORIGIN + DVec2::new(p.dot(self.right), -p.dot(self.up)) * RADIUS
    }
}

pub(super) fn write(seen: &Seen<'_>, out: &mut impl Write) -> io::Result<()> {
    begin(SIZE, "BRDF for a fixed viewer", STYLE, out)?;
    let camera = Camera::new(seen.away());
    let points = mesh(seen);
    let most = points.iter().flatten().fold(0.0_f64, |most, p| most.max(p.length()));
    ground(&camera, most, out)?;
    if most > 0.0 {
        quads(&camera, &points, most, out)?;
    }
    let value = |direction: DVec3| if most > 0.0 { seen.luminance(direction) / most } else { 0.0 };
    let mirror = seen.mirrored();
    let mut labelled = |direction: DVec3, end: f64, class: &str, anchor: &str, text: &str| {
        // Where it is inside of the lobe it is not seen.
        let start = if class == "arrow" && text == "mirror" { 0.0 } else { (value(direction) + 0.01).min(end - 0.08) };
        let [from, to] = [start, end].map(|radius| camera.place(direction * radius));
        arrow(from, to, class, out)?;
        label(to + (to - from).normalize_or_zero() * 12.0 + DVec2::Y * 5.0, anchor, "", text, out)
    };
    if seen.outgoing.z < 0.9999 {
        labelled(DVec3::Z, value(DVec3::Z).max(0.6) + 0.18, "axis", "middle", "n")?;
    }
    labelled(seen.outgoing, value(seen.outgoing).max(0.8) + 0.2, "arrow", "end", "viewer")?;
    if seen.has_mirror() {
        labelled(mirror, 1.1, "arrow", "start", "mirror")?;
    } else if seen.outgoing.z < 0.9999 {
        labelled(mirror, value(mirror).max(0.75) + 0.12, "dashed", "start", "r")?;
    }
    if most > 0.0 {
        let step = round_step(most, 1.5);
        let length = step / most * RADIUS;
        let [x, y] = [24.0, 58.0];
        writeln!(out, r#"<path class="axis" d="M{x},{y}v-5v10v-5h{}v-5v10"/>"#, Number(length))?;
        word(
            DVec2::new(x + length + 12.0, y + 5.0),
            "start",
            "small",
            &format!("{} sr\u{207b}\u{b9}", short(step)),
            out,
        )?;
    }
    Ok(())
}

/// The BRDF's luminance times the direction, along meridians from the mirror direction to the horizon.
fn mesh(seen: &Seen<'_>) -> Vec<Vec<DVec3>> {
    let axis = seen.mirrored();
    let across = DVec3::Z.cross(seen.away());
    let down = axis.cross(across);
    let meridian = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(MERIDIANS)).sin_cos();
        let side = across * cos + down * sin;
        // Where cos a axis.z + sin a side.z = 0, first.
        let end = axis.z.atan2(-side.z).clamp(0.0, FRAC_PI_2 + FRAC_PI_2);
        let step = move |j: u32| {
            // Closer together near the axis: at a thousandth of the way first.
            let t = f64::from(j) / f64::from(STEPS);
            let angle = end * 0.999_999 * t * t * (0.25 + 0.75 * t);
            let direction = axis * angle.cos() + side * angle.sin();
            direction * seen.luminance(direction)
        };
        (0..=STEPS).map(step).collect()
    };
    (0..MERIDIANS).map(meridian).collect()
}

fn quads(camera: &Camera, points: &[Vec<DVec3>], most: f64, out: &mut impl Write) -> io::Result<()> {
    let mut quads: Vec<(f64, [DVec3; 4])> = Vec::new();
    for (k, here) in points.iter().enumerate() {
        let next = &points[(k + 1) % points.len()];
        for j in 1..here.len() {
            let quad = [here[j - 1], next[j - 1], next[j], here[j]].map(|p| p / most);
            let depth = quad.iter().map(|p| p.dot(camera.towards)).sum();
            quads.push((depth, quad));
        }
    }
    // From far to near.
    quads.sort_by(|a, b| b.0.total_cmp(&a.0));
    let light = (camera.up * 0.7 - camera.towards * 0.55 - camera.right * 0.45).normalize();
    writeln!(out, r#"<g id="lobe">"#)?;
    for (_, [a, b, c, d]) in quads {
        let Some(normal) = (c - a).cross(d - b).try_normalize() else { continue };
        // Outwards.
        let normal = if normal.dot(a + b + c + d) < 0.0 { -normal } else { normal };
        let shade = 0.5 + 0.5 * normal.dot(light);
        let [red, green, blue] = [(150.0, 255.0), (85.0, 196.0), (30.0, 110.0)]
            .map(|(low, high)| (low + (high - low) * shade).round().clamp(0.0, 255.0) as u8);
        let mut data = PathData::default();
        data.add([a, b, c, d].map(|p| camera.place(p)), true);
        if !data.is_empty() {
            writeln!(out, r##"<path class="quad" fill="#{red:02x}{green:02x}{blue:02x}" d="{data}"/>"##)?;
        }
    }
    writeln!(out, "</g>")
}

/// A disc of the surface.
fn ground(camera: &Camera, most: f64, out: &mut impl Write) -> io::Result<()> {
    let radius = if most > 0.0 { 0.75 } else { 0.6 };
    let rim = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / 96.0).sin_cos();
        camera.place(DVec3::new(cos, sin, 0.0) * radius)
    };
    let mut data = PathData::default();
    data.add((0..96).map(rim), true);
    writeln!(out, r#"<path class="ground" d="{data}"/>"#)
}
