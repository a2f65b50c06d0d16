//! The reactions of a recording, the phase criterion and how sure the labels are.

use super::abscissa::Abscissa;
use super::canvas::{BODY, FigureError, HPos, PAGE, TITLE, span, svg, write};
use super::palette::{INK, MUTED, label_colour};
use super::trace::{self, Along, LINE, TracePart};
use rod_files::Reconstructed;
use std::ops::Range;
use vibrissa::{ClampPath, Pose, Rod};

const WIDTH: u32 = PAGE;
/// Height of a plot, and of the title.
const PLOT: u32 = 240;
const HEAD: u32 = 110;
/// Least and largest value of each of so many columns: no more can be seen.
const COLUMNS: f64 = 1600.0;

/// A number that each sample has; NaN where it has none.
type Quantity<'a> = &'a dyn Fn(usize) -> f64;

/// Draws reactions, criterion and margin above each other, coloured by label, with the kinks as vertical lines.
pub(crate) fn reactions(found: &Reconstructed) -> Result<String, FigureError> {
    let reactions = |sample: usize| &found.samples[sample].reactions;
    let phase_criterion = |rod: &Rod, sample: usize| {
        1e6 * reactions(sample).phase_criterion(found.samples[sample].pose.phi, rod.bending_stiffness())
    };
    let angle = |sample: usize| found.found.evidence(sample).map_or(f64::NAN, |evidence| evidence.criterion.value);
    let uniform = found.rod.uniform();
    let quantities: [(&str, Quantity<'_>); 5] = [
        ("f_{0x} in N", &|sample| reactions(sample).f0x),
        ("f_{0y} in N", &|sample| reactions(sample).f0y),
        ("m_{0z} in N mm", &|sample| 1e3 * reactions(sample).m0z),
        match uniform {
            Some(_) => ("K in (N mm)²", &|sample| uniform.map_or(f64::NAN, |rod| phase_criterion(rod, sample))),
            None => ("−2 f sin ρ in EI/L²", &angle),
        },
        ("probability", &|sample| found.found.readings[sample].probability),
    ];
    let height = HEAD + PLOT * quantities.len() as u32 + trace::trimmings(true, true);
    let Some(path) = path(found) else { return svg((WIDTH, HEAD), |_| Ok(())) };
    let abscissa = Abscissa::of(&path);
    let along = along(found, &path, abscissa);
    svg((WIDTH, height), |root| {
        let (head, rest) = root.split_vertically(HEAD);
        let criterion = if uniform.is_some() { "phase criterion K" } else { "phase criterion −2 f sin ρ" };
        let title = format!("{}: reactions, {criterion}, and probability of the label", found.name);
        write(&head, &title, (24, 36), HPos::Left, TITLE, INK)?;
        let kinks = match found.found.kinks.len() {
            1 => "1 kink or jump".to_owned(),
            kinks => format!("{kinks} kinks and jumps"),
        };
        let definition =
            if uniform.is_some() { "; K = m_{0z}² − 2 EI (f_{0y} sin φ_{0} + f_{0x} cos φ_{0})" } else { "" };
        write(&head, &format!("vertical lines: {kinks}{definition}"), (24, 80), HPos::Left, BODY, MUTED)?;
        let trace = |(name, quantity)| (name, parts(found, abscissa, &along.across, quantity));
        trace::stack(root, &rest, &along, PLOT, quantities.into_iter().map(trace).collect())
    })
}

/// The straight way from the first pose to the last; where they are the same, to the one farthest from it.
pub(super) fn path(found: &Reconstructed) -> Option<ClampPath> {
    let (first, length) = (found.samples.first()?.pose, found.rod.at_clamp().length());
    let off = |pose: &Pose| (pose.x - first.x).hypot(pose.y - first.y).hypot(length * (pose.phi - first.phi));
    let poses = || found.samples.iter().map(|sample| sample.pose);
    let last = poses().next_back().filter(|pose| off(pose) > 0.1 * length);
    ClampPath::new(first, last.or_else(|| poses().max_by(|a, b| off(a).total_cmp(&off(b))))?).ok()
}

/// The abscissa of a recording, with the phases of its answers, and its kinks as marks.
pub(super) fn along(found: &Reconstructed, path: &ClampPath, abscissa: Abscissa) -> Along {
    let value = |sample: usize| abscissa.value(found.samples[sample].pose);
    let phases = found.runs().map(|(samples, label)| (value(samples.start)..value(samples.end - 1), label.to_string()));
    Along {
        across: span(found.samples.iter().map(|sample| abscissa.value(sample.pose)), 0.02),
        foot: abscissa.label(path),
        phases: phases.collect(),
        marks: found.kink_poses().into_iter().map(|pose| abscissa.value(pose)).collect(),
        legs: Vec::new(),
        modes: Vec::new(),
    }
}

fn parts(found: &Reconstructed, abscissa: Abscissa, across: &Range<f64>, quantity: Quantity<'_>) -> Vec<TracePart> {
    let width = (across.end - across.start) / COLUMNS;
    let part = |(samples, label): (Range<usize>, _)| {
        let points = samples.map(|sample| (abscissa.value(found.samples[sample].pose), quantity(sample)));
        TracePart {
            points: columns(points.filter(|point| point.1.is_finite()), width),
            style: label_colour(label).stroke_width(LINE),
        }
    };
    found.runs().map(part).collect()
}

/// The first, the least, the largest and the last of the points in each column of this width.
fn columns(points: impl Iterator<Item = (f64, f64)>, width: f64) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    let mut column: Vec<(f64, f64)> = Vec::new();
    let mut flush = |column: &mut Vec<(f64, f64)>| {
        if let (Some(&first), Some(&last)) = (column.first(), column.last()) {
            let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
            let ends = [column.iter().min_by(by_value), column.iter().max_by(by_value)];
            kept.push(first);
            kept.extend(ends.into_iter().flatten().filter(|point| **point != first && **point != last));
            if column.len() > 1 {
                kept.push(last);
            }
        }
        column.clear();
    };
    for point in points {
        if column.first().is_some_and(|first| (first.0 - point.0).abs() > width) {
            flush(&mut column);
        }
        column.push(point);
    }
    flush(&mut column);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_keeps_its_ends_and_extremes() {
        let values = [0.0, 3.0, -2.0, 1.0, 5.0, 5.0];
        let points = values.into_iter().enumerate().map(|(k, value)| (0.1 * k as f64, value));
        assert_eq!(
            columns(points, 0.35).iter().map(|point| point.1).collect::<Vec<_>>(),
            [0.0, -2.0, 3.0, 1.0, 5.0, 5.0]
        );
        assert!(columns(std::iter::empty(), 1.0).is_empty());
    }
}
