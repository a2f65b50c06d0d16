//! Several pieces as one contour.

use crate::assembly;
use crate::joint::Joint;
use crate::piece::Piece;
use crate::tree::Tree;
use crate::{Bounds, Closest, Contour, ContourError, Frame, Range, Stretch, StretchKind};

/// Pieces in order, with the solid on the left, as one contour with one parameter.
///
/// The parameter runs through the pieces by their own parameters, each moved by an offset; the first piece keeps its own.
/// Between two pieces whose tangents differ by more than 1e-9 rad stands a joint, a stretch of its own as long as the
/// turn: the point stands still (speed 0) while alpha grows (convex corner, turning +1) or falls (notch, turning -1).
///
/// ```
/// use rod_contours::{Composite, Contour, Parabola, StretchKind};
///
/// // A wedge standing on its edge at (0, 1): slope -2 on its left, +2 on its right.
/// let left = Parabola::new([1.0, 0.0], 1.0)?.between(-1.0, 0.0)?;
/// let right = Parabola::new([-1.0, 0.0], 1.0)?.between(0.0, 1.0)?;
/// let wedge = Composite::new(vec![Box::new(left), Box::new(right)])?;
/// assert_eq!(wedge.stretches()[1].kind, StretchKind::Corner { before: 0 });
///
/// let below = wedge.closest(0.0, 0.25);
/// assert_eq!((below.gap, below.interior), (0.75, true));
/// assert_eq!(below.frame.speed, 0.0);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Debug)]
pub struct Composite {
    pieces: Vec<Piece>,
    /// The joint after each piece but the last; none where the joint is smooth.
    joints: Vec<Option<Joint>>,
    /// Never empty: a composite has a piece.
    stretches: Vec<Stretch>,
    tree: Tree,
}

impl Composite {
    /// Pieces whose ends meet, to 1e-9 of the largest coordinate at their ends.
    ///
    /// # Errors
    ///
    /// Without pieces ([`ContourError::Empty`]), with a range upside down ([`ContourError::PieceRange`]), an inner end at
    /// infinity ([`ContourError::NoEnd`]) or ends that do not meet ([`ContourError::Apart`]).
    pub fn new(pieces: Vec<Box<dyn Contour>>) -> Result<Self, ContourError> {
        let pieces = pieces
            .into_iter()
            .map(|shape| {
                let range = shape.range();
                Piece::new(shape, range)
            })
            .collect();
        Self::assembled(pieces)
    }

    /// Pieces that cross: each is left at the first point where it enters the solid of the next, so that the solid is
    /// the union. Pieces may go on for ever.
    ///
    /// The crossing is exact to rounding. Unseen are crossings closer together than 1/16 of a cell, of which there are
    /// 256 spread over the piece by [`Range::at`], and crossings more than 1e4 along a piece that goes on for ever.
    ///
    /// # Errors
    ///
    /// Those of [`Composite::new`]; consecutive pieces that do not cross ([`ContourError::NoCrossing`]); a piece that
    /// its neighbours hide ([`ContourError::Hidden`]).
    pub fn joined(pieces: Vec<Box<dyn Contour>>) -> Result<Self, ContourError> {
        Self::assembled(assembly::crossing(pieces)?)
    }

    /// One shape as a composite, with its own parameter.
    pub fn single(shape: impl Contour + 'static) -> Self {
        let range = shape.range();
        Self::laid_out(vec![Piece::new(Box::new(shape), range)], Vec::new())
    }

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// Pieces and joints in the order of the parameter; never empty.
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// Index of the stretch that holds `t`: the later one at a boundary, the first or last one beyond the range.
    pub fn stretch_at(&self, t: f64) -> usize {
        self.stretches.partition_point(|stretch| stretch.range.to <= t).min(self.stretches.len() - 1)
    }

    /// The frame of one stretch (index of [`stretches`](Self::stretches); too large a one means the last) at the
    /// composite's parameter `t`, continued smoothly beyond the stretch's range.
    pub fn frame_on(&self, stretch: usize, t: f64) -> Frame {
        self.part(stretch).frame(t)
    }

    /// The closest point of one stretch alone, by the composite's parameter.
    ///
    /// For a joint: the vertex, and the tangent whose normal passes through the point; `interior` is true where there is
    /// one, that is, where the point lies between the outward normals of a corner or the inward normals of a notch.
    pub fn closest_on(&self, stretch: usize, x: f64, y: f64) -> Closest {
        let range = self.stretches[stretch.min(self.stretches.len() - 1)].range;
        self.part(stretch).closest_in(range, x, y)
    }

    /// Index of the piece and its own parameter at the composite's parameter `t` on one stretch; none on a joint.
    pub fn local(&self, stretch: usize, t: f64) -> Option<(usize, f64)> {
        match self.stretches.get(stretch)?.kind {
            StretchKind::Piece(piece) => Some((piece, t - self.pieces[piece].offset)),
            StretchKind::Corner { .. } | StretchKind::Notch { .. } => None,
        }
    }

    /// The range of one stretch in its own parameter, free of the rounding that an offset brings: that of the piece's shape,
    /// or the angle turned at a joint, from 0.
    pub fn own_range(&self, stretch: usize) -> Range {
        match self.part(stretch) {
            Part::Piece(piece) => piece.range,
            Part::Joint(joint) => Range { from: 0.0, to: joint.range().length() },
        }
    }

    /// [`frame_on`](Self::frame_on) by the stretch's own parameter.
    pub fn own_frame(&self, stretch: usize, u: f64) -> Frame {
        match self.part(stretch) {
            Part::Piece(piece) => piece.own_frame(u),
            Part::Joint(joint) => joint.frame(joint.range().from + u),
        }
    }

