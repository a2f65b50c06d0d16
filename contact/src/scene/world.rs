//! The objects as the rod sees them: in lengths of the rod.

use crate::error::ContactError;
use crate::friction::law::{Coefficients, Friction};
use rod_contours::{
    Bounds, Closest, Composite, Contour, Frame, FrameRate, Index, Part, Range, Run, RunClosest, RunEnd, StretchKind,
};
use rod_core::{Support, SupportRate};
use smallvec::SmallVec;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Depth (L) to which there is solid behind an open contour. A step of the sweep moves no point of the rod as far; a rod that is
/// deeper came around the end of the contour.
const SKIN: f64 = 0.1;

/// Arc length of the contour that can face a part of the rod, over the length of that part.
pub(crate) const AHEAD: f64 = 1.25;

/// How far a contour that bends outwards is followed first, over the way on which it turns as much as the rod if it goes on turning
/// as it does; and how often twice as far.
const TURNED: f64 = 1.5;
const LOOKS_AHEAD: usize = 4;

/// Intervals in which the curvature of a part is sampled, for shapes without bounds of it. Such states are not proven.
const SAMPLES: u32 = 8;

/// Contours in dimensionless lengths, their stretches numbered through. Each stretch keeps a parameter of its own (that
/// of its shape over the rod's length, or the angle turned at a joint), so that nothing is lost to an offset, however
/// small the rod is.
#[derive(Clone, Debug)]
pub(crate) struct World<'a> {
    objects: &'a [Composite],
    /// The objects by their bounds.
    index: Index,
    /// Number of each object's first stretch.
    first: SmallVec<[usize; 4]>,
    /// Number of each object's first run, and the number of all.
    first_run: SmallVec<[usize; 5]>,
    ends: SmallVec<[(f64, f64); 2]>,
    /// Depth to which there is solid behind an open contour.
    skin: f64,
    /// Length of the rod in the contours' unit.
    length: f64,
    /// Coefficients of friction by stretch, if there is any.
    friction: Option<Arc<[Coefficients]>>,
    /// The coefficient with which all contacts slide one way along the rod; 0 without.
    sliding: f64,
    /// Whether any object is a closed curve in one piece that is smooth where it closes.
    has_loops: bool,
}

/// The point of one part of the contour that is closest to a given point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    pub t: f64,
    pub gap: f64,
    pub alpha: f64,
    pub x: f64,
    pub y: f64,
    /// Whether the foot is a perpendicular one, not an end of the part.
    pub interior: bool,
}

/// Gap (L) above which the difference of point and foot gives the normal: it has lost three digits there. Below, the frame
/// gives it.
const DISTANT: f64 = 1e-3;

impl Foot {
    /// The direction in which the gap of the point `(x, y)`, whose foot this is, grows: the outward normal, or away from an end
    /// of the part. Where the foot is not too near, the way from there gives the normal, which takes no sine.
    pub fn uphill(&self, x: f64, y: f64) -> (f64, f64) {
        if self.interior && self.gap.abs() < DISTANT {
            return self.normal();
        }
        let (dx, dy) = (x - self.x, y - self.y);
        let distance = if self.interior { self.gap } else { dx.hypot(dy).max(f64::MIN_POSITIVE) };
        (dx / distance, dy / distance)
    }

    /// The outward normal of the contour.
    pub fn normal(&self) -> (f64, f64) {
        normal(self.alpha)
    }
}

/// The outward normal of a contour whose tangent angle is `alpha`.
fn normal(alpha: f64) -> (f64, f64) {
    let (sin, cos) = alpha.sin_cos();
    (sin, -cos)
}

/// The point of a run that is closest to a given point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RunFoot {
    pub foot: Foot,
    pub stretch: usize,
    /// Which end of the run it is, if it is one.
    pub end: Option<usize>,
    /// Whether it is on a joint inside the run.
    pub joint: bool,
}

