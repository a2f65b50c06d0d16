//! Several pieces as one contour.

use crate::assembly;
use crate::index::Index;
use crate::joint::Joint;
use crate::piece::Piece;
use crate::{Bounds, Closest, Contour, ContourError, Frame, Part, Range, SelfCrossing, Stretch, StretchKind};

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
/// assert_eq!(wedge.stretch(1).kind, StretchKind::Corner { before: 0 });
///
/// let below = wedge.closest(0.0, 0.25);
/// assert_eq!((below.gap, below.interior), (0.75, true));
/// assert_eq!(below.frame.speed, 0.0);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Debug)]
pub struct Composite {
    /// Never empty.
    pieces: Vec<Piece>,
    /// The stretches in order: twice the piece, and one more for the joint after it.
    order: Vec<u32>,
    /// Turns of a closed contour, 0 for an open one.
    turns: i32,
    /// The pieces cut into simple arcs, in order; empty where no piece is cut.
    cells: Vec<Cell>,
    /// Of the cells (of the pieces, where none is cut), each with the joint after it.
    index: Index,
    bounds: Bounds,
}

/// A simple arc of a piece, in its own parameter.
#[derive(Clone, Copy, Debug)]
struct Cell {
    piece: u32,
    range: Range,
}

impl Composite {
    /// Pieces whose ends meet, to 1e-9 of the largest coordinate at their ends and in their middle.
    ///
    /// # Errors
    ///
    /// Without pieces ([`ContourError::Empty`]), with a range upside down ([`ContourError::PieceRange`]), an inner end at
    /// infinity ([`ContourError::NoEnd`]), ends that do not meet ([`ContourError::Apart`]) or a closed contour that takes
    /// more or less than one turn ([`ContourError::Crosses`], or [`ContourError::Loops`] where no crossing is found).
    pub fn new(pieces: Vec<Box<dyn Contour>>) -> Result<Self, ContourError> {
        Self::assembled(assembly::whole(pieces))
    }

    /// Pieces that meet or cross: each is left at its end, where the next one starts there, and else at the first point
    /// where it enters the solid of the next, so that the solid is the union. Pieces may go on for ever.
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

    /// One shape as a composite, with its own parameter; closed if its end meets its start after one turn.
    pub fn single(shape: impl Contour + 'static) -> Self {
        let mut pieces = assembly::whole(vec![Box::new(shape)]);
        let turns = assembly::placed(&mut pieces).unwrap_or(0);
        Self::laid_out(pieces, turns)
    }

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// Whether the end meets the start, so that the contour goes round.
    pub fn is_closed(&self) -> bool {
        self.turns != 0
    }

    /// Whether it goes round clockwise: the border of a cavity, with the solid outside.
    pub fn is_cavity(&self) -> bool {
        self.turns < 0
    }

    /// Pieces and joints in the order of the parameter; at least one.
    pub fn stretches(&self) -> impl ExactSizeIterator<Item = Stretch> {
        (0..self.order.len()).map(|index| self.stretch(index))
    }

    /// One of the [`stretches`](Self::stretches); too large an index means the last.
    pub fn stretch(&self, index: usize) -> Stretch {
        let (piece, joint) = self.place(self.known(index));
        let at = &self.pieces[piece];
        let range = if joint {
            at.joint().range()
        } else {
            // Neighbours share their boundary to the last bit.
            let from = if piece > 0 { self.pieces[piece - 1].after() } else { at.range.from + at.offset };
            Range { from, to: at.to() }
        };
        Stretch { kind: self.kind(index), range }
    }

    /// What one of the [`stretches`](Self::stretches) is; too large an index means the last.
    pub fn kind(&self, stretch: usize) -> StretchKind {
        let (piece, joint) = self.place(self.known(stretch));
        match self.pieces[piece].turn() {
            _ if !joint => StretchKind::Piece(piece),
            turn if turn > 0.0 => StretchKind::Corner { before: piece },
            _ => StretchKind::Notch { before: piece },
        }
    }