    /// [`closest_on`](Self::closest_on) by the stretch's own parameter.
    pub fn own_closest(&self, stretch: usize, x: f64, y: f64) -> Closest {
        match self.part(stretch) {
            Part::Piece(piece) => piece.own_closest(x, y),
            Part::Joint(joint) => {
                let closest = joint.closest_in(joint.range(), x, y);
                Closest { t: closest.t - joint.range().from, ..closest }
            }
        }
    }

    fn assembled(pieces: Vec<Piece>) -> Result<Self, ContourError> {
        let (pieces, joints) = assembly::placed(pieces)?;
        Ok(Self::laid_out(pieces, joints))
    }

    /// Lists the stretches of placed pieces and builds their tree.
    fn laid_out(pieces: Vec<Piece>, joints: Vec<Option<Joint>>) -> Self {
        let mut stretches = Vec::with_capacity(pieces.len() + joints.len());
        let mut boxes = Vec::with_capacity(stretches.capacity());
        let mut from = None;
        for (index, piece) in pieces.iter().enumerate() {
            let own = piece.range.shifted(piece.offset);
            stretches.push(Stretch {
                kind: StretchKind::Piece(index),
                // Neighbours share their boundary to the last bit.
                range: Range { from: from.unwrap_or(own.from), to: own.to },
            });
            boxes.push(piece.bounds());
            from = Some(own.to);
            if let Some(joint) = joints.get(index).copied().flatten() {
                let vertex = joint.frame(own.to);
                stretches.push(Stretch {
                    kind: if vertex.turning > 0.0 {
                        StretchKind::Corner { before: index }
                    } else {
                        StretchKind::Notch { before: index }
                    },
                    range: joint.range(),
                });
                boxes.push(Bounds::EMPTY.with(vertex.x, vertex.y));
                from = Some(joint.range().to);
            }
        }
        Self { pieces, joints, stretches, tree: Tree::new(boxes.into_iter()) }
    }

    /// The closest point of one stretch as a candidate for the whole: none at the end of a piece where a joint begins,
    /// since the joint knows the sign of the gap there and the piece does not.
    fn candidate(&self, stretch: usize, range: Range, x: f64, y: f64) -> Option<Closest> {
        let own = self.stretches[stretch];
        let part = own.range.within(range);
        let mut closest = self.part(stretch).closest_in(part, x, y);
        if !closest.interior {
            let at_start = closest.t - part.from < part.to - closest.t;
            let goes_on = if at_start { part.from > range.from } else { part.to < range.to };
            let neighbour = if at_start { stretch.checked_sub(1) } else { Some(stretch + 1) };
            if let Some(neighbour) = neighbour.filter(|_| goes_on)
                && let Some(neighbour) = self.stretches.get(neighbour)
            {
                if neighbour.is_joint() && !own.is_joint() {
                    return None;
                }
                closest.interior = true;
            }
        }
        Some(closest)
    }

    /// What a stretch consists of.
    fn part(&self, stretch: usize) -> Part<'_> {
        let stretch = self.stretches[stretch.min(self.stretches.len() - 1)];
        match stretch.kind {
            StretchKind::Piece(index) => Part::Piece(&self.pieces[index]),
            StretchKind::Corner { before } | StretchKind::Notch { before } => match &self.joints[before] {
                Some(joint) => Part::Joint(joint),
                None => Part::Piece(&self.pieces[before]),
            },
        }
    }
}

/// A piece or a joint, by the composite's parameter.
enum Part<'a> {
    Piece(&'a Piece),
    Joint(&'a Joint),
}

impl Part<'_> {
    fn frame(&self, t: f64) -> Frame {
        match self {
            Self::Piece(piece) => piece.frame(t),
            Self::Joint(joint) => joint.frame(t),
        }
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        match self {
            Self::Piece(piece) => piece.closest_in(range, x, y),
            Self::Joint(joint) => joint.closest_in(range, x, y),
        }
    }
}

impl Contour for Composite {
    fn frame(&self, t: f64) -> Frame {
        self.frame_on(self.stretch_at(t), t)
    }

    fn range(&self) -> Range {
        Range { from: self.stretches[0].range.from, to: self.stretches[self.stretches.len() - 1].range.to }
    }

    /// The best over the stretches; those whose boxes are too far away are passed over together.
    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let (first, last) = (self.stretch_at(range.from), self.stretch_at(range.to));
        if first == last {
            let only = self.stretches[first].range.within(range);
            return self.part(first).closest_in(only, x, y);
        }
        let mut best: Option<Closest> = None;
        self.tree.visit(x, y, f64::INFINITY, &mut |stretch| {
            if (first..=last).contains(&stretch)
                && let Some(closest) = self.candidate(stretch, range, x, y)
                && best.is_none_or(|best| closest.gap.abs() < best.gap.abs())
            {
                best = Some(closest);
            }
            best.map_or(f64::INFINITY, |best| best.gap.abs())
        });
        // No candidate only where the point is not a number.
        best.unwrap_or_else(|| {
            let part = self.stretches[first].range.within(range);
            self.part(first).closest_in(part, x, y)
        })
    }

    fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let (first, last) = (self.stretch_at(range.from), self.stretch_at(range.to));
        let mut bounds = Bounds::EMPTY;
        for stretch in &self.stretches[first..=last] {
            bounds = match stretch.kind {
                StretchKind::Piece(index) => {
                    let piece = &self.pieces[index];
                    let own = piece.range.within(range.shifted(-piece.offset));
                    bounds.union(piece.shape.bounds_in(own))
                }
                _ => {
                    let vertex = self.frame(stretch.range.from);
                    bounds.with(vertex.x, vertex.y)
                }
            };
        }
        bounds
    }
}