impl<'a> World<'a> {
    pub fn new(objects: &'a [Composite], length: f64) -> Self {
        let first = objects.iter().scan(0, |next, object| {
            let first = *next;
            *next += object.stretches().len();
            Some(first)
        });
        let mut first_run: SmallVec<[usize; 5]> = SmallVec::new();
        let mut runs = 0;
        for object in objects {
            first_run.push(runs);
            runs += object.run_count();
        }
        first_run.push(runs);
        let open = objects.iter().filter(|object| !object.is_closed());
        let ends = open.flat_map(|object| {
            let Range { from, to } = object.range();
            [from, to].into_iter().filter(|t| t.is_finite()).map(|t| object.frame(t))
        });
        let ends = ends.map(|end| (end.x / length, end.y / length)).collect();
        let index =
            Index::new(objects.iter().map(|object| if is_bounded(object) { object.bounds() } else { Bounds::ALL }));
        let has_loops = objects.iter().any(|object| object.neighbour(0, true) == Some(0));
        Self {
            objects,
            index,
            first: first.collect(),
            first_run,
            ends,
            skin: SKIN,
            length,
            friction: None,
            sliding: 0.0,
            has_loops,
        }
    }

    /// Gives the objects this friction, which is asked once for each piece.
    pub fn rub(&mut self, friction: &dyn Friction) -> Result<(), ContactError> {
        friction.fits(self.objects.len())?;
        let of = |stretch| friction.coefficients(self.object(stretch), self.piece(stretch));
        let count: usize = self.objects.iter().map(|object| object.stretches().len()).sum();
        let all: Vec<Coefficients> = (0..count).map(of).collect();
        for (stretch, coefficients) in all.iter().enumerate() {
            coefficients.check(self.object(stretch))?;
        }
        self.friction = Some(all.into());
        Ok(())
    }

    /// Lets all contacts slide with this coefficient, positive where friction draws the rod towards its tip.
    pub fn slide(&mut self, coefficient: f64) -> Result<(), ContactError> {
        if !coefficient.is_finite() {
            return Err(ContactError::NotFinite { what: "coefficient", value: coefficient });
        }
        self.sliding = coefficient;
        Ok(())
    }

    /// The coefficient with which all contacts slide one way along the rod, whatever their motion; 0 where it is not so.
    #[inline(always)]
    pub fn sliding(&self) -> f64 {
        self.sliding
    }

    /// Takes the friction away.
    pub fn polish(&mut self) {
        (self.friction, self.sliding) = (None, 0.0);
    }

    /// Whether the objects have friction.
    #[inline(always)]
    pub fn rubs(&self) -> bool {
        self.friction.is_some()
    }

    /// The coefficients of friction of a stretch: of a corner or notch those of the piece before it.
    pub fn coefficients(&self, stretch: usize) -> Coefficients {
        self.friction.as_ref().map_or(Coefficients::NONE, |friction| friction[stretch])
    }

    /// Makes solid all that is behind an open contour.
    pub fn fill(&mut self) {
        self.skin = f64::INFINITY;
    }

    /// The number of the object that a stretch belongs to.
    pub fn object(&self, stretch: usize) -> usize {
        if self.objects.len() == 1 {
            0
        } else {
            self.first.partition_point(|first| *first <= stretch).saturating_sub(1)
        }
    }

    /// The object of a stretch, and the number of the stretch in it.
    fn at(&self, stretch: usize) -> (&'a Composite, usize) {
        if let [only] = self.objects {
            return (only, stretch);
        }
        let object = self.object(stretch);
        (&self.objects[object], stretch - self.first[object])
    }

    pub fn kind(&self, stretch: usize) -> StretchKind {
        let (object, own) = self.at(stretch);
        object.kind(own)
    }

    pub fn is_notch(&self, stretch: usize) -> bool {
        matches!(self.kind(stretch), StretchKind::Notch { .. })
    }

    pub fn is_corner(&self, stretch: usize) -> bool {
        matches!(self.kind(stretch), StretchKind::Corner { .. })
    }

    /// The number of the stretch of an object that is of this kind.
    pub fn find(&self, object: usize, kind: StretchKind) -> Option<usize> {
        let stretch = self.objects.get(object)?.find(kind)?;
        Some(self.first[object] + stretch)
    }

