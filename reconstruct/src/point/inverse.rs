//! What the inversion of a scan has to know of a rod.

use super::bent::{Bent, zeros};
use super::carried::{Carried, CrossSection, RodInterval, cut, of_cut};
use super::clamp::{Clamp, SectionGradient};
use super::moment_zero::MomentZero;
use super::no_contact::NoContact;
use nalgebra::{Matrix3, Matrix4x3, Vector3, Vector4};
use rod_core::{
    Clamp as Held, PhysicalRod, Pose, RodModel, Scalar, Section, Uniform, advance, advance_with_sensitivities,
    inflection,
};

/// Where the moment of a rod vanishes, and the criterion of a tangential contact, dimensionless and with exact derivatives. Which rod it
/// is, is a type, so that the uniform one keeps its closed forms.
pub(crate) trait Inverse {
    /// Whether the criterion needs no zero of the moment: on a uniform rod, straight at rest or bent to an arc.
    const UNIFORM: bool;

    /// Whether the criterion of one tangential contact holds for the last of several as well: where stiffness and natural curvature are the
    /// same all along the rod.
    fn tells_last(&self) -> bool;

    /// The zero of the moment that is next to the clamp.
    fn first(&self, clamp: &Clamp) -> Result<MomentZero, NoContact>;

    /// The zero that is nearest to the tip, if that is a later one than `first`.
    fn by_tip(&self, first: &MomentZero, clamp: &Clamp) -> Option<MomentZero>;

    /// The section at an arc length, and the derivatives of (x, y, phi, moment) there.
    fn gradient_at(&self, clamp: &Clamp, s: f64) -> (Section, SectionGradient);

    /// 2 F . t - 2 |F| sin rho, where F is the force on the rod at the first zero of the moment, t the rod's tangent there and rho the angle
    /// of friction: 0 where that is a tangential contact, negative where it is one of the tip. Of the uniform rod it is the phase
    /// criterion K (Merker et al. 2020, eq. 20) less 2 |F| sin rho, wherever the zero is. With its derivatives by the reactions; none
    /// where the moment vanishes nowhere.
    fn criterion(&self, clamp: &Clamp, first: Option<&MomentZero>) -> Option<(f64, Vector3<f64>)>;

    /// The cross-section next to a clamp with this pose and these reactions; `natural` is as in a [`Clamp`].
    fn base<T: Carried>(&self, pose: [T; 3], reactions: [T; 3], natural: T) -> CrossSection<T>;

    /// The cross-section at the end of an interval that starts with `start`.
    fn carry<T: Carried>(&self, start: &CrossSection<T>, along: &RodInterval<T>) -> CrossSection<T>;

    /// The cross-section at the tip of a part that starts at arc length `s`, and the derivatives of its bend by the force (A, B).
    fn tip(&self, start: &CrossSection, s: f64, force: [f64; 2]) -> (CrossSection, [f64; 2]);

    /// The moment at a cross-section.
    fn moment<T: Scalar>(&self, at: &CrossSection<T>, natural: T) -> T;

    /// The curvature at a cross-section at arc length `s`.
    fn curvature(&self, at: &CrossSection, s: f64) -> f64;

    /// Arc length of the first zero of the moment beyond a cross-section at `s`, under this force (A, B).
    fn next_zero(&self, start: &CrossSection, s: f64, force: [f64; 2]) -> Option<f64>;

    /// Whether stiffness or natural curvature jump somewhere.
    fn has_joints(&self) -> bool;

    /// The cross-section at an arc length before the first contact.
    fn at(&self, clamp: &Clamp, s: f64) -> CrossSection {
        let start = self.base(clamp.pose.into(), clamp.reactions.into(), clamp.natural);
        self.carry(&start, &RodInterval { from: 0.0, to: s, force: clamp.force() })
    }

    /// The zero at which the tip would be, were it the only contact.
    fn of_tip(&self, clamp: &Clamp) -> Result<MomentZero, NoContact> {
        let first = self.first(clamp)?;
        Ok(self.by_tip(&first, clamp).unwrap_or(first))
    }
}

/// The uniform rod in closed form. Its natural curvature is that of the clamp it is asked with.
impl Inverse for Uniform {
    const UNIFORM: bool = true;

