//! The parts of a composite that queries look at.

use crate::Range;

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
