//! Drawings as SVG and PNG from one code: lines, letters and areas at whole pixels.

use core::error::Error;
use plotters::{
    coord::Shift,
    prelude::*,
    style::{FontStyle, FontTransform, register_font, text_anchor::Pos},
};
pub use plotters::{
    prelude::{DrawingBackend, RGBColor, WHITE},
    style::text_anchor::{HPos, VPos},
};
use std::sync::Once;

/// A drawing cannot be made: the font is broken, or a library refuses.
pub type Refused = Box<dyn Error + Send + Sync>;

/// Something that can be drawn.
pub trait Figure {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    /// Draws it on a white canvas of that size.
    ///
    /// # Errors
    /// What the drawing library refuses.
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<'_, B>) -> Result<(), Refused>
    where
        B::ErrorType: 'static;
}

/// The figure as SVG.
///
/// # Errors
/// What the drawing library refuses.
pub fn svg(figure: &impl Figure) -> Result<String, Refused> {
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, figure.size()).into_drawing_area();
    Canvas { area: &area, scale: 1 }.show(figure)?;
    drop(area);
    Ok(text)
}

/// The figure as a PNG file, 8 bits.
///
/// # Errors
/// What the drawing library refuses.
pub fn png(figure: &impl Figure) -> Result<Vec<u8>, Refused> {
    // Drawn twice as large and made smaller, so that lines and letters are smooth.
    let size = figure.size();
    let (width, height) = (size.0 as usize, size.1 as usize);
    let mut large = vec![255; width * height * 4 * 3];
    let area = BitMapBackend::with_buffer(&mut large, (2 * size.0, 2 * size.1)).into_drawing_area();
    Canvas { area: &area, scale: 2 }.show(figure)?;
    drop(area);
    let mean = |i: usize| {
        let (x, y, channel) = (i / 3 % width, i / 3 / width, i % 3);
        let at = |dx: usize, dy: usize| u32::from(large[((2 * y + dy) * 2 * width + 2 * x + dx) * 3 + channel]);
        ((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1) + 2) / 4) as u8
    };
    let pixels: Vec<u8> = (0..width * height * 3).map(mean).collect();
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, size.0, size.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(file)
}

/// Where a figure is drawn.
pub struct Canvas<'a, B: DrawingBackend> {
    area: &'a DrawingArea<B, Shift>,
    /// Pixels of the drawing to one of the figure.
    scale: i32,
}

impl<B: DrawingBackend> Canvas<'_, B>
where
    B::ErrorType: 'static,
{
    fn show(&self, figure: &impl Figure) -> Result<(), Refused> {
        fonts();
        self.area.fill(&WHITE)?;
        figure.draw(self)?;
        self.area.present()?;
        Ok(())
    }

    fn scaled(&self, (x, y): (i32, i32)) -> (i32, i32) {
        (x * self.scale, y * self.scale)
    }

    fn style(&self, size: i32, color: RGBColor) -> TextStyle<'static> {
        ("sans-serif", f64::from(size * self.scale)).into_font().color(&color)
    }

    /// A line of text; `h` and `v` say which of its points stands at `at`.
    ///
    /// # Errors
    /// What the drawing library refuses.
    pub fn text(
        &self,
        text: &str,
        at: (i32, i32),
        size: i32,
        color: RGBColor,
        h: HPos,
        v: VPos,
    ) -> Result<(), Refused> {
        let style = self.style(size, color).pos(Pos::new(h, v));
        self.area.draw(&Text::new(text.to_owned(), self.scaled(at), style))?;
        Ok(())
    }

    /// A line of text that runs upward, its middle at `at`.
    ///
    /// # Errors
    /// What the drawing library refuses.
    pub fn text_upward(&self, text: &str, at: (i32, i32), size: i32, color: RGBColor) -> Result<(), Refused> {
        let style = self.style(size, color).transform(FontTransform::Rotate270);
        let style = style.pos(Pos::new(HPos::Center, VPos::Center));
        self.area.draw(&Text::new(text.to_owned(), self.scaled(at), style))?;
        Ok(())
    }

    /// A line through some points.
    ///
    /// # Errors
    /// What the drawing library refuses.
    pub fn line(&self, points: &[(i32, i32)], color: RGBColor, width: i32) -> Result<(), Refused> {
        let points: Vec<_> = points.iter().map(|point| self.scaled(*point)).collect();
        self.area.draw(&PathElement::new(points, color.stroke_width((width * self.scale) as u32)))?;
        Ok(())
    }

    /// The area within an outline.
    ///
    /// # Errors
    /// What the drawing library refuses.
    pub fn filled(&self, outline: &[(i32, i32)], color: RGBColor) -> Result<(), Refused> {
        let scaled: Vec<_> = outline.iter().map(|point| self.scaled(*point)).collect();
        self.area.draw(&Polygon::new(scaled, color.filled()))?;
        Ok(())
    }

    /// A rectangle from its upper left to its lower right corner.
    ///
    /// # Errors
    /// What the drawing library refuses.
    pub fn rectangle(&self, from: (i32, i32), to: (i32, i32), color: RGBColor) -> Result<(), Refused> {
        self.area.draw(&Rectangle::new([self.scaled(from), self.scaled(to)], color.filled()))?;
        Ok(())
    }

    /// A circle of radius `r` with a rim.
    ///
    /// # Errors
    /// What the drawing library refuses.
    pub fn circle(&self, at: (i32, i32), r: i32, inside: RGBColor, rim: RGBColor) -> Result<(), Refused> {
        let (at, r) = (self.scaled(at), r * self.scale);
        self.area.draw(&Circle::new(at, r, inside.filled()))?;
        self.area.draw(&Circle::new(at, r, rim.stroke_width((2 * self.scale) as u32)))?;
        Ok(())
    }
}

/// About how wide a text is, in pixels.
#[must_use]
pub fn width(text: &str, size: i32) -> i32 {
    (text.chars().count() as i32 * size * 54).div_euclid(100)
}

/// The one font of the drawings, the same on every machine.
fn fonts() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        for style in [FontStyle::Normal, FontStyle::Bold] {
            // A font that is refused shows as an error of the drawing.
            let _ = register_font("sans-serif", style, epaint_default_fonts::UBUNTU_LIGHT);
        }
    });
}
