//! A plot of lines, as data and as SVG.

use super::Report;
use crate::error::{Error, ErrorKind};
use plotters::prelude::{ChartBuilder, Color, IntoDrawingArea, IntoFont, LineSeries, Palette, Palette99, PathElement, SVGBackend, WHITE, BLACK};
use std::path::Path;

/// Size of the picture [px].
const SIZE: (u32, u32) = (900, 520);
/// Points of a curve.
const POINTS: usize = 60;

/// Lines over one axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// What it shows.
    pub title: String,
    /// Quantity and unit of the axes, x first.
    pub labels: [String; 2],
    /// The lines, each with its name.
    pub lines: Vec<(String, Vec<[f64; 2]>)>,
}

impl Plot {
    /// The largest error of each joint [% of its peak torque] over the share of the speeds analysed, and the threshold.
    pub fn of(report: &Report) -> Self {
        let curve = |percent: f64| {
            let point = |i: usize| i as f64 / POINTS as f64;
            (0..=POINTS).map(|i| [100.0 * point(i), percent * point(i) * point(i)]).collect::<Vec<_>>()
        };
        let joint = |j: &super::JointReport| {
            (format!("{} (100 % = {})", j.name, j.speed_text(j.top_speed)), curve(j.worst_percent()))
        };
        let mut lines: Vec<_> = report.joints.iter().map(joint).collect();
        let threshold = report.threshold_percent;
        lines.push((format!("threshold {threshold} %"), vec![[0.0, threshold], [100.0, threshold]]));
        Self {
            title: format!("{}: torque error of the reduced model", report.robot),
            labels: ["share of the speeds analysed [%]", "largest error [% of peak torque]"].map(str::to_owned),
            lines,
        }
    }

    /// Draws the lines as an SVG file.
    ///
    /// # Errors
    /// A name that does not end in `.svg`, a plot without points, or a file that cannot be written.
    pub fn draw(&self, path: &Path) -> Result<(), Error> {
        let file = path.display().to_string();
        let wrong = |problem: String, remedy: &str| Error {
            kind: ErrorKind::Io,
            file: file.clone(),
            element: String::new(),
            problem,
            remedy: remedy.to_owned(),
        };
        if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg")) {
            return Err(wrong("plots are drawn as SVG only".to_owned(), "give a file name that ends in .svg"));
        }
        let text = self.svg().map_err(|e| wrong(e, "check the numbers of the plot"))?;
        std::fs::write(path, text)
            .map_err(|e| wrong(format!("cannot be written: {e}"), "check that the folder exists and may be written to"))
    }

    /// The picture as the text of an SVG file.
    fn svg(&self) -> Result<String, String> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in self.lines.iter().flat_map(|(_, points)| points) {
            for (k, x) in point.iter().enumerate() {
                (low[k], high[k]) = (low[k].min(*x), high[k].max(*x));
            }
        }
        if low.iter().chain(&high).any(|x| !x.is_finite()) {
            return Err("the plot has no points, or one that is not finite".to_owned());
        }
        let top = high[1] + 0.05 * (high[1] - low[1]).max(f64::MIN_POSITIVE.max(1e-12 * high[1].abs()));
        let right = if high[0] > low[0] { high[0] } else { low[0] + 1.0 };
        let mut text = String::new();
        let result = (|| -> Result<(), Box<dyn std::error::Error + '_>> {
            let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
            root.fill(&WHITE)?;
            let font = |size: i32| ("sans-serif", size).into_font();
            let mut chart = ChartBuilder::on(&root)
                .caption(&self.title, font(20))
                .margin(12)
                .x_label_area_size(44)
                .y_label_area_size(64)
                .build_cartesian_2d(low[0]..right, low[1]..top.max(low[1] + 1e-12))?;
            let [x, y] = &self.labels;
            chart.configure_mesh().x_desc(x).y_desc(y).label_style(font(14)).light_line_style(BLACK.mix(0.04)).draw()?;
            for (i, (name, points)) in self.lines.iter().enumerate() {
                let colour = Palette99::pick(i).to_rgba();
                chart
                    .draw_series(LineSeries::new(points.iter().map(|[x, y]| (*x, *y)), colour.stroke_width(2)))?
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
            }
            chart
                .configure_series_labels()
                .position(plotters::prelude::SeriesLabelPosition::UpperLeft)
                .background_style(WHITE.mix(0.8))
                .label_font(font(13))
                .draw()?;
            root.present()?;
            Ok(())
        })();
        result.map_err(|e| format!("the plot cannot be drawn: {e}"))?;
        Ok(text)
    }
}
