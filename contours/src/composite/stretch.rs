//! The stretches of a composite (pieces and the joints between them), and the parts of them that queries look at.

use crate::Range;

/// The kind of a stretch of a composite. Pieces are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StretchKind {
    /// The piece with this index.
    Piece(usize),
    /// A convex corner: the point stands still and alpha grows by 1 per unit of the parameter.
    Corner {
        /// Index of the piece before the corner.
        before: usize,
    },
    /// A concave corner: the point stands still and alpha falls by 1 per unit of the parameter.
    Notch {
        /// Index of the piece before the notch.
        before: usize,
    },
}

/// A part of a composite's parameter on which the contour is smooth.
///
/// ```
/// use rod_contours::{Composite, Parabola, StretchKind};
///
/// let line = Composite::single(Parabola::new([0.0, 0.0], 0.0)?)?;
/// assert_eq!(line.stretches().len(), 1);
/// assert_eq!(line.stretch(0).kind, StretchKind::Piece(0));
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Piece, corner or notch.
    pub kind: StretchKind,
    /// Its part of the composite's parameter.
    pub range: Range,
}

impl Stretch {
    /// Whether the stretch is a corner or a notch.
    pub fn is_joint(&self) -> bool {
        !matches!(self.kind, StretchKind::Piece(_))
    }
}

/// A part of one stretch of a composite: a joint, or a part of a piece that bends one way only and by a right angle at
/// most, so that something small and nearly straight comes nearest to it in one place.
///
/// ```
/// use rod_contours::{Composite, Parabola};
///
/// let bump = Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?;
/// let parts: Vec<_> = bump.parts().collect();
/// assert_eq!((parts.len(), parts[0].stretch), (1, 0));
/// let closest = bump.own_closest_in(parts[0].stretch, parts[0].range, 0.0, -0.2);
/// assert_eq!(closest.gap, 0.2);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Index of the stretch.
    pub stretch: usize,
    /// Which part of it, in the stretch's own parameter.
    pub range: Range,
}
