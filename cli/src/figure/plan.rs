//! What is known of a contour, the hypotheses about it, and the scans to make next.

use super::canvas::{BODY, FigureError, HPos, PAGE, TITLE, span, stroke, svg, width, write};
use super::element::Element;
use super::line::thin_line;
use super::palette::{FAINT, INK, MUTED, OTHERS};
use super::plane::PlaneWindow;
use rod_files::Planned;
use vibrissa::reconstruct::Knowledge;

/// Height of title and legend, and of the plane (from, to), pixels.
const HEAD: u32 = 116;
const PLANE: (f64, f64) = (500.0, 1300.0);
/// Radius of a point, pixels.
const POINT: f64 = 5.0;
/// Length of the arrow that shows the rod, in lengths of the path.
const ROD: f64 = 0.08;

/// Distance of the number of a scan from where it begins, pixels.
const NUMBER: f64 = 26.0;

/// Draws hypotheses, known points and the chosen paths of the clamp.
pub(crate) fn plan(found: &Planned) -> Result<String, FigureError> {
    let mm = |[x, y]: [f64; 2]| (1e3 * x, 1e3 * y);
    let points = || found.known.iter().flat_map(|contour| contour.points.iter().zip(&contour.known));
    let ends = || {
        found.choices.iter().flat_map(|choice| {
            let path = found.plan.forecasts[choice.candidate].candidate.path;
            [path.at(0.0), path.at(path.length())].map(|pose| mm([pose.x, pose.y]))
        })
    };
    let all = || points().map(|(point, _)| mm(*point)).chain(ends());
    let (x, y) = (span(all().map(|point| point.0), 0.08), span(all().map(|point| point.1), 0.08));
    let (window, height) = PlaneWindow::as_wide_as(PAGE, &x, &y, PLANE);
    svg((PAGE, HEAD + height), |root| {
        let (head, body) = root.split_vertically(HEAD);
        write(&head, &format!("{}: the next scans", found.name), (24, 36), HPos::Left, TITLE, INK)?;
        let entries = [
            (INK, "touched"),
            (OTHERS[1], "bounded"),
            (MUTED, "unknown"),
            (FAINT, "hypotheses"),
            (OTHERS[0], "clamp, with the rod's direction"),
        ];
        let mut left = 24;
        for (colour, name) in entries {
            stroke(&head, vec![(left, 84), (left + 44, 84)], colour.stroke_width(6))?;
            write(&head, name, (left + 56, 84), HPos::Left, BODY, INK)?;
            left += 56 + width(name, BODY) + 30;
        }
        let chart = window.chart(&body, (12, 10))?;
        for hypothesis in &found.plan.hypotheses {
            for (object, outline) in hypothesis.objects.iter().zip(&hypothesis.outlines) {
                let line = outline.points(object).map(|(_, frame)| mm([frame.x, frame.y]));
                let line = thin_line(line, (window.scale, window.scale));
                chart.draw_series([Element::line(line, FAINT.stroke_width(2))])?;
            }
        }
        for (point, known) in points() {
            let colour = match known {
                Knowledge::Touched { .. } => INK,
                Knowledge::Bounded { .. } => OTHERS[1],
                Knowledge::Unknown => MUTED,
            };
            chart.draw_series([Element::circle(mm(*point), POINT, colour.filled())])?;
        }
        for (place, choice) in found.choices.iter().enumerate() {
            let path = found.plan.forecasts[choice.candidate].candidate.path;
            let [from, to] = [path.at(0.0), path.at(path.length())];
            let line = [from, to].map(|pose| mm([pose.x, pose.y]));
            chart.draw_series([Element::line(line, OTHERS[0].stroke_width(4))])?;
            let rod = ROD * path.length();
            let tip = mm([from.x + rod * from.phi.cos(), from.y + rod * from.phi.sin()]);
            chart.draw_series([Element::line([line[0], tip], OTHERS[0].stroke_width(4))])?;
            // between the extensions of both lines
            let (sin, cos) = from.phi.sin_cos();
            let along = [(to.x - from.x) / path.length() + cos, (to.y - from.y) / path.length() + sin];
            let pixels = |along: f64| (NUMBER * along / 2.0_f64.sqrt()).round() as i32;
            let at = chart.backend_coord(&line[0]);
            let at = (at.0 - pixels(along[0]), at.1 + pixels(along[1]));
            write(root, &(place + 1).to_string(), at, HPos::Center, BODY, OTHERS[0])?;
        }
        Ok(())
    })
}