    /// Whether the shape of a piece of an object has a parameter of this name.
    pub fn has_parameter(&self, object: usize, piece: usize, parameter: &str) -> bool {
        let own = self.objects.get(object).and_then(|object| Some((object, object.find(StretchKind::Piece(piece))?)));
        own.is_some_and(|(object, own)| {
            object.own_frame_rate(own, object.own_range(own).clamp(0.0), piece, parameter).is_some()
        })
    }

    /// The change of [`support`](Self::support) at a fixed parameter with a parameter of the shape of a piece of the same object.
    pub fn support_rate(&self, stretch: usize, t: f64, piece: usize, parameter: &str) -> Option<SupportRate> {
        let (object, own) = self.at(stretch);
        let (unit, t) = (self.unit((object, own)), self.within(stretch, t));
        let FrameRate { x, y, alpha } = object.own_frame_rate(own, t * unit, piece, parameter)?;
        Some(SupportRate { x: x / self.length, y: y / self.length, alpha })
    }

    /// The change of [`border`](Self::border) with a parameter of the shape of a piece of the same object.
    pub fn border_rate(&self, stretch: usize, upper: bool, piece: usize, parameter: &str) -> Option<f64> {
        let (object, own) = self.at(stretch);
        Some(object.own_border_rate(own, upper, piece, parameter)? / self.unit((object, own)))
    }

    /// What of the contour's parameter counts as 1 here: of pieces about the rod's length, so that nothing depends on the unit
    /// of length or on how the shape is parametrised; of joints, which are measured by angle, 1.
    fn unit(&self, (object, own): (&Composite, usize)) -> f64 {
        object.own_pace(own).map_or(1.0, |pace| self.length * pace)
    }

    /// Range of a stretch in its own parameter.
    pub fn range(&self, stretch: usize) -> Range {
        let (object, own) = self.at(stretch);
        let (range, unit) = (object.own_range(own), self.unit((object, own)));
        Range { from: range.from / unit, to: range.to / unit }
    }

    /// Range of a part in its stretch's own parameter.
    pub fn own_range_of(&self, Part { stretch, range }: Part) -> Range {
        let unit = self.unit(self.at(stretch));
        Range { from: range.from / unit, to: range.to / unit }
    }

    /// Upper bound of the curvature of a part; infinite where its shape knows none.
    pub fn largest_curvature(&self, Part { stretch, range }: Part) -> f64 {
        let (object, own) = self.at(stretch);
        object.own_curvature_in(own, range).1 * self.length
    }

    /// The upper or lower end of a stretch's range.
    pub fn border(&self, stretch: usize, upper: bool) -> f64 {
        let range = self.range(stretch);
        if upper { range.to } else { range.from }
    }

    /// The stretch after or before; none where the contour ends.
    pub fn neighbour(&self, stretch: usize, after: bool) -> Option<usize> {
        let (object, own) = self.at(stretch);
        object.neighbour(own, after).map(|neighbour| stretch - own + neighbour)
    }

    pub fn support(&self, stretch: usize, t: f64) -> Support {
        if self.has_loops { self.support_on_loop(stretch, t) } else { self.support_within(stretch, t) }
    }

    /// The same where a stretch may be a loop.
    #[cold]
    fn support_on_loop(&self, stretch: usize, t: f64) -> Support {
        let (object, own) = self.at(stretch);
        let unit = self.unit((object, own));
        if object.own_range(own).contains(t * unit) {
            return self.support_of(object, own, unit, t);
        }
        let (t, turn) = self.around(stretch, t).unwrap_or((t, 0.0));
        let there = self.support_within(stretch, t);
        Support { alpha: there.alpha + turn, ..there }
    }

    /// The same on the stretch itself, beyond its ends as its shape goes on there.
    #[inline(always)]
    fn support_within(&self, stretch: usize, t: f64) -> Support {
        let (object, own) = self.at(stretch);
        self.support_of(object, own, self.unit((object, own)), t)
    }

    /// The same of a stretch of an object, in whose parameter `unit` counts as 1.
    #[inline(always)]
    fn support_of(&self, object: &Composite, own: usize, unit: f64, t: f64) -> Support {
        let Frame { x, y, alpha, speed, turning } = object.own_frame(own, t * unit);
        Support {
            x: x / self.length,
            y: y / self.length,
            alpha,
            speed: speed / self.length * unit,
            turning: turning * unit,
        }
    }

