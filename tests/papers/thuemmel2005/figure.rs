//! Figures 6 and 7 of the paper.

use crate::arm::N;
use crate::following::{LAWS, Run};
use crate::positioning::residual;
use crate::square::{HALF, Square};
use crate::torques::Torques;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::fmt::Display;
use std::ops::Range;

const SIZE: (u32, u32) = (960, 1040);
/// The letters of the program's own plots.
const FONT: &[u8] = include_bytes!("../../../crates/cli/src/plot/font/plot-sans.ttf");
/// Colours that the colour-blind can tell apart (Okabe, Ito), one per joint.
const COLOURS: [RGBColor; N] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(60, 60, 60),
];
/// Those of the controllers.
const OF_LAW: [RGBColor; 3] = [RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(0, 114, 178)];
/// Samples to a drawn point.
const EVERY: usize = 2;
/// End of the drawn part of figure 6 [s].
const STEP_END: f64 = 0.5;
/// How much larger deviations from the path are drawn than they are.
const MAGNIFIED: f64 = 10.0;

/// What is drawn.
pub struct Content<'a> {
    /// Figure 6.
    pub torques: &'a Torques,
    /// Figure 7, left: a run under each of the [`LAWS`].
    pub positioning: &'a [Run],
    /// Figure 7, right.
    pub square: &'a Square,
    /// The same along it.
    pub tracking: &'a [Run],
}

/// All panels, as SVG.
pub fn svg(content: &Content<'_>) -> Result<String, Failed> {
    register_font("sans-serif", FontStyle::Normal, FONT).map_err(|_| "the font cannot be read")?;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(why)?;
        let (upper, lower) = root.split_vertically(440);
        let (middle, bottom) = lower.split_vertically(360);
        figure_6(&upper, content.torques)?;
        let (left, right) = middle.split_horizontally(520);
        vibration(&left, content.positioning)?;
        path(&right, content.square, content.tracking)?;
        deviation(&bottom, content.square, content.tracking)?;
        root.present().map_err(why)?;
    }
    Ok(text)
}

/// Says why a picture could not be drawn; plotters' own errors borrow the picture.
type Failed = String;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A line with its name, empty for none.
struct Line {
    name: String,
    colour: RGBColor,
    points: Vec<(f64, f64)>,
}

fn figure_6(area: &Area<'_>, torques: &Torques) -> Result<(), Failed> {
    let lines = |named: bool, values: &dyn Fn(usize) -> Vec<f64>| -> Vec<Line> {
        let line = |joint: usize| Line {
            name: if named { format!("joint {}", joint + 1) } else { String::new() },
            colour: COLOURS[joint],
            points: torques.time.iter().copied().zip(values(joint)).filter(|p| p.0 <= STEP_END).collect(),
        };
        (0..N).map(line).collect()
    };
    let (left, right) = area.split_horizontally(520);
    let (rigid, reduced) = right.split_vertically(220);
    let time = "time [s]";
    chart(&left, "motor torque, complete model", [time, "torque [N m]"], &lines(true, &|j| torques.of[0][j].clone()))?;
    chart(&rigid, "rigid model less complete", [time, "error [N m]"], &lines(false, &|j| torques.difference(2, j)))?;
    chart(&reduced, "reduced model less complete", [time, "error [N m]"], &lines(false, &|j| torques.difference(1, j)))
}

fn vibration(area: &Area<'_>, runs: &[Run]) -> Result<(), Failed> {
    let line = |law: usize| Line {
        name: LAWS[law].0.to_owned(),
        colour: OF_LAW[law],
        points: residual(&runs[law]).into_iter().map(|(t, d)| (t, 1e3 * d)).step_by(EVERY).collect(),
    };
    let labels = ["time after the motion [s]", "distance from rest [mm]"];
    chart(area, "tip after positioning", labels, &[line(0), line(2)])
}

fn deviation(area: &Area<'_>, square: &Square, runs: &[Run]) -> Result<(), Failed> {
    let line = |law: usize| {
        let run = &runs[law];
        let points = run.time.iter().zip(&run.tip).map(|(t, p)| (*t, 1e3 * square.distance(*p)));
        Line { name: LAWS[law].0.to_owned(), colour: OF_LAW[law], points: points.step_by(EVERY).collect() }
    };
    chart(area, "tip along the square", ["time [s]", "distance from path [mm]"], &[line(0), line(2)])
}

fn path(area: &Area<'_>, square: &Square, runs: &[Run]) -> Result<(), Failed> {
    let millimetres = |p: gyroflex::spatial::Vec3<f64>| {
        let [x, y, _] = (p - square.centre).scale(1e3).to_array();
        (x, y)
    };
    let line = |law: usize| {
        let magnified = |p: &gyroflex::spatial::Vec3<f64>| {
            let foot = square.nearest(*p);
            millimetres(foot + (*p - foot).scale(MAGNIFIED))
        };
        let points = runs[law].tip.iter().map(magnified).step_by(EVERY).collect();
        Line { name: String::new(), colour: OF_LAW[law], points }
    };
    let title = format!("path from above, deviations × {MAGNIFIED}");
    // The panel is wider than high by as much, so that the square is one.
    let (half, wide) = (1.5e3 * HALF, 1.28 * 1.5e3 * HALF);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(20)
        .caption(title, ("sans-serif", 16))
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(-wide..wide, -half..half)
        .map_err(why)?;
    chart
        .configure_mesh()
        .x_desc("x [mm]")
        .y_desc("y [mm]")
        .x_labels(7)
        .y_labels(7)
        .x_label_formatter(&number)
        .y_label_formatter(&number)
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(why)?;
    for Line { colour, points, .. } in [line(0), line(2)] {
        chart.draw_series(LineSeries::new(points, colour.stroke_width(2))).map_err(why)?;
    }
    let start = Circle::new((-1e3 * HALF, 0.0), 4, BLACK.filled());
    chart.draw_series([start]).map_err(why)?;
    Ok(())
}

/// Lines with their names above them, where they have any.
fn chart(area: &Area<'_>, title: &str, [x, y]: [&str; 2], lines: &[Line]) -> Result<(), Failed> {
    let (width, height) = (range(lines, |p| p.0), range(lines, |p| p.1));
    let room = 0.06 * (height.end - height.start);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(20)
        .caption(title, ("sans-serif", 16))
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(width, height.start - room..height.end + room)
        .map_err(why)?;
    chart
        .configure_mesh()
        .x_desc(x)
        .y_desc(y)
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&number)
        .y_label_formatter(&number)
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(why)?;
    for Line { name, colour, points } in lines {
        let colour = *colour;
        let drawn = chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2))).map_err(why)?;
        if !name.is_empty() {
            let key = move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2));
            drawn.label(name).legend(key);
        }
    }
    if lines.iter().any(|l| !l.name.is_empty()) {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE)
            .label_font(("sans-serif", 14))
            .draw()
            .map_err(why)?;
    }
    Ok(())
}

/// A number beside an axis, without zeros behind it.
fn number(x: &f64) -> String {
    // Adding zero takes the sign off it.
    ((1e3 * x).round() / 1e3 + 0.0).to_string()
}

/// From the least to the largest coordinate of all points.
fn range(lines: &[Line], of: fn(&(f64, f64)) -> f64) -> Range<f64> {
    let all = || lines.iter().flat_map(|l| l.points.iter().map(of));
    all().fold(f64::INFINITY, f64::min)..all().fold(f64::NEG_INFINITY, f64::max)
}

fn why(e: impl Display) -> Failed {
    e.to_string()
}
