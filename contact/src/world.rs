//! The contour as the rod sees it: in lengths of the rod.

use rod_contours::{Composite, Contour, Stretch, StretchKind};
use rod_core::Support;

/// A contour in dimensionless lengths. Its parameter stays the contour's own.
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

    pub fn support(&self, stretch: usize, t: f64) -> Support {
        let frame = self.contour.frame_on(stretch, t);
        Support {
            x: frame.x / self.length,
            y: frame.y / self.length,
            alpha: frame.alpha,
            speed: frame.speed / self.length,
            turning: frame.turning,
        }
    }

    pub fn foot(&self, stretch: usize, x: f64, y: f64) -> Foot {
        let closest = self.contour.closest_on(stretch, x * self.length, y * self.length);
        let frame = closest.frame;
        Foot {
            t: closest.t,
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
        let stretches = self.stretches();
        let range = stretches[stretch].range;
        let neighbour = if foot.t >= range.to {
            Some(stretch + 1)
        } else if foot.t <= range.from {
            stretch.checked_sub(1)
        } else {
            None
        };
        let kind = neighbour.and_then(|k| stretches.get(k)).map(|s| s.kind);
        !foot.interior && matches!(kind, Some(StretchKind::Notch { .. }))
    }

    /// Number of the piece a stretch belongs to: for a joint the piece before it.
    pub fn piece(&self, stretch: usize) -> usize {
        match self.stretches()[stretch].kind {
            StretchKind::Piece(piece) => piece,
            StretchKind::Corner { before } | StretchKind::Notch { before } => before,
        }
    }
}
