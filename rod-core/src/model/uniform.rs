//! The uniform straight rod, in closed form.

use crate::model::interval::{moment_range, sign_between};
use crate::model::{Cut, CutSensitivities, RodModel};
use crate::segment::{
    Section, Segment, Sensitivities, Station, advance, advance_with_sensitivities, agm, axial, stations,
};
use std::f64::consts::{PI, TAU};

/// The uniform straight rod: curvature = moment. See [`advance`] for the closed form.
///
/// ```
/// use rod_core::{Cut, RodModel, Uniform};
/// let clamp = Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 2.0 };
/// let quarter_circle = Uniform.carry(0.0, &clamp, 0.0, 0.0, std::f64::consts::FRAC_PI_4);
/// assert!((quarter_circle.x - 0.5).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uniform;

impl RodModel for Uniform {
    #[inline(always)]
    fn carry_with_sensitivities(&self, _s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        let (end, d) = advance_with_sensitivities(&section(start), a, b, length);
        let Sensitivities { by_phi, by_kappa, by_a, by_b, by_s } = d;
        // the rod is the same everywhere: only the length counts
        (
            cut(&end),
            CutSensitivities { by_phi, by_moment: by_kappa, by_a, by_b, by_from: by_s.map(|v| -v), by_to: by_s },
        )
    }

    #[inline(always)]
    fn carry(&self, _s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        cut(&advance(&section(start), a, b, length))
    }

    #[inline(always)]
    fn curvature_at(&self, _s: f64, moment: f64) -> f64 {
        moment
    }

    /// kappa^2 / 2 = A sin phi - B cos phi + constant along a segment, and the integrals of sin phi and cos phi are the
    /// differences of position: nothing is evaluated again.
    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        let Segment { s, start, a, b } = *segment;
        if a == 0.0 && b == 0.0 {
            return 0.5 * start.moment * start.moment * (to - s);
        }
        let (sin, cos) = start.phi.sin_cos();
        let constant = 0.5 * start.moment * start.moment - a * sin + b * cos;
        a * (end.y - start.y) - b * (end.x - start.x) + constant * (to - s)
    }

    /// It is at an end of the segment or where the rod runs along the stable direction of the pendulum, phi = atan2(B, A) +
    /// pi / 2: there kappa^2 / 4 = M.
    ///
    /// A pendulum that does not go over the top passes it once every half period: surely in that time, and in less exactly
    /// if it ends on the other side. One that goes over the top turns one way only, so that the ends tell.
    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        let Segment { s, start, a, b } = *segment;
        let at_ends = start.moment.abs().max(end.moment.abs());
        if a == 0.0 && b == 0.0 {
            return at_ends;
        }
        let (sin, cos) = start.phi.sin_cos();
        let (c, d) = (a * sin - b * cos, a * cos + b * sin);
        let p = c.hypot(d);
        let excess = 0.25 * start.moment * start.moment - axial(c, d, p);
        // turning angles from the stable direction to both ends: is there a multiple of 2 pi between them?
        let from_stable = d.atan2(-c) - PI;
        let to_stable = from_stable + end.phi - start.phi;
        let passes = (from_stable.min(to_stable) / TAU).ceil() <= (from_stable.max(to_stable) / TAU).floor();
        let length = to - s;
        let swings_back = length * p.sqrt() >= PI && excess < 0.0 && length >= PI / agm(p.sqrt(), (-excess).sqrt());
        if passes || swings_back { at_ends.max(2.0 * (p + excess).max(0.0).sqrt()) } else { at_ends }
    }

    /// An arc: that of its moment.
    fn largest_free_curvature(&self, _s: f64, start: &Cut, _to: f64) -> f64 {
        start.moment.abs()
    }

    #[inline(always)]
    fn one_bend(&self, from: (f64, f64), to: (f64, f64), force: f64) -> Option<f64> {
        sign_between([from.1, to.1], force, to.0 - from.0)
    }

    #[inline(always)]
    fn least_stiffness(&self, _from: f64, _to: f64) -> f64 {
        1.0
    }

    #[inline(always)]
    fn is_straight(&self) -> bool {
        true
    }

    #[inline(always)]
    fn is_uniform(&self) -> bool {
        true
    }

    #[inline(always)]
    fn stations(
        &self,
        segment: &Segment<Cut>,
        (length, steps): (f64, usize),
        count: usize,
        visit: impl FnMut(Station),
    ) {
        stations(&section(&segment.start), segment.a, segment.b, length, steps).take(count).for_each(visit);
    }

    #[inline(always)]
    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64) {
        let (moments, length) = ([from.1, to.1], to.0 - from.0);
        let bent = moments[0].abs().max(moments[1].abs()) + 0.5 * force * length;
        moment_range(moments, force, length, bent)
    }
}

/// The cut of a uniform straight rod: its moment is its curvature.
#[inline(always)]
pub(crate) fn cut(&Section { x, y, phi, kappa }: &Section) -> Cut {
    Cut { x, y, phi, moment: kappa }
}

/// The section of a uniform straight rod.
#[inline(always)]
pub(crate) fn section(&Cut { x, y, phi, moment }: &Cut) -> Section {
    Section { x, y, phi, kappa: moment }
}