    /// Whether a stretch is a loop: a closed curve in one piece that is smooth where it closes. Its parameter goes on beyond both ends, round
    /// after round.
    fn is_loop(&self, stretch: usize) -> bool {
        self.has_loops && self.neighbour(stretch, true) == Some(stretch)
    }

    /// A parameter of a loop beyond its range as the one within, and the angle by which the tangent has turned on the rounds between.
    fn around(&self, stretch: usize, t: f64) -> Option<(f64, f64)> {
        if !self.has_loops {
            return None;
        }
        let Range { from, to } = self.range(stretch);
        if (from..=to).contains(&t) || !self.is_loop(stretch) {
            return None;
        }
        let rounds = ((t - from) / (to - from)).floor();
        let [first, last] = [from, to].map(|t| self.support_within(stretch, t).alpha);
        Some((t - rounds * (to - from), rounds * TAU * ((last - first) / TAU).round()))
    }

    /// A parameter of a loop within its range; of another stretch as it is.
    fn within(&self, stretch: usize, t: f64) -> f64 {
        self.around(stretch, t).map_or(t, |(t, _)| t)
    }

    /// The range within which a contact is on the stretch: without ends on a closed curve that is smooth where it closes.
    pub fn span(&self, stretch: usize) -> Range {
        if self.is_loop(stretch) { Range::ALL } else { self.range(stretch) }
    }

    /// The closest point of a whole stretch.
    pub fn foot(&self, stretch: usize, x: f64, y: f64) -> Foot {
        let (object, own) = self.at(stretch);
        self.foot_in(Part { stretch, range: object.own_range(own) }, x, y)
    }

    /// The closest point of a part of a stretch.
    pub fn foot_in(&self, part: Part, x: f64, y: f64) -> Foot {
        let Part { stretch, range } = part;
        let (object, own) = self.at(stretch);
        let unit = self.unit((object, own));
        self.foot_of(&object.own_closest_in(own, range, x * self.length, y * self.length), unit)
    }

    fn foot_of(&self, closest: &Closest, unit: f64) -> Foot {
        let frame = closest.frame;
        Foot {
            t: closest.t / unit,
            gap: closest.gap / self.length,
            alpha: frame.alpha,
            x: frame.x / self.length,
            y: frame.y / self.length,
            interior: closest.interior,
        }
    }

    /// Whether there are so few runs that asking which of them are near costs more than to look at all.
    pub fn is_small(&self) -> bool {
        self.objects.len() <= 2 && self.objects.iter().all(Composite::is_small)
    }

    /// Calls `visit` with all parts of all contours that meet `bounds`, and perhaps with others near by. Their ranges
    /// stay in the contours' unit, so that they come back to the contour as they are.
    pub fn parts_near(&self, bounds: Bounds, mut visit: impl FnMut(Part)) {
        let bounds = self.in_unit(bounds);
        self.index.meeting(bounds, &mut |object| {
            let first = self.first[object];
            self.objects[object].parts_near(bounds, |part| visit(Part { stretch: first + part.stretch, ..part }));
        });
    }

    /// Signed distance of a point from the nearest object: negative inside any of them.
    pub fn gap(&self, x: f64, y: f64) -> f64 {
        let (x, y) = (x * self.length, y * self.length);
        let mut least = f64::INFINITY;
        self.index.nearest(x, y, &mut |object| {
            let object = &self.objects[object];
            // most of many objects are farther away than what has been found
            if !is_bounded(object) || object.bounds().distance(x, y) <= least.max(0.0) {
                least = least.min(object.gap(x, y));
            }
            least.max(0.0)
        });
        least / self.length
    }

    /// How many objects have a contour not farther than `distance` from a point.
    pub fn contours_at(&self, x: f64, y: f64, distance: f64) -> usize {
        let (x, y) = (x * self.length, y * self.length);
        self.objects.iter().filter(|object| object.gap(x, y).abs() <= distance * self.length).count()
    }

    /// Number of objects.
    pub fn objects(&self) -> usize {
        self.objects.len()
    }

    /// Number of runs of all objects.
    pub fn runs(&self) -> usize {
        self.first_run[self.objects.len()]
    }

