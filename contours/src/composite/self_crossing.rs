//! Search for places where a contour crosses itself.

use std::f64::consts::{FRAC_PI_2, PI};

use super::crossing::newton_crossing;
use crate::point::{cross, minus};
use crate::{Bounds, Composite, ContourError, Frame, Index, Part, Point, Range, StretchKind};

/// Chords of a right angle: the arc leaves them by 1/200 of its radius at most.
const CHORDS: f64 = 8.0;

/// Largest number of chords of one part, for shapes whose angle may be wrong; also the number of an infinite part, whose
/// neighbouring chords differ by 7 % in length.
const MOST: f64 = 512.0;

/// Samples of the angle from which the turn of a part is summed up.
const SAMPLES: usize = 8;

/// Turn (rad) of a part that is a line: rounding.
const STRAIGHT: f64 = 1e-9;

/// Sine of the angle below which two directions are the same: what runs back along itself does not cross itself.
const PARALLEL: f64 = 1e-9;

/// Distance beyond the ends of a chord, relative to its length, within which a crossing counts. At 0 a crossing through a vertex
/// would lie on neither of the two chords.
const SLACK: f64 = 1e-9;

/// Largest distance of the two points of a crossing, relative to the coordinates.
const TOGETHER: f64 = 1e-9;

/// A place where a contour crosses itself, or touches itself at an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfCrossing {
    /// The composite's parameter each of the two times.
    pub places: [f64; 2],
    /// Index of the piece each of the two times.
    pub pieces: [usize; 2],
    /// The point, lengths.
    pub point: Point,
}

impl From<SelfCrossing> for ContourError {
    fn from(SelfCrossing { pieces: [first, second], point: [x, y], .. }: SelfCrossing) -> Self {
        Self::Crosses { what: "piece", first: first + 1, second: second + 1, x, y }
    }
}

impl Composite {
    /// The first place where the contour crosses itself, or touches itself at an angle; `None` if it does not.
    ///
    /// Arcs are followed by chords, 8 to a right angle, and a crossing of two chords is one if the arcs cross there: exact
    /// for lines, while arcs that cross twice within 1/200 of their radius can go unseen. What runs back along itself,
    /// like the two sides of a thin plate, does not cross. The work is `O(n log n)` for `n` chords.
    ///
    /// ```
    /// use rod_contours::{Composite, Contour, Line};
    ///
    /// let line = |from, to| Line::new(from, to).map(|line| Box::new(line) as Box<dyn Contour>);
    /// let loops = Composite::new(vec![
    ///     line([0.0, 0.0], [2.0, 0.0])?,
    ///     line([2.0, 0.0], [2.0, 1.0])?,
    ///     line([2.0, 1.0], [1.0, -1.0])?,
    /// ])?;
    /// let crossing = loops.self_crossing().map(|crossing| (crossing.pieces, crossing.point));
    /// assert_eq!(crossing, Some(([0, 2], [1.5, 0.0])));
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    pub fn self_crossing(&self) -> Option<SelfCrossing> {
        self.crossing_among(&self.parts().flat_map(|part| chords(self, part)).collect::<Vec<_>>())
    }

    /// The first place where one of the pieces crosses itself, of those whose shape does not rule it out.
    pub(crate) fn crossing_of_a_piece(&self) -> Option<SelfCrossing> {
        let may_cross: Vec<bool> = self.may_cross_themselves().collect();
        if !may_cross.contains(&true) {
            return None;
        }
        let parts: Vec<Part> = self.parts().collect();
        parts.chunk_by(|one, other| one.stretch == other.stretch).find_map(|parts| {
            let StretchKind::Piece(piece) = self.kind(parts.first()?.stretch) else { return None };
            let alpha = |part: &Part, t: f64| self.own_frame(part.stretch, t).alpha;
            // What turns by less than a half turn in all does not come back; parts bend one way.
            let turn: f64 =
                parts.iter().map(|part| (alpha(part, part.range.to) - alpha(part, part.range.from)).abs()).sum();
            if !may_cross[piece] || turn < PI {
                return None;
            }
            self.crossing_among(&parts.iter().flat_map(|&part| chords(self, part)).collect::<Vec<_>>())
        })
    }

