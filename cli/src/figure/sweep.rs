//! The figure of a sweep: shapes on the left, reactions on the right (Merker et al. 2021, fig. 4).

use super::canvas::{Area, BODY, FigureError, TITLE, stroke, svg, width, write};
use super::elasticae;
use super::palette::{INK, colour};
use super::trace::{self, Quantity, Trace};
use crate::Scan;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use vibrissa::{EventKind, Phase};

const SIZE: (u32, u32) = (2000, 1080);
/// Rows of pixels for the title and the legend.
const HEAD: u32 = 120;
/// Columns of pixels for the shapes.
const LEFT: u32 = 1080;

/// Draws a sweep.
pub(crate) fn sweep(scan: &Scan) -> Result<String, FigureError> {
    svg(SIZE, |root| {
        let (head, body) = root.split_vertically(HEAD);
        let (left, right) = body.split_horizontally(LEFT);
        write(&head, &title(scan), (24, 36), HPos::Left, TITLE, INK)?;
        legend(&head, scan)?;
        elasticae::draw(root, &left, scan)?;
        reactions(root, &right, scan)
    })
}

fn title(scan: &Scan) -> String {
    let stop = if scan.outcome.stop.is_some() { ", stopped early" } else { "" };
    format!("{}: phases {}{stop}", scan.scene.name, scan.cycle().titled())
}

/// A row of line samples and what they mean.
fn legend(area: &Area<'_>, scan: &Scan) -> Result<(), FigureError> {
    let intervals = scan.intervals();
    let mut phases: Vec<Phase> = Vec::new();
    for interval in &intervals {
        if !phases.contains(&interval.phase) {
            phases.push(interval.phase);
        }
    }
    let (y, sample) = (88, 44);
    let mut x = 24;
    let mut entry = |name: &str, style: ShapeStyle, dashed: bool| -> Result<(), FigureError> {
        let parts = if dashed { vec![(0, 14), (24, 38)] } else { vec![(0, sample)] };
        for (from, to) in parts {
            stroke(area, vec![(x + from, y), (x + to, y)], style)?;
        }
        write(area, name, (x + sample + 10, y), HPos::Left, BODY, INK)?;
        x += sample + 10 + width(name, BODY) + 24;
        Ok(())
    };
    entry("contour", INK.stroke_width(6), false)?;
    for phase in phases {
        let name = if phase == Phase::FREE { "free".to_owned() } else { format!("phase {phase}") };
        entry(&name, colour(phase).stroke_width(5), false)?;
    }
    if intervals.len() > 1 {
        entry("at a transition", INK.stroke_width(3), false)?;
    }
    if intervals.iter().any(|interval| interval.end == Some(EventKind::Snap)) {
        entry("after a snap", INK.stroke_width(3), true)?;
    }
    Ok(())
}

/// The three reactions above each other.
fn reactions(root: &Area<'_>, area: &Area<'_>, scan: &Scan) -> Result<(), FigureError> {
    let quantities: [(&str, Quantity<'_>); 3] = [
        ("f0x in N", &|state| state.reactions.f0x),
        ("f0y in N", &|state| state.reactions.f0y),
        ("m0z in N mm", &|state| 1e3 * state.reactions.m0z),
    ];
    let across = trace::across(scan);
    let height = (area.dim_in_pixel().1 - trace::trimmings(true, true)) / 3;
    let mut rest = area.clone();
    for (index, (name, quantity)) in quantities.into_iter().enumerate() {
        let (phases, foot) = (index == 0, index == 2);
        let (part, below) = rest.split_vertically(height + trace::trimmings(phases, foot));
        trace::draw(root, &part, &Trace { scan, quantity, name, across: across.clone(), phases, foot })?;
        rest = below;
    }
    Ok(())
}
