//! The transitions between phases that were observed, as a diagram (Merker et al. 2020, fig. 8b).

use crate::figure::canvas::{Area, BODY, FigureError, HPos, TITLE, stroke, svg, width, write};
use crate::figure::element::Element;
use crate::figure::palette::{INK, WHITE, colour, ink_on};
use rod_files::Scan;
use std::collections::BTreeMap;
use vibrissa::Label;
use vibrissa::contact::{EventKind, Phase};

const SIZE: (u32, u32) = (1400, 880);
/// Half the width and height of a box, pixels.
const BOX: (f64, f64) = (85.0, 46.0);
/// Distance of arrows between the same boxes, pixels.
const LANE: f64 = 46.0;
/// Length and half the width of an arrow's head, pixels.
const POINT: (f64, f64) = (24.0, 9.0);
/// Length of a dash and the gap behind it, pixels.
const DASH: (f64, f64) = (14.0, 10.0);

/// The phases and the middles of their boxes, pixels.
const PLACES: [(Label, Phase, (f64, f64)); 5] = [
    (Label::Free, Phase::FREE, (150.0, 500.0)),
    (Label::A, Phase { contacts: 1, tip: true }, (520.0, 500.0)),
    (Label::B, Phase { contacts: 1, tip: false }, (880.0, 220.0)),
    (Label::BA, Phase { contacts: 2, tip: true }, (880.0, 780.0)),
    (Label::BB, Phase { contacts: 2, tip: false }, (1240.0, 500.0)),
];

/// A kind of transition: from, to, and whether the rod jumps.
type Kind = (Label, Label, bool);

/// How often each kind of transition occurs in these scans. What happens within a phase is none.
fn count<'a>(scans: impl IntoIterator<Item = &'a Scan>) -> BTreeMap<Kind, usize> {
    let mut counts = BTreeMap::new();
    for event in scans.into_iter().flat_map(|scan| &scan.outcome.events) {
        let [from, to] = [event.from(), event.to()].map(|phase| Label::of(phase.contacts, phase.tip));
        if from != to {
            let jumps = matches!(event.kind, EventKind::Snap | EventKind::SnapOff);
            *counts.entry((from, to, jumps)).or_insert(0) += 1;
        }
    }
    counts
}

/// Draws the phases as boxes, and an arrow with its number for each kind of transition.
pub(crate) fn transitions<'a>(scans: impl IntoIterator<Item = &'a Scan>) -> Result<String, FigureError> {
    let counts = count(scans);
    svg(SIZE, |root| {
        let title = "Transitions observed in the nine scans, with their number";
        write(root, title, (24, 36), HPos::Left, TITLE, INK)?;
        for (name, jumps, y) in [("the shape changes without a jump", false, 84.0), ("snap or snap-off", true, 120.0)] {
            arrow(root, (24.0, y), (104.0, y), jumps)?;
            write(root, name, (124, y as i32), HPos::Left, BODY, INK)?;
        }
        for (index, (here, _, _)) in PLACES.iter().enumerate() {
            for (there, _, _) in &PLACES[index + 1..] {
                between(root, &counts, *here, *there)?;
            }
        }
        for (label, phase, (x, y)) in PLACES {
            let corners = [(x - BOX.0, y - BOX.1), (x + BOX.0, y + BOX.1)].map(pixel);
            root.draw(&Element::rectangle(corners, colour(phase).filled()))?;
            root.draw(&Element::rectangle(corners, INK.stroke_width(3)))?;
            write(root, &label.to_string(), pixel((x, y)), HPos::Center, TITLE + 6, ink_on(colour(phase)))?;
        }
        Ok(())
    })
}

/// The arrows between two boxes, beside each other.
fn between(root: &Area<'_>, counts: &BTreeMap<Kind, usize>, here: Label, there: Label) -> Result<(), FigureError> {
    let of_both = |(from, to, _): &Kind| (*from, *to) == (here, there) || (*from, *to) == (there, here);
    let arrows: Vec<(&Kind, &usize)> = counts.iter().filter(|(kind, _)| of_both(kind)).collect();
    let (Some(start), Some(end)) = (place(here), place(there)) else { return Ok(()) };
    let (dx, dy) = direction(start, end);
    for (index, ((from, _, jumps), number)) in arrows.iter().enumerate() {
        let aside = LANE * (index as f64 - 0.5 * (arrows.len() - 1) as f64);
        let aside = (-dy * aside, dx * aside);
        let (tail, head) = (leave(start, aside, (dx, dy)), leave(end, aside, (-dx, -dy)));
        let (tail, head) = if *from == here { (tail, head) } else { (head, tail) };
        arrow(root, tail, head, *jumps)?;
        let middle = pixel((0.5 * (tail.0 + head.0), 0.5 * (tail.1 + head.1)));
        let text = number.to_string();
        let half = ((width(&text, BODY) + 8) / 2, BODY as i32 / 2 + 1);
        let corners = [(middle.0 - half.0, middle.1 - half.1), (middle.0 + half.0, middle.1 + half.1)];
        root.draw(&Element::rectangle(corners, WHITE.filled()))?;
        write(root, &text, middle, HPos::Center, BODY, INK)?;
    }
    Ok(())
}

