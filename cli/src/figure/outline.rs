//! The visible part of a contour as points.

use vibrissa::Composite;
use vibrissa::contour::{Bounds, Frame, Range};

/// Points along a visible stretch; also the most steps taken where a stretch goes on for ever.
const POINTS: usize = 500;

/// The frames of the contour within `window` (m), one list for each part that is seen without a break.
pub(super) fn visible(contour: &Composite, window: Bounds) -> Vec<Vec<Frame>> {
    let mut parts = vec![Vec::new()];
    let diagonal = (window.max[0] - window.min[0]).hypot(window.max[1] - window.min[1]);
    let share = (4 * POINTS / contour.stretches().len()).clamp(2, POINTS);
    for (index, stretch) in contour.stretches().enumerate() {
        let Range { from, to } = reachable(contour, index, window, diagonal);
        for i in 0..=share {
            let frame = contour.frame_on(index, from + (to - from) * i as f64 / share as f64);
            let seen = window.contains(frame.x, frame.y);
            match parts.last_mut() {
                Some(part) if seen && !stretch.is_joint() => part.push(frame),
                Some(part) if !seen && !part.is_empty() => parts.push(Vec::new()),
                _ => {}
            }
        }
    }
    parts.retain(|part| part.len() > 1);
    parts
}

/// The frames of a closed contour that lies in `window` (m) as a whole; the last one is at the place of the first.
pub(super) fn seen_whole(contour: &Composite, window: Bounds) -> Option<Vec<Frame>> {
    if !contour.is_closed() {
        return None;
    }
    let mut parts = visible(contour, window);
    let diagonal = (window.max[0] - window.min[0]).hypot(window.max[1] - window.min[1]);
    // a contour that leaves the window is seen in parts, or from one border to another
    let is_whole = |part: &Vec<Frame>| {
        part.first().zip(part.last()).is_some_and(|(a, b)| (a.x - b.x).hypot(a.y - b.y) < 1e-5 * diagonal)
    };
    if parts.len() == 1 { parts.pop().filter(is_whole) } else { None }
}

/// The part of a stretch's range that can be seen: all of it, or, where it goes on for ever, as far as it takes to
/// leave the window for good.
fn reachable(contour: &Composite, index: usize, window: Bounds, diagonal: f64) -> Range {
    let range = contour.stretch(index).range;
    if range.is_finite() {
        return range;
    }
    let middle = [0, 1].map(|i| 0.5 * (window.min[i] + window.max[i]));
    let start = range.clamp(contour.closest_on(index, middle[0], middle[1]).t);
    let walk = |direction: f64| {
        let mut t = start;
        for _ in 0..POINTS {
            let frame = contour.frame_on(index, t);
            if window.distance(frame.x, frame.y) > diagonal {
                break;
            }
            // A hundredth of the window, or, where the point hardly moves, far enough in the parameter to get on.
            t += direction * diagonal / 100.0 / frame.speed.max(1e-6);
        }
        t
    };
    Range {
        from: if range.from.is_finite() { range.from } else { walk(-1.0) },
        to: if range.to.is_finite() { range.to } else { walk(1.0) },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::{CircularArc, Contour, Parabola};

    #[test]
    fn two_parabolas_are_seen_in_one_piece_up_to_the_window() {
        let pieces = [0.0, 0.03].map(|x| Box::new(Parabola::new([x, 0.0], 50.0).unwrap()) as Box<dyn Contour>);
        let contour = Composite::joined(Vec::from(pieces)).unwrap();
        let window = Bounds { min: [-0.1, -0.05], max: [0.1, 0.05] };
        let parts = visible(&contour, window);
        assert_eq!(parts.len(), 1);
        let (first, last) = (parts[0].first().unwrap(), parts[0].last().unwrap());
        assert!((first.y - 0.05).abs() < 1e-3 && (last.y - 0.05).abs() < 1e-3, "{first:?} {last:?}");
        assert!(first.x < -0.03 && last.x > 0.06);
    }

    #[test]
    fn a_circle_is_seen_whole_if_no_part_of_it_is_outside_of_the_window() {
        let circle =
            Composite::single(CircularArc::new([0.0, 0.0], 0.01, 0.0, std::f64::consts::TAU).unwrap()).unwrap();
        let window = |right: f64| Bounds { min: [-0.02, -0.02], max: [right, 0.02] };
        assert!(seen_whole(&circle, window(0.02)).is_some());
        assert!(seen_whole(&circle, window(0.005)).is_none());
    }

    #[test]
    fn a_contour_elsewhere_is_not_seen() {
        let line = Composite::single(Parabola::new([0.0, 7.0], 0.0).unwrap()).unwrap();
        assert!(visible(&line, Bounds { min: [0.0, 0.0], max: [1.0, 1.0] }).is_empty());
    }
}
