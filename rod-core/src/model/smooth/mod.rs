//! Rods whose stiffness and natural curvature vary along them, by collocation.

mod element;
pub(crate) mod gauss;
mod maximum;
mod mesh;

use crate::error::RodError;
use crate::model::constant::Constant;
use crate::model::interval::{
    Chain, Range, curvature_range, piece_at, pieces, sign_between, sign_by_cells, sign_of_range, union,
};
use crate::model::profile::Profile;
use crate::model::{Cut, CutSensitivities, RodModel};
use crate::segment::Segment;
use element::Element;
use maximum::maximum_within;
use mesh::Mesh;

/// Largest number of elements of an interval. The stiff half of a whisker takes 2 under 20 E I / L^2.
const MOST_ELEMENTS: usize = 4096;
/// What an element may take on: its length over that on which the profile is resolved, plus the angle by which the pendulum swings in
/// it, plus [`TURN`] times the angle by which it turns. Measured on random intervals (`error_on_random_intervals`): 1.4 leaves errors of
/// 1e-12 at worst, 2 of 4e-11 at three quarters of the price.
const THETA: f64 = 1.4;
/// A rod that just turns is easier to follow than one that swings.
const TURN: f64 = 0.5;
/// How often an element that was too bold is halved.
const MOST_HALVINGS: usize = 20;
/// Part of the way to the next node at which a curvature that is largest at an end is compared with that at the end.
const INWARDS: f64 = 1e-3;
/// How far beside a joint is on its other side, yet at the same place: two roundings of a length of 1.
const BESIDE: f64 = 4.0 * f64::EPSILON;

/// A rod with any smooth [`Profile`] of stiffness and natural curvature, or one that is smooth between given borders: collocation at
/// 8 Gauss points an element (order 16), derivatives by the same equations.
///
/// ```
/// use rod_core::{Cone, Cut, RodModel, Smooth};
/// let whisker = Smooth::new(Cone { taper: 0.8 })?;
/// let clamp = Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 1e-6 };
/// // a small moment turns the tip by int (1 - t s)^-4 ds = ((1 - t)^-3 - 1) / 3 t
/// let tip = whisker.carry(0.0, &clamp, 0.0, 0.0, 1.0);
/// assert!((tip.phi / 1e-6 - 124.0 / 2.4).abs() < 1e-9);
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Smooth<P> {
    profile: P,
    mesh: Mesh,
    /// What the rod is beyond its ends.
    beyond: [Constant; 2],
}

impl<P: Profile> Smooth<P> {
    /// A rod with this profile, which is smooth from the clamp to the tip.
    ///
    /// # Errors
    /// [`RodError::Stiffness`] and [`RodError::NaturalCurvature`] for values that are none, with the arc length (in L);
    /// [`RodError::NotSmooth`] near a jump or a kink.
    pub fn new(profile: P) -> Result<Self, RodError> {
        Self::with_borders(profile, &[])
    }

    /// A rod with this profile, which is smooth between `borders`: arc lengths that grow from the clamp to the tip, both of which are
    /// left out.
    ///
    /// # Errors
    /// As [`Smooth::new`], and [`RodError::Border`] for borders out of order.
    pub fn with_borders(profile: P, borders: &[f64]) -> Result<Self, RodError> {
        let mesh = Mesh::new(&profile, borders)?;
        let end = |s| Constant { stiffness: profile.stiffness(s), natural_curvature: profile.natural_curvature(s) };
        Ok(Self { beyond: [end(0.0), end(1.0)], profile, mesh })
    }
}

impl<P: Profile> Smooth<P> {
    /// The rod beyond one of its ends, if that is what the piece of this number is.
    #[inline(always)]
    fn outside(&self, piece: usize) -> Option<&Constant> {
        match piece {
            0 => Some(&self.beyond[0]),
            last if last == self.mesh.joints.len() => Some(&self.beyond[1]),
            _ => None,
        }
    }

    /// The ranges of compliance and natural curvature on a part of a piece.
    fn ranges(&self, piece: usize, from: f64, to: f64) -> [Range; 2] {
        if let Some(Constant { stiffness, natural_curvature }) = self.outside(piece) {
            return [1.0 / stiffness, *natural_curvature].map(|value| (value, value));
        }
        let at = |s: f64| [1.0 / self.profile.stiffness(s), self.profile.natural_curvature(s)];
        let (first, last) = (at(from + BESIDE), at(to - BESIDE));
        let (half, steepest) = (0.5 * (to - from), self.mesh.steepest(from, to));
        let bounded_by_ends = [self.profile.is_monotonic(), false];
        let range = |k: usize| {
            let slack = if bounded_by_ends[k] { 0.0 } else { half * steepest[k] };
            (first[k].min(last[k]) - slack, first[k].max(last[k]) + slack)
        };
        // no compliance is negative, however steeply it falls
        let (least, most) = range(0);
        [(least.max(0.0), most), range(1)]
    }

