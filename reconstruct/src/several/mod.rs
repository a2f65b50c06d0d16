//! Placeholder until merged.
use crate::fit::Noise;
use crate::label::Label;
use crate::touch::Touch;
use crate::track::Track;
use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
/// x
pub enum Unresolved {
    /// x
    #[error("no")]
    NoTouch,
}
pub(crate) struct Piece {
    pub range: Range<usize>,
    pub label: Label,
}
pub(crate) struct Neighbour {
    pub range: Range<usize>,
    pub label: Label,
}
pub(crate) struct Pair {
    pub first: Result<Touch, Unresolved>,
    pub second: Result<Touch, Unresolved>,
}
#[derive(Default)]
pub(crate) struct Limits {}
pub(crate) fn resolve(
    _t: &Track,
    _n: &Noise,
    pieces: &[Piece],
    _b: Option<Neighbour>,
    _a: Option<Neighbour>,
    _l: &Limits,
) -> Vec<Pair> {
    (pieces[0].range.start..pieces[pieces.len() - 1].range.end)
        .map(|_| Pair { first: Err(Unresolved::NoTouch), second: Err(Unresolved::NoTouch) })
        .collect()
}
