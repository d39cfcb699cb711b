//! Pictures of BRDFs: on the image plane below a contour image, as a polar diagram, as a lobe in space.

mod bands;
mod lobe;
mod plane;
mod polar;

use super::{Number, open, paper};
use crate::brdf::{Brdf, Form, Place};
use crate::contour::ContourImage;
use glam::{DVec2, DVec3};
use std::io::{self, BufWriter, Error, Write};

/// What a picture of a BRDF shows, for one direction towards the viewer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BrdfPicture {
    /// The BRDF times the cosine times the ratio of solid angles, on the image plane that is perpendicular to the normal: what one integrates over that plane. A matt
    /// surface gives cos^4. The contour image is drawn over it.
    #[default]
    Plane,
    /// The BRDF in the plane of the normal and the viewer, as a polar diagram by colours.
    Polar,
    /// The BRDF's luminance over the hemisphere, as the surface that it is the radius of.
    Lobe,
}

impl BrdfPicture {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Plane, Self::Polar, Self::Lobe];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Polar => "polar",
            Self::Lobe => "lobe",
        }
    }
}

/// Draws a BRDF for a surface at the viewpoint of an image of a hemisphere, and a viewer, as for
/// [`reflected_radiance`](crate::brdf::reflected_radiance). What mirrors reflect is drawn as an arrow: it has no finite value.
///
/// # Errors
/// Those of `out`; or of kind `InvalidInput` if there is no surface, or a direction is not fit for use.
pub fn write_brdf_svg(
    image: &ContourImage,
    brdf: &dyn Brdf,
    tangent: Option<DVec3>,
    view: DVec3,
    picture: BrdfPicture,
    out: impl Write,
) -> io::Result<()> {
    let place = Place::new(image, tangent, view).map_err(Error::other)?;
    let lobe = Seen { brdf, outgoing: place.outgoing };
    let mut out = BufWriter::new(out);
    match picture {
        BrdfPicture::Plane => plane::write(image, &place, &lobe, &mut out)?,
        BrdfPicture::Polar => polar::write(&lobe, &mut out)?,
        BrdfPicture::Lobe => lobe::write(&lobe, &mut out)?,
    }
    writeln!(out, "</svg>")?;
    out.flush()
}

/// A BRDF as a viewer sees it.
struct Seen<'a> {
    brdf: &'a dyn Brdf,
    outgoing: DVec3,
}

impl Seen<'_> {
    fn eval(&self, incoming: DVec3) -> DVec3 {
        self.brdf.eval(incoming, self.outgoing)
    }

    /// What the eye makes of red, green and blue (ITU-R BT.709).
    fn luminance(&self, incoming: DVec3) -> f64 {
        self.eval(incoming).dot(DVec3::new(0.2126, 0.7152, 0.0722))
    }

    fn mirrored(&self) -> DVec3 {
        DVec3::new(-self.outgoing.x, -self.outgoing.y, self.outgoing.z)
    }

    /// The horizontal direction away from the viewer; the tangent if the viewer looks straight down.
    fn away(&self) -> DVec3 {
        DVec3::new(-self.outgoing.x, -self.outgoing.y, 0.0).try_normalize().unwrap_or(DVec3::X)
    }

    /// True if a part of it is a mirror.
    fn has_mirror(&self) -> bool {
        fn found(form: &Form<'_>, outgoing: DVec3) -> bool {
            match form {
                Form::Dirac { .. } => true,
                Form::Sum(parts) => parts.iter().any(|part| found(&part.form(outgoing), outgoing)),
                _ => false,
            }
        }
        found(&self.brdf.form(self.outgoing), self.outgoing)
    }

    /// Where it is large, besides about the mirror direction.
    fn axes(&self) -> Vec<DVec3> {
        fn gather(form: &Form<'_>, outgoing: DVec3, axes: &mut Vec<DVec3>) {
            match form {
                Form::Lobes(lobes) => axes.extend(lobes.iter().filter(|lobe| lobe.power > 0).map(|lobe| lobe.axis)),
                Form::General { peaks, .. } => axes.extend(peaks.first().map(|peak| peak.axis)),
                Form::Sum(parts) => parts.iter().for_each(|part| gather(&part.form(outgoing), outgoing, axes)),
                _ => {}
            }
        }
        let mut axes = vec![self.mirrored()];
        gather(&self.brdf.form(self.outgoing), self.outgoing, &mut axes);
        axes
    }
}

const STYLE: &str = "\
text{font:14px sans-serif;fill:#222}
.title{font-size:17px}
.small{font-size:12px;fill:#555}
.halo{fill:#fff;stroke:#fff;stroke-width:3.5px;stroke-linejoin:round}
.thin{fill:none;stroke:#999;stroke-width:.7}
.dashed{fill:none;stroke:#777;stroke-width:.8;stroke-dasharray:4 4}
.axis{fill:none;stroke:#222;stroke-width:1.2}
.arrow{fill:none;stroke:#222;stroke-width:1.8;stroke-linecap:round}
.head{fill:#222;stroke:none}
";

/// Opens a picture.
fn begin(size: DVec2, title: &str, style: &str, out: &mut impl Write) -> io::Result<()> {
    open(size, out)?;
    writeln!(out, "<title>{title}</title>\n<style>\n{style}{STYLE}</style>")?;
    paper(size, out)?;
    writeln!(out, r#"<text class="title" x="20" y="28">{title}</text>"#)
}

/// A word at a point, over white that makes it legible on anything.
fn label(at: DVec2, anchor: &str, class: &str, text: &str, out: &mut impl Write) -> io::Result<()> {
    // Twice, as not all programs know how to paint the stroke of a text first.
    word(at, anchor, &format!("{class} halo"), text, out)?;
    word(at, anchor, class, text, out)
}

/// A word at a point.
fn word(at: DVec2, anchor: &str, class: &str, text: &str, out: &mut impl Write) -> io::Result<()> {
    let [x, y] = [Number(at.x), Number(at.y)];
    writeln!(out, r#"<text class="{class}" x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>"#)
}

/// A line with a head at its end.
fn arrow(from: DVec2, to: DVec2, class: &str, out: &mut impl Write) -> io::Result<()> {
    let along = (to - from).normalize_or_zero();
    let base = to - along * 10.0;
    let [left, right] = [along.perp() * 4.0, along.perp() * -4.0].map(|side| base + side);
    let n = |p: DVec2| format!("{},{}", Number(p.x), Number(p.y));
    writeln!(out, r#"<path class="{class}" d="M{} {}"/>"#, n(from), n(base))?;
    writeln!(out, r#"<path class="head" d="M{} {} {}Z"/>"#, n(to), n(left), n(right))
}

/// A value in as few digits as tell it.
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    if (1e-4..1e5).contains(&value.abs()) {
        let text = format!("{value:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{value:.1e}")
    }
}

/// The largest of 1, 2 and 5 times a power of ten that goes at least `parts` times into a positive value.
fn round_step(value: f64, parts: f64) -> f64 {
    let most = value / parts;
    let power = 10_f64.powf(most.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|factor| factor * power).find(|&step| step <= most * (1.0 + 1e-12)).unwrap_or(power)
}