    /// The object that a run belongs to.
    pub fn object_of_run(&self, run: usize) -> usize {
        if self.objects.len() == 1 { 0 } else { self.first_run.partition_point(|first| *first <= run) - 1 }
    }

    fn own_run(&self, run: usize) -> (usize, &'a Composite, usize) {
        let object = self.object_of_run(run);
        (object, &self.objects[object], run - self.first_run[object])
    }

    /// A run, in lengths of the rod.
    pub fn run(&self, run: usize) -> Run {
        let (_, object, own) = self.own_run(run);
        let run = object.run(own);
        let end = |end: RunEnd| RunEnd { x: end.x / self.length, y: end.y / self.length, ..end };
        Run { ends: run.ends.map(|one| one.map(end)), bounds: self.in_lengths(run.bounds), ..run }
    }

    /// A box around a run.
    pub fn run_bounds(&self, run: usize) -> Bounds {
        let (_, object, own) = self.own_run(run);
        self.in_lengths(object.run_bounds(own))
    }

    /// A box in the contours' unit.
    fn in_unit(&self, Bounds { min, max }: Bounds) -> Bounds {
        let scaled = |side: [f64; 2]| side.map(|side| side * self.length);
        Bounds { min: scaled(min), max: scaled(max) }
    }

    /// A box in lengths of the rod.
    fn in_lengths(&self, Bounds { min, max }: Bounds) -> Bounds {
        let scaled = |side: [f64; 2]| side.map(|side| side / self.length);
        Bounds { min: scaled(min), max: scaled(max) }
    }

    /// Calls `visit` with the runs that meet `bounds`, and perhaps with others.
    pub fn runs_near(&self, bounds: Bounds, mut visit: impl FnMut(usize)) {
        let bounds = self.in_unit(bounds);
        self.index.meeting(bounds, &mut |object| {
            self.objects[object].runs_near(bounds, |run| visit(self.first_run[object] + run));
        });
    }

    /// The closest point of a run.
    pub fn run_foot(&self, run: usize, x: f64, y: f64) -> RunFoot {
        let (number, object, own) = self.own_run(run);
        let RunClosest { stretch, closest, end, joint } = object.run_closest(own, x * self.length, y * self.length);
        let unit = self.unit((object, stretch));
        RunFoot { foot: self.foot_of(&closest, unit), stretch: self.first[number] + stretch, end, joint }
    }

    /// Whether a stretch is part of a run at the parameter `t`.
    pub fn is_on_run(&self, run: usize, stretch: usize, t: f64) -> bool {
        if self.object_of_run(run) != self.object(stretch) {
            return false;
        }
        let (object, own) = self.at(stretch);
        let (unit, t) = (self.unit((object, own)), self.within(stretch, t));
        object.run_holds(run - self.first_run[self.object(stretch)], own, t * unit)
    }

    /// The point of a stretch at `t` as the foot of a point `(x, y)` that touches it there.
    pub fn foot_at(&self, stretch: usize, t: f64, x: f64, y: f64) -> Foot {
        let at = self.support(stretch, t);
        let (sin, cos) = at.alpha.sin_cos();
        let gap = (x - at.x) * sin - (y - at.y) * cos;
        Foot { t, gap, alpha: at.alpha, x: at.x, y: at.y, interior: true }
    }

    /// The run of an object that is nearest to a point.
    pub fn run_at(&self, object: usize, x: f64, y: f64) -> usize {
        self.first_run[object] + self.objects[object].run_at(x * self.length, y * self.length)
    }

    /// Bounds of the curvature of a whole run.
    pub fn run_curvature(&self, run: usize) -> (f64, f64) {
        let (_, object, own) = self.own_run(run);
        let arcs = object.run_arcs(own).map(|part| self.curvature(object, part.stretch, part.range));
        arcs.fold((f64::INFINITY, f64::NEG_INFINITY), |all, one| (all.0.min(one.0), all.1.max(one.1)))
    }

