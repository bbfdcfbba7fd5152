//! Figure 3 of the paper, and the significance ratio beneath it.

use crate::study::Comparison;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::fmt::Display;

const SIZE: (u32, u32) = (900, 640);
/// The letters of the program's own plots.
const FONT: &[u8] = include_bytes!("../../../crates/cli/src/plot/font/plot-sans.ttf");

/// Both tool errors and `r_s` over time, as SVG.
pub fn svg(c: &Comparison) -> Result<String, Failed> {
    register_font("sans-serif", FontStyle::Normal, FONT).map_err(|_| "the font cannot be read")?;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(why)?;
        let (upper, lower) = root.split_vertically(400);
        let micro = |v: &[f64]| v.iter().map(|x| 1e6 * x).collect::<Vec<_>>();
        let lines = [
            ("complete simulator", RGBColor(0, 114, 178), micro(&c.error[0])),
            ("reduced simulator", RGBColor(213, 94, 0), micro(&c.error[1])),
        ];
        panel(&upper, "tool error [µm]", &c.time, &lines)?;
        panel(&lower, "r_s", &c.time, &[("significance ratio", RGBColor(60, 60, 60), c.ratio.clone())])?;
        root.present().map_err(why)?;
    }
    Ok(text)
}

/// Says why a picture could not be drawn; plotters' own errors borrow the picture.
type Failed = String;
type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Lines over time with their names.
fn panel(area: &Area<'_>, label: &str, time: &[f64], lines: &[(&str, RGBColor, Vec<f64>)]) -> Result<(), Failed> {
    let all = || lines.iter().flat_map(|(.., y)| y.iter().copied());
    let (low, high) = (all().fold(0.0, f64::min), all().fold(1e-12, f64::max));
    // Above the lines, the names have a place of their own.
    let (room, head) = (0.05 * (high - low), 0.15 * (1 + lines.len()) as f64 * (high - low));
    let end = time.last().copied().unwrap_or(1.0);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(0.0..end, low - room..high + head)
        .map_err(why)?;
    chart
        .configure_mesh()
        .x_desc("time [s]")
        .y_desc(label)
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(why)?;
    for (name, colour, values) in lines {
        let colour = *colour;
        let points = time.iter().copied().zip(values.iter().copied());
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(2)))
            .map_err(why)?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
    }
    let place = SeriesLabelPosition::UpperRight;
    chart
        .configure_series_labels()
        .position(place)
        .background_style(WHITE)
        .label_font(("sans-serif", 14))
        .draw()
        .map_err(why)?;
    Ok(())
}

fn why(e: impl Display) -> Failed {
    e.to_string()
}