    /// The stretch after or before another one: none beyond the ends of an open contour.
    pub fn neighbour(&self, stretch: usize, after: bool) -> Option<usize> {
        let last = self.order.len() - 1;
        match (after, self.known(stretch)) {
            (true, stretch) if stretch == last => self.is_closed().then_some(0),
            (true, stretch) => Some(stretch + 1),
            (false, 0) => self.is_closed().then_some(last),
            (false, stretch) => Some(stretch - 1),
        }
    }

    /// Index of the stretch that holds `t`: the later one at a boundary, the first or last one beyond the range.
    pub fn stretch_at(&self, t: f64) -> usize {
        let piece = self.pieces.partition_point(|piece| piece.after() <= t).min(self.pieces.len() - 1);
        let at = &self.pieces[piece];
        at.stretch as usize + usize::from(at.has_joint() && at.to() <= t)
    }

    /// The frame of one stretch (index of [`stretches`](Self::stretches); too large a one means the last) at the
    /// composite's parameter `t`, continued smoothly beyond the stretch's range.
    pub fn frame_on(&self, stretch: usize, t: f64) -> Frame {
        match self.at(stretch) {
            At::Piece(piece) => piece.frame(t),
            At::Joint(joint) => joint.frame(t),
        }
    }

    /// The closest point of one stretch alone, by the composite's parameter.
    ///
    /// For a joint: the vertex, and the tangent whose normal passes through the point; `interior` is true where there is
    /// one, that is, where the point lies between the outward normals of a corner or the inward normals of a notch.
    pub fn closest_on(&self, stretch: usize, x: f64, y: f64) -> Closest {
        let closest = self.own_closest_in(stretch, self.own_range(stretch), x, y);
        Closest { t: self.common(stretch, closest.t), ..closest }
    }

    /// Index of the piece and its own parameter at the composite's parameter `t` on one stretch; none on a joint.
    pub fn local(&self, stretch: usize, t: f64) -> Option<(usize, f64)> {
        if stretch >= self.order.len() {
            return None;
        }
        let (piece, joint) = self.place(stretch);
        (!joint).then(|| (piece, t - self.pieces[piece].offset))
    }

    /// The range of one stretch in its own parameter, free of the rounding that an offset brings: that of the piece's
    /// shape, or the angle turned at a joint, from 0.
    pub fn own_range(&self, stretch: usize) -> Range {
        match self.at(stretch) {
            At::Piece(piece) => piece.range,
            At::Joint(joint) => joint.own_range(),
        }
    }

    /// [`frame_on`](Self::frame_on) by the stretch's own parameter.
    pub fn own_frame(&self, stretch: usize, u: f64) -> Frame {
        match self.at(stretch) {
            At::Piece(piece) => piece.own_frame(u),
            At::Joint(joint) => joint.frame(joint.range().from + u),
        }
    }

    /// [`closest_on`](Self::closest_on) for a part of the stretch, by the stretch's own parameter.
    pub fn own_closest_in(&self, stretch: usize, range: Range, x: f64, y: f64) -> Closest {
        match self.at(stretch) {
            At::Piece(piece) => piece.own_closest_in(range, x, y),
            At::Joint(joint) => {
                let from = joint.range().from;
                let closest = joint.closest_in(range.shifted(from), x, y);
                Closest { t: range.clamp(closest.t - from), ..closest }
            }
        }
    }

    /// Whether a part of a stretch, by the stretch's own parameter, [is convex](Contour::is_convex).
    pub fn own_is_convex(&self, stretch: usize, range: Range) -> bool {
        match self.at(stretch) {
            At::Piece(piece) => piece.shape.is_convex(range),
            At::Joint(_) => true,
        }
    }

    /// A box that contains a part of a stretch, by the stretch's own parameter.
    pub fn own_bounds_in(&self, stretch: usize, range: Range) -> Bounds {
        match self.at(stretch) {
            At::Piece(piece) => piece.bounds_in(range),
            At::Joint(joint) => joint.bounds(),
        }
    }

    /// All parts of all stretches, in order.
    pub fn parts(&self) -> impl Iterator<Item = Part> {
        let cells = if self.cells.is_empty() { self.pieces.len() } else { self.cells.len() };
        (0..cells).flat_map(|cell| self.parts_of(cell)).flatten()
    }

    /// Whether there are so few parts that [`parts_near`](Self::parts_near) gives all of them.
    pub fn is_small(&self) -> bool {
        self.index.is_small()
    }

