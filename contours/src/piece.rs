//! One shape in its place in a composite.

use crate::{Bounds, Closest, Contour, Frame, Range};

/// A shape, the part of it that belongs to the composite, and how its parameter and angle continue those before it.
#[derive(Debug)]
pub(crate) struct Piece {
    pub shape: Box<dyn Contour>,
    /// The part of the shape, its own parameter.
    pub range: Range,
    /// The composite's parameter less the shape's own.
    pub offset: f64,
    /// The composite's alpha less the shape's own: whole turns.
    pub winding: f64,
}

impl Piece {
    /// A piece that keeps its own parameter and angle.
    pub fn new(shape: Box<dyn Contour>, range: Range) -> Self {
        Self { shape, range, offset: 0.0, winding: 0.0 }
    }

    /// The frame at the composite's parameter `t`.
    pub fn frame(&self, t: f64) -> Frame {
        self.own_frame(t - self.offset)
    }

    /// The frame at the shape's own parameter `u`.
    pub fn own_frame(&self, u: f64) -> Frame {
        self.wound(self.shape.frame(u))
    }

    /// The closest point of the piece, by the shape's own parameter.
    pub fn own_closest(&self, x: f64, y: f64) -> Closest {
        let closest = self.shape.closest_in(self.range, x, y);
        Closest { frame: self.wound(closest.frame), ..closest }
    }

    /// The first frame of the piece.
    pub fn first(&self) -> Frame {
        self.own_frame(self.range.from)
    }

    /// The last frame of the piece.
    pub fn last(&self) -> Frame {
        self.own_frame(self.range.to)
    }

    /// The closest point of the part in `range`, both by the composite's parameter.
    pub fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let own = self.range.within(range.shifted(-self.offset));
        let closest = self.shape.closest_in(own, x, y);
        Closest {
            // Rounding of the offset must not move the point out of the range.
            t: range.clamp(closest.t + self.offset),
            frame: self.wound(closest.frame),
            ..closest
        }
    }

    pub fn bounds(&self) -> Bounds {
        self.shape.bounds_in(self.range)
    }

    /// Largest coordinate at the ends of the piece (one unit of the parameter away from a single end, or from 0, where
    /// it goes on for ever): the length against which rounding is judged.
    pub fn scale(&self) -> f64 {
        let part = self.range.window(1.0);
        [part.from, part.to]
            .into_iter()
            .map(|t| self.shape.frame(t))
            .fold(0.0, |scale: f64, frame| scale.max(frame.x.abs()).max(frame.y.abs()))
    }

    fn wound(&self, frame: Frame) -> Frame {
        Frame { alpha: frame.alpha + self.winding, ..frame }
    }
}
