//! Lines, circles and areas, in decimal pixels or in the units of axes.

use super::palette::RGBColor;

/// How an element looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeStyle {
    colour: RGBColor,
    opacity: f64,
    /// Width of the line, pixels; none for an area.
    width: Option<u32>,
}

impl From<RGBColor> for ShapeStyle {
    fn from(colour: RGBColor) -> Self {
        colour.stroke_width(1)
    }
}

impl RGBColor {
    /// An area of this colour.
    pub fn filled(self) -> ShapeStyle {
        ShapeStyle { colour: self, opacity: 1.0, width: None }
    }

    /// A line of this colour and width (pixels).
    pub fn stroke_width(self, width: u32) -> ShapeStyle {
        ShapeStyle { colour: self, opacity: 1.0, width: Some(width) }
    }

    /// As SVG has it.
    pub fn code(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

impl ShapeStyle {
    /// The same, but only partly opaque.
    pub fn mix(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    fn svg(self) -> String {
        let (colour, opacity) = (self.colour.code(), self.opacity);
        let opacity = if opacity < 1.0 { format!(" opacity=\"{opacity}\"") } else { String::new() };
        match self.width {
            Some(width) => format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{opacity}"),
            None => format!("fill=\"{colour}\"{opacity}"),
        }
    }
}

/// A thing that is drawn.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    points: Vec<(f64, f64)>,
    form: Form,
    style: ShapeStyle,
}

#[derive(Clone, Copy, Debug)]
enum Form {
    /// A line; with the lengths of a dash and the gap behind it, pixels, a dashed one.
    Line(Option<(i32, i32)>),
    /// The area within the points.
    Polygon,
    /// Radius, pixels.
    Circle(f64),
}

impl Element {
    /// A straight or broken line.
    pub fn line<T: Into<f64>>(points: impl IntoIterator<Item = (T, T)>, style: impl Into<ShapeStyle>) -> Self {
        let points = points.into_iter().map(|(x, y)| (x.into(), y.into())).collect();
        Self { points, form: Form::Line(None), style: style.into() }
    }

    /// A line with dashes and gaps of these lengths (pixels).
    pub fn dashed(
        points: impl IntoIterator<Item = (f64, f64)>,
        dash: (i32, i32),
        style: impl Into<ShapeStyle>,
    ) -> Self {
        Self { form: Form::Line(Some(dash)), ..Self::line(points, style) }
    }

    /// The area within points, or its border.
    pub fn polygon<T: Into<f64>>(points: impl IntoIterator<Item = (T, T)>, style: impl Into<ShapeStyle>) -> Self {
        Self { form: Form::Polygon, ..Self::line(points, style) }
    }

    /// A rectangle from corner to corner.
    pub fn rectangle<T: Into<f64>>([from, to]: [(T, T); 2], style: impl Into<ShapeStyle>) -> Self {
        let ((left, top), (right, bottom)) = ((from.0.into(), from.1.into()), (to.0.into(), to.1.into()));
        Self::polygon([(left, top), (right, top), (right, bottom), (left, bottom)], style)
    }

    /// A circle of this radius (pixels).
    pub fn circle<T: Into<f64>>(at: (T, T), radius: impl Into<f64>, style: impl Into<ShapeStyle>) -> Self {
        Self { form: Form::Circle(radius.into()), ..Self::line([(at.0.into(), at.1.into())], style) }
    }

    /// As SVG text, its points moved to pixels of the canvas.
    pub fn svg(&self, pixel: impl Fn((f64, f64)) -> (f64, f64)) -> String {
        let style = self.style.svg();
        let mut points = self.points.iter().map(|point| pixel(*point));
        if let Form::Circle(radius) = self.form {
            let (x, y) = points.next().unwrap_or_default();
            return format!("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {style}/>", number(x), number(y), number(radius));
        }
        let list: Vec<String> = points.map(|(x, y)| format!("{},{}", number(x), number(y))).collect();
        let list = list.join(" ");
        match self.form {
            Form::Line(Some((dash, gap))) => {
                format!("<polyline points=\"{list}\" {style} stroke-dasharray=\"{dash} {gap}\"/>")
            }
            Form::Polygon => format!("<polygon points=\"{list}\" {style}/>"),
            _ => format!("<polyline points=\"{list}\" {style}/>"),
        }
    }
}

/// A coordinate to a hundredth of a pixel.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_not_rounded_to_whole_pixels() {
        let line = Element::line([(0.0, 0.004), (10.256, -0.001)], RGBColor(0, 158, 115).stroke_width(2));
        let expected = "<polyline points=\"0.5,0 10.76,0\" fill=\"none\" stroke=\"#009e73\" stroke-width=\"2\"/>";
        assert_eq!(line.svg(|(x, y)| (x + 0.5, y)), expected);
    }
}
