//! The contour as the rod sees it: in lengths of the rod.

use rod_contours::{Composite, Contour, Range, Stretch, StretchKind};
use rod_core::Support;

/// A contour in dimensionless lengths. Each stretch keeps a parameter of its own (that of its shape over the rod's length, or
/// the angle turned at a joint), so that nothing is lost to an offset, however small the rod is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct World<'a> {
    contour: &'a Composite,
    /// Length of the rod in the contour's unit.
    length: f64,
}

/// The point of one stretch that is closest to a given point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    pub t: f64,
    pub gap: f64,
    pub alpha: f64,
    /// Signed curvature of the contour there; infinite at a corner.
    pub curvature: f64,
    pub x: f64,
    pub y: f64,
    /// Whether the foot is a perpendicular one, not an end of the stretch.
    pub interior: bool,
}

impl<'a> World<'a> {
    pub fn new(contour: &'a Composite, length: f64) -> Self {
        Self { contour, length }
    }

    pub fn stretches(&self) -> &'a [Stretch] {
        self.contour.stretches()
    }

    /// Length of the contour's parameter that counts as 1 here: of pieces the rod's length, of joints, which are measured by
    /// angle, 1.
    fn unit(&self, stretch: usize) -> f64 {
        if self.stretches()[stretch].is_joint() { 1.0 } else { self.length }
    }

    /// Range of a stretch in its own parameter.
    pub fn range(&self, stretch: usize) -> Range {
        let (own, unit) = (self.contour.own_range(stretch), self.unit(stretch));
        Range { from: own.from / unit, to: own.to / unit }
    }

    /// The upper or lower end of a stretch's range.
    pub fn border(&self, stretch: usize, upper: bool) -> f64 {
        let range = self.range(stretch);
        if upper { range.to } else { range.from }
    }

    /// The stretch after or before.
    pub fn neighbour(&self, stretch: usize, after: bool) -> Option<usize> {
        let neighbour = if after { Some(stretch + 1) } else { stretch.checked_sub(1) };
        neighbour.filter(|k| *k < self.stretches().len())
    }

    pub fn support(&self, stretch: usize, t: f64) -> Support {
        let unit = self.unit(stretch);
        let frame = self.contour.own_frame(stretch, t * unit);
        Support {
            x: frame.x / self.length,
            y: frame.y / self.length,
            alpha: frame.alpha,
            speed: frame.speed / self.length * unit,
            turning: frame.turning * unit,
        }
    }

    pub fn foot(&self, stretch: usize, x: f64, y: f64) -> Foot {
        let closest = self.contour.own_closest(stretch, x * self.length, y * self.length);
        let frame = closest.frame;
        Foot {
            t: closest.t / self.unit(stretch),
            gap: closest.gap / self.length,
            alpha: frame.alpha,
            curvature: frame.turning / frame.speed * self.length,
            x: frame.x / self.length,
            y: frame.y / self.length,
            interior: closest.interior,
        }
    }

    /// Whether a point with a negative gap to `foot`'s stretch is inside the solid, and there nearest to that stretch: what
    /// lies behind one stretch may be outside of the object or nearer to another stretch, whose gap it then is.
    pub fn goes_through(&self, foot: &Foot, x: f64, y: f64) -> bool {
        let gap = self.contour.gap(x * self.length, y * self.length) / self.length;
        foot.gap < 0.0 && foot.gap >= gap * (1.0 + 1e-6) - 1e-14
    }

    /// Whether `foot` is the end of its stretch at a notch.
    pub fn ends_in_notch(&self, stretch: usize, foot: &Foot) -> bool {
        let after = foot.t >= self.range(stretch).to;
        let neighbour = self.neighbour(stretch, after).map(|k| self.stretches()[k].kind);
        !foot.interior && matches!(neighbour, Some(StretchKind::Notch { .. }))
    }

    /// Number of the piece a stretch belongs to: for a joint the piece before it.
    pub fn piece(&self, stretch: usize) -> usize {
        match self.stretches()[stretch].kind {
            StretchKind::Piece(piece) => piece,
            StretchKind::Corner { before } | StretchKind::Notch { before } => before,
        }
    }
}
