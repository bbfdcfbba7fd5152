//! Magnitude and phase over frequency.

use super::canvas::{Anchor, Canvas};
use super::panel::{Axis, Panel};
use super::{BLACK, BLUE, Drawing, GREY, LIGHT, ORANGE, digits, picture};
use gyroflex_sim::error::Error;
use gyroflex_sim::linearize::{Response, bode};
use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use std::path::Path;

const SIZE: (u32, u32) = (900, 640);
const LEFT: f64 = 86.0;
const RIGHT: f64 = 878.0;

struct Bode<'a> {
    title: &'a str,
    unit: &'a str,
    response: &'a Response,
}

/// A picture of a frequency response: magnitudes of motor and link above, phases below, resonances marked.
pub fn response(path: &Path, title: &str, unit: &str, response: &Response) -> Result<Vec<u8>, Error> {
    picture(path, SIZE, &Bode { title, unit, response })
}

impl Drawing for Bode<'_> {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), String> {
        let r = self.response;
        let ([motor, motor_phase], [link, link_phase]) = (bode(&r.motor), bode(&r.link));
        let ends = [r.frequency.first().copied().unwrap_or(0.1), r.frequency.last().copied().unwrap_or(1.0)];
        let axis = Axis::logarithmic(ends, "frequency [Hz]");
        canvas.fill(RGBColor(255, 255, 255))?;
        canvas.text(self.title, (LEFT, 20.0), Anchor::Right, 16.0, BLACK)?;
        for (i, (name, colour)) in [("motor position", BLUE), ("link position", ORANGE)].into_iter().enumerate() {
            let x = RIGHT - 250.0 + 130.0 * i as f64;
            canvas.line(&[(x, 20.0), (x + 18.0, 20.0)], colour, 2.5)?;
            canvas.text(name, (x + 23.0, 20.0), Anchor::Right, 13.0, BLACK)?;
        }

        let y = Axis::logarithmic(self.magnitudes(&motor, &link), &format!("magnitude [{}]", self.unit));
        let upper = Panel { left: LEFT, right: RIGHT, top: 56.0, bottom: 350.0, x: axis.clone(), y };
        upper.draw(canvas, false)?;
        self.marks(canvas, &upper)?;
        for (colour, values) in [(ORANGE, &link), (BLUE, &motor)] {
            upper.curve(canvas, r.frequency.iter().zip(values).map(|(f, y)| (*f, *y)), colour)?;
        }

        let degrees = |v: &[f64]| -> Vec<f64> { v.iter().map(|x| x.to_degrees()).collect() };
        let (motor, link) = (degrees(&motor_phase), degrees(&link_phase));
        let y = phases(&motor, &link);
        let lower = Panel { left: LEFT, right: RIGHT, top: 366.0, bottom: 586.0, x: axis, y };
        lower.draw(canvas, true)?;
        for (colour, values) in [(ORANGE, &link), (BLUE, &motor)] {
            lower.curve(canvas, r.frequency.iter().zip(values).map(|(f, y)| (*f, *y)), colour)?;
        }
        Ok(())
    }
}

impl Bode<'_> {
    /// The range of magnitudes worth showing: down to three decades under the motor's lowest, where a link's only falls.
    fn magnitudes(&self, motor: &[f64], link: &[f64]) -> [f64; 2] {
        let lowest = |v: &[f64]| v.iter().copied().filter(|x| *x > 0.0).fold(f64::INFINITY, f64::min);
        let high = motor.iter().chain(link).copied().fold(0.0, f64::max);
        let low = lowest(motor).min(lowest(link)).max(1e-3 * lowest(motor));
        if low.is_finite() && high > low { [low / 1.5, high * 1.5] } else { [0.1, 10.0] }
    }

    /// Resonances as lines with their frequencies, where there is room for the letters.
    fn marks<B: DrawingBackend>(&self, canvas: &Canvas<B>, panel: &Panel) -> Result<(), String> {
        let r = self.response;
        let mut marks: Vec<f64> = r.resonances.iter().chain(&r.antiresonances).map(|e| e.frequency).collect();
        marks.sort_by(f64::total_cmp);
        let mut free = 0.0;
        for f in marks {
            let x = panel.place(f, panel.y.ends[0]).0;
            canvas.line(&[(x, panel.top), (x, panel.bottom)], LIGHT, 1.0)?;
            if x > free {
                canvas.text(&digits(f), (x, panel.top - 16.0), Anchor::Below, 11.0, GREY)?;
                free = x + 46.0;
            }
        }
        Ok(())
    }
}

/// Degrees in quarters of a turn.
fn phases(motor: &[f64], link: &[f64]) -> Axis {
    let all = || motor.iter().chain(link).copied();
    let low = (all().fold(f64::INFINITY, f64::min) / 90.0 - 0.1).floor();
    let high = (all().fold(f64::NEG_INFINITY, f64::max) / 90.0 + 0.1).ceil().max(low + 1.0);
    let every = ((high - low) / 8.0).ceil().max(1.0) as usize;
    let ticks = (low as i32..=high as i32).step_by(every).map(|i| (90.0 * f64::from(i), format!("{}°", 90 * i)));
    Axis { ends: [90.0 * low, 90.0 * high], logarithmic: false, ticks: ticks.collect(), label: "phase".to_owned() }
}
