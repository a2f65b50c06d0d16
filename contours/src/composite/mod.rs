//! Several pieces as one contour.

mod assembly;
mod crossing;
mod joint;
mod piece;
pub(crate) mod polygon;
mod run;
mod self_crossing;
mod stretch;
mod transform;

pub use run::{Bend, Run, RunEnd};
pub use self_crossing::SelfCrossing;
pub use stretch::{Part, Stretch, StretchKind};

use std::sync::Arc;

use crate::contour::{Seal, Trust};
use crate::proof::limits;
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Index, Range};
use joint::{Joint, VertexRate};
use piece::{Piece, unshared_pieces};
use run::StoredRun;

/// Pieces in order, with the solid on the left, as one contour with one parameter.
///
/// The parameter runs through the pieces by their own parameters, each moved by an offset; the first piece keeps its own.
/// Between two pieces whose tangents differ by more than 1e-9 rad stands a joint, a stretch of its own as long as the
/// turn: the point stands still (speed 0) while alpha grows (convex corner, turning +1) or falls (notch, turning -1).
///
/// A clone shares the shapes.
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
#[derive(Clone, Debug)]
pub struct Composite {
    /// Never empty.
    pieces: Arc<Vec<Piece>>,
    /// The stretches in order: twice the piece, and one more for the joint after it.
    order: Vec<u32>,
    /// Turns of a closed contour, 0 for an open one.
    turns: i32,
    /// The pieces cut into simple arcs, in order; empty where no piece is cut.
    cells: Vec<Cell>,
    /// Index of the cells (of the pieces if none is cut), each with the joint after it.
    index: Index,
    /// Neighbouring cells that bend one way, in order, and their boxes.
    runs: Vec<StoredRun>,
    /// None where each cell is a run.
    run_index: Option<Index>,
    /// The boxes of the runs where they are few and the index keeps none.
    run_boxes: Vec<Bounds>,
    proven: bool,
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
    /// more or less than one turn, or a piece that crosses itself ([`ContourError::Crosses`], or [`ContourError::Loops`] where no crossing is found).
    ///
    /// A shape from outside this crate, a [`Graph`](crate::Graph) and a [`Curve`](crate::Curve) are tested at five places;
    /// one that breaks the contract of [`Contour`] there is refused ([`ContourError::Contract`]).
    pub fn new(pieces: Vec<Box<dyn Contour>>) -> Result<Self, ContourError> {
        Self::assemble(assembly::whole_pieces(pieces)?)
    }

    /// Pieces that meet or cross: each is left at its end, where the next one starts there, and else at the first point
    /// where it enters the solid of the next, so that the solid is the union. Pieces may be infinite.
    ///
    /// The crossing is exact to rounding. Unseen are crossings closer together than 1/16 of a cell, of which there are
    /// 256 spread over the piece by [`Range::at`], and crossings more than 1e4 along a piece that is infinite.
    ///
    /// # Errors
    ///
    /// Those of [`Composite::new`]; consecutive pieces that do not cross ([`ContourError::NoCrossing`]); a piece that
    /// its neighbours hide ([`ContourError::Hidden`]).
    pub fn joined(pieces: Vec<Box<dyn Contour>>) -> Result<Self, ContourError> {
        Self::assemble(assembly::crossing_pieces(pieces)?)
    }

    /// One shape as a composite, with its own parameter; closed if its end meets its start after one turn.
    ///
    /// # Errors
    ///
    /// Those of [`Composite::new`].
    pub fn single(shape: impl Contour + 'static) -> Result<Self, ContourError> {
        Self::new(vec![Box::new(shape)])
    }

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// Whether the contour is closed: its end meets its start.
    pub fn is_closed(&self) -> bool {
        self.turns != 0
    }

    /// Whether it is closed and runs clockwise: the border of a cavity, with the solid outside.
    pub fn is_cavity(&self) -> bool {
        self.turns < 0
    }

    /// Pieces and joints in the order of the parameter; at least one.
    pub fn stretches(&self) -> impl ExactSizeIterator<Item = Stretch> {
        (0..self.order.len()).map(|index| self.stretch(index))
    }

