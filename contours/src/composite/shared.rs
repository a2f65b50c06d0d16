//! Pieces that the clones of a composite share, so that no shape need be `Clone`.

use std::ops::Deref;
use std::sync::Arc;

use super::piece::Piece;
use crate::contour::behind_pointer;
use crate::trust::{Seal, Trust};
use crate::{Bounds, Closest, Contour, Frame, FrameRate, Range};

/// The shape of one of the pieces.
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

/// The pieces for another contour: themselves where nobody else has them.
pub(crate) fn owned(pieces: Arc<Vec<Piece>>) -> Vec<Piece> {
    Arc::try_unwrap(pieces).unwrap_or_else(|pieces| {
        let shared =
            |(index, piece): (usize, &Piece)| piece.with_shape(Box::new(Shared { pieces: pieces.clone(), index }));
        pieces.iter().enumerate().map(shared).collect()
    })
}
