//! One shape in its place in a composite.

use std::f64::consts::TAU;
use std::ops::Deref;
use std::sync::Arc;

use super::joint::Joint;
use crate::contour::{Seal, Trust, behind_pointer};
use crate::{Bounds, Closest, Contour, Frame, FrameRate, Range};

/// A shape, the part of it that belongs to the composite, how its parameter and angle continue those before it, and the
/// joint after it. Kept small: there may be 1e5 of them.
#[derive(Debug)]
pub(crate) struct Piece {
    pub shape: Box<dyn Contour>,
    /// The part of the shape, its own parameter.
    pub range: Range,
    /// The composite's parameter less the shape's own.
    pub offset: f64,
    /// The composite's alpha less the shape's own, in whole turns.
    pub turns: i32,
    /// Index of its stretch.
    pub stretch: u32,
    /// Change of the parameter per length about the middle, as a power of two: a product with it loses no digit.
    pub pace: f64,
    /// The turn to the next piece, rad; 0 where that joint is smooth, or there is none.
    turn: f64,
    /// The point and the angle (of the composite) where the piece ends; known where there is a turn.
    end: [f64; 3],
}

impl Piece {
    /// A piece that keeps its own parameter and angle.
    pub fn new(shape: Box<dyn Contour>, range: Range) -> Self {
        Self { shape, range, offset: 0.0, turns: 0, stretch: 0, pace: 1.0, turn: 0.0, end: [0.0; 3] }
    }

    /// The piece with another shape, which must be the same curve.
    pub fn with_shape(&self, shape: Box<dyn Contour>) -> Self {
        Self { shape, ..*self }
    }

    /// Measures the pace; the range must be final.
    pub fn set_pace(&mut self) {
        // of a piece that goes on for ever: where it begins, or at 0, as these are the same points in any unit of length
        let t = if self.range.is_finite() { self.range.at(0.5) } else { self.range.clamp(0.0) };
        let speed = self.shape.frame(t).speed;
        self.pace = if speed.is_normal() && speed > 0.0 { (-speed.log2().round()).exp2() } else { 1.0 };
    }

    /// Sets the joint after it, which turns by `turn`, rad.
    pub fn set_turn(&mut self, turn: f64) {
        let Frame { x, y, alpha, .. } = self.last();
        (self.turn, self.end) = (turn, [x, y, alpha]);
    }

    /// The turn to the next piece, rad.
    pub fn turn(&self) -> f64 {
        self.turn
    }

    pub fn has_joint(&self) -> bool {
        self.turn != 0.0
    }

    /// The joint after it.
    pub fn joint(&self) -> Joint {
        let [x, y, alpha] = self.end;
        Joint::new(Frame { x, y, alpha, speed: 0.0, turning: 0.0 }, self.to(), self.turn)
    }

    /// The composite's parameter where the piece ends.
    pub fn to(&self) -> f64 {
        self.range.to + self.offset
    }

    /// The composite's parameter where the piece and the joint after it end.
    pub fn after(&self) -> f64 {
        self.to() + self.turn.abs()
    }

    /// The frame at the composite's parameter `t`.
    pub fn frame(&self, t: f64) -> Frame {
        self.own_frame(t - self.offset)
    }

    /// The frame at the shape's own parameter `u`.
    pub fn own_frame(&self, u: f64) -> Frame {
        self.with_turns(self.shape.frame(u))
    }

    /// The closest point of the part in `range`, both by the shape's own parameter.
    pub fn own_closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let closest = self.shape.closest_in(range, x, y);
        Closest { frame: self.with_turns(closest.frame), ..closest }
    }

    /// The first frame of the piece.
    pub fn first(&self) -> Frame {
        self.own_frame(self.range.from)
    }

    /// The last frame of the piece.
    pub fn last(&self) -> Frame {
        self.own_frame(self.range.to)
    }

    /// A box that contains the part in `range`, by the shape's own parameter.
    pub fn bounds_in(&self, range: Range) -> Bounds {
        self.shape.bounds_in(range)
    }

    /// Largest coordinate at the ends and in the middle of the piece (one unit of the parameter away from a single end,
    /// or from 0, where it is infinite): the length against which rounding is judged.
    pub fn scale(&self) -> f64 {
        let part = self.range.window(1.0);
        // Both ends alone would not do for a circle from the origin to the origin.
        [part.from, 0.5 * (part.from + part.to), part.to]
            .into_iter()
            .map(|t| self.shape.frame(t))
            .fold(0.0, |scale: f64, frame| scale.max(frame.x.abs()).max(frame.y.abs()))
    }

    fn with_turns(&self, frame: Frame) -> Frame {
        Frame { alpha: frame.alpha + TAU * f64::from(self.turns), ..frame }
    }
}

/// The shape of one of the pieces that the clones of a composite share, so that no shape need be `Clone`.
#[derive(Debug)]
struct Shared {
    pieces: Arc<Vec<Piece>>,
    index: usize,
}

impl Deref for Shared {
    type Target = dyn Contour;

    fn deref(&self) -> &Self::Target {
        &*self.pieces[self.index].shape
    }
}

behind_pointer!(impl Contour for Shared);

/// The pieces for another contour: moved out where no clone shares them, else new pieces that refer to the shared shapes.
pub(crate) fn unshared_pieces(pieces: Arc<Vec<Piece>>) -> Vec<Piece> {
    Arc::try_unwrap(pieces).unwrap_or_else(|pieces| {
        let shared =
            |(index, piece): (usize, &Piece)| piece.with_shape(Box::new(Shared { pieces: pieces.clone(), index }));
        pieces.iter().enumerate().map(shared).collect()
    })
}
