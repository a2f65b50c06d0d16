//! The figure of a sweep: shapes on the left, reactions on the right (Merker et al. 2020, fig. 4).

use super::canvas::{Area, FigureError, HPos, PAGE, TITLE, svg, width, write};
use super::elasticae;
use super::legend::Legend;
use super::palette::INK;
use super::trace::{self, Along};
use rod_files::Scan;
use std::ops::Range;
use vibrissa::State;

const WIDTH: u32 = PAGE;
/// Least and largest height.
const HEIGHT: Range<f64> = 780.0..1150.0;
/// Rows of pixels for the title, between the legend and the plots, and room at the left and right edge.
const HEAD: u32 = 71;
const GAP: u32 = 15;
const EDGE: i32 = 24;
/// Columns of pixels for the shapes.
const LEFT: u32 = 860;

/// Draws a sweep.
pub(crate) fn sweep(scan: &Scan) -> Result<String, FigureError> {
    let along = Along::of(scan);
    let legend = Legend::of(&scan.intervals(), &along.all_modes(), WIDTH as i32 - 2 * EDGE);
    let height = f64::from(HEAD + legend.height() + GAP) + elasticae::height(scan, LEFT)?;
    svg((WIDTH, height.clamp(HEIGHT.start, HEIGHT.end) as u32), |root| {
        let (head, body) = root.split_vertically(HEAD + legend.height() + GAP);
        let (left, right) = body.split_horizontally(LEFT);
        write(&head, &title(scan), (EDGE, 36), HPos::Left, TITLE, INK)?;
        legend.draw(&head, (EDGE, HEAD))?;
        elasticae::draw(root, &left, scan)?;
        reactions(root, &right, scan, &along)
    })
}

/// The name of the scene and its phases, as many as there is room for.
fn title(scan: &Scan) -> String {
    let stop = match (&scan.interrupted, &scan.outcome.stop) {
        (Some(_), _) => ", interrupted",
        (None, Some(_)) => ", stopped early",
        (None, None) => "",
    };
    let start = format!("{}: phases ", scan.scene.name);
    let fits = |title: &String| width(title, TITLE) <= WIDTH as i32 - 2 * EDGE;
    let whole = format!("{start}{}{stop}", scan.cycle().titled());
    if fits(&whole) {
        return whole;
    }
    let phases = scan.cycle().to_string();
    let shorter = phases.match_indices(' ').map(|(end, _)| format!("{start}{} …{stop}", &phases[..end]));
    shorter.take_while(fits).last().unwrap_or(start)
}

/// A number that a state has.
type Quantity = fn(&State) -> f64;

/// The three reactions above each other.
fn reactions(root: &Area<'_>, area: &Area<'_>, scan: &Scan, along: &Along) -> Result<(), FigureError> {
    let quantities: [(&str, Quantity); 3] = [
        ("f_{0x} in N", |state| state.reactions.f0x),
        ("f_{0y} in N", |state| state.reactions.f0y),
        ("m_{0z} in N mm", |state| 1e3 * state.reactions.m0z),
    ];
    let height = (area.dim_in_pixel().1 - trace::trimmings(true, true)) / 3;
    let traces = quantities.into_iter().map(|(name, quantity)| (name, trace::parts(scan, quantity))).collect();
    trace::stack(root, area, along, height, traces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{event, outcome};
    use rod_files::Scene;
    use vibrissa::contact::EventKind;

    #[test]
    fn a_title_too_long_loses_its_last_phases() {
        let scene = Scene::parse("O1_q40.toml".as_ref(), include_str!("../../../scenes/O1_q40.toml")).unwrap();
        let names = ["A", "B", "BA", "BB"].repeat(30);
        let events = names.windows(2).map(|pair| event(1.0, pair[0], pair[1], EventKind::Touch)).collect();
        let title = title(&Scan { scene, outcome: outcome(&[(0.0, "A")], events), interrupted: None });
        assert!(title.starts_with("O1_q40: phases A B BA BB A") && title.ends_with(" …"), "{title}");
        assert!((1350..WIDTH as i32).contains(&width(&title, TITLE)), "{}", width(&title, TITLE));
    }
}