    fn tells_last(&self) -> bool {
        true
    }

    fn first(&self, clamp: &Clamp) -> Result<MomentZero, NoContact> {
        MomentZero::of(clamp, &Matrix3::zeros())
    }

    fn by_tip(&self, first: &MomentZero, clamp: &Clamp) -> Option<MomentZero> {
        first.by_tip(clamp)
    }

    fn gradient_at(&self, clamp: &Clamp, s: f64) -> (Section, SectionGradient) {
        clamp.gradient_at(s)
    }

    fn criterion(&self, clamp: &Clamp, _first: Option<&MomentZero>) -> Option<(f64, Vector3<f64>)> {
        Some(clamp.criterion())
    }

    fn base<T: Carried>(&self, [x, y, phi]: [T; 3], [_, _, m0z]: [T; 3], natural: T) -> CrossSection<T> {
        CrossSection { x, y, phi, bend: natural - m0z }
    }

    fn carry<T: Carried>(&self, start: &CrossSection<T>, along: &RodInterval<T>) -> CrossSection<T> {
        let [a, b] = along.force;
        cross_section(advance(&section(start), a, b, along.to - along.from))
    }

    fn tip(&self, start: &CrossSection, s: f64, [a, b]: [f64; 2]) -> (CrossSection, [f64; 2]) {
        let (end, by) = advance_with_sensitivities(&section(start), a, b, 1.0 - s);
        (cross_section(end), [by.by_a[3], by.by_b[3]])
    }

    fn moment<T: Scalar>(&self, at: &CrossSection<T>, natural: T) -> T {
        at.bend - natural
    }

    fn curvature(&self, at: &CrossSection, _s: f64) -> f64 {
        at.bend
    }

    fn has_joints(&self) -> bool {
        false
    }

    /// That of the curvature.
    fn next_zero(&self, start: &CrossSection, s: f64, [a, b]: [f64; 2]) -> Option<f64> {
        Some(s + inflection(&section(start), a, b)?)
    }
}

fn section<T>(CrossSection { x, y, phi, bend }: &CrossSection<T>) -> Section<T>
where
    T: Copy,
{
    Section { x: *x, y: *y, phi: *phi, kappa: *bend }
}

fn cross_section<T>(Section { x, y, phi, kappa }: Section<T>) -> CrossSection<T> {
    CrossSection { x, y, phi, bend: kappa }
}

/// Any rod on any clamp, followed step by step. The poses are those of the support.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Any<'a, R>(pub &'a R);