fn place(label: Label) -> Option<(f64, f64)> {
    PLACES.iter().find(|(other, _, _)| *other == label).map(|(_, _, place)| *place)
}

fn direction(from: (f64, f64), to: (f64, f64)) -> (f64, f64) {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    (dx / length, dy / length)
}

/// Where a line from beside the middle of a box leaves it.
fn leave(middle: (f64, f64), aside: (f64, f64), (dx, dy): (f64, f64)) -> (f64, f64) {
    let way = |half: f64, aside: f64, d: f64| if d == 0.0 { f64::INFINITY } else { (half.copysign(d) - aside) / d };
    let length = way(BOX.0, aside.0, dx).min(way(BOX.1, aside.1, dy));
    (middle.0 + aside.0 + length * dx, middle.1 + aside.1 + length * dy)
}

/// An arrow, dashed for a jump.
fn arrow(root: &Area<'_>, tail: (f64, f64), head: (f64, f64), jumps: bool) -> Result<(), FigureError> {
    let (dx, dy) = direction(tail, head);
    let at = |along: f64, aside: f64| pixel((head.0 - along * dx - aside * dy, head.1 - along * dy + aside * dx));
    let length = (head.0 - tail.0).hypot(head.1 - tail.1) - POINT.0;
    let mut done = 0.0;
    while done < length {
        let end = if jumps { length.min(done + DASH.0) } else { length };
        stroke(root, vec![at(POINT.0 + length - done, 0.0), at(POINT.0 + length - end, 0.0)], INK.stroke_width(3))?;
        done = end + DASH.1;
    }
    root.draw(&Element::polygon(vec![at(0.0, 0.0), at(POINT.0, POINT.1), at(POINT.0, -POINT.1)], INK.filled()))
}

fn pixel((x, y): (f64, f64)) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{event, outcome};
    use rod_files::Scene;

    #[test]
    fn transitions_are_counted_by_label_and_by_jump() {
        let scene = Scene::parse("O1_q40.toml".as_ref(), include_str!("../../../../scenes/O1_q40.toml")).unwrap();
        let steps = [
            ("free", "A", EventKind::FirstContact),
            ("A", "A", EventKind::Piece),
            ("A", "BA", EventKind::Snap),
            ("BA", "BBA", EventKind::Touch),
            ("BBA", "A", EventKind::Snap),
            ("A", "BA", EventKind::Touch),
            ("BA", "A", EventKind::Snap),
        ];
        let events = steps.into_iter().map(|(from, to, kind)| event(1.0, from, to, kind)).collect();
        let scan = Scan { scene, outcome: outcome(&[(0.0, "free")], events), interrupted: None };
        let counts = count([&scan]);
        let expected = [
            ((Label::Free, Label::A, false), 1),
            ((Label::A, Label::BA, false), 1),
            ((Label::A, Label::BA, true), 1),
            ((Label::BA, Label::A, true), 2),
        ];
        assert_eq!(counts.into_iter().collect::<Vec<_>>(), expected);
        let drawing = transitions([&scan]).unwrap();
        assert!(drawing.contains("snap-off") && !drawing.contains("NaN"));
    }

    #[test]
    fn lines_leave_a_box_at_its_border() {
        assert_eq!(leave((0.0, 0.0), (0.0, 10.0), (1.0, 0.0)), (BOX.0, 10.0));
        assert_eq!(leave((0.0, 0.0), (10.0, 0.0), (0.0, -1.0)), (10.0, -BOX.1));
        let (x, y) = leave((5.0, 5.0), (0.0, 0.0), direction((0.0, 0.0), (1.0, 1.0)));
        assert!((x - 5.0 - BOX.1).abs() < 1e-9 && (y - 5.0 - BOX.1).abs() < 1e-9);
    }
}
