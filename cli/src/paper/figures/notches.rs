//! Both contacts of a rod held by two, beside what a reconstruction for one contact makes of them: the gap that Merker et
//! al. (2020) leave, closed as far as the rod touches.

use crate::figure::canvas::{Area, BODY, FigureError, HPos, PAGE, TITLE, span, svg, write};
use crate::figure::cloud::{self, Dot};
use crate::figure::palette::{self, FAINT, INK, MUTED};
use crate::figure::plane::PlaneWindow;
use crate::paper::resolved::ResolvedScan;

/// Width of a scan, height of the title and key, of a row's title, and of the lines above each scan, pixels.
const WIDTH: u32 = PAGE / 3;
const HEAD: u32 = 116;
const ROW: u32 = 56;
const NAME: u32 = 112;

const SINGLE: Dot = Dot { colour: FAINT, filled: true };
const NAIVE: Dot = Dot { colour: MUTED, filled: false };
const FIRST: Dot = Dot { colour: palette::FIRST, filled: true };
const SECOND: Dot = Dot { colour: palette::SECOND, filled: true };

/// Draws the notches of several scans side by side: above as the paper has them, below with both contacts.
pub(crate) fn notches(scans: &[ResolvedScan<'_>]) -> Result<String, FigureError> {
    let all =
        || scans.iter().flat_map(|scan| scan.first.iter().chain(&scan.second).chain(&scan.naive).chain(&scan.notches));
    let (x, y) = (span(all().map(|point| 1e3 * point.0), 0.2), span(all().map(|point| 1e3 * point.1), 0.1));
    let plot = f64::from(WIDTH - PlaneWindow::TRIMMINGS.0);
    let window = PlaneWindow::of(&x, &y, (plot, plot * (y.end - y.start) / (x.end - x.start)), (0.0, 0.0));
    let panel = NAME + PlaneWindow::TRIMMINGS.1 + ((window.y.end - window.y.start) / window.scale).ceil() as u32;
    let size = (WIDTH * scans.len().max(1) as u32, HEAD + 2 * (ROW + panel));
    svg(size, |root| {
        let (head, rest) = root.split_vertically(HEAD);
        let title = "The notches of O1, O2, O3, from the reactions of one scan each, without noise";
        write(&head, title, (24, 36), HPos::Left, TITLE, INK)?;
        let names = [
            (SINGLE, "one contact"),
            (NAIVE, "two contacts, taken for one"),
            (FIRST, "the first of two contacts"),
            (SECOND, "the second"),
        ];
        cloud::key(&head, (24, 86), &names, Some("true contour"))?;
        let (above, below) = rest.split_vertically(ROW + panel);
        let title = "As if there were never more than one contact: wrong points, or, where they are discarded, a gap";
        row(&above, &window, title, scans, false)?;
        let title = "Both contacts, from the envelope of the scan: closed as far as the rod touches";
        row(&below, &window, title, scans, true)
    })
}

fn row(
    area: &Area<'_>,
    window: &PlaneWindow,
    title: &str,
    scans: &[ResolvedScan<'_>],
    both: bool,
) -> Result<(), FigureError> {
    let (name, mut rest) = area.split_vertically(ROW);
    write(&name, title, (24, 34), HPos::Left, TITLE, INK)?;
    for scan in scans {
        let (part, others) = rest.split_horizontally(WIDTH);
        let (head, plot) = part.split_vertically(NAME);
        let name = format!("{}, q = {} mm", scan.scan.object, scan.scan.distance);
        write(&head, &name, (24, 24), HPos::Left, BODY, INK)?;
        let error = if both {
            let share = format!("{:.0} % of the samples", 100.0 * scan.share);
            write(&head, &share, (24, 92), HPos::Left, BODY, MUTED)?;
            format!("largest error {:.0e} mm", 1e3 * scan.error)
        } else {
            format!("largest error {:.2} mm", 1e3 * scan.naive_error)
        };
        write(&head, &error, (24, 60), HPos::Left, BODY, MUTED)?;
        let chart = window.chart(&plot, (8, 6))?;
        cloud::contours(&chart, window, &scan.scan.scan.scene.objects)?;
        let shown = if both { vec![(&scan.first, FIRST), (&scan.second, SECOND)] } else { vec![(&scan.naive, NAIVE)] };
        for (points, dot) in std::iter::once((&scan.single, SINGLE)).chain(shown) {
            let seen = points.iter().map(|(x, y)| (1e3 * x, 1e3 * y));
            let seen = seen.filter(|(x, y)| window.x.contains(x) && window.y.contains(y));
            cloud::dots(&chart, window, seen, dot)?;
        }
        rest = others;
    }
    Ok(())
}
