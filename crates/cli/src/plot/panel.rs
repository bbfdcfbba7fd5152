//! A rectangle with axes.

use super::canvas::{Anchor, Canvas};
use super::{BLACK, GREY, PALE, RGBColor};
use plotters::prelude::DrawingBackend;

/// Values along one side.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// Values at its ends.
    pub(super) ends: [f64; 2],
    /// Whether equal ratios have equal lengths.
    pub(super) logarithmic: bool,
    /// Values with a line and a label.
    pub(super) ticks: Vec<(f64, String)>,
    /// What it shows.
    pub(super) label: String,
}

impl Axis {
    /// A logarithmic axis, with ticks at powers of ten, or closer where there are few.
    pub(super) fn logarithmic(ends: [f64; 2], label: &str) -> Self {
        let decades = (ends[1] / ends[0]).log10();
        let steps: &[f64] = match decades {
            d if d < 1.0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
            d if d < 3.5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let every = (decades / 9.0).ceil().max(1.0) as i32;
        let powers = ends[0].log10().floor() as i32..=ends[1].log10().ceil() as i32;
        let ticks = powers
            .filter(|p| p % every == 0)
            .flat_map(|p| steps.iter().map(move |s| s * 10_f64.powi(p)))
            .filter(|x| (ends[0]..=ends[1]).contains(x))
            .map(|x| (x, short(x)));
        Self { ends, logarithmic: true, ticks: ticks.collect(), label: label.to_owned() }
    }

    /// An axis of equal steps, with ticks at round numbers.
    pub(super) fn linear(ends: [f64; 2], label: &str) -> Self {
        let rough = ((ends[1] - ends[0]) / 6.0).max(f64::MIN_POSITIVE);
        let power = 10_f64.powf(rough.log10().floor());
        let step = power * [1.0, 2.0, 5.0].into_iter().find(|s| s * power >= rough).unwrap_or(10.0);
        let ticks = (0..20).map(|i| ((ends[0] / step).ceil() + f64::from(i)) * step).filter(|x| *x <= ends[1]);
        Self { ends, logarithmic: false, ticks: ticks.map(|x| (x, short(x))).collect(), label: label.to_owned() }
    }

    /// Where a value lies, 0 to 1.
    fn share(&self, x: f64) -> f64 {
        let [a, b] = self.ends;
        let share = if self.logarithmic { (x / a).ln() / (b / a).ln() } else { (x - a) / (b - a) };
        share.clamp(0.0, 1.0)
    }
}

/// A rectangle in units of the drawing with an axis along the bottom and one along the left.
pub(super) struct Panel {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
    pub(super) x: Axis,
    pub(super) y: Axis,
}

impl Panel {
    /// Where a point lies in the drawing; what is outside lies on the edge.
    pub(super) fn place(&self, x: f64, y: f64) -> (f64, f64) {
        let across = self.left + self.x.share(x) * (self.right - self.left);
        (across, self.bottom - self.y.share(y) * (self.bottom - self.top))
    }

    /// Grid, frame and labels; the values along the bottom only if `numbers`.
    pub(super) fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, numbers: bool) -> Result<(), String> {
        let Self { left, right, top, bottom, x, y } = self;
        for (value, label) in &x.ticks {
            let at = self.place(*value, 0.0).0;
            canvas.line(&[(at, *top), (at, *bottom)], PALE, 1.0)?;
            if numbers {
                canvas.text(label, (at, bottom + 5.0), Anchor::Below, 12.0, BLACK)?;
            }
        }
        for (value, label) in &y.ticks {
            let at = self.bottom - self.y.share(*value) * (self.bottom - self.top);
            canvas.line(&[(*left, at), (*right, at)], PALE, 1.0)?;
            canvas.text(label, (left - 6.0, at), Anchor::Left, 12.0, BLACK)?;
        }
        if numbers {
            canvas.text(&x.label, (0.5 * (left + right), bottom + 22.0), Anchor::Below, 13.0, BLACK)?;
        }
        canvas.text(&y.label, (left - 62.0, 0.5 * (top + bottom)), Anchor::Upward, 13.0, BLACK)?;
        let frame = [(*left, *top), (*right, *top), (*right, *bottom), (*left, *bottom), (*left, *top)];
        canvas.line(&frame, GREY, 1.0)
    }

    /// A curve, as far as it is inside.
    pub(super) fn curve<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        points: impl Iterator<Item = (f64, f64)>,
        colour: RGBColor,
    ) -> Result<(), String> {
        let [low, high] = self.y.ends;
        let inside = |(_, y): &(f64, f64)| (low..=high).contains(y);
        let points: Vec<(f64, f64)> = points.collect();
        for piece in points.split(|p| !inside(p)).filter(|piece| piece.len() > 1) {
            let places: Vec<(f64, f64)> = piece.iter().map(|(x, y)| self.place(*x, *y)).collect();
            canvas.line(&places, colour, 1.6)?;
        }
        Ok(())
    }
}

/// A tick in few letters.
fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x) { format!("{}", (x * 1e6).round() / 1e6) } else { format!("{x:.0e}") }
}