    /// Curvature at a place of a piece: at one of the ends of an interval, on the side of `towards`.
    fn curvature_beside(&self, s: f64, towards: f64, moment: f64) -> f64 {
        let inside = if self.mesh.joints.contains(&s) { s + BESIDE * (towards - s).signum() } else { s };
        self.curvature_at(inside, moment)
    }

    /// Goes along a part of the rod between two joints, element by element, each with the arc length where it starts. What cannot be
    /// computed ends as NaN.
    #[inline(always)]
    fn elements(
        &self,
        from: f64,
        to: f64,
        start: &Cut,
        force: [f64; 2],
        mut show: impl FnMut(f64, &mut Element),
    ) -> Cut {
        let (mut at, mut cut, mut element) = (from, *start, Element::UNSOLVED);
        for _ in 0..MOST_ELEMENTS {
            if at == to {
                return cut;
            }
            let (mut h, is_last) = self.length(at, to, &cut, force);
            // a bound that was too bold shows in an iteration that does not converge
            let whole = element.solve(&self.profile, at, h, &cut, force);
            let mut solved = whole;
            for _ in 0..MOST_HALVINGS {
                if solved {
                    break;
                }
                h *= 0.5;
                solved = element.solve(&self.profile, at, h, &cut, force);
            }
            if !solved {
                break;
            }
            show(at, &mut element);
            cut = element.end();
            at = if is_last && whole { to } else { at + h };
        }
        Cut { x: f64::NAN, y: f64::NAN, phi: f64::NAN, moment: f64::NAN }
    }

    /// How long the next element is on the way from `at` to `to`, and whether it is the last.
    #[inline(always)]
    fn length(&self, at: f64, to: f64, cut: &Cut, [a, b]: [f64; 2]) -> (f64, bool) {
        let (left, p) = ((to - at).abs(), a.hypot(b).sqrt());
        let direction = (to - at).signum();
        let beside = |s: f64, inwards: f64| s + inwards * direction * BESIDE;
        let here = beside(at, 1.0);
        let (rate, compliance) = (self.mesh.rate(here), 1.0 / self.profile.stiffness(here));
        let (bent, natural) = (compliance * cut.moment, self.profile.natural_curvature(here));
        let (swing, turn) = (p * compliance.sqrt(), TURN * (bent + natural).abs());
        let reach = (self.mesh.away(here, direction * THETA) - at).abs();
        let bold = left.min(reach).min(THETA / (rate + swing + turn));
        // the rod may be softer, turn or vary faster at the other end
        let other = beside(at + direction * bold, -1.0);
        let swing = swing.max(p / self.profile.stiffness(other).sqrt());
        let turn = turn.max(TURN * (bent + self.profile.natural_curvature(other)).abs());
        let length = reach.min(THETA / (rate.max(self.mesh.rate(other)) + swing + turn));
        let count = (left / length).ceil();
        if count > 1.0 { (direction * left / count, false) } else { (to - at, true) }
    }
}

impl<P: Profile> RodModel for Smooth<P> {
    fn carry_with_sensitivities(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        let (mut end, mut chain, to) = (*start, Chain::new(), s + length);
        pieces(&self.mesh.joints, s, to, |i, from, to| {
            end = match self.outside(i) {
                Some(part) => {
                    let (next, d) = part.carry_with_sensitivities(&end, a, b, to - from);
                    chain.then(&d);
                    next
                }
                None => self.elements(from, to, &end, [a, b], |_, element| {
                    chain.extend(element.changes(chain.directions()));
                }),
            };
        });
        let (kappa_start, kappa_end) =
            (self.curvature_beside(s, to, start.moment), self.curvature_beside(to, s, end.moment));
        (end, chain.finish((start, kappa_start), (&end, kappa_end), a, b))
    }

    fn carry(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        let mut end = *start;
        pieces(&self.mesh.joints, s, s + length, |i, from, to| {
            end = match self.outside(i) {
                Some(part) => part.carry(&end, a, b, to - from),
                None => self.elements(from, to, &end, [a, b], |_, _| ()),
            };
        });
        end
    }