    /// Bounds of the curvature of a part of a stretch; by samples where the shape knows none, and then the contour is not
    /// proven anyway.
    fn curvature(&self, object: &Composite, stretch: usize, range: Range) -> (f64, f64) {
        let (mut least, mut largest) = object.own_curvature_in(stretch, range);
        if range.is_finite() && least == f64::NEG_INFINITY && largest == f64::INFINITY {
            (least, largest) = (largest, least);
            let mut change = 0.0;
            let mut before = f64::NAN;
            for k in 0..=SAMPLES {
                let t = range.from + (range.to - range.from) * f64::from(k) / f64::from(SAMPLES);
                let Frame { speed, turning, .. } = object.own_frame(stretch, t);
                let here = turning / speed;
                change = f64::max(change, (here - before).abs());
                (least, largest, before) = (least.min(here), largest.max(here), here);
            }
            (least, largest) = (least - change, largest + change);
        }
        (least * self.length, largest * self.length)
    }

    /// The outward normals at both ends of a joint.
    pub fn joint_normals(&self, joint: usize) -> [(f64, f64); 2] {
        let Range { from, to } = self.range(joint);
        [from, to].map(|t| normal(self.support(joint, t).alpha))
    }

    /// Lower bound of the curvature of a stretch from `t` on in the sense `ahead` (+1 or -1), as far as the contour runs over the
    /// tangent at `t` for a `length`, or to the end of the stretch; beyond that a run that bends outwards keeps doing so. Where such a
    /// run has turned as much as the rod does on its way, by `turn`, it falls away from there on, and the bound ends there too. None
    /// where it turns by more than `most`.
    pub fn curvature_ahead(
        &self,
        outward: bool,
        stretch: usize,
        t: f64,
        ahead: f64,
        (length, turn): (f64, f64),
        most: f64,
    ) -> Option<f64> {
        let (object, own) = self.at(stretch);
        let t = self.within(stretch, t);
        let here = self.support(stretch, t);
        // a curve that is smooth where it closes has no border there
        let is_loop = self.is_loop(stretch);
        let border = if is_loop { ahead * f64::INFINITY } else { self.border(stretch, ahead > 0.0) };
        let (sin, cos) = here.alpha.sin_cos();
        let mut reach = AHEAD * length / here.speed;
        if outward && here.turning > 0.0 {
            reach = reach.min(TURNED * turn / here.turning);
        }
        for _ in 0..LOOKS_AHEAD {
            let to = t + ahead * reach;
            let clipped = (to - border) * ahead >= 0.0;
            let to = if clipped { border } else { to };
            if !to.is_finite() {
                return None;
            }
            let there = self.support(stretch, to);
            let turned = ahead * (there.alpha - here.alpha);
            if turned.abs() > most {
                return None;
            }
            let falls_away = outward && turned >= turn;
            let over = ahead * ((there.x - here.x) * cos + (there.y - here.y) * sin);
            if !clipped && over < length && !falls_away {
                // a contour that slows down, or bends less than here, is followed for longer
                reach *= 2.0;
                continue;
            }
            let unit = self.unit((object, own));
            let (range, whole) = (Range { from: t.min(to) * unit, to: t.max(to) * unit }, object.own_range(own));
            let beyond = is_loop && !whole.contains(to * unit);
            let (least, largest) = self.curvature(object, own, if beyond { whole } else { range });
            // where it bends both ways the ends do not tell the largest turn
            if least < 0.0 && largest > 0.0 && 2.0 * reach * here.speed * least.abs().max(largest) > most {
                return None;
            }
            return Some(if clipped && outward && !falls_away { least.min(0.0) } else { least });
        }
        None
    }

    /// Signed distance of a point from an object.
    pub fn object_gap(&self, object: usize, x: f64, y: f64) -> f64 {
        self.objects[object].gap(x * self.length, y * self.length) / self.length
    }

    /// Whether a point is inside an object by more than `tolerance`. What is deep behind an open contour came there around an
    /// end of it, and what is nearest to an end of it is beside it.
    pub fn is_inside(&self, object: usize, x: f64, y: f64, tolerance: f64) -> bool {
        let object = &self.objects[object];
        let (x, y) = (x * self.length, y * self.length);
        if object.is_closed() {
            return object.gap(x, y) < -tolerance * self.length;
        }
        let closest = object.closest(x, y);
        let gap = closest.gap / self.length;
        closest.interior && gap < -tolerance && gap > -self.skin
    }

