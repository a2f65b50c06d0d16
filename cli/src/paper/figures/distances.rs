//! The contact points of one object from several distances (Merker et al. 2020, fig. 9).

use crate::figure::canvas::{Area, BODY, FigureError, HPos, PAGE, TITLE, span, svg, tick, write};
use crate::figure::cloud::{self, Dot};
use crate::figure::element::Element;
use crate::figure::palette::{INK, MUTED, OTHERS, RGBColor};
use crate::figure::plane::PlaneWindow;
use crate::paper::naive::{Naive, NaivePoint, STEP};
use crate::paper::scans::{DISTANCES, OBJECTS};
use vibrissa::reconstruct::{Comparison, ContourEstimate};

/// Width of an object, height of the title and keys, of a row's title, and of an object's name, pixels.
const WIDTH: u32 = PAGE / 3;
const HEAD: u32 = 150;
const ROW: u32 = 56;
const NAME: u32 = 80;

/// Colours of the distances.
const COLOURS: [RGBColor; 3] = OTHERS;

/// What contours may be apart, m, through points so far from each other.
const LEAST: f64 = STEP;
/// Where the scans disagree.
const SHADE: RGBColor = RGBColor(232, 232, 232);

/// mm with one decimal.
fn round(metres: f64) -> f64 {
    (1e4 * metres).round() / 10.0
}

/// How high a point is, m, in the frame of a row.
type Height = fn(&NaivePoint) -> f64;

/// A row of the figure.
struct Row {
    letters: [char; 3],
    title: &'static str,
    axis: &'static str,
    height: Height,
    /// Whether the true contour is where the points are.
    truth: bool,
}

/// What a clamp knows is the height above itself; where it stands puts the distances together.
const ROWS: [Row; 2] = [
    Row {
        letters: ['a', 'b', 'c'],
        title: "As each scan has them: height above its clamp",
        axis: "y − y_{0} in mm",
        height: |point| point.above,
        truth: false,
    },
    Row {
        letters: ['d', 'e', 'f'],
        title: "The offsets of the distances removed: the scans disagree at the concave part only",
        axis: "y in mm",
        height: |point| point.y,
        truth: true,
    },
];

/// Draws the points of all scans: a column for each object, above as the clamp knows them, below with the offset of the
/// distances removed.
pub(crate) fn distances(scans: &[Naive<'_>]) -> Result<String, FigureError> {
    let windows = ROWS.map(|row| window(scans, row.height));
    let heights = windows.each_ref().map(|window| {
        let plot = (window.y.end - window.y.start) / window.scale;
        ROW + NAME + PlaneWindow::TRIMMINGS.1 + plot.ceil() as u32
    });
    svg((WIDTH * OBJECTS.len() as u32, HEAD + heights.iter().sum::<u32>()), |root| {
        let (head, mut rest) = root.split_vertically(HEAD);
        let title =
            "Contact points from the reactions, as if there were never more than one contact, at three distances";
        write(&head, title, (24, 36), HPos::Left, TITLE, INK)?;
        let names = DISTANCES.map(|distance| format!("q = {distance} mm"));
        let entries: Vec<(Dot, &str)> =
            COLOURS.iter().zip(&names).map(|(&colour, name)| (Dot { colour, filled: true }, name.as_str())).collect();
        cloud::key(&head, (24, 84), &entries, Some("true contour"))?;
        let kinds = [(true, "one contact"), (false, "two contacts")];
        let kinds = kinds.map(|(filled, name)| (Dot { colour: MUTED, filled }, name));
        cloud::key(&head, (24, 124), &kinds, None)?;
        for ((row, window), height) in ROWS.iter().zip(&windows).zip(heights) {
            let (part, below) = rest.split_vertically(height);
            let (name, mut panels) = part.split_vertically(ROW);
            write(&name, row.title, (24, 34), HPos::Left, TITLE, INK)?;
            for (letter, object) in row.letters.into_iter().zip(OBJECTS) {
                let (area, others) = panels.split_horizontally(WIDTH);
                let of_object = scans.iter().filter(|scan| scan.scan.object == object).collect::<Vec<_>>();
                panel(&area, window, row, &format!("({letter}) {object}"), &of_object)?;
                panels = others;
            }
            rest = below;
        }
        Ok(())
    })
}

/// A window on the points of all scans, as wide as a panel.
fn window(scans: &[Naive<'_>], height: Height) -> PlaneWindow {
    let all = || scans.iter().flat_map(|scan| &scan.points);
    let (x, y) = (span(all().map(|point| 1e3 * point.x), 0.06), span(all().map(|point| 1e3 * height(point)), 0.08));
    let plot = f64::from(WIDTH - PlaneWindow::TRIMMINGS.0);
    let high = plot * (y.end - y.start) / (x.end - x.start);
    PlaneWindow::of(&x, &y, (plot, high), (0.0, 0.0))
}

fn panel(
    area: &Area<'_>,
    window: &PlaneWindow,
    row: &Row,
    name: &str,
    scans: &[&Naive<'_>],
) -> Result<(), FigureError> {
    let (head, plot) = area.split_vertically(NAME);
    write(&head, name, (24, 26), HPos::Left, BODY, INK)?;
    let chart = window.chart_called(&plot, (8, 6), ("x in mm", row.axis))?;
    if row.truth {
        let contours: Vec<ContourEstimate> = scans.iter().map(|scan| scan.contour()).collect();
        let concave = Comparison { least: LEAST, ..Comparison::default() }.disagreements(&contours);
        let shades = concave.iter().map(|found| {
            Element::rectangle([(1e3 * found.from, window.y.start), (1e3 * found.to, window.y.end)], SHADE.filled())
        });
        chart.draw_series(shades)?;
        let told = concave.iter().map(|found| {
            format!("{} to {} mm, {:.1} mm apart", tick(&round(found.from)), tick(&round(found.to)), 1e3 * found.gap)
        });
        let told = told.collect::<Vec<_>>().join("; ");
        write(&head, &format!("concave: {told}"), (24, 60), HPos::Left, BODY, MUTED)?;
    }
    for (filled, scan) in [true, false].into_iter().flat_map(|filled| scans.iter().map(move |scan| (filled, scan))) {
        let Some(place) = DISTANCES.iter().position(|distance| *distance == scan.scan.distance) else { continue };
        let points = scan.points.iter().filter(|point| point.several != filled);
        let points = points.map(|point| (1e3 * point.x, 1e3 * (row.height)(point)));
        cloud::dots(&chart, window, points, Dot { colour: COLOURS[place], filled })?;
    }
    match scans.first().filter(|_| row.truth) {
        Some(scan) => cloud::contours(&chart, window, &scan.scan.scan.scene.objects),
        None => Ok(()),
    }
}
