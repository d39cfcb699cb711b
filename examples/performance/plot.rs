//! Charts with logarithmic axes.

use nusselt::io::atomic_write;
use plotters::prelude::*;
use std::error::Error;
use std::io::Write;
use std::path::Path;

/// An axis.
pub(crate) struct Log {
    pub(crate) title: &'static str,
    pub(crate) range: (f64, f64),
}

/// Points of one kind.
pub(crate) struct Series {
    pub(crate) name: &'static str,
    pub(crate) points: Vec<(f64, f64)>,
}

/// Colours that stay apart for the colour-blind (Okabe and Ito 2008).
const COLOURS: [RGBColor; 3] = [RGBColor(213, 94, 0), RGBColor(0, 114, 178), RGBColor(0, 158, 115)];

/// A chart of at most three series, of points that lines join or not.
pub(crate) fn chart(path: &Path, x: &Log, y: &Log, series: &[Series], joined: bool) -> Result<(), Box<dyn Error>> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (640, 460)).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(62)
            .build_cartesian_2d((x.range.0..x.range.1).log_scale(), (y.range.0..y.range.1).log_scale())?;
        chart
            .configure_mesh()
            .x_desc(x.title)
            .y_desc(y.title)
            .x_label_formatter(&|x| format!("{x}"))
            .y_label_formatter(&|y| format!("{y}"))
            .bold_line_style(BLACK.mix(0.15))
            .light_line_style(TRANSPARENT)
            .label_style(("sans-serif", 13))
            .draw()?;
        for (Series { name, points }, colour) in series.iter().zip(COLOURS) {
            let size = if joined { 3 } else { 2 };
            let dots = points.iter().map(|&point| Circle::new(point, size, colour.filled()));
            chart.draw_series(dots)?.label(*name).legend(move |at| Circle::new((at.0 + 10, at.1), 4, colour.filled()));
            if joined {
                chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
            }
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.filled())
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 14))
            .draw()?;
        root.present()?;
    }
    Ok(atomic_write(path, |file| file.write_all(svg.as_bytes()))?)
}
