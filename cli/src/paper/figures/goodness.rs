//! How well the clean reactions fit noisy ones, over the nine scans (Merker et al. 2020, fig. 5).

use crate::figure::canvas::{Area, BODY, FigureError, HPos, TITLE, svg, write};
use crate::figure::element::Element;
use crate::figure::palette::{FAINT, INK, MUTED, OTHERS, RGBColor};
use crate::paper::naive::{Naive, STEP};
use crate::paper::scans::{DISTANCES, OBJECTS};
use vibrissa::reconstruct::NoiseModel;
use vibrissa::reconstruct::score::goodness_of_fit;
use vibrissa::rod::Reactions;

/// Noise of the sensor that stands in for the experiment: standard deviations, N, N, N m.
const NOISE: Reactions = Reactions { f0x: 2.5e-3, f0y: 2.5e-3, m0z: 6e-5 };
/// Any: the figure is the same every time.
const SEED: u64 = 2021;

/// Size of a cell, room left of the cells of a quantity, between two of them, above and below, pixels.
const CELL: (i32, i32) = (137, 190);
const LEFT: i32 = 60;
const APART: i32 = 30;
const HEAD: i32 = 250;
const FOOT: i32 = 150;
/// Radius of the largest circle, pixels.
const RADIUS: f64 = 60.0;
/// Area of the smallest circle beside the largest, as in the paper.
const LEAST: f64 = 0.1;

/// A reaction: its name, its colour, its value.
type Quantity = (&'static str, RGBColor, fn(&Reactions) -> f64);

const QUANTITIES: [Quantity; 3] = [
    ("f_{0x}", OTHERS[0], |reactions| reactions.f0x),
    ("f_{0y}", OTHERS[1], |reactions| reactions.f0y),
    ("m_{0z}", OTHERS[2], |reactions| reactions.m0z),
];

/// Draws a circle for each reaction, object and distance, with the goodness of fit as its area.
pub(crate) fn goodness(scans: &[Naive<'_>]) -> Result<String, FigureError> {
    let fits: Vec<[Option<f64>; 3]> = scans.iter().zip(SEED..).map(|(scan, seed)| fits(scan, seed)).collect();
    let all = || fits.iter().flatten().flatten().copied();
    let range = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let (columns, rows) = (DISTANCES.len() as i32, OBJECTS.len() as i32);
    let block = LEFT + columns * CELL.0;
    let size = (24 + QUANTITIES.len() as i32 * (block + APART), HEAD + rows * CELL.1 + FOOT);
    svg((size.0.unsigned_abs(), size.1.unsigned_abs()), |root| {
        heading(root)?;
        for (index, (name, colour, _)) in QUANTITIES.into_iter().enumerate() {
            let left = 24 + index as i32 * (block + APART) + LEFT;
            write(root, &format!("{name}, q ="), (left + columns * CELL.0 / 2, HEAD - 66), HPos::Center, TITLE, INK)?;
            for (column, distance) in (0..).zip(DISTANCES) {
                let at = (left + column * CELL.0 + CELL.0 / 2, HEAD - 24);
                write(root, &format!("{distance} mm"), at, HPos::Center, BODY, INK)?;
            }
            for (row, object) in (0..).zip(OBJECTS) {
                let top = HEAD + row * CELL.1;
                write(root, object, (left - LEFT / 2, top + CELL.1 / 2), HPos::Center, BODY, INK)?;
                for (column, distance) in (0..).zip(DISTANCES) {
                    let here = |scan: &Naive<'_>| scan.scan.object == object && scan.scan.distance == distance;
                    let fit = scans.iter().position(here).and_then(|place| fits[place][index]);
                    cell(root, (left + column * CELL.0, top), fit, range, colour)?;
                }
            }
        }
        let text =
            format!("areas from {LEAST} for the smallest ({:.5}) to 1 for the largest ({:.5})", range.0, range.1);
        write(root, &text, (24, size.1 - FOOT + 60), HPos::Left, BODY, MUTED)?;
        let text =
            "white noise alone, no friction, no dynamics of snaps: the fit is worst where a reaction varies least";
        write(root, text, (24, size.1 - FOOT + 100), HPos::Left, BODY, MUTED)
    })
}

/// Goodness of fit of the three reactions along a scan, the noisy ones as the reference.
fn fits(scan: &Naive<'_>, seed: u64) -> [Option<f64>; 3] {
    let clean: Vec<Reactions> = scan.states.iter().map(|state| state.reactions).collect();
    let model = NoiseModel { white: NOISE, ..NoiseModel::default() };
    // the model is one: this never fails
    let Ok(mut sensor) = model.generator(seed) else { return [None; 3] };
    let noise: Vec<Reactions> = clean.iter().filter_map(|felt| sensor.sample(*felt)).collect();
    QUANTITIES.map(|(_, _, value)| {
        let [clean, noise] = [&clean, &noise].map(|list| list.iter().map(value).collect::<Vec<f64>>());
        goodness_of_fit(&clean, &noise)
    })
}

fn heading(root: &Area<'_>) -> Result<(), FigureError> {
    let title = "Goodness of fit 1 − |x − r|² / |r − mean r|² (NMSE) between clean and noisy reactions";
    write(root, title, (24, 36), HPos::Left, TITLE, INK)?;
    let text = format!(
        "simulated noise in place of the experiment: white, σ = {:.1} mN and {:.2} N mm, every {:.2} mm in contact",
        1e3 * NOISE.f0x,
        1e3 * NOISE.m0z,
        1e3 * STEP,
    );
    write(root, &text, (24, 84), HPos::Left, BODY, INK)
}

/// Area of a circle beside the largest one.
fn area(fit: f64, (least, most): (f64, f64)) -> f64 {
    if most > least { LEAST + (1.0 - LEAST) * (fit - least) / (most - least) } else { 1.0 }
}

fn cell(
    root: &Area<'_>,
    (x, y): (i32, i32),
    fit: Option<f64>,
    range: (f64, f64),
    colour: RGBColor,
) -> Result<(), FigureError> {
    root.draw(&Element::rectangle([(x, y), (x + CELL.0, y + CELL.1)], FAINT.stroke_width(2)))?;
    let Some(fit) = fit else { return Ok(()) };
    let radius = RADIUS * area(fit, range).sqrt();
    root.draw(&Element::circle((x + CELL.0 / 2, y + 78), radius.round() as i32, colour.filled()))?;
    write(root, &format!("{fit:.5}"), (x + CELL.0 / 2, y + CELL.1 - 22), HPos::Center, BODY, INK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_go_from_a_tenth_to_one_linearly() {
        let areas = [0.9, 0.95, 1.0].map(|fit| area(fit, (0.9, 1.0)));
        assert!((areas[0] - 0.1).abs() < 1e-12 && (areas[1] - 0.55).abs() < 1e-12 && areas[2] == 1.0);
        assert_eq!(area(0.5, (0.5, 0.5)), 1.0);
    }
}
