//! Lines, boxes and letters at places in units, on any backend.

use plotters::coord::Shift;
use plotters::prelude::{Color, DrawingArea, DrawingBackend, PathElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontTransform, IntoFont, RGBColor, ShapeStyle};

/// An area of a backend with `scale` dots a unit.
pub(super) struct Canvas<'a, B: DrawingBackend> {
    area: &'a DrawingArea<B, Shift>,
    scale: f64,
}

/// Where letters are with regard to their place, and how they run.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    /// To the right of it, at half height.
    Right,
    /// To the left of it, at half height.
    Left,
    /// Below it, centred.
    Below,
    /// Centred on it, running upward.
    Upward,
}

impl<'a, B: DrawingBackend> Canvas<'a, B> {
    pub(super) fn new(area: &'a DrawingArea<B, Shift>, scale: f64) -> Self {
        Self { area, scale }
    }

    /// Paints everything.
    pub(super) fn fill(&self, colour: RGBColor) -> Result<(), String> {
        self.area.fill(&colour).map_err(|e| e.to_string())
    }

    /// A line through points.
    pub(super) fn line(&self, points: &[(f64, f64)], colour: RGBColor, width: f64) -> Result<(), String> {
        let points: Vec<(i32, i32)> = points.iter().map(|p| self.dot(*p)).collect();
        let style = ShapeStyle { color: colour.to_rgba(), filled: false, stroke_width: self.width(width) };
        self.area.draw(&PathElement::new(points, style)).map_err(|e| e.to_string())
    }

    /// A filled box between two corners.
    pub(super) fn block(&self, from: (f64, f64), to: (f64, f64), colour: RGBColor) -> Result<(), String> {
        let corners = [self.dot(from), self.dot(to)];
        self.area.draw(&Rectangle::new(corners, colour.filled())).map_err(|e| e.to_string())
    }

    /// Letters.
    pub(super) fn text(
        &self,
        text: &str,
        at: (f64, f64),
        anchor: Anchor,
        size: f64,
        colour: RGBColor,
    ) -> Result<(), String> {
        let pos = match anchor {
            Anchor::Right => Pos::new(HPos::Left, VPos::Center),
            Anchor::Left => Pos::new(HPos::Right, VPos::Center),
            Anchor::Below => Pos::new(HPos::Center, VPos::Top),
            Anchor::Upward => Pos::new(HPos::Center, VPos::Center),
        };
        let mut font = ("sans-serif", size * self.scale).into_font();
        if matches!(anchor, Anchor::Upward) {
            font = font.transform(FontTransform::Rotate270);
        }
        let style = plotters::style::TextStyle::from(font).color(&colour).pos(pos);
        self.area.draw(&Text::new(text.to_owned(), self.dot(at), style)).map_err(|e| e.to_string())
    }

    fn dot(&self, (x, y): (f64, f64)) -> (i32, i32) {
        ((x * self.scale).round() as i32, (y * self.scale).round() as i32)
    }

    fn width(&self, width: f64) -> u32 {
        (width * self.scale).round().max(1.0) as u32
    }
}
