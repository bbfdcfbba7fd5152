//! Pictures of results, as SVG or PNG.

mod analyze;
mod canvas;
mod modes;
mod panel;
mod response;

pub use analyze::analysis;
pub use modes::modes;
pub use response::response;

use canvas::Canvas;
use gyroflex_sim::error::{Error, ErrorKind};
use plotters::prelude::{BitMapBackend, DrawingBackend, IntoDrawingArea, SVGBackend};
use plotters::style::{FontStyle, RGBColor, register_font};
use std::path::Path;

/// Letters for every machine, those without fonts included; see `font/LICENSE`.
const FONT: &[u8] = include_bytes!("font/plot-sans.ttf");
/// Places per unit of the drawing.
const FINENESS: u32 = 4;
/// Places per dot of a PNG.
const SMOOTH: u32 = 2;

/// Colours that everybody can tell apart (Okabe, Ito), and greys.
const BLUE: RGBColor = RGBColor(0, 114, 178);
const ORANGE: RGBColor = RGBColor(213, 94, 0);
const GREY: RGBColor = RGBColor(120, 120, 120);
const LIGHT: RGBColor = RGBColor(180, 180, 180);
const PALE: RGBColor = RGBColor(225, 225, 225);
const BLACK: RGBColor = RGBColor(0, 0, 0);

/// Something that can be drawn, whatever on.
trait Drawing {
    /// Draws, in units; says why it cannot.
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Result<(), String>;
}

/// The bytes of a picture of `size` units, of the kind that the name of the file says.
fn picture(path: &Path, size: (u32, u32), drawing: &impl Drawing) -> Result<Vec<u8>, Error> {
    let failed = |why: String| Error {
        kind: ErrorKind::Io,
        file: path.display().to_string(),
        element: "plot".to_owned(),
        problem: format!("cannot be drawn: {why}"),
        remedy: "try the other format, .svg or .png, and report this".to_owned(),
    };
    register_font("sans-serif", FontStyle::Normal, FONT)
        .map_err(|_| failed("the font of the program cannot be read".to_owned()))?;
    let dots_wide = (size.0 * FINENESS, size.1 * FINENESS);
    if path.extension().is_some_and(|e| e == "svg") {
        let mut text = String::new();
        let area = SVGBackend::with_string(&mut text, dots_wide).into_drawing_area();
        let canvas = Canvas::new(&area, f64::from(FINENESS));
        drawing.draw(&canvas).and_then(|()| area.present().map_err(|e| e.to_string())).map_err(failed)?;
        drop(area);
        // The size on the screen; the view box keeps the places fine.
        let fine = format!("width=\"{}\" height=\"{}\"", dots_wide.0, dots_wide.1);
        return Ok(text.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", size.0, size.1), 1).into_bytes());
    }
    let mut dots = vec![0; 3 * (dots_wide.0 * dots_wide.1) as usize];
    let area = BitMapBackend::with_buffer(&mut dots, dots_wide).into_drawing_area();
    drawing.draw(&Canvas::new(&area, f64::from(FINENESS))).map_err(failed)?;
    drop(area);
    let (width, height) = (size.0 * FINENESS / SMOOTH, size.1 * FINENESS / SMOOTH);
    png(width, height, &averaged(&dots, width as usize)).map_err(|e| failed(e.to_string()))
}

/// One dot of `width` a row for every `SMOOTH × SMOOTH` dots, so that slanting lines have no stairs.
fn averaged(fine: &[u8], width: usize) -> Vec<u8> {
    let many = SMOOTH as usize;
    let row = 3 * width * many;
    let mut dots = Vec::with_capacity(fine.len() / (many * many));
    for rows in fine.chunks_exact(row * many) {
        for i in 0..3 * width {
            let first = i / 3 * 3 * many + i % 3;
            let of = |r: usize, c: usize| usize::from(rows[r * row + first + 3 * c]);
            let sum: usize = (0..many * many).map(|k| of(k / many, k % many)).sum();
            dots.push((sum / (many * many)) as u8);
        }
    }
    dots
}

fn png(width: u32, height: u32, dots: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(dots)?;
    Ok(bytes)
}

/// A number in five digits, without a power of ten where that is short.
pub fn digits(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        a if (1e-3..1e5).contains(&a) => {
            let places = (4 - a.log10().floor() as i32).max(0) as usize;
            format!("{x:.places$}")
        }
        _ => format!("{x:.4e}"),
    }
}