    /// One of the [`stretches`](Self::stretches); too large an index means the last.
    pub fn stretch(&self, index: usize) -> Stretch {
        let (piece, joint) = self.piece_of(self.clamp_stretch(index));
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

    /// The kind of one of the [`stretches`](Self::stretches); too large an index means the last.
    pub fn kind(&self, stretch: usize) -> StretchKind {
        let (piece, joint) = self.piece_of(self.clamp_stretch(stretch));
        match self.pieces[piece].turn() {
            _ if !joint => StretchKind::Piece(piece),
            turn if turn > 0.0 => StretchKind::Corner { before: piece },
            _ => StretchKind::Notch { before: piece },
        }
    }

    /// The stretch after or before another one: none beyond the ends of an open contour.
    pub fn neighbour(&self, stretch: usize, after: bool) -> Option<usize> {
        let last = self.order.len() - 1;
        match (after, self.clamp_stretch(stretch)) {
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
        match self.piece_or_joint(stretch) {
            PieceOrJoint::Piece(piece) => piece.frame(t),
            PieceOrJoint::Joint(joint) => joint.frame(t - joint.range().from),
        }
    }

    /// The closest point of one stretch alone, by the composite's parameter.
    ///
    /// For a joint: the vertex, and the tangent whose normal passes through the point; `interior` is true where there is
    /// one, that is, where the point lies between the outward normals of a corner or the inward normals of a notch.
    pub fn closest_on(&self, stretch: usize, x: f64, y: f64) -> Closest {
        let closest = self.own_closest_in(stretch, self.own_range(stretch), x, y);
        Closest { t: self.common_parameter(stretch, closest.t), ..closest }
    }

    /// The range of one stretch in its own parameter, free of the rounding that an offset brings: that of the piece's
    /// shape, or the angle turned at a joint, from 0.
    pub fn own_range(&self, stretch: usize) -> Range {
        match self.piece_or_joint(stretch) {
            PieceOrJoint::Piece(piece) => piece.range,
            PieceOrJoint::Joint(joint) => joint.own_range(),
        }
    }

    /// [`frame_on`](Self::frame_on) by the stretch's own parameter.
    pub fn own_frame(&self, stretch: usize, u: f64) -> Frame {
        match self.piece_or_joint(stretch) {
            PieceOrJoint::Piece(piece) => piece.own_frame(u),
            PieceOrJoint::Joint(joint) => joint.frame(u),
        }
    }

    /// The change of [`own_frame`](Self::own_frame) with a [parameter](Contour::frame_rate) of the shape of `piece`, all other
    /// pieces staying as they are; `None` if there is no such piece, or its shape has no such parameter.
    ///
    /// A vertex is the point where the two pieces, continued, cross. At a vertex the frame turns by nothing: its own parameter
    /// is the angle.
    pub fn own_frame_rate(&self, stretch: usize, u: f64, piece: usize, parameter: &str) -> Option<FrameRate> {
        let shape = &self.pieces.get(piece)?.shape;
        let (at, is_joint) = self.piece_of(self.clamp_stretch(stretch));
        if !is_joint {
            let rate = shape.frame_rate(u, parameter)?;
            return Some(if at == piece { rate } else { FrameRate::ZERO });
        }
        let [x, y] = self.vertex_rate(at, piece, parameter)?.point;
        Some(FrameRate { x, y, alpha: 0.0 })
    }

    /// The change of the upper or lower end of [`own_range`](Self::own_range) with a parameter of the shape of `piece`; none as
    /// for [`own_frame_rate`](Self::own_frame_rate), and where the piece has no vertex there.
    pub fn own_border_rate(&self, stretch: usize, upper: bool, piece: usize, parameter: &str) -> Option<f64> {
        let (at, is_joint) = self.piece_of(self.clamp_stretch(stretch));
        if is_joint {
            let [before, after] = self.vertex_rate(at, piece, parameter)?.alphas;
            // The own parameter of a joint begins with 0 at the angle where the piece before it ends.
            return Some(self.pieces[at].turn().signum() * if upper { after } else { before });
        }
        let before = if upper { at } else { self.piece_before(at)? };
        let ends = self.vertex_rate(before, piece, parameter)?.ends;
        Some(if upper { ends[0] } else { ends[1] })
    }

    /// The change of the vertex after the piece `before`.
    fn vertex_rate(&self, before: usize, piece: usize, parameter: &str) -> Option<VertexRate> {
        let pieces = [before, (before + 1) % self.pieces.len()];
        if !self.pieces[before].has_joint() {
            return None;
        }
        let [one, other] = pieces.map(|number| &self.pieces[number]);
        let rate = |number: usize, t: f64| {
            let rate = self.pieces.get(piece)?.shape.frame_rate(t, parameter)?;
            Some(if number == piece { rate } else { FrameRate::ZERO })
        };
        let rates = [rate(pieces[0], one.range.to)?, rate(pieces[1], other.range.from)?];
        Some(VertexRate::new([one.last(), other.first()], rates))
    }

    fn piece_before(&self, piece: usize) -> Option<usize> {
        piece.checked_sub(1).or_else(|| self.is_closed().then(|| self.pieces.len() - 1))
    }

    /// Index of the stretch of this kind; `None` if there is no such piece, or no such joint after it.
    pub fn find(&self, kind: StretchKind) -> Option<usize> {
        let (StretchKind::Piece(index) | StretchKind::Corner { before: index } | StretchKind::Notch { before: index }) =
            kind;
        let piece = self.pieces.get(index)?;
        let stretch = piece.stretch as usize + usize::from(!matches!(kind, StretchKind::Piece(_)));
        (stretch < self.order.len() && self.kind(stretch) == kind).then_some(stretch)
    }

    /// Change of a stretch's own parameter per length of the contour, about its middle and rounded to a power of two; none for
    /// a joint, whose parameter is an angle.
    pub fn own_pace(&self, stretch: usize) -> Option<f64> {
        let (piece, joint) = self.piece_of(self.clamp_stretch(stretch));
        (!joint).then(|| self.pieces[piece].pace)
    }

    /// [`closest_on`](Self::closest_on) for a part of the stretch, by the stretch's own parameter.
    pub fn own_closest_in(&self, stretch: usize, range: Range, x: f64, y: f64) -> Closest {
        match self.piece_or_joint(stretch) {
            PieceOrJoint::Piece(piece) => piece.own_closest_in(range, x, y),
            PieceOrJoint::Joint(joint) => joint.closest_in(range, x, y),
        }
    }

    /// The least and the largest [curvature](Contour::curvature_in) of a part of a stretch, by the stretch's own parameter:
    /// infinity for a corner, minus infinity for a notch.
    pub fn own_curvature_in(&self, stretch: usize, range: Range) -> (f64, f64) {
        match self.piece_or_joint(stretch) {
            PieceOrJoint::Piece(piece) => piece.shape.curvature_in(range),
            PieceOrJoint::Joint(joint) => joint.curvature(),
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

    /// Number of [runs](Run): neighbouring arcs that bend one way. Together they are the whole contour.
    pub fn run_count(&self) -> usize {
        self.runs.len()
    }

    /// One of the runs, in the contour's order; too large a number means the last.
    pub fn run(&self, run: usize) -> Run {
        let stored = &self.runs[run.min(self.runs.len() - 1)];
        let [first, last] = [stored.cells[0], stored.cells[1] - 1].map(|cell| self.cell(cell as usize));
        Run::new(stored, [first, last], self.run_bounds(run))
    }

    fn run_index(&self) -> &Index {
        self.run_index.as_ref().unwrap_or(&self.index)
    }

    /// A box around a run.
    pub fn run_bounds(&self, run: usize) -> Bounds {
        let run = run.min(self.runs.len() - 1);
        self.run_boxes.get(run).copied().or_else(|| self.run_index().bounds(run)).unwrap_or(Bounds::ALL)
    }

    /// Whether it is the border of a convex body: closed, and nowhere bent inwards.
    pub fn is_convex_body(&self) -> bool {
        matches!(self.runs[..], [StoredRun { closed: true, .. }])
    }

    /// Whether bends and closest points of all pieces are proven, not sampled.
    pub fn is_proven(&self) -> bool {
        self.proven
    }

    /// Calls `visit` with the numbers of the runs that meet `bounds`, and perhaps with others near by.
    pub fn runs_near(&self, bounds: Bounds, mut visit: impl FnMut(usize)) {
        if self.bounds.meets(&bounds) {
            self.run_index().meeting(bounds, &mut visit);
        }
    }

    /// The closest point of a run, with the joints inside it; too large a number means the last run.
    pub fn run_closest(&self, run: usize, x: f64, y: f64) -> RunClosest {
        let StoredRun { cells: [first, last], closed, .. } = self.runs[run.min(self.runs.len() - 1)];
        let mut best: Option<RunClosest> = None;
        self.index.nearest_among([first as usize, last as usize], x, y, &mut |cell| {
            let [arc, joint] = self.parts_of(cell);
            let joint = joint.filter(|_| closed || cell + 1 < last as usize);
            for (part, is_joint) in [(arc, false), (joint, true)] {
                let Some(Part { stretch, range }) = part else { continue };
                let closest = self.own_closest_in(stretch, range, x, y);
                let better = best.is_none_or(|best| {
                    let (new, old) = (closest.gap.abs(), best.closest.gap.abs());
                    // a vertex is the end of an arc too, which does not tell the side there
                    new < old || (is_joint && closest.interior && new <= old)
                });
                if better && (!is_joint || closest.interior) {
                    let upper = closest.t - range.from > range.to - closest.t;
                    let at_end = match (closed || closest.interior, upper) {
                        (false, false) if cell == first as usize => Some(0),
                        (false, true) if cell + 1 == last as usize => Some(1),
                        _ => None,
                    };
                    // between two of its arcs rounding decides which one it is on
                    let closest = Closest { interior: at_end.is_none(), ..closest };
                    best = Some(RunClosest { stretch, closest, end: at_end, joint: is_joint });
                }
            }
            best.map_or(f64::INFINITY, |best| best.closest.gap.abs())
        });
        // none only where the point is not a number
        best.unwrap_or_else(|| {
            let stretch = self.stretch_at(self.range().from);
            RunClosest { stretch, closest: self.closest_on(stretch, x, y), end: None, joint: false }
        })
    }

    /// Whether a stretch, at its own parameter `t`, is part of a run.
    pub fn run_holds(&self, run: usize, stretch: usize, t: f64) -> bool {
        let StoredRun { cells: [first, last], closed, .. } = self.runs[run.min(self.runs.len() - 1)];
        let (piece, is_joint) = self.piece_of(self.clamp_stretch(stretch));
        let cell = if self.cells.is_empty() {
            piece
        } else {
            let of_piece = |cell: &Cell| cell.piece as usize == piece;
            let first = self.cells.partition_point(|cell| (cell.piece as usize) < piece);
            let own = &self.cells[first..];
            let last = own.partition_point(of_piece).saturating_sub(1);
            let within = own.partition_point(|cell| of_piece(cell) && cell.range.to < t);
            first + if is_joint { last } else { within.min(last) }
        };
        let last = last as usize - usize::from(is_joint && !closed);
        (first as usize..last).contains(&cell)
    }

    /// The run that is nearest to a point.
    pub fn run_at(&self, x: f64, y: f64) -> usize {
        let (mut best, mut at) = (f64::INFINITY, 0);
        self.run_index().nearest(x, y, &mut |run| {
            let closest = self.run_closest(run, x, y).closest;
            if closest.gap.abs() < best {
                (best, at) = (closest.gap.abs(), run);
            }
            best
        });
        at
    }

    /// The arcs of a run, without the joints between them.
    pub fn run_arcs(&self, run: usize) -> impl Iterator<Item = Part> {
        let StoredRun { cells: [first, last], .. } = self.runs[run.min(self.runs.len() - 1)];
        (first as usize..last as usize).filter_map(|cell| self.parts_of(cell)[0])
    }

    fn assemble(mut pieces: Vec<Piece>) -> Result<Self, ContourError> {
        match assembly::place_pieces(&mut pieces) {
            Ok(turns) => {
                let contour = Self::from_placed_pieces(pieces, turns);
                contour.crossing_of_a_piece().map_or(Ok(contour), |crossing| Err(crossing.into()))
            }
            // Where it crosses itself is easier to mend than how often it turns.
            Err(error @ ContourError::Loops { .. }) => {
                Err(Self::from_placed_pieces(pieces, 0).without_self_crossing().err().unwrap_or(error))
            }
            Err(error) => Err(error),
        }
    }

    /// The contour itself, unless it crosses itself: then [`ContourError::Crosses`].
    pub(crate) fn without_self_crossing(self) -> Result<Self, ContourError> {
        match self.self_crossing() {
            None => Ok(self),
            Some(crossing) => Err(crossing.into()),
        }
    }

    /// For each piece, whether its shape may cross itself: false only where the way in which it was made excludes that.
    pub(crate) fn may_cross_themselves(&self) -> impl Iterator<Item = bool> {
        self.pieces.iter().map(|piece| !piece.shape.trust(Seal(())).simple)
    }

    /// The pieces in order, and the turns of a closed contour (0 for an open one).
    pub(crate) fn into_placed_pieces(self) -> (Vec<Piece>, i32) {
        (unshared_pieces(self.pieces), self.turns)
    }

    /// The contour of pieces that are in their places: lists their stretches, cuts them into cells and groups these into runs.
    pub(crate) fn from_placed_pieces(mut pieces: Vec<Piece>, turns: i32) -> Self {
        let mut order = Vec::with_capacity(pieces.iter().map(|piece| 1 + usize::from(piece.has_joint())).sum());
        for (index, piece) in pieces.iter_mut().enumerate() {
            piece.set_pace();
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
        let arcs = cells.iter().map(|Cell { piece, range }| {
            let piece = &pieces[*piece as usize];
            let joint = if range.to == piece.range.to { piece.turn() } else { 0.0 };
            run::Arc { piece, range: *range, joint }
        });
        let runs = run::group_into_runs(arcs, turns);
        let boxes = runs.iter().map(|run| {
            let arcs = &cells[run.cells[0] as usize..run.cells[1] as usize];
            let boxes = arcs.iter().map(|cell| pieces[cell.piece as usize].bounds_in(cell.range));
            boxes.fold(Bounds::EMPTY, |all, bounds| all.union(bounds))
        });
        let run_index = (runs.len() < cells.len()).then(|| Index::new(boxes.clone()));
        let few_runs = run_index.as_ref().unwrap_or(&index).is_small();
        let run_boxes = if few_runs { boxes.collect() } else { Vec::new() };
        let proven = runs.iter().all(|run| run.proven);
        if cells.len() == pieces.len() {
            cells = Vec::new();
        }
        cells.shrink_to_fit();
        pieces.shrink_to_fit();
        let pieces = Arc::new(pieces);
        Self { pieces, order, turns, cells, index, runs, run_index, run_boxes, proven, bounds }
    }

    fn clamp_stretch(&self, stretch: usize) -> usize {
        stretch.min(self.order.len() - 1)
    }

    /// The piece of a stretch, and whether the stretch is the joint after it.
    fn piece_of(&self, stretch: usize) -> (usize, bool) {
        let place = self.order[stretch];
        ((place / 2) as usize, place % 2 == 1)
    }

    fn piece_or_joint(&self, stretch: usize) -> PieceOrJoint<'_> {
        let (piece, joint) = self.piece_of(self.clamp_stretch(stretch));
        let piece = &self.pieces[piece];
        if joint { PieceOrJoint::Joint(piece.joint()) } else { PieceOrJoint::Piece(piece) }
    }

    /// The composite's parameter from the stretch's own.
    pub(crate) fn common_parameter(&self, stretch: usize, t: f64) -> f64 {
        let range = self.stretch(stretch).range;
        // Rounding of the offset must not move the point out of the range.
        match self.piece_or_joint(stretch) {
            PieceOrJoint::Piece(piece) => range.clamp(t + piece.offset),
            PieceOrJoint::Joint(_) => range.clamp(t + range.from),
        }
    }

    /// The stretch's own parameter from the composite's.
    fn own_parameter(&self, stretch: usize, t: f64) -> f64 {
        match self.piece_or_joint(stretch) {
            PieceOrJoint::Piece(piece) => t - piece.offset,
            PieceOrJoint::Joint(joint) => t - joint.range().from,
        }
    }

    /// The piece of a cell, and the part of it.
    fn cell(&self, cell: usize) -> (&Piece, Range) {
        match self.cells.get(cell) {
            Some(cell) => (&self.pieces[cell.piece as usize], cell.range),
            None => (&self.pieces[cell], self.pieces[cell].range),
        }
    }

    /// The parts of a cell: the arc, and the joint after it.
    fn parts_of(&self, cell: usize) -> [Option<Part>; 2] {
        let (piece, range) = self.cell(cell);
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
            from: if range.from <= common.from { all.from } else { self.own_parameter(stretch, range.from) },
            to: if range.to >= common.to { all.to } else { self.own_parameter(stretch, range.to) },
        };
        let part = own.within(asked);
        if part.from > part.to || asked.from > own.to || asked.to < own.from {
            return None;
        }
        let closest = self.own_closest_in(stretch, part, x, y);
        let mut closest = Closest { t: range.clamp(self.common_parameter(stretch, closest.t)), ..closest };
        if !closest.interior && self.continues_smoothly(stretch, part, own, range, closest.t)? {
            closest.interior = true;
        }
        Some(closest)
    }

    /// Whether the contour within `range` goes on smoothly beyond the end `t` of a part; `None` if a joint goes on.
    fn continues_smoothly(&self, stretch: usize, part: Range, own: Range, range: Range, t: f64) -> Option<bool> {
        let (common, all) = (self.stretch(stretch).range, self.own_range(stretch));
        let at_start = t - self.common_parameter(stretch, part.from) < self.common_parameter(stretch, part.to) - t;
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
            Some(neighbour) if self.piece_of(neighbour).1 && !self.piece_of(stretch).1 => None,
            neighbour => Some(neighbour.is_some()),
        }
    }
}

/// The point of a [`Run`] that is nearest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunClosest {
    /// Its stretch.
    pub stretch: usize,
    /// The point, by the stretch's own parameter.
    pub closest: Closest,
    /// Which end of the run it is, where it is one: 0 the first, 1 the last.
    pub end: Option<usize>,
    /// Whether it is on a joint inside the run.
    pub joint: bool,
}

/// A piece or a joint.
enum PieceOrJoint<'a> {
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
        // No candidate only where the point is not a number, or rounding of the offset leaves nothing of a range without length.
        best.unwrap_or_else(|| {
            let t = range.window(1.0).from;
            let stretch = self.stretch_at(t);
            let own = self.own_range(stretch).clamp(self.own_parameter(stretch, t));
            let closest = self.own_closest_in(stretch, Range { from: own, to: own }, x, y);
            Closest { t: range.clamp(t), ..closest }
        })
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        let (first, last) = (self.stretch_at(range.from), self.stretch_at(range.to));
        let mut bounds = Bounds::EMPTY;
        for stretch in first..=last {
            bounds = match self.piece_or_joint(stretch) {
                PieceOrJoint::Piece(piece) => {
                    bounds.union(piece.bounds_in(piece.range.within(range.shifted(-piece.offset))))
                }
                PieceOrJoint::Joint(joint) => bounds.union(joint.bounds()),
            };
        }
        bounds
    }

    /// None: a composite within another one looks for its parts itself.
    fn cuts(&self, _: Range) -> Vec<f64> {
        Vec::new()
    }

    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let (first, last) = (self.stretch_at(range.from), self.stretch_at(range.to));
        (first..=last).fold(limits::NO_CURVATURE, |bounds, stretch| {
            let of_stretch = match self.piece_or_joint(stretch) {
                PieceOrJoint::Piece(piece) => {
                    piece.shape.curvature_in(piece.range.within(range.shifted(-piece.offset)))
                }
                PieceOrJoint::Joint(joint) => joint.curvature(),
            };
            limits::curvature_union(bounds, of_stretch)
        })
    }

    /// If those of all pieces are.
    fn closest_is_exact(&self) -> bool {
        self.pieces.iter().all(|piece| piece.shape.closest_is_exact())
    }

    fn trust(&self, _: Seal) -> Trust {
        // Its pieces were tested when it was made.
        Trust::SIMPLE
    }
}

impl AsRef<[Composite]> for Composite {
    /// A scene with this object alone.
    fn as_ref(&self) -> &[Composite] {
        std::slice::from_ref(self)
    }
}
