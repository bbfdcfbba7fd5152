//! Stick diagram, forces of the ground, errors and torques of one step (the paper's figures 2 to 5).

use crate::study::Study;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::fmt::Display;

const SIZE: (u32, u32) = (1000, 1180);
/// The letters of the program's own plots.
const FONT: &[u8] = include_bytes!("../../../crates/cli/src/plot/font/plot-sans.ttf");
const BLUE: RGBColor = RGBColor(0, 114, 178);
const ORANGE: RGBColor = RGBColor(213, 94, 0);
const GREY: RGBColor = RGBColor(90, 90, 90);
/// Two steps in the middle of the walk [s].
const SPAN: (f64, f64) = (6.9, 8.3);

/// Says why a picture could not be drawn; plotters' own errors borrow the picture.
type Failed = String;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The picture, as SVG.
pub fn svg(ideal: &Study, elastic: &Study) -> Result<String, Failed> {
    register_font("sans-serif", FontStyle::Normal, FONT).map_err(|_| "the font cannot be read")?;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(why)?;
        let (sticks, rest) = root.split_vertically(380);
        diagram(&sticks, ideal)?;
        let panels = rest.split_evenly((4, 1));
        let vertical = |s: &Study, foot: &str| column(s, &format!("contact.{foot}.fz"), 1.0);
        panel(
            &panels[0],
            "vertical force [N], ideal",
            &[("left foot", BLUE, vertical(ideal, "left_foot")), ("right foot", ORANGE, vertical(ideal, "right_foot"))],
        )?;
        panel(
            &panels[1],
            "vertical force [N], elastic",
            &[
                ("left foot", BLUE, vertical(elastic, "left_foot")),
                ("right foot", ORANGE, vertical(elastic, "right_foot")),
            ],
        )?;
        panel(
            &panels[2],
            "error of the hip [mm]",
            &[
                ("ahead, ideal", BLUE, column(ideal, "tracking_error.hip_x", 1e3)),
                ("up, ideal", ORANGE, column(ideal, "tracking_error.hip_z", 1e3)),
                ("ahead, elastic", GREY, column(elastic, "tracking_error.hip_x", 1e3)),
            ],
        )?;
        panel(
            &panels[3],
            "torque of the left knee [N m]",
            &[
                ("ideal", BLUE, column(ideal, "tau.left_knee", 1.0)),
                ("elastic, through the spring", ORANGE, column(elastic, "tau_j.left_knee", 1.0)),
            ],
        )?;
        root.present().map_err(why)?;
    }
    Ok(text)
}

type Points = Vec<(f64, f64)>;

fn column(study: &Study, name: &str, scale: f64) -> Points {
    let (time, values) = (study.column("time"), study.column(name));
    let inside = |(t, _): &(f64, f64)| (SPAN.0..SPAN.1).contains(t);
    time.iter().copied().zip(values.iter().map(|v| scale * v)).filter(inside).collect()
}

/// The biped every 50 ms: solid on one foot, pale on both, with its centre of mass.
fn diagram(area: &Area<'_>, study: &Study) -> Result<(), Failed> {
    let time = study.column("time");
    let from = time.iter().position(|t| *t >= SPAN.0).unwrap_or(0);
    let to = time.iter().position(|t| *t >= SPAN.1).unwrap_or(time.len());
    let ahead = study.column("q.hip_x");
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(60)
        .build_cartesian_2d(ahead[from] - 0.45..ahead[to - 1] + 0.45, -0.02..1.0)
        .map_err(why)?;
    chart
        .configure_mesh()
        .x_desc("ahead [m]")
        .y_desc("up [m]")
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(why)?;
    let period = time[1] - time[0];
    for k in (from..to).step_by((0.05 / period).round() as usize) {
        let colour = if study.phase(time[k]).1 { ORANGE.mix(0.8) } else { BLUE.mix(0.8) };
        let [hip, knee, foot] = study.leg("left", k);
        let [_, other_knee, other_foot] = study.leg("right", k);
        let pitch = study.column("q.trunk_pitch")[k];
        let head = [hip[0] + 0.486 * pitch.sin(), hip[1] + 0.486 * pitch.cos()];
        for line in [[head, hip].as_slice(), &[hip, knee, foot], &[hip, other_knee, other_foot]] {
            let points: Points = line.iter().map(|p| (p[0], p[1])).collect();
            chart.draw_series(LineSeries::new(points, colour.stroke_width(1))).map_err(why)?;
        }
        let centre = ["x", "z"].map(|axis| study.column(&format!("center_of_mass.{axis}"))[k]);
        chart.draw_series([Cross::new((centre[0], centre[1]), 3, BLACK)]).map_err(why)?;
    }
    Ok(())
}

/// Lines over time with their names.
fn panel(area: &Area<'_>, label: &str, lines: &[(&str, RGBColor, Points)]) -> Result<(), Failed> {
    let all = || lines.iter().flat_map(|(.., p)| p.iter().map(|p| p.1));
    let (low, high) = (all().fold(0.0, f64::min), all().fold(1e-12, f64::max));
    let (room, head) = (0.05 * (high - low), 0.1 * (high - low));
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(32)
        .y_label_area_size(60)
        .build_cartesian_2d(SPAN.0..SPAN.1, low - room..high + head)
        .map_err(why)?;
    chart
        .configure_mesh()
        .x_desc("time [s]")
        .y_desc(label)
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(why)?;
    for (name, colour, points) in lines {
        let colour = *colour;
        chart
            .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))
            .map_err(why)?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", 13))
        .draw()
        .map_err(why)?;
    Ok(())
}

fn why(e: impl Display) -> Failed {
    e.to_string()
}
