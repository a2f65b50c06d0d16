//! Putting pieces in their places: where consecutive ones meet or cross, and what stands between them.

use std::f64::consts::TAU;

use crate::crossing::{self, Crossing};
use crate::joint::{Joint, wrapped};
use crate::piece::Piece;
use crate::{Contour, ContourError, Frame, Range};

/// Largest distance between the ends of consecutive pieces, relative to the largest coordinate at their ends: room for
/// breaks typed to ten digits, far below anything mechanical.
const MEETING: f64 = 1e-9;

/// Largest turn, rad, that is still a smooth joint: what a break computed in double precision leaves between tangents.
const SMOOTH: f64 = 1e-9;

/// Each piece up to where it enters the solid of the next, see [`Composite::joined`](crate::Composite::joined).
pub(crate) fn crossing(pieces: Vec<Box<dyn Contour>>) -> Result<Vec<Piece>, ContourError> {
    let mut ranges: Vec<Range> = pieces.iter().map(|shape| shape.range()).collect();
    for (index, pair) in pieces.windows(2).enumerate() {
        let (piece, next) = (index + 1, index + 2);
        let range = checked(ranges[index], piece)?;
        let Crossing { leaves, enters } = crossing::entry(&pair[0], &pair[1], range.from)
            .ok_or(ContourError::NoCrossing { piece, next, from: range.from, to: range.to })?;
        if leaves <= range.from {
            return Err(ContourError::Hidden { piece, next, enters: range.from, leaves });
        }
        ranges[index].to = leaves;
        ranges[index + 1].from = enters;
    }
    Ok(pieces.into_iter().zip(ranges).map(|(shape, range)| Piece::new(shape, range)).collect())
}

/// Checks that consecutive ends meet, then sets the pieces' offsets and whole turns and finds the joints between them.
pub(crate) fn placed(mut pieces: Vec<Piece>) -> Result<(Vec<Piece>, Vec<Option<Joint>>), ContourError> {
    if pieces.is_empty() {
        return Err(ContourError::Empty);
    }
    for (index, piece) in pieces.iter().enumerate() {
        checked(piece.range, index + 1)?;
    }
    let mut joints = Vec::with_capacity(pieces.len() - 1);
    for index in 1..pieces.len() {
        let (before, after) = pieces.split_at_mut(index);
        let (before, after) = (&before[index - 1], &mut after[0]);
        let (end, start) = meeting(before, after, index)?;
        let turn = wrapped(start.alpha - end.alpha);
        // Rounded to whole turns, the piece keeps the digits of its own angle.
        after.winding = TAU * ((end.alpha + turn - start.alpha) / TAU).round();
        let end_t = before.range.to + before.offset;
        let joint = (turn.abs() > SMOOTH).then(|| Joint::new(end, end_t, turn));
        after.offset = joint.map_or(end_t, |joint| joint.range().to) - after.range.from;
        joints.push(joint);
    }
    Ok((pieces, joints))
}

/// The range of a piece, if it is one.
fn checked(range: Range, piece: usize) -> Result<Range, ContourError> {
    if range.from < range.to {
        Ok(range)
    } else {
        Err(ContourError::PieceRange { piece, from: range.from, to: range.to })
    }
}

/// The frames in which piece `number` (from 1) ends and the next one starts, if they meet.
fn meeting(before: &Piece, after: &Piece, number: usize) -> Result<(Frame, Frame), ContourError> {
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
