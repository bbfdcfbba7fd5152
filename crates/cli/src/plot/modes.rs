//! Shapes of oscillations: a panel a mode, a bar a position.

use super::canvas::{Anchor, Canvas};
use super::{BLACK, BLUE, Drawing, GREY, ORANGE, digits, picture};
use gyroflex_sim::error::Error;
use gyroflex_sim::linearize::{ModeKind, NaturalMode};
use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use std::path::Path;

const WIDTH: f64 = 900.0;
/// Width of the names of the positions at the left.
const NAMES: f64 = 130.0;
/// Height of a bar with its gap.
const BAR: f64 = 15.0;
/// Panels side by side.
const ROW: usize = 4;
const HEAD: f64 = 50.0;

struct Shapes<'a> {
    title: &'a str,
    positions: &'a [String],
    modes: Vec<&'a NaturalMode>,
}

/// A picture of the shapes of all oscillations, the slowest first: how far each position swings relative to the one that swings
/// most, at the instant when that one is at its end.
pub fn modes(path: &Path, title: &str, positions: &[String], modes: &[NaturalMode]) -> Result<Vec<u8>, Error> {
    let modes: Vec<&NaturalMode> = modes.iter().filter(|m| m.kind == ModeKind::Oscillation).collect();
    let rows = modes.len().div_ceil(ROW).max(1);
    let height = 60.0 + rows as f64 * (HEAD + BAR * positions.len() as f64 + 14.0);
    picture(path, (WIDTH as u32, height as u32), &Shapes { title, positions, modes })
}

impl Drawing for Shapes<'_> {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), String> {
        canvas.fill(RGBColor(255, 255, 255))?;
        canvas.text(self.title, (14.0, 20.0), Anchor::Right, 16.0, BLACK)?;
        for (i, (name, colour)) in [("links, q", BLUE), ("motors, θ", ORANGE)].into_iter().enumerate() {
            let x = WIDTH - 200.0 + 100.0 * i as f64;
            canvas.block((x, 15.0), (x + 12.0, 25.0), colour)?;
            canvas.text(name, (x + 18.0, 20.0), Anchor::Right, 13.0, BLACK)?;
        }
        if self.modes.is_empty() {
            return canvas.text("no oscillations at this pose", (14.0, 60.0), Anchor::Right, 14.0, GREY);
        }
        let width = (WIDTH - NAMES - 14.0) / ROW as f64;
        for (i, mode) in self.modes.iter().enumerate() {
            let top = 44.0 + (i / ROW) as f64 * (HEAD + BAR * self.positions.len() as f64 + 14.0);
            let left = NAMES + (i % ROW) as f64 * width;
            self.panel(canvas, mode, (left, left + width - 16.0), top, i % ROW == 0)?;
        }
        Ok(())
    }
}

impl Shapes<'_> {
    fn panel<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        mode: &NaturalMode,
        (left, right): (f64, f64),
        top: f64,
        names: bool,
    ) -> Result<(), String> {
        let middle = 0.5 * (left + right);
        let damping = mode.damping_ratio.map_or(String::new(), |z| format!("  ζ {z:.3}"));
        canvas.text(&format!("{} Hz{damping}", digits(mode.frequency)), (middle, top), Anchor::Below, 13.0, BLACK)?;
        let (first, last) = (top + 24.0, top + 24.0 + BAR * self.positions.len() as f64);
        for (i, (name, entry)) in self.positions.iter().zip(&mode.shape).enumerate() {
            let y = first + BAR * i as f64;
            let colour = if name.starts_with("theta") { ORANGE } else { BLUE };
            let end = middle + entry[0].clamp(-1.0, 1.0) * 0.5 * (right - left);
            canvas.block((middle, y + 2.0), (end, y + BAR - 2.0), colour)?;
            if names {
                let name = name.replacen("theta.", "θ ", 1).replacen("q.", "q ", 1);
                canvas.text(&name, (left - 8.0, y + 0.5 * BAR), Anchor::Left, 11.0, BLACK)?;
            }
        }
        canvas.line(&[(middle, first), (middle, last)], GREY, 1.0)?;
        let frame = [(left, first), (right, first), (right, last), (left, last), (left, first)];
        canvas.line(&frame, GREY, 1.0)
    }
}