    fn crossing_among(&self, chords: &[Chord]) -> Option<SelfCrossing> {
        let index = Index::new(chords.iter().map(Chord::bounds));
        let last = chords.len().checked_sub(1)?;
        // Not only where it is closed: what goes round twice is not, and ends where it starts.
        let closes = self.is_closed() || chords[last].reaches(&chords[0]);
        for (first, chord) in chords.iter().enumerate() {
            let mut found: Option<SelfCrossing> = None;
            index.meeting(chord.bounds(), &mut |second| {
                let neighbours = second <= first + 1 || (closes && first == 0 && second == last);
                if neighbours || !chord.bounds().meets(&chords[second].bounds()) {
                    return;
                }
                if let Some(crossing) = chord.crossing(&chords[second], self)
                    && found.is_none_or(|found| crossing.places[0] < found.places[0])
                {
                    found = Some(crossing);
                }
            });
            if found.is_some() {
                return found;
            }
        }
        None
    }
}

/// The straight way from one place of a stretch to another.
#[derive(Clone, Copy, Debug)]
struct Chord {
    stretch: usize,
    /// The stretch's own parameter.
    range: Range,
    from: Point,
    to: Point,
}

/// The chords of a part in order; none of a joint, which is a point.
fn chords(contour: &Composite, Part { stretch, range }: Part) -> impl Iterator<Item = Chord> {
    let angle = |sample: usize| contour.own_frame(stretch, range.at(sample as f64 / SAMPLES as f64)).alpha;
    let count = if !matches!(contour.kind(stretch), StretchKind::Piece(_)) {
        0.0
    } else if range.is_finite() {
        let turn: f64 = (0..SAMPLES).map(|sample| (angle(sample + 1) - angle(sample)).abs()).sum();
        if turn <= STRAIGHT { 1.0 } else { (CHORDS * turn / FRAC_PI_2).ceil().clamp(CHORDS, MOST) }
    } else {
        MOST
    };
    (0..count as usize).map(move |chord| {
        let range = Range { from: range.at(chord as f64 / count), to: range.at((chord + 1) as f64 / count) };
        let [from, to] = [range.from, range.to].map(|t| point(contour.own_frame(stretch, t)));
        Chord { stretch, range, from, to }
    })
}

impl Chord {
    fn bounds(&self) -> Bounds {
        Bounds::EMPTY.with(self.from[0], self.from[1]).with(self.to[0], self.to[1])
    }

    /// Whether it ends where the other one starts.
    fn reaches(&self, other: &Self) -> bool {
        let [dx, dy] = minus(other.from, self.to);
        dx.hypot(dy) <= TOGETHER * self.to[0].abs().max(self.to[1].abs())
    }

    /// Where the arcs of both chords cross, if the chords do.
    fn crossing(&self, other: &Self, contour: &Composite) -> Option<SelfCrossing> {
        let (one, two) = (minus(self.to, self.from), minus(other.to, other.from));
        let sine = cross(one, two);
        if sine.abs() <= PARALLEL * one[0].hypot(one[1]) * two[0].hypot(two[1]) {
            return None;
        }
        let between = minus(other.from, self.from);
        let shares = [cross(between, two) / sine, cross(between, one) / sine];
        if !shares.iter().all(|share| (-SLACK..=1.0 + SLACK).contains(share)) {
            return None;
        }
        let at = |chord: &Self, share: f64| chord.range.clamp(chord.range.from + share * chord.range.length());
        self.refine(other, [at(self, shares[0]), at(other, shares[1])], contour)
    }

    /// The crossing near these places; `None` if Newton's iteration does not lead to one.
    fn refine(&self, other: &Self, places: [f64; 2], contour: &Composite) -> Option<SelfCrossing> {
        let chords = [self, other];
        let frames = |places: [f64; 2]| [0, 1].map(|side| contour.own_frame(chords[side].stretch, places[side]));
        let ranges = chords.map(|chord| contour.own_range(chord.stretch));
        let (distance, places) = newton_crossing(places, ranges, frames);
        let [one, two] = frames(places);
        let scale = one.x.abs().max(one.y.abs()).max(self.range.length() * one.speed);
        let near = |side: usize| {
            let range = chords[side].range;
            let beyond = range.from - places[side];
            beyond.max(places[side] - range.to) <= range.length()
        };
        let crosses = (one.alpha - two.alpha).sin().abs() > PARALLEL;
        if distance > TOGETHER * scale
            || !near(0)
            || !near(1)
            || !crosses
            || self.is_continued_by(other, places, contour)
        {
            return None;
        }
        Some(SelfCrossing {
            places: [0, 1].map(|side| contour.common_parameter(chords[side].stretch, places[side])),
            pieces: chords.map(|chord| match contour.kind(chord.stretch) {
                StretchKind::Piece(piece) => piece,
                StretchKind::Corner { before } | StretchKind::Notch { before } => before,
            }),
            point: point(one),
        })
    }