    fn curvature_at(&self, s: f64, moment: f64) -> f64 {
        match self.outside(piece_at(&self.mesh.joints, s)) {
            Some(part) => part.curvature(moment),
            None => moment / self.profile.stiffness(s) + self.profile.natural_curvature(s),
        }
    }

    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        self.bending_energy_by_parts(segment, to, end, &mut |_| ())
    }

    fn bending_energy_by_parts(
        &self,
        segment: &Segment<Cut>,
        to: f64,
        _end: &Cut,
        show: &mut dyn FnMut(Segment<Cut>),
    ) -> f64 {
        let (mut energy, mut cut) = (0.0, segment.start);
        let Segment { s, a, b, .. } = *segment;
        pieces(&self.mesh.joints, s, to, |i, from, to| {
            if let Some(part) = self.outside(i) {
                let end = part.carry(&cut, a, b, to - from);
                energy += part.bending_energy(&Segment { s: from, start: cut, a, b }, to, &end);
                cut = end;
            } else {
                cut = self.elements(from, to, &cut, [a, b], |at, element| {
                    if at != s {
                        show(Segment { s: at, start: element.start(), a, b });
                    }
                    energy += element.bending_energy();
                });
            }
        });
        energy
    }

    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64) {
        let (mut compliance, mut natural) = ((f64::INFINITY, 0.0), (f64::INFINITY, f64::NEG_INFINITY));
        pieces(&self.mesh.joints, from.0, to.0, |i, from, to| {
            let [of_compliance, of_natural] = self.ranges(i, from, to);
            (compliance, natural) = (union(compliance, of_compliance), union(natural, of_natural));
        });
        curvature_range([from.1, to.1], force, to.0 - from.0, compliance, natural)
    }

    fn one_bend(&self, from: (f64, f64), to: (f64, f64), force: f64) -> Option<f64> {
        if !self.is_straight() {
            return sign_of_range(self.curvature_bounds(from, to, force));
        }
        let (moments, length) = ([from.1, to.1], to.0 - from.0);
        sign_between(moments, force / self.least_stiffness(from.0, to.0), length).or_else(|| {
            sign_by_cells(moments, force, length, |x, y| 1.0 / self.least_stiffness(from.0 + x, from.0 + y))
        })
    }

    fn least_stiffness(&self, from: f64, to: f64) -> f64 {
        let mut most: f64 = 0.0;
        pieces(&self.mesh.joints, from, to, |i, from, to| most = most.max(self.ranges(i, from, to)[0].1));
        1.0 / most
    }

    fn joints(&self) -> &[f64] {
        // the first and the last are the ends of the rod
        let all = &self.mesh.joints;
        &all[1..all.len() - 1]
    }

    fn is_straight(&self) -> bool {
        let mut natural = (0.0, 0.0);
        pieces(&self.mesh.joints, 0.0, 1.0, |i, from, to| natural = union(natural, self.ranges(i, from, to)[1]));
        natural == (0.0, 0.0)
    }

    /// The largest at the ends and nodes of the elements, and then the largest around that.
    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, _end: &Cut) -> f64 {
        let Segment { s, start, a, b } = *segment;
        // the cuts where elements begin, and |curvature| along the way; a joint counts on either side
        let (mut starts, mut along, mut cut) = (vec![(s, start)], Vec::new(), start);
        let mut beyond: f64 = 0.0;
        pieces(&self.mesh.joints, s, to, |i, from, to| {
            along.push((from, self.curvature_beside(from, to, cut.moment).abs()));
            cut = match self.outside(i) {
                Some(part) => {
                    let end = part.carry(&cut, a, b, to - from);
                    beyond = beyond.max(part.largest_curvature(&Segment { s: from, start: cut, a, b }, to, &end));
                    end
                }
                None => self.elements(from, to, &cut, [a, b], |at, element| {
                    starts.push((at, element.start()));
                    along.extend(element.nodes(at).into_iter().zip(element.curvatures().map(f64::abs)));
                }),
            };
            along.push((to, self.curvature_beside(to, from, cut.moment).abs()));
        });
        if cut.moment.is_nan() {
            return f64::NAN;
        }
        let most = (0..along.len()).fold(0, |best, i| if along[i].1 > along[best].1 { i } else { best });
        let size = |at: f64| {
            let behind = |&&(start, _): &&(f64, Cut)| (at - start) * (to - s) >= 0.0;
            let (from, cut) = starts.iter().rev().find(behind).unwrap_or(&starts[0]);
            self.curvature_at(at, self.carry(*from, cut, a, b, at - from).moment).abs()
        };
        let (before, after) = (along[most.saturating_sub(1)].0, along[(most + 1).min(along.len() - 1)].0);
        let (at, largest) = (along[most].0, along[most].1.max(beyond));
        // at an end it is the largest unless it grows inwards
        let grows_towards = |to: f64| to != at && size(at + INWARDS * (to - at)) > largest;
        let is_end = before == at || after == at;
        if is_end && !grows_towards(before) && !grows_towards(after) {
            return largest;
        }
        largest.max(maximum_within((before, after), size))
    }
}
