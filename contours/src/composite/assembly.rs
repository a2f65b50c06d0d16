//! Puts pieces in their places: finds where consecutive ones meet or cross, and the joints between them.

use std::f64::consts::{PI, TAU};

use super::crossing::{self, Crossing};
use super::piece::Piece;
use crate::contour::Seal;
use crate::contract::spot_check;
use crate::point::{SMOOTH, wrap_angle};
use crate::{Contour, ContourError, Frame, Range};

/// Largest distance between the ends of consecutive pieces, relative to the largest coordinate of [`Piece::scale`]:
/// room for breaks typed to ten digits, far below anything mechanical.
const MEETING: f64 = 1e-9;

/// The shapes as pieces, whole.
///
/// Those that are not known to keep the contract of [`Contour`] are tested for plain mistakes.
pub(crate) fn whole_pieces(shapes: Vec<Box<dyn Contour>>) -> Result<Vec<Piece>, ContourError> {
    let piece = |(index, shape): (usize, Box<dyn Contour>)| {
        let range = check_range(shape.range(), index + 1)?;
        let tested = shape.trust(Seal(())).contract;
        match if tested { None } else { spot_check::broken_line(&*shape) } {
            Some(broken) => Err(ContourError::Contract { piece: index + 1, broken }),
            None => Ok(Piece::new(shape, range)),
        }
    };
    shapes.into_iter().enumerate().map(piece).collect()
}

/// Each piece up to where it meets the next one or enters its solid, see [`Composite::joined`](crate::Composite::joined).
pub(crate) fn crossing_pieces(shapes: Vec<Box<dyn Contour>>) -> Result<Vec<Piece>, ContourError> {
    let mut pieces = whole_pieces(shapes)?;
    for next in 2..=pieces.len() {
        let piece = next - 1;
        let (before, after) = pieces.split_at_mut(piece);
        let (before, after) = (&mut before[piece - 1], &mut after[0]);
        let range = check_range(before.range, piece)?;
        let apart = match meeting_frames(before, after, piece) {
            Ok(_) => continue,
            // Ends that should have met, but for the crossing that is not there either.
            Err(error @ ContourError::Apart { .. }) => error,
            Err(_) => ContourError::NoCrossing { piece, next, from: range.from, to: range.to },
        };
        let Crossing { leaves, enters } = crossing::entry(&before.shape, &after.shape, range.from).ok_or(apart)?;
        if leaves <= range.from {
            return Err(ContourError::Hidden { piece, next, enters: range.from, leaves });
        }
        before.range.to = leaves;
        after.range.from = enters;
    }
    Ok(pieces)
}

/// Checks that consecutive ends meet, and sets the pieces' offsets, whole turns and the joints between them. Returns
/// how many turns the contour takes if its end meets its start, 0 if it does not.
pub(crate) fn place_pieces(pieces: &mut [Piece]) -> Result<i32, ContourError> {
    if pieces.is_empty() {
        return Err(ContourError::Empty);
    }
    for (index, piece) in pieces.iter().enumerate() {
        check_range(piece.range, index + 1)?;
    }
    for index in 1..pieces.len() {
        let (before, after) = pieces.split_at_mut(index);
        let (before, after) = (&mut before[index - 1], &mut after[0]);
        let (end, start) = meeting_frames(before, after, index)?;
        let turn = turn(end, start);
        // Rounded to whole turns, the piece keeps the digits of its own angle.
        after.turns = whole_turns(end.alpha + turn - start.alpha);
        if turn.abs() > SMOOTH {
            before.set_turn(turn);
        }
        after.offset = before.after() - after.range.from;
    }
    let last = pieces.len() - 1;
    let Ok((end, start)) = meeting_frames(&pieces[last], &pieces[0], last + 1) else { return Ok(0) };
    let turn = turn(end, start);
    let turns = whole_turns(end.alpha + turn - start.alpha);
    if turns.abs() != 1 {
        return Err(ContourError::Loops { turns });
    }
    if turn.abs() > SMOOTH {
        pieces[last].set_turn(turn);
    }
    Ok(turns)
}

/// The turn, rad, from one direction to the next: a reversal is the end of a plate, which is convex.
fn turn(end: Frame, start: Frame) -> f64 {
    let turn = wrap_angle(start.alpha - end.alpha);
    if turn < SMOOTH - PI { turn + TAU } else { turn }
}

fn whole_turns(angle: f64) -> i32 {
    (angle / TAU).round() as i32
}

/// Checks that the range of a piece has a length.
fn check_range(range: Range, piece: usize) -> Result<Range, ContourError> {
    if range.from < range.to {
        Ok(range)
    } else {
        Err(ContourError::PieceRange { piece, from: range.from, to: range.to })
    }
}

/// The frames in which piece `number` (from 1) ends and the next one starts, if they meet.
fn meeting_frames(before: &Piece, after: &Piece, number: usize) -> Result<(Frame, Frame), ContourError> {
    let (end, start) = (before.last(), after.first());
    let finite = |t: f64, frame: Frame| t.is_finite() && frame.x.is_finite() && frame.y.is_finite();
    if !finite(before.range.to, end) {
        return Err(ContourError::NoEnd { piece: number, neighbour: number + 1 });
    }
    if !finite(after.range.from, start) {
        return Err(ContourError::NoEnd { piece: number + 1, neighbour: number });
    }
    let distance = end.distance(start.x, start.y);
    let tolerance = MEETING * before.scale().max(after.scale());
    if distance <= tolerance {
        Ok((end, start))
    } else {
        Err(ContourError::Apart { piece: number, next: number + 1, x: end.x, y: end.y, distance, tolerance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CircularArc, Composite};

    #[test]
    fn a_circle_from_the_origin_to_the_origin_is_closed() {
        let circle = CircularArc::new([0.0, 0.015], 0.015, -0.5 * PI, 1.5 * PI).unwrap();
        assert!(Composite::single(circle).unwrap().is_closed());
        assert!(Composite::new(vec![Box::new(circle)]).unwrap().is_closed());
    }
}
