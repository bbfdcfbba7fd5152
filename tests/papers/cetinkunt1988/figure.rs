//! Joint angles of the flexible arm over those of the rigid one (the paper's figures 5 to 7).

use crate::study::Response;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::fmt::Display;

const SIZE: (u32, u32) = (1000, 760);
/// The letters of the program's own plots.
const FONT: &[u8] = include_bytes!("../../../crates/cli/src/plot/font/plot-sans.ttf");
const COLOURS: [RGBColor; 2] = [RGBColor(0, 114, 178), RGBColor(213, 94, 0)];
const GREY: RGBColor = RGBColor(120, 120, 120);

/// Says why a picture could not be drawn; plotters' own errors borrow the picture.
type Failed = String;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The picture, as SVG: one panel per run, the rigid arm in grey.
pub fn svg(rigid: &Response, runs: &[(String, Response)]) -> Result<String, Failed> {
    register_font("sans-serif", FontStyle::Normal, FONT).map_err(|_| "the font cannot be read")?;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(why)?;
        for (area, (name, run)) in root.split_evenly((2, 2)).iter().zip(runs) {
            panel(area, name, rigid, run)?;
        }
        root.present().map_err(why)?;
    }
    Ok(text)
}

fn panel(area: &Area<'_>, name: &str, rigid: &Response, run: &Response) -> Result<(), Failed> {
    let all = || [rigid, run].into_iter().flat_map(|r| r.angles.iter().flatten());
    let (low, high) = (all().fold(0.0, |a: f64, b| a.min(*b)), all().fold(0.0, |a: f64, b| a.max(*b)));
    let room = 0.08 * (high - low);
    let end = run.time.last().copied().unwrap_or(1.0);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(name, ("sans-serif", 16))
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d(0.0..end, low - room..high + 2.0 * room)
        .map_err(why)?;
    chart
        .configure_mesh()
        .x_desc("time [s]")
        .y_desc("joint angle [rad]")
        .label_style(("sans-serif", 13))
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(why)?;
    let line = |r: &Response, j: usize| r.time.iter().copied().zip(r.angles[j].iter().copied()).collect::<Vec<_>>();
    for j in 0..2 {
        let grey = GREY.stroke_width(if j == 0 { 3 } else { 1 });
        chart
            .draw_series(LineSeries::new(line(rigid, j), grey))
            .map_err(why)?
            .label(format!("joint {}, rigid links", j + 1))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], grey));
        let colour = COLOURS[j].stroke_width(2);
        chart
            .draw_series(LineSeries::new(line(run, j), colour))
            .map_err(why)?
            .label(format!("joint {}", j + 1))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", 12))
        .draw()
        .map_err(why)
}

fn why(e: impl Display) -> Failed {
    e.to_string()
}