    /// Calls `visit` with all parts that meet `bounds`, and perhaps with others near by; the cost grows with their number,
    /// not with that of all.
    pub fn parts_near(&self, bounds: Bounds, mut visit: impl FnMut(Part)) {
        if self.bounds.meets(&bounds) {
            self.index.meeting(bounds, &mut |cell| self.parts_of(cell).into_iter().flatten().for_each(&mut visit));
        }
    }

    fn assembled(mut pieces: Vec<Piece>) -> Result<Self, ContourError> {
        match assembly::placed(&mut pieces) {
            Ok(turns) => Ok(Self::laid_out(pieces, turns)),
            // Where it crosses itself is easier to mend than how often it turns.
            Err(error @ ContourError::Loops { .. }) => Err(Self::laid_out(pieces, 0).simple().err().unwrap_or(error)),
            Err(error) => Err(error),
        }
    }

    /// The contour itself, unless it crosses itself: then [`ContourError::Crosses`].
    pub(crate) fn simple(self) -> Result<Self, ContourError> {
        match self.self_crossing() {
            None => Ok(self),
            Some(SelfCrossing { pieces: [first, second], point: [x, y], .. }) => {
                Err(ContourError::Crosses { what: "piece", first: first + 1, second: second + 1, x, y })
            }
        }
    }

    /// The pieces in order, and the turns of a closed contour (0 for an open one).
    pub(crate) fn taken_apart(self) -> (Vec<Piece>, i32) {
        (self.pieces, self.turns)
    }

    /// Lists the stretches of placed pieces and cuts them into cells.
    pub(crate) fn laid_out(mut pieces: Vec<Piece>, turns: i32) -> Self {
        let mut order = Vec::with_capacity(pieces.iter().map(|piece| 1 + usize::from(piece.has_joint())).sum());
        for (index, piece) in pieces.iter_mut().enumerate() {
            piece.stretch = order.len() as u32;
            order.push(2 * index as u32);
            if piece.has_joint() {
                order.push(2 * index as u32 + 1);
            }
        }
        let mut cells = Vec::new();
        for (index, piece) in pieces.iter().enumerate() {
            let mut from = piece.range.from;
            for to in piece.shape.cuts(piece.range).into_iter().chain([piece.range.to]) {
                cells.push(Cell { piece: index as u32, range: Range { from, to } });
                from = to;
            }
        }
        let boxes = cells.iter().map(|cell| pieces[cell.piece as usize].bounds_in(cell.range));
        let bounds = boxes.clone().fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
        let index = Index::new(boxes);
        if cells.len() == pieces.len() {
            cells = Vec::new();
        }
        cells.shrink_to_fit();
        pieces.shrink_to_fit();
        Self { pieces, order, turns, cells, index, bounds }
    }

    fn known(&self, stretch: usize) -> usize {
        stretch.min(self.order.len() - 1)
    }

    /// The piece of a stretch, and whether the stretch is the joint after it.
    fn place(&self, stretch: usize) -> (usize, bool) {
        let place = self.order[stretch];
        ((place / 2) as usize, place % 2 == 1)
    }

