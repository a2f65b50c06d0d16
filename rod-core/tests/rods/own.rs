//! A model of a user's own through everything that takes a model: it gives what the library's model of the same rod gives.

use rod_core::{
    Cut, CutSensitivities, GeneralElastica, Hold, Load, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, RodModel,
    RodSection, Sections, Segment, Support, Supports, Uniform, Units, solve,
};

/// The uniform rod with a constant natural curvature: it turns like the straight one whose moment is m + kappa0.
#[derive(Clone, Copy)]
struct Arc(f64);

impl Arc {
    fn straight(&self, cut: &Cut) -> Cut {
        Cut { moment: cut.moment + self.0, ..*cut }
    }
}

impl RodModel for Arc {
    fn carry_with_sensitivities(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        let (end, derivatives) = Uniform.carry_with_sensitivities(s, &self.straight(start), a, b, length);
        (Cut { moment: end.moment - self.0, ..end }, derivatives)
    }
    fn curvature_at(&self, _s: f64, moment: f64) -> f64 {
        moment + self.0
    }
    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        let straight = Segment { start: self.straight(&segment.start), ..*segment };
        let turned = end.phi - segment.start.phi;
        let half_square = Uniform.bending_energy(&straight, to, &self.straight(end));
        half_square - self.0 * turned + 0.5 * self.0 * self.0 * (to - segment.s)
    }
    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        let straight = Segment { start: self.straight(&segment.start), ..*segment };
        Uniform.largest_curvature(&straight, to, &self.straight(end))
    }
    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64) {
        Uniform.curvature_bounds((from.0, from.1 + self.0), (to.0, to.1 + self.0), force)
    }
    fn least_stiffness(&self, _from: f64, _to: f64) -> f64 {
        1.0
    }
}

/// The parabola y = 5 x^2 from below, on which the rod lies: t is x.
struct Ceiling;

impl Supports for Ceiling {
    fn count(&self) -> usize {
        1
    }
    fn hold(&self, _: usize) -> Hold {
        Hold::Tangent { offset: 0.0 }
    }
    fn support(&self, _: usize, t: f64) -> Support {
        let square = 1.0 + 100.0 * t * t;
        Support { x: t, y: 5.0 * t * t, alpha: (10.0 * t).atan(), speed: square.sqrt(), turning: 10.0 / square }
    }
}

#[test]
fn a_model_of_ones_own_is_as_good_as_the_librarys() {
    let (own, section) = (Arc(-0.6), RodSection { length: 1.0, bending_stiffness: 1.0, natural_curvature: -0.6 });
    let library = Sections::new(&[section]).unwrap();
    let clamp = Pose { x: -0.4, y: -0.2, phi: 0.9 };
    let solved = |problem: &dyn rod_core::System| {
        let mut u = vec![0.05, 1.0, 0.5];
        let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        assert!(report.status.is_solved() && report.residual < 1e-13, "{report:?}");
        u
    };
    let (ours, theirs) =
        (MultiPoint { rod: own, clamp, supports: &Ceiling }, MultiPoint { rod: &library, clamp, supports: &Ceiling });
    let (u, v) = (solved(&ours), solved(&theirs));
    assert!(u[1].abs() > 0.1 && u.iter().zip(&v).all(|(u, v)| (u - v).abs() < 1e-13), "{u:?} {v:?}");

    let (ours, theirs) = (ours.elastica(&u, Units::ONE), theirs.elastica(&v, Units::ONE));
    assert!((ours.bending_energy() - theirs.bending_energy()).abs() < 1e-14);
    assert!((ours.largest_curvature() - theirs.largest_curvature()).abs() < 1e-13);
    // the free end is bent as at rest
    assert!((ours.at(1.0).kappa + 0.6).abs() < 1e-13 && (ours.at(1.0).y - theirs.at(1.0).y).abs() < 1e-13);
    // and the energy is that of samples: 1/2 m^2 / EI
    let n = 2000;
    let density = |i: usize| 0.5 * (ours.at(i as f64 / n as f64).kappa + 0.6).powi(2);
    let middles = (0..n).map(|i| 0.5 * (density(i) + density(i + 1)) / n as f64).sum::<f64>();
    assert!((ours.bending_energy() - middles).abs() < 1e-5 * middles, "{} {middles}", ours.bending_energy());

    let loads = [Load { s: 0.7, force: 2.0, alpha: 0.3 }];
    let [(one, _), (other, _)] = [&own as &dyn rod_core::Propagator, &library]
        .map(|rod| GeneralElastica::under_loads(rod, Units::ONE, clamp, &loads).unwrap());
    assert!((one.at(1.0).unwrap().y - other.at(1.0).unwrap().y).abs() < 1e-13);
}