impl<R: PhysicalRod> Inverse for Any<'_, R> {
    const UNIFORM: bool = false;

    fn tells_last(&self) -> bool {
        // without moment, and under the same moment everywhere
        [0.0, 1.0].into_iter().all(|moment| {
            let (least, most) = self.0.model().curvature_bounds((0.0, moment), (1.0, moment), 0.0);
            least == most
        })
    }

    fn first(&self, clamp: &Clamp) -> Result<MomentZero, NoContact> {
        if clamp.reactions == Vector3::zeros() {
            return Err(NoContact::Free);
        }
        let bent = Bent::new(self.0, clamp);
        bent.zeros().next().and_then(|s| zero(&bent, clamp, s)).ok_or(NoContact::NoMomentZero)
    }

    fn by_tip(&self, first: &MomentZero, clamp: &Clamp) -> Option<MomentZero> {
        let bent = Bent::new(self.0, clamp);
        let from_tip = |s: &f64| (s - 1.0).abs();
        let nearest = bent.zeros().min_by(|u, v| from_tip(u).total_cmp(&from_tip(v)))?;
        (from_tip(&nearest) < from_tip(&first.s)).then(|| zero(&bent, clamp, nearest)).flatten()
    }

    fn gradient_at(&self, clamp: &Clamp, s: f64) -> (Section, SectionGradient) {
        let bent = Bent::new(self.0, clamp);
        let (at, columns, by_phi0) = bent.by_reactions(s);
        let (sin, cos) = at.phi.sin_cos();
        let kappa = bent.model.curvature_at(s, at.moment);
        let gradient = SectionGradient {
            by_reactions: Matrix4x3::from_columns(&columns.map(Vector4::from)),
            by_phi0: by_phi0.into(),
            by_s: Vector4::new(cos, sin, kappa, bent.moment_rate(&at)),
        };
        (Section { x: at.x, y: at.y, phi: at.phi, kappa }, gradient)
    }

    fn criterion(&self, clamp: &Clamp, first: Option<&MomentZero>) -> Option<(f64, Vector3<f64>)> {
        let found = first?;
        let ([a, b], (sin, cos)) = (clamp.force(), found.section.phi.sin_cos());
        // B = -f0x and A = f0y change it, and so does the slope angle there
        let by_force = Vector3::new(-2.0 * cos, -2.0 * sin, 0.0);
        let turns = found.by_reactions.row(2).transpose() * (-2.0 * (b * sin + a * cos));
        let (rubbing, of_rubbing) = clamp.rubbing();
        Some((2.0 * (b * cos - a * sin) - rubbing, by_force + turns - of_rubbing))
    }

    fn base<T: Carried>(&self, pose: [T; 3], reactions: [T; 3], _natural: T) -> CrossSection<T> {
        let [x, y, phi] = pose.map(T::to_f64);
        let compliance = self.0.clamp(Pose { x, y, phi }).law().map_or([[0.0; 3]; 3], |law| law.compliance);
        let given_way = |i: usize| {
            compliance[i].into_iter().zip(reactions).fold(pose[i], |at, (by, reaction)| at - T::from_f64(by) * reaction)
        };
        CrossSection { x: given_way(0), y: given_way(1), phi: given_way(2), bend: -reactions[2] }
    }

    fn carry<T: Carried>(&self, start: &CrossSection<T>, along: &RodInterval<T>) -> CrossSection<T> {
        T::carry(self.0.model(), start, along)
    }

    fn tip(&self, start: &CrossSection, s: f64, [a, b]: [f64; 2]) -> (CrossSection, [f64; 2]) {
        let (end, by) = self.0.model().carry_with_sensitivities(s, &cut(start), a, b, 1.0 - s);
        (of_cut(end), [by.by_a[3], by.by_b[3]])
    }

    fn moment<T: Scalar>(&self, at: &CrossSection<T>, _natural: T) -> T {
        at.bend
    }

    fn curvature(&self, at: &CrossSection, s: f64) -> f64 {
        self.0.model().curvature_at(s, at.bend)
    }

    fn has_joints(&self) -> bool {
        !self.0.model().joints().is_empty()
    }

    fn next_zero(&self, start: &CrossSection, s: f64, force: [f64; 2]) -> Option<f64> {
        zeros(self.0.model(), s, cut(start), force).next()
    }
}

