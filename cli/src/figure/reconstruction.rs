//! The contact points of a recording, beside what they would be if there were never more than one contact.

use super::canvas::{BODY, FigureError, HPos, PAGE, TITLE, span, svg, write};
use super::cloud::{self, Dot};
use super::fitted;
use super::palette::{self, FAINT, INK, MUTED, label_colour};
use super::plane::PlaneWindow;
use rod_files::{Comparison, Reconstructed, naive_touch};
use vibrissa::Label;
use vibrissa::reconstruct::Touch;
use vibrissa::reconstruct::score::Deviation;

/// Width; least and largest height of the plot; height of the title and the key, and of a line on errors between them, pixels.
const WIDTH: u32 = PAGE;
const HEIGHT: (f64, f64) = (300.0, 1200.0);
const HEAD: u32 = 116;
const ERROR_LINE: u32 = 34;
/// Height of the line that says what is drawn of a fit, pixels.
const NOTE: u32 = 36;

/// First and second contacts of several: rings.
const FIRST: Dot = Dot { colour: palette::FIRST, filled: false };
const SECOND: Dot = Dot { colour: palette::SECOND, filled: false };
const NAIVE: Dot = Dot { colour: FAINT, filled: true };

/// Draws the contact points in the plane, the contour of the fit, and the true contour where it is known.
pub(crate) fn reconstruction(found: &Reconstructed) -> Result<String, FigureError> {
    let single = |label: Label| {
        let readings = found.found.readings.iter().filter(move |reading| reading.label == label);
        readings.filter_map(|reading| reading.touch.ok()).map(millimetres)
    };
    let several = || found.found.readings.iter().filter(|reading| reading.label.several());
    let first = || several().filter_map(|reading| reading.touch.ok()).map(millimetres);
    let second = || several().filter_map(|reading| reading.second?.ok()).map(millimetres);
    let naive = found.samples.iter().zip(&found.found.readings).filter(|(_, reading)| reading.label.several());
    let naive: Vec<(f64, f64)> =
        naive.filter_map(|(sample, _)| naive_touch(&found.rod, sample)).map(millimetres).collect();

    let all = || single(Label::A).chain(single(Label::B)).chain(first()).chain(second());
    let (x, y) = (span(all().map(|point| point.0), 0.06), span(all().map(|point| point.1), 0.1));
    let (window, height) = PlaneWindow::as_wide_as(WIDTH, &x, &y, HEIGHT);
    let in_view = |point: &(f64, f64)| window.x.contains(&point.0) && window.y.contains(&point.1);
    let seen: Vec<(f64, f64)> = naive.into_iter().filter(in_view).collect();
    let errors = match &found.comparison {
        _ if all().next().is_none() => "no sample has a contact point, so there is no contour".to_owned(),
        Some(comparison) => errors(comparison),
        None => String::new(),
    };
    let errors_height = ERROR_LINE * errors.lines().count() as u32;
    let head_height = HEAD + errors_height;
    let room = head_height + found.fitted().map_or(0, |_| NOTE);
    svg((WIDTH, room + height), |root| {
        let (head, area) = root.split_vertically(room);
        write(&head, &format!("{}: contact points from the reactions", found.name), (24, 36), HPos::Left, TITLE, INK)?;
        for (line, y) in errors.lines().zip((76..).step_by(ERROR_LINE as usize)) {
            write(&head, line, (24, y), HPos::Left, BODY, MUTED)?;
        }
        let tip = Dot { colour: label_colour(Label::A), filled: true };
        let tangential = Dot { colour: label_colour(Label::B), filled: true };
        let entries = [
            (tip, "A", single(Label::A).next()),
            (tangential, "B", single(Label::B).next()),
            (FIRST, "first of several", first().next()),
            (SECOND, "second of several", second().next()),
            (NAIVE, "naive: one contact assumed", seen.first().copied()),
        ];
        let drawn = entries.into_iter().filter(|(_, _, point)| point.is_some());
        let entries: Vec<(Dot, &str)> = drawn.map(|(dot, name, _)| (dot, name)).collect();
        cloud::key(
            &head,
            (24, 86 + errors_height as i32),
            &entries,
            found.comparison.as_ref().map(|_| "true contour"),
        )?;
        let chart = window.chart(&area, (12, 8))?;
        if let Some(fit) = found.fitted() {
            write(&head, &fitted::note(fit), (24, head_height as i32 + 6), HPos::Left, BODY, MUTED)?;
            fitted::draw(&chart, fit)?;
        }
        cloud::dots(&chart, &window, seen, NAIVE)?;
        for (label, dot) in [(Label::A, tip), (Label::B, tangential)] {
            cloud::dots(&chart, &window, single(label), dot)?;
        }
        cloud::dots(&chart, &window, first(), FIRST)?;
        cloud::dots(&chart, &window, second(), SECOND)?;
        match &found.comparison {
            Some(comparison) => cloud::contours(&chart, &window, &comparison.scene.objects),
            None => Ok(()),
        }
    })
}

fn millimetres(touch: Touch) -> (f64, f64) {
    (1e3 * touch.x, 1e3 * touch.y)
}

/// How far the points are from the contour.
fn errors(comparison: &Comparison) -> String {
    let Comparison { single, first, second, naive, .. } = comparison;
    let kinds = [("one contact", single), ("first", first), ("second", second), ("naive: one contact assumed", naive)];
    let text = |(name, deviation): (&str, &Option<Deviation>)| {
        deviation.map(|d| format!("{name} {:.1e} ({:.1e})", 1e3 * d.median, 1e3 * d.largest))
    };
    let texts: Vec<String> = kinds.into_iter().filter_map(text).collect();
    format!("distance from the contour in mm, median (largest):\n{}", texts.join(", "))
}
