//! Contact points from reactions as if there were never more than one contact (Merker et al. 2020, fig. 6).

use crate::figure::canvas::{Area, BODY, FigureError, HPos, PAGE, TITLE, span, svg, write};
use crate::figure::cloud::{self, Dot};
use crate::figure::palette::{FAINT, INK, MUTED};
use crate::figure::plane::PlaneWindow;
use crate::paper::naive::Naive;

/// Width of a scan, height of the title and key, and of the lines above each scan, pixels.
const WIDTH: u32 = PAGE / 3;
const HEAD: u32 = 116;
const NAME: u32 = 122;

/// Points of one contact and of two.
const ONE: Dot = Dot { colour: FAINT, filled: true };
const TWO: Dot = Dot { colour: MUTED, filled: false };

/// Draws the points of several scans side by side, all to one scale.
pub(crate) fn contact_points(scans: &[&Naive<'_>]) -> Result<String, FigureError> {
    let all = || scans.iter().flat_map(|scan| &scan.points);
    let (x, y) = (span(all().map(|point| 1e3 * point.x), 0.06), span(all().map(|point| 1e3 * point.y), 0.1));
    let (beside, below) = PlaneWindow::TRIMMINGS;
    let plot = f64::from(WIDTH - beside);
    let high = plot * (y.end - y.start) / (x.end - x.start);
    let window = PlaneWindow::of(&x, &y, (plot, high), (0.0, 0.0));
    let size = (WIDTH * scans.len().max(1) as u32, HEAD + NAME + below + high.ceil() as u32);
    svg(size, |root| {
        let (head, mut rest) = root.split_vertically(HEAD);
        let title = "Contact points from the reactions, as if there were never more than one contact";
        write(&head, title, (24, 36), HPos::Left, TITLE, INK)?;
        let names = [(ONE, "samples with one contact (A, B)"), (TWO, "samples with two contacts (BA, BB)")];
        cloud::key(&head, (24, 86), &names, Some("true contour"))?;
        for scan in scans {
            let (part, others) = rest.split_horizontally(WIDTH);
            panel(&part, &window, scan)?;
            rest = others;
        }
        Ok(())
    })
}

fn panel(area: &Area<'_>, window: &PlaneWindow, scan: &Naive<'_>) -> Result<(), FigureError> {
    let (name, plot) = area.split_vertically(NAME);
    let title = format!("{}, q = {} mm", scan.scan.object, scan.scan.distance);
    write(&name, &title, (24, 28), HPos::Left, TITLE, INK)?;
    for (line, y) in errors(scan).iter().zip([68, 100]) {
        write(&name, line, (24, y), HPos::Left, BODY, MUTED)?;
    }
    let chart = window.chart(&plot, (8, 6))?;
    for (several, dot) in [(false, ONE), (true, TWO)] {
        let points = scan.points.iter().filter(|point| point.several == several);
        cloud::dots(&chart, window, points.map(|point| (1e3 * point.x, 1e3 * point.y)), dot)?;
    }
    cloud::contours(&chart, window, &scan.scan.scan.scene.objects)
}

/// How far the points are from the contour at most, with one contact and with two.
fn errors(scan: &Naive<'_>) -> Vec<String> {
    let one = scan.largest_error(false).map(|error| format!("error ≤ {:.0e} mm with one contact,", 1e3 * error));
    let two = scan.largest_error(true).map(|error| format!("≤ {:.2} mm with two contacts", 1e3 * error));
    one.into_iter().chain(two).collect()
}
