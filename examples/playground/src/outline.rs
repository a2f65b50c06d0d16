//! A contour as a line to draw.

use vibrissa::{Composite, contour};

/// Points from the start of the contour to its end.
pub type Line = Vec<contour::Point>;

/// Points on each piece of a contour that is finite: of a disc that fills the page, chords are within 0.1 % of the radius.
const POINTS: u32 = 80;
/// A piece without end is drawn to here, m (for a parabola: beside its vertex), beyond the border of the page.
const REACH: f64 = 0.3;
/// Points on a piece without end: most of them are beyond the border, so 1 mm apart.
const POINTS_WITHOUT_END: u32 = 600;

pub fn outline(object: &Composite) -> Line {
    let pieces = (0..object.stretches().len()).filter(|index| !object.stretch(*index).is_joint());
    pieces
        .flat_map(|index| {
            let range = object.own_range(index);
            let (from, to) = (range.from.max(-REACH), range.to.min(REACH));
            let points = if range.is_finite() { POINTS } else { POINTS_WITHOUT_END };
            (0..=points).map(move |point| {
                let at = object.own_frame(index, from + (to - from) * f64::from(point) / f64::from(points));
                [at.x, at.y]
            })
        })
        .collect()
}
