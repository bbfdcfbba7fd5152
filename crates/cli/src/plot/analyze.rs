//! Errors of the reduced model over speed.

use super::canvas::{Anchor, Canvas};
use super::panel::{Axis, Panel};
use super::{BLACK, Drawing, GREY, picture};
use gyroflex_sim::analyze::{JointReport, Report};
use gyroflex_sim::error::Error;
use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use std::path::Path;

const SIZE: (u32, u32) = (900, 520);
const LEFT: f64 = 86.0;
const RIGHT: f64 = 620.0;
/// Points of a curve.
const POINTS: usize = 120;
/// Colours that everybody can tell apart (Okabe, Ito); joints beyond them begin anew.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
];

/// A picture of the largest error of each joint [% of its peak torque] over the share of the speeds analysed, with the threshold.
pub fn analysis(path: &Path, report: &Report) -> Result<Vec<u8>, Error> {
    picture(path, SIZE, report)
}

impl Drawing for Report {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), String> {
        let worst = self.joints.iter().map(JointReport::worst_percent).fold(0.0, f64::max);
        let top = 1.1 * worst.max(self.threshold_percent);
        let panel = Panel {
            left: LEFT,
            right: RIGHT,
            top: 56.0,
            bottom: f64::from(SIZE.1) - 54.0,
            x: Axis::linear([0.0, 100.0], "speed [% of the speeds analysed]"),
            y: Axis::linear([0.0, top], "largest error [% of peak torque]"),
        };
        canvas.fill(RGBColor(255, 255, 255))?;
        let title = format!("{}: torque that the reduced model leaves out", self.robot);
        canvas.text(&title, (LEFT, 20.0), Anchor::Right, 16.0, BLACK)?;
        panel.draw(canvas, true)?;
        let threshold = self.threshold_percent;
        panel.curve(canvas, [(0.0, threshold), (100.0, threshold)].into_iter(), GREY)?;
        let key = |row: usize, text: &str, colour: RGBColor| -> Result<(), String> {
            let (x, y) = (RIGHT + 16.0, 64.0 + 20.0 * row as f64);
            canvas.line(&[(x, y), (x + 18.0, y)], colour, 2.5)?;
            canvas.text(text, (x + 24.0, y), Anchor::Right, 12.0, BLACK)
        };
        for (i, joint) in self.joints.iter().enumerate() {
            let colour = COLOURS[i % COLOURS.len()];
            // Errors grow with the square of the speed.
            let at = |k: usize| k as f64 / POINTS as f64;
            let curve = (0..=POINTS).map(|k| (100.0 * at(k), joint.worst_percent() * at(k) * at(k)));
            panel.curve(canvas, curve, colour)?;
            key(i, &format!("{}, 100 % = {}", joint.name, joint.speed_text(joint.top_speed)), colour)?;
        }
        key(self.joints.len(), &format!("threshold, {threshold} %"), GREY)
    }
}
