//! The objects as the rod sees them: in lengths of the rod.

use rod_contours::{Bounds, Composite, Contour, Frame, Index, Part, Range, StretchKind};
use rod_core::Support;
use smallvec::SmallVec;

/// Depth to which a rod that has come there may be in the solid behind an open contour: further than a step of the
/// sweep takes any point of it.
const SKIN: f64 = 0.1;

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
    ends: SmallVec<[(f64, f64); 2]>,
    /// Depth to which there is solid behind an open contour.
    pub skin: f64,
    /// Length of the rod in the contours' unit.
    length: f64,
}

/// The point of one part of the contour that is closest to a given point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    pub t: f64,
    pub gap: f64,
    pub alpha: f64,
    /// Signed curvature of the contour there; infinite at a corner.
    pub curvature: f64,
    pub x: f64,
    pub y: f64,
    /// Whether the foot is a perpendicular one, not an end of the part.
    pub interior: bool,
}

/// Gap at which the direction to the foot has lost no more than three digits.
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
        let (sin, cos) = self.alpha.sin_cos();
        (sin, -cos)
    }
}

impl<'a> World<'a> {
    pub fn new(objects: &'a [Composite], length: f64) -> Self {
        let first = objects.iter().scan(0, |next, object| {
            let first = *next;
            *next += object.stretches().len();
            Some(first)
        });
        let open = objects.iter().filter(|object| !object.is_closed());
        let ends = open.flat_map(|object| {
            let Range { from, to } = object.range();
            [from, to].into_iter().filter(|t| t.is_finite()).map(|t| object.frame(t))
        });
        let ends = ends.map(|end| (end.x / length, end.y / length)).collect();
        let index =
            Index::new(objects.iter().map(|object| if is_bounded(object) { object.bounds() } else { Bounds::ALL }));
        Self { objects, index, first: first.collect(), ends, skin: SKIN, length }
    }

    /// The number of the object that a stretch belongs to.
    pub fn object(&self, stretch: usize) -> usize {
        self.first.partition_point(|first| *first <= stretch).saturating_sub(1)
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
        let stretch = self.objects.get(object)?.stretches().position(|stretch| stretch.kind == kind)?;
        Some(self.first[object] + stretch)
    }

    /// Length of the contour's parameter that counts as 1 here: of pieces the rod's length, of joints, which are
    /// measured by angle, 1.
    fn unit(&self, (object, own): (&Composite, usize)) -> f64 {
        if matches!(object.kind(own), StretchKind::Piece(_)) { self.length } else { 1.0 }
    }

    /// Range of a stretch in its own parameter.
    pub fn range(&self, stretch: usize) -> Range {
        let (object, own) = self.at(stretch);
        let (range, unit) = (object.own_range(own), self.unit((object, own)));
        Range { from: range.from / unit, to: range.to / unit }
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
        let (object, own) = self.at(stretch);
        let unit = self.unit((object, own));
        let Frame { x, y, alpha, speed, turning } = object.own_frame(own, t * unit);
        Support {
            x: x / self.length,
            y: y / self.length,
            alpha,
            speed: speed / self.length * unit,
            turning: turning * unit,
        }
    }

    /// The closest point of a whole stretch.
    pub fn foot(&self, stretch: usize, x: f64, y: f64) -> Foot {
        let (object, own) = self.at(stretch);
        self.foot_in(Part { stretch, range: object.own_range(own) }, x, y)
    }

    /// Whether `t` is in a part of its stretch, or next to it but for rounding.
    pub fn holds(&self, part: &Part, t: f64) -> bool {
        let t = t * self.unit(self.at(part.stretch));
        let slack = 1e-9 * (1.0 + t.abs());
        part.range.from - slack <= t && t <= part.range.to + slack
    }

    /// Whether `t` is in a part of its stretch, and not at an end, where a corner may be.
    pub fn is_inside(&self, part: &Part, t: f64) -> bool {
        let t = t * self.unit(self.at(part.stretch));
        let slack = 1e-6 * (1.0 + t.abs());
        part.range.from + slack < t && t < part.range.to - slack
    }

    /// The closest point of a part of a stretch.
    pub fn foot_in(&self, part: Part, x: f64, y: f64) -> Foot {
        let Part { stretch, range } = part;
        let (object, own) = self.at(stretch);
        let unit = self.unit((object, own));
        let closest = object.own_closest_in(own, range, x * self.length, y * self.length);
        let frame = closest.frame;
        Foot {
            t: closest.t / unit,
            gap: closest.gap / self.length,
            alpha: frame.alpha,
            curvature: frame.turning / frame.speed * self.length,
            x: frame.x / self.length,
            y: frame.y / self.length,
            interior: closest.interior,
        }
    }

    /// Whether [`parts_near`](Self::parts_near) gives all parts whatever the bounds.
    pub fn is_small(&self) -> bool {
        self.objects.len() <= 2 && self.objects.iter().all(Composite::is_small)
    }

    /// Calls `visit` with all parts of all contours that meet `bounds`, and perhaps with others near by. Their ranges
    /// stay in the contours' unit, so that they come back to the contour as they are.
    pub fn parts_near(&self, bounds: Bounds, mut visit: impl FnMut(Part)) {
        let scaled = |side: [f64; 2]| side.map(|side| side * self.length);
        let bounds = Bounds { min: scaled(bounds.min), max: scaled(bounds.max) };
        self.index.meeting(bounds, &mut |object| {
            let first = self.first[object];
            self.objects[object].parts_near(bounds, |part| visit(Part { stretch: first + part.stretch, ..part }));
        });
    }

    /// A box around a part.
    pub fn bounds(&self, part: Part) -> Bounds {
        let (object, own) = self.at(part.stretch);
        let Bounds { min, max } = object.own_bounds_in(own, part.range);
        let scaled = |side: [f64; 2]| side.map(|side| side / self.length);
        Bounds { min: scaled(min), max: scaled(max) }
    }

    /// Whether a part lies on one side of each of its tangents.
    pub fn is_convex(&self, part: Part) -> bool {
        let (object, own) = self.at(part.stretch);
        object.own_is_convex(own, part.range)
    }

    /// The tangent angle in the middle of a part.
    pub fn angle(&self, part: Part) -> f64 {
        let (object, own) = self.at(part.stretch);
        object.own_frame(own, 0.5 * (part.range.from + part.range.to)).alpha
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

    /// Whether the contour goes on smoothly beyond `foot`, an end of a part.
    pub fn goes_on(&self, stretch: usize, foot: &Foot) -> bool {
        let range = self.range(stretch);
        let inside = range.from < foot.t && foot.t < range.to;
        inside || self.beyond_end(stretch, foot).is_some_and(|on| matches!(self.kind(on), StretchKind::Piece(_)))
    }

    /// Whether `foot` is an end of an open contour.
    pub fn is_open_end(&self, stretch: usize, foot: &Foot) -> bool {
        let range = self.range(stretch);
        (foot.t >= range.to || foot.t <= range.from) && self.beyond_end(stretch, foot).is_none()
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
