//! The pieces of a contour, for other contours.

use crate::{Composite, Contour, Trimmed};

impl Composite {
    /// The pieces in order, each trimmed to its part of the contour; [`new`](Self::new) puts them together again.
    ///
    /// ```
    /// use rod_contours::{Composite, Parabola};
    ///
    /// let bump = |x| Parabola::new([x, 0.0], 5.0).map(|bump| Box::new(bump) as _);
    /// let pieces = Composite::joined(vec![bump(0.0)?, bump(0.3)?])?.into_pieces();
    /// assert!((pieces[0].range().to - 0.15).abs() < 1e-15);
    /// assert_eq!(Composite::new(pieces)?.stretches().len(), 3);
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    pub fn into_pieces(self) -> Vec<Box<dyn Contour>> {
        let (pieces, _) = self.taken_apart();
        pieces
            .into_iter()
            .map(|piece| {
                if piece.range == piece.shape.range() {
                    piece.shape
                } else {
                    Box::new(Trimmed::known(piece.shape, piece.range))
                }
            })
            .collect()
    }
}