    fn at(&self, stretch: usize) -> At<'_> {
        let (piece, joint) = self.place(self.known(stretch));
        let piece = &self.pieces[piece];
        if joint { At::Joint(piece.joint()) } else { At::Piece(piece) }
    }

    /// The composite's parameter from the stretch's own.
    pub(crate) fn common(&self, stretch: usize, t: f64) -> f64 {
        let range = self.stretch(stretch).range;
        // Rounding of the offset must not move the point out of the range.
        match self.at(stretch) {
            At::Piece(piece) => range.clamp(t + piece.offset),
            At::Joint(_) => range.clamp(t + range.from),
        }
    }

    /// The parts of a cell: the arc, and the joint after it.
    fn parts_of(&self, cell: usize) -> [Option<Part>; 2] {
        let (index, range) = match self.cells.get(cell) {
            Some(cell) => (cell.piece as usize, cell.range),
            None => (cell, self.pieces[cell].range),
        };
        let piece = &self.pieces[index];
        let stretch = piece.stretch as usize;
        let joint = piece.has_joint() && range.to == piece.range.to;
        [Some(Part { stretch, range }), joint.then(|| Part { stretch: stretch + 1, range: piece.joint().own_range() })]
    }

    /// The closest point of a part as a candidate for the whole of `range` (the composite's parameter), itself by the
    /// composite's parameter. None where the part has nothing of the range, and none at the end of a piece where a joint
    /// begins, since the joint knows the sign of the gap there and the piece does not.
    fn candidate(&self, part: Part, range: Range, x: f64, y: f64) -> Option<Closest> {
        let Part { stretch, range: own } = part;
        let (common, all) = (self.stretch(stretch).range, self.own_range(stretch));
        // Where the range takes all of the stretch nothing is lost to the offset.
        let asked = Range {
            from: if range.from <= common.from { all.from } else { all.from + (range.from - common.from) },
            to: if range.to >= common.to { all.to } else { all.to - (common.to - range.to) },
        };
        let part = own.within(asked);
        if part.from > part.to || asked.from > own.to || asked.to < own.from {
            return None;
        }
        let closest = self.own_closest_in(stretch, part, x, y);
        let mut closest = Closest { t: self.common(stretch, closest.t), ..closest };
        if !closest.interior && self.goes_on(stretch, part, own, range, closest.t)? {
            closest.interior = true;
        }
        Some(closest)
    }

    /// Whether the contour within `range` goes on smoothly beyond the end `t` of a part; none where a joint goes on.
    fn goes_on(&self, stretch: usize, part: Range, own: Range, range: Range, t: f64) -> Option<bool> {
        let (common, all) = (self.stretch(stretch).range, self.own_range(stretch));
        let at_start = t - self.common(stretch, part.from) < self.common(stretch, part.to) - t;
        let (end, own_end, all_end) =
            if at_start { (part.from, own.from, all.from) } else { (part.to, own.to, all.to) };
        if end != own_end {
            // The range ends here.
            return Some(false);
        }
        if own_end != all_end {
            return Some(true);
        }
        let whole = self.range();
        let inside = if at_start { common.from > range.from } else { common.to < range.to };
        let seam = self.is_closed() && range.from <= whole.from && range.to >= whole.to;
        match self.neighbour(stretch, !at_start).filter(|_| inside || seam) {
            Some(neighbour) if self.place(neighbour).1 && !self.place(stretch).1 => None,
            neighbour => Some(neighbour.is_some()),
        }
    }
}

/// A piece or a joint.
enum At<'a> {
    Piece(&'a Piece),
    Joint(Joint),
}

impl Contour for Composite {
    fn frame(&self, t: f64) -> Frame {
        self.frame_on(self.stretch_at(t), t)
    }

    fn range(&self) -> Range {
        Range { from: self.stretch(0).range.from, to: self.stretch(self.order.len() - 1).range.to }
    }

    /// The best over the parts; those whose boxes are too far away are passed over together.
    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let mut best: Option<Closest> = None;
        self.index.nearest(x, y, &mut |cell| {
            for part in self.parts_of(cell).into_iter().flatten() {
                if let Some(closest) = self.candidate(part, range, x, y)
                    && best.is_none_or(|best| closest.gap.abs() < best.gap.abs())
                {
                    best = Some(closest);
                }
            }
            best.map_or(f64::INFINITY, |best| best.gap.abs())
        });
        // No candidate only where the point is not a number.
        best.unwrap_or_else(|| self.closest_on(self.stretch_at(range.from), x, y))
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let (first, last) = (self.stretch_at(range.from), self.stretch_at(range.to));
        let mut bounds = Bounds::EMPTY;
        for stretch in first..=last {
            bounds = match self.at(stretch) {
                At::Piece(piece) => bounds.union(piece.bounds_in(piece.range.within(range.shifted(-piece.offset)))),
                At::Joint(joint) => bounds.union(joint.bounds()),
            };
        }
        bounds
    }

    /// None: a composite within another one looks for its parts itself.
    fn cuts(&self, _: Range) -> Vec<f64> {
        Vec::new()
    }
}

impl AsRef<[Composite]> for Composite {
    /// A scene with this object alone.
    fn as_ref(&self) -> &[Composite] {
        std::slice::from_ref(self)
    }
}