/// The zero of the moment at an arc length; none where the moment is stationary.
fn zero<M: RodModel>(bent: &Bent<'_, M>, clamp: &Clamp, s: f64) -> Option<MomentZero> {
    let (at, columns, by_phi0) = bent.by_reactions(s);
    let (rate, kappa) = (bent.moment_rate(&at), bent.model.curvature_at(s, at.moment));
    if rate == 0.0 || !at.x.is_finite() {
        return None;
    }
    let (sin, cos) = at.phi.sin_cos();
    let s_by_reactions = Vector3::from(columns.map(|column| -column[3] / rate));
    let slide = Vector3::new(cos, sin, kappa);
    let at_s = Matrix3::from_columns(&columns.map(|[x, y, phi, _]| Vector3::new(x, y, phi)));
    let [x, y, phi, moment] = by_phi0;
    Some(MomentZero {
        s,
        section: Section { x: at.x, y: at.y, phi: at.phi, kappa },
        force: bent.a.hypot(bent.b),
        alpha: clamp.alpha(at.phi),
        s_by_reactions,
        by_reactions: at_s + slide * s_by_reactions.transpose(),
        by_phi0: Vector3::new(x, y, phi) - slide * (moment / rate),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::{ElasticClamp, Elastica, GeneralElastica, Load, Mounted, Pose, Rod, RodSection, Units};

    #[test]
    fn the_criterion_tells_of_the_last_contact_where_the_rod_is_the_same_all_along() {
        let wire = Rod::new(1.0, 1.0).unwrap();
        let springs = ElasticClamp::springs(Some(100.0), None, Some(20.0)).unwrap();
        assert!(Any(&wire).tells_last() && Any(&Mounted::new(wire, springs)).tells_last());
        assert!(Any(&wire.with_natural_curvature(0.5).unwrap()).tells_last());
        assert!(!Any(&Rod::tapered(1.0, 0.01, 0.0099, 1.0).unwrap()).tells_last());
        let section =
            |bending_stiffness, natural_curvature| RodSection { length: 0.5, bending_stiffness, natural_curvature };
        for outer in [section(0.9, 0.0), section(1.1, 0.0), section(1.0, 0.1), section(1.0, -0.1)] {
            assert!(!Any(&Rod::sections(1.0, &[section(1.0, 0.0), outer]).unwrap()).tells_last());
        }
    }

    /// The rod of the closed forms, followed step by step, gives the same; and all derivatives are those of differences.
    #[test]
    fn the_step_by_step_inverse_agrees_with_the_closed_forms_and_with_differences() {
        let rod = Rod::new(1.0, 1.0).unwrap();
        let at = Pose { x: 0.1, y: -0.4, phi: 1.5 };
        let soft = Mounted::new(
            Rod::tapered(1.0, 0.01, 0.008, 1.0).unwrap(),
            ElasticClamp::springs(Some(4e-7), None, Some(4e-8)).unwrap(),
        );
        for load in [Load { s: 1.0, force: 2.0, alpha: 1.0 }, Load { s: 0.8, force: 3.0, alpha: 1.2 }] {
            let bent = Elastica::under_loads(rod.units(), at, &[load]).unwrap().0;
            let clamp = Clamp::new(rod.units(), at, bent.reactions());
            let [closed, found] = [Uniform.first(&clamp).unwrap(), Any(&rod).first(&clamp).unwrap()];
            assert!((closed.s - load.s).abs() < 1e-13 && (found.s - closed.s).abs() < 1e-13);
            assert!((found.by_reactions - closed.by_reactions).norm() < 1e-11);
            assert!((found.s_by_reactions - closed.s_by_reactions).norm() < 1e-11);
            let (by_steps, closed_form) = (Any(&rod).gradient_at(&clamp, 0.7).1, Uniform.gradient_at(&clamp, 0.7).1);
            assert!((by_steps.by_reactions - closed_form.by_reactions).norm() < 1e-12);
            assert!((by_steps.by_phi0 - closed_form.by_phi0).norm() < 1e-12);
            let k = Any(&rod).criterion(&clamp, Some(&found)).unwrap();
            let closed_form = Uniform.criterion(&clamp, None).unwrap();
            assert!((k.0 - closed_form.0).abs() < 1e-12);
            // the uniform rod's criterion does not depend on where the zero is: the derivatives are the same too
            assert!((k.1 - closed_form.1).norm() < 1e-11, "{} {}", k.1, closed_form.1);
            // of a soft cone by differences, under a load of its own
            let (shape, _) = GeneralElastica::under_loads(soft.rod(), Units::ONE, at, &[load]).unwrap();
            let clamp = Clamp::new(Units::ONE, at, shape.reactions());
            let of = |clamp: &Clamp| {
                let first = Any(&soft).first(clamp).unwrap();
                let k = Any(&soft).criterion(clamp, Some(&first)).unwrap().0;
                Vector4::new(first.s, first.section.x, first.section.phi, k)
            };
            let first = Any(&soft).first(&clamp).unwrap();
            let k = Any(&soft).criterion(&clamp, Some(&first)).unwrap().1;
            for c in 0..3 {
                let by = |h: f64| {
                    let mut moved = clamp;
                    moved.reactions[c] += h;
                    of(&moved)
                };
                let h = 1e-5;
                let difference = (by(h) - by(-h)) / (2.0 * h);
                let exact =
                    Vector4::new(first.s_by_reactions[c], first.by_reactions[(0, c)], first.by_reactions[(2, c)], k[c]);
                assert!((difference - exact).norm() < 1e-7 * (1.0 + exact.norm()), "{c}: {difference} {exact}");
            }
        }
    }
}