    /// Whether a point is outside of the box of a closed object.
    pub fn is_far_outside(&self, object: usize, x: f64, y: f64) -> bool {
        let object = &self.objects[object];
        is_bounded(object) && object.bounds().distance(x * self.length, y * self.length) > 0.0
    }

    /// Whether an object is a closed contour that bends one way: then the lines that keep it on one side tell the side.
    pub fn is_one_convex(&self, object: usize) -> bool {
        self.objects[object].is_convex_body()
    }

    /// Calls `visit` with the closed objects that are wholly within a box, and a point of each.
    pub fn closed_objects_in(&self, around: Bounds, mut visit: impl FnMut(usize, (f64, f64))) {
        let around = self.in_unit(around);
        self.index.meeting(around, &mut |number| {
            let object = &self.objects[number];
            let Bounds { min, max } = object.bounds();
            let inside = (0..2).all(|i| min[i] >= around.min[i] && max[i] <= around.max[i]);
            if is_bounded(object) && inside {
                let Frame { x, y, .. } = object.frame(object.range().from);
                visit(number, (x / self.length, y / self.length));
            }
        });
    }

    /// Calls `visit` with the objects whose boxes hold a point, and perhaps with others.
    pub fn objects_at(&self, x: f64, y: f64, mut visit: impl FnMut(usize)) {
        let point = Bounds::EMPTY.with(x * self.length, y * self.length);
        self.index.meeting(point, &mut visit);
    }

    /// Whether bends and closest points of all objects are proven.
    pub fn is_proven(&self) -> bool {
        self.objects.iter().all(Composite::is_proven)
    }

    /// Whether a point with a negative gap to `foot`, the closest point of a part of a stretch, is inside the solid,
    /// and there nearest to that part: what lies behind one part may be outside of the object or nearer to another
    /// part, whose gap it then is. What is deep behind an open contour came there around an end of it.
    pub fn goes_through(&self, stretch: usize, foot: &Foot, x: f64, y: f64) -> bool {
        foot.gap < 0.0
            && foot.gap >= self.gap(x, y) * (1.0 + 1e-6) - 1e-14
            && (foot.gap > -self.skin || self.at(stretch).0.is_closed())
    }

    /// Whether `foot` is the end of its stretch at a notch.
    pub fn ends_in_notch(&self, stretch: usize, foot: &Foot) -> bool {
        !foot.interior && self.beyond_end(stretch, foot).is_some_and(|beyond| self.is_notch(beyond))
    }

    /// The stretch beyond the end that `foot` is, if it is one.
    fn beyond_end(&self, stretch: usize, foot: &Foot) -> Option<usize> {
        let range = self.range(stretch);
        let neighbour = |after| self.neighbour(stretch, after);
        let upper = (foot.t >= range.to).then(|| neighbour(true)).flatten();
        upper.or_else(|| (foot.t <= range.from).then(|| neighbour(false)).flatten())
    }

    /// The pieces before and after a notch.
    pub fn walls(&self, notch: usize) -> [Option<usize>; 2] {
        [false, true].map(|after| self.neighbour(notch, after))
    }

    /// The notch between two of its walls.
    pub fn notch_between(&self, wall: usize, other: usize) -> Option<usize> {
        [true, false].into_iter().find_map(|after| {
            let notch = self.neighbour(wall, after).filter(|notch| self.is_notch(*notch))?;
            (self.neighbour(notch, after) == Some(other)).then_some(notch)
        })
    }

    /// The points where open contours end.
    pub fn open_ends(&self) -> &[(f64, f64)] {
        &self.ends
    }

    /// Number of the piece, in its object, that a stretch belongs to: for a joint the piece before it.
    pub fn piece(&self, stretch: usize) -> usize {
        match self.kind(stretch) {
            StretchKind::Piece(piece) => piece,
            StretchKind::Corner { before } | StretchKind::Notch { before } => before,
        }
    }
}

/// Whether the solid is within the bounds of its contour.
fn is_bounded(object: &Composite) -> bool {
    object.is_closed() && !object.is_cavity()
}
