//! A part of a rod whose stiffness and natural curvature are constant, in closed form.
//!
//! With kappa = m / EI + kappa0 the curvature obeys kappa' = (A cos phi + B sin phi) / EI: the uniform straight rod's equation under
//! the force (A, B) / EI. A natural curvature that is constant does not enter it.

use crate::model::uniform::Uniform;
use crate::model::{Cut, CutSensitivities, RodModel};
use crate::segment::{Section, Segment, Sensitivities, advance, advance_with_sensitivities};

/// Stiffness and natural curvature of a part, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Constant {
    pub stiffness: f64,
    pub natural_curvature: f64,
}

impl Constant {
    pub fn curvature(&self, moment: f64) -> f64 {
        moment / self.stiffness + self.natural_curvature
    }

    /// The section of the uniform straight rod that moves as this part does.
    fn as_straight(&self, &Cut { x, y, phi, moment }: &Cut) -> Section {
        Section { x, y, phi, kappa: self.curvature(moment) }
    }

    /// The moment by its balance, which keeps that of a start exactly.
    fn cut(start: &Cut, &Section { x, y, phi, .. }: &Section, a: f64, b: f64) -> Cut {
        Cut { x, y, phi, moment: start.moment + (a * (x - start.x) + b * (y - start.y)) }
    }

    pub fn carry(&self, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        let compliance = 1.0 / self.stiffness;
        Self::cut(start, &advance(&self.as_straight(start), a * compliance, b * compliance, length), a, b)
    }

    /// The end with its derivatives by angle, moment and force at the start.
    pub fn carry_with_sensitivities(&self, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        let compliance = 1.0 / self.stiffness;
        let straight = self.as_straight(start);
        let (end, d) = advance_with_sensitivities(&straight, a * compliance, b * compliance, length);
        let Sensitivities { by_phi, by_kappa, by_a, by_b, by_s } = d;
        let of_curvature = |[x, y, phi, kappa]: [f64; 4]| [x, y, phi, kappa * self.stiffness];
        let by_moment = |[x, y, phi, kappa]: [f64; 4]| [x * compliance, y * compliance, phi * compliance, kappa];
        let by_to = of_curvature(by_s);
        let all = CutSensitivities {
            by_phi: of_curvature(by_phi),
            by_moment: by_moment(by_kappa),
            by_a: by_moment(by_a),
            by_b: by_moment(by_b),
            by_from: by_to.map(|v| -v),
            by_to,
        };
        (Self::cut(start, &end, a, b), all)
    }

    /// m^2 / 2 EI = EI (kappa^2 / 2 - kappa kappa0 + kappa0^2 / 2), of which the first is that of a uniform straight rod and the
    /// integral of the second the change of the angle.
    pub fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        let (natural, straight) = (self.natural_curvature, self.equivalent(segment));
        let half_square = Uniform.bending_energy(&straight, to, &self.equivalent_cut(end));
        let turned = end.phi - segment.start.phi;
        self.stiffness * (half_square - natural * turned + 0.5 * natural * natural * (to - segment.s))
    }

    pub fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        Uniform.largest_curvature(&self.equivalent(segment), to, &self.equivalent_cut(end))
    }

    fn equivalent(&self, &Segment { s, start, a, b }: &Segment<Cut>) -> Segment<Cut> {
        let compliance = 1.0 / self.stiffness;
        Segment { s, start: self.equivalent_cut(&start), a: a * compliance, b: b * compliance }
    }

    fn equivalent_cut(&self, cut: &Cut) -> Cut {
        Cut { moment: self.curvature(cut.moment), ..*cut }
    }
}