    /// Whether both places are one and the same place of the contour.
    fn is_continued_by(&self, other: &Self, places: [f64; 2], contour: &Composite) -> bool {
        let tiny = SLACK * self.range.length().max(other.range.length());
        if self.stretch == other.stretch && (places[1] - places[0]).abs() <= tiny {
            return true;
        }
        let end_meets_start = |before: usize, end: f64, after: usize, start: f64| {
            let at_ends = contour.own_range(before).to - end <= tiny && start - contour.own_range(after).from <= tiny;
            at_ends && next_piece(contour, before) == Some(after)
        };
        end_meets_start(self.stretch, places[0], other.stretch, places[1])
            || end_meets_start(other.stretch, places[1], self.stretch, places[0])
    }
}

/// The stretch of the piece after the piece of another stretch.
fn next_piece(contour: &Composite, stretch: usize) -> Option<usize> {
    let next = contour.neighbour(stretch, true)?;
    if matches!(contour.kind(next), StretchKind::Piece(_)) { Some(next) } else { contour.neighbour(next, true) }
}

fn point(frame: Frame) -> Point {
    [frame.x, frame.y]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::{CircularArc, Contour, EllipticArc, Line, Parabola};

    fn line(from: Point, to: Point) -> Box<dyn Contour> {
        Box::new(Line::new(from, to).unwrap())
    }

    #[test]
    fn arcs_cross_where_they_do() {
        // Three quarters of a circle, then a line out through its first quarter.
        let circle = CircularArc::new([0.0, 0.0], 1.0, 0.0, 1.5 * PI).unwrap();
        let hook = Composite::new(vec![Box::new(circle), line([0.0, -1.0], [0.6, 1.8])]).unwrap();
        let crossing = hook.self_crossing().unwrap();
        assert_eq!(crossing.pieces, [0, 1]);
        let [x, y] = crossing.point;
        assert!((x.hypot(y) - 1.0).abs() < 1e-15 && (y + 1.0 - x * 2.8 / 0.6).abs() < 1e-14, "{x} {y}");
        for place in crossing.places {
            let frame = hook.frame(place);
            assert!(frame.distance(x, y) < 1e-14);
        }
        // Shortened, it stays inside.
        let inside = Composite::new(vec![Box::new(circle), line([0.0, -1.0], [0.2, 0.5])]).unwrap();
        assert_eq!(inside.self_crossing(), None);
    }

    #[test]
    fn whole_curves_do_not_cross_themselves() {
        let circle = CircularArc::new([1.0, 0.0], 1.0, 0.3, 0.3 + TAU).unwrap();
        assert_eq!(Composite::single(circle).unwrap().self_crossing(), None);
        let ellipse = EllipticArc::new([1.0, 0.0], [1e3, 1.0], 0.4, 2.0, 2.0 - TAU).unwrap();
        assert_eq!(Composite::single(ellipse).unwrap().self_crossing(), None);
        assert_eq!(Composite::single(Parabola::new([0.0, 0.0], 50.0).unwrap()).unwrap().self_crossing(), None);
        let two = [0.0, 0.3].map(|x| Box::new(Parabola::new([x, 0.0], 5.0).unwrap()) as Box<dyn Contour>);
        assert_eq!(Composite::joined(two.into()).unwrap().self_crossing(), None);
    }

    #[test]
    fn a_plate_runs_back_along_itself() {
        let there = [[0.0, 0.0], [1.0, 0.2], [2.0, 0.4]];
        let plate = vec![line(there[0], there[1]), line(there[1], there[2]), line(there[2], there[0])];
        let plate = Composite::new(plate).unwrap();
        assert!(plate.is_closed());
        assert_eq!(plate.self_crossing(), None);
    }

    #[test]
    fn a_long_comb_is_free_and_its_last_tooth_is_found() {
        let mut points: Vec<Point> = (0..20_000).map(|k| [f64::from(k), f64::from(k % 2)]).collect();
        let comb =
            |points: &[Point]| Composite::new(points.windows(2).map(|pair| line(pair[0], pair[1])).collect()).unwrap();
        assert_eq!(comb(&points).self_crossing(), None);
        points.push([19_997.0, 0.5]);
        let crossing = comb(&points).self_crossing().unwrap();
        assert_eq!(crossing.pieces, [19_997, 19_999]);
    }
}
