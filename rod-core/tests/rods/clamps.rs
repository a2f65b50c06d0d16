//! Clamps that give way, against the integration of the differential equation from the displaced base, differences of equilibria, the
//! energy, limits and symmetries.

use rod_core::{
    Clamp, Cone, Cut, Elastic, ElasticClamp, Hold, Method, MultiPoint, NewtonOptions, NewtonWorkspace, Ode, Pivot,
    Pose, Propagator, Reactions, RodModel, Smooth, SolveStatus, Support, Supports, Uniform, Units, solve,
};
use std::f64::consts::PI;

/// Circles of radius 0.1 about (x, y) with the solid inside: t is the tangent angle.
struct Pegs(Vec<(Hold, [f64; 2])>);

const RADIUS: f64 = 0.1;
const LYING: Hold = Hold::Tangent { offset: 0.0 };

impl Supports for Pegs {
    fn count(&self) -> usize {
        self.0.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.0[j].0
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let [x, y] = self.0[j].1;
        Support { x: x + RADIUS * t.sin(), y: y - RADIUS * t.cos(), alpha: t, speed: RADIUS, turning: 1.0 }
    }
}

/// The same seen in the mirror y = 0, with the solid on the left again.
struct Mirrored<'a>(&'a Pegs);

impl Supports for Mirrored<'_> {
    fn count(&self) -> usize {
        self.0.count()
    }
    fn hold(&self, j: usize) -> Hold {
        match self.0.hold(j) {
            Hold::Tangent { offset } => Hold::Tangent { offset: -PI - offset },
            Hold::Tip => Hold::Tip,
        }
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let Support { x, y, alpha, speed, turning } = self.0.support(j, -t);
        Support { x, y: -y, alpha: PI - alpha, speed, turning }
    }
}

/// A rod below a peg, and one below a peg and over another at its tip, with guesses.
fn scenes() -> [(Pegs, Vec<f64>); 2] {
    let peg = |x| (LYING, [x, 0.02]);
    let over = (Hold::Tip, [0.97, -0.08]);
    [(Pegs(vec![peg(0.6)]), vec![-0.1, 1.0, 0.6]), (Pegs(vec![peg(0.5), over]), vec![-0.1, 4.0, 0.5, PI, 2.0, 0.1])]
}

const SUPPORT: Pose = Pose { x: 0.0, y: 0.0, phi: 0.05 };
/// Symmetric, positive definite.
const COUPLED: [[f64; 3]; 3] = [[0.011, 0.003, -0.008], [0.003, 0.007, 0.006], [-0.008, 0.006, 0.05]];
const NONE: [[f64; 3]; 3] = [[0.0; 3]; 3];

fn solved<S: Supports, M: RodModel, C: Clamp>(problem: &MultiPoint<'_, S, M, C>, guess: &[f64]) -> Vec<f64> {
    let mut u = guess.to_vec();
    let mut solve = || solve(problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
    // once more from there, for what the tolerance left
    let (first, report) = (solve(), solve());
    assert!(first.status.is_solved() && report.status.is_solved() && report.residual < 1e-12, "{first:?} {report:?}");
    u
}

/// The equilibrium and what the clamp feels.
fn held<S: Supports, C: Clamp>(supports: &S, clamp: C, guess: &[f64]) -> (Vec<f64>, Reactions) {
    let problem = MultiPoint { rod: Uniform, clamp, supports };
    let u = solved(&problem, guess);
    let reactions = problem.elastica(&u, Units::ONE).reactions();
    (u, reactions)
}

fn numbers(&Reactions { f0x, f0y, m0z }: &Reactions) -> [f64; 3] {
    [f0x, f0y, m0z]
}

fn gives(compliance: &[[f64; 3]; 3], reactions: &Reactions) -> [f64; 3] {
    let r = numbers(reactions);
    compliance.map(|row| (0..3).map(|i| row[i] * r[i]).sum())
}

fn moved(pose: Pose, axis: usize, by: f64) -> Pose {
    let [x, y, phi] = [0, 1, 2].map(|i| if i == axis { by } else { 0.0 });
    Pose { x: pose.x + x, y: pose.y + y, phi: pose.phi + phi }
}

fn unit(axis: usize) -> Pose {
    moved(Pose { x: 0.0, y: 0.0, phi: 0.0 }, axis, 1.0)
}

/// The derivative of three numbers at 0 by central differences of order 6.
fn derivative(of: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
    let h = 1e-3;
    let pairs = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)];
    let terms = pairs.map(|(step, weight)| {
        let (up, down) = (of(step * h), of(-step * h));
        [0, 1, 2].map(|i| weight * (up[i] - down[i]) / h)
    });
    [0, 1, 2].map(|i| terms.iter().map(|term| term[i]).sum())
}

fn close(what: &str, ours: [f64; 3], theirs: [f64; 3], most: f64) {
    for (ours, theirs) in ours.into_iter().zip(theirs) {
        assert!((ours - theirs).abs() < most * (1.0 + theirs.abs()), "{what}: {ours:?} {theirs:?}");
    }
}

/// How far off the contacts, and what is left of force and moment, where `Dop853` integrates from the base under the reactions.
fn missed(law: impl Fn(f64, f64) -> f64, base: Pose, reactions: &Reactions, supports: &Pegs, u: &[f64]) -> f64 {
    let rod = Ode::with_law(law, Method::Dop853, 1e-14).unwrap();
    let (mut a, mut b) = (reactions.f0y, -reactions.f0x);
    let mut cut = Cut { x: base.x, y: base.y, phi: base.phi, moment: -reactions.m0z };
    let (mut s, mut worst) = (0.0, 0.0_f64);
    for (j, v) in u.chunks_exact(3).enumerate() {
        let at = supports.support(j, v[0]);
        let (to, phi) = if supports.hold(j) == Hold::Tip { (1.0, v[2]) } else { (v[2], at.alpha) };
        cut = rod.advance(s, &cut, a, b, to - s).unwrap();
        s = to;
        worst = worst.max((cut.x - at.x).abs()).max((cut.y - at.y).abs()).max((cut.phi - phi).abs());
        (a, b) = (a - v[1] * at.alpha.cos(), b - v[1] * at.alpha.sin());
    }
    worst.max(a.abs()).max(b.abs()).max(cut.moment.abs())
}

#[test]
fn a_rod_integrated_from_the_displaced_base_meets_its_contacts() {
    for (supports, guess) in &scenes() {
        let (u, reactions) = held(supports, Elastic { pose: SUPPORT, compliance: COUPLED }, guess);
        let [x, y, phi] = gives(&COUPLED, &reactions);
        let base = Pose { x: SUPPORT.x - x, y: SUPPORT.y - y, phi: SUPPORT.phi - phi };
        assert!(u[1] > 0.1 && x.abs().min(y.abs()).min(phi.abs()) > 1e-4, "{u:?} {x} {y} {phi}");
        let miss = missed(|_, m| m, base, &reactions, supports, &u);
        assert!(miss < 1e-12, "{miss:e}");

        // a cone
        let cone = Smooth::new(Cone { taper: 0.5 }).unwrap();
        let clamp = Elastic { pose: SUPPORT, compliance: COUPLED };
        let problem = MultiPoint { rod: &cone, clamp, supports };
        let u = solved(&problem, &u);
        let shape = problem.elastica(&u, Units::ONE);
        let [x, y, phi] = gives(&COUPLED, &shape.reactions());
        let base = Pose { x: SUPPORT.x - x, y: SUPPORT.y - y, phi: SUPPORT.phi - phi };
        let miss = missed(|s, m| m / (1.0 - 0.5 * s).powi(4), base, &shape.reactions(), supports, &u);
        assert!(miss < 1e-11, "{miss:e}");
        // shapes begin at the base
        assert!((shape.at(0.0).y - base.y).abs() < 1e-12 && (shape.at(0.0).phi - base.phi).abs() < 1e-12);
    }
}

#[test]
fn stiff_springs_are_the_rigid_clamp() {
    for (supports, guess) in &scenes() {
        let (rigid, reactions) = held(supports, SUPPORT, guess);
        for stiffness in [1e15, f64::INFINITY] {
            let clamp = ElasticClamp::springs(Some(stiffness), Some(stiffness), Some(stiffness)).unwrap();
            let (u, ours) = held(supports, clamp.at(SUPPORT, &Units::ONE), guess);
            assert!(u.iter().zip(&rigid).all(|(u, v)| (u - v).abs() < 1e-12 * (1.0 + v.abs())), "{u:?} {rigid:?}");
            close("reactions", numbers(&ours), numbers(&reactions), 1e-12);
        }
        // and tend to it like the compliance
        let linear = MultiPoint { rod: Uniform, clamp: SUPPORT, supports }.linearise(&rigid);
        let rate = linear.response_to_compliance(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
        let by = |stiffness: f64| {
            let clamp = ElasticClamp::springs(Some(stiffness), Some(stiffness), Some(stiffness)).unwrap();
            let ours = numbers(&held(supports, clamp.at(SUPPORT, &Units::ONE), &rigid).1);
            [0, 1, 2].map(|i| stiffness * (ours[i] - numbers(&reactions)[i]))
        };
        let (near, far) = (by(1e6), by(2e6));
        let rest = [0, 1, 2].map(|i| 2.0 * far[i] - near[i]);
        close("rate", numbers(&rate.reactions), rest, 1e-6);
    }
}

#[test]
fn derivatives_are_differences_of_equilibria() {
    for (supports, guess) in &scenes() {
        // of the rigid clamp, too, by compliances from 0
        for compliance in [COUPLED, NONE] {
            let at = |pose, compliance| Elastic { pose, compliance };
            let (u, reactions) = held(supports, at(SUPPORT, compliance), guess);
            let linear = MultiPoint { rod: Uniform, clamp: at(SUPPORT, compliance), supports }.linearise(&u);
            let rigid = MultiPoint { rod: Uniform, clamp: SUPPORT, supports }.linearise(&u);
            let rest = vec![Default::default(); supports.count()];
            let mut stiffness = [[0.0; 3]; 3];
            for (axis, row) in stiffness.iter_mut().enumerate() {
                let by = |h: f64| numbers(&held(supports, at(moved(SUPPORT, axis, h), compliance), &u).1);
                let ours = linear.reactions_to_clamp(unit(axis)).unwrap();
                close("by the pose", numbers(&ours), derivative(by), 1e-8);
                assert_eq!(linear.response(unit(axis), &rest).unwrap().reactions, ours);
                *row = numbers(&ours);
            }
            for i in 0..3 {
                for j in 0..3 {
                    // the energy is a function of the pose of the support
                    assert!((stiffness[i][j] - stiffness[j][i]).abs() < 1e-11 * (1.0 + stiffness[i][j].abs()));
                    let mut change = NONE;
                    (change[i][j], change[j][i]) = (1.0, 1.0);
                    let by = |h: f64| {
                        let mut compliance = compliance;
                        (0..9).for_each(|k| compliance[k / 3][k % 3] += 0.1 * h * change[k / 3][k % 3]);
                        numbers(&held(supports, at(SUPPORT, compliance), &u).1).map(|r| r / 0.1)
                    };
                    let ours = linear.response_to_compliance(&change).unwrap();
                    close("by a compliance", numbers(&ours.reactions), derivative(by), 1e-8);
                    if compliance == NONE {
                        let same = rigid.response_to_compliance(&change).unwrap();
                        close("from rigid", numbers(&same.reactions), numbers(&ours.reactions), 1e-10);
                    }
                }
            }
            // the work of the stage is what rod and springs store
            let energy = |pose: Pose, compliance| {
                let clamp = at(pose, compliance);
                let (u, reactions) = held(supports, clamp, &u);
                let shape = MultiPoint { rod: Uniform, clamp, supports }.elastica(&u, Units::ONE);
                shape.bending_energy() + clamp.energy(&reactions)
            };
            let work = [0, 1, 2].map(|axis| derivative(|h| [energy(moved(SUPPORT, axis, h), compliance), 0.0, 0.0])[0]);
            close("work", work, numbers(&reactions), 1e-9);
        }
    }
}

#[test]
fn mirror_images_and_other_units_are_the_same_equilibrium() {
    for (supports, guess) in &scenes() {
        let (u, reactions) = held(supports, Elastic { pose: SUPPORT, compliance: COUPLED }, guess);
        let sign = [1.0, -1.0, -1.0];
        let compliance = [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| sign[i] * sign[j] * COUPLED[i][j]));
        let pose = Pose { x: SUPPORT.x, y: -SUPPORT.y, phi: -SUPPORT.phi };
        let mut guess = u.clone();
        for (j, v) in guess.chunks_exact_mut(3).enumerate() {
            v[0] = -v[0];
            if supports.hold(j) == Hold::Tip {
                v[2] = -v[2];
            }
        }
        let (v, mirrored) = held(&Mirrored(supports), Elastic { pose, compliance }, &guess);
        assert!(v.iter().zip(&guess).all(|(v, u)| (v - u).abs() < 1e-12), "{v:?} {guess:?}");
        let [f0x, f0y, m0z] = numbers(&reactions);
        close("mirrored", numbers(&mirrored), [f0x, -f0y, -m0z], 1e-12);
    }
    // a rod of 80 mm and 3e-3 N m^2, and the same in its own units
    let units = rod_core::Rod::new(0.08, 3e-3).unwrap().units();
    let si = [units.force / units.length, units.force / units.length, units.moment];
    let springs = ElasticClamp::springs(Some(90.0 * si[0]), Some(40.0 * si[1]), Some(20.0 * si[2])).unwrap();
    let own = ElasticClamp::springs(Some(90.0), Some(40.0), Some(20.0)).unwrap();
    let (here, there) = (springs.at(SUPPORT, &units), own.at(SUPPORT, &Units::ONE));
    let matrix = [[90.0, 7.0, -3.0], [7.0, 40.0, 5.0], [-3.0, 5.0, 20.0]];
    let reaction = [units.force, units.force, units.moment];
    let displacement = [units.length, units.length, 1.0];
    let coupled = [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| matrix[i][j] * reaction[i] / displacement[j]));
    let coupled_here = ElasticClamp::stiffness(coupled).unwrap();
    let coupled_there = ElasticClamp::stiffness(matrix).unwrap().at(SUPPORT, &Units::ONE);
    for (i, stiffness) in matrix.iter().enumerate() {
        close("springs", here.compliance[i], there.compliance[i], 1e-15);
        close("coupled", coupled_here.at(SUPPORT, &units).compliance[i], coupled_there.compliance[i], 1e-15);
        let row = [0, 1, 2].map(|k: usize| (0..3).map(|j| stiffness[j] * coupled_there.compliance[j][k]).sum::<f64>());
        close("inverse", row, [0, 1, 2].map(|k| f64::from(u8::from(i == k))), 1e-14);
    }
    let reactions = Reactions { f0x: 0.3, f0y: -0.7, m0z: 0.2 };
    let in_si = Reactions { f0x: 0.3 * units.force, f0y: -0.7 * units.force, m0z: 0.2 * units.moment };
    let (energy, joule) = (coupled_there.energy(&reactions), coupled_here.energy(&in_si));
    assert!((joule / units.energy - energy).abs() < 1e-15 && energy > 0.0);
}

#[test]
fn a_pivot_carries_the_torque_that_it_is_given() {
    for (supports, guess) in &scenes() {
        // the torque of the rigid clamp turns the rod to where that holds it
        let (rigid, reactions) = held(supports, SUPPORT, guess);
        let clamp = Pivot { pose: Pose { phi: 0.3, ..SUPPORT }, torque: reactions.m0z };
        let (u, _) = held(supports, clamp, guess);
        assert!(u.iter().zip(&rigid).all(|(u, v)| (u - v).abs() < 1e-11 * (1.0 + v.abs())), "{u:?} {rigid:?}");
        // another torque: the judge starts with the angle that the rod has there
        let problem = MultiPoint { rod: Uniform, clamp: Pivot { torque: 0.8 * reactions.m0z, ..clamp }, supports };
        let u = solved(&problem, &u);
        let Cut { phi, moment, .. } = problem.base(&u);
        assert!((moment + 0.8 * reactions.m0z).abs() < 1e-12 && (phi - SUPPORT.phi).abs() > 1e-3);
        let feels = problem.elastica(&u, Units::ONE).reactions();
        assert!(missed(|_, m| m, Pose { phi, ..SUPPORT }, &feels, supports, &u) < 1e-12);

        // derivatives by the torque and by the place
        let linear = problem.linearise(&u);
        let by = |h: f64| {
            let clamp = Pivot { torque: 0.8 * reactions.m0z + h, ..clamp };
            numbers(&held(supports, clamp, &u).1)
        };
        close("by the torque", numbers(&linear.response_to_torque().unwrap().reactions), derivative(by), 1e-8);
        for axis in 0..3 {
            let by = |h: f64| {
                let pose = moved(clamp.pose, axis, h);
                numbers(&held(supports, Pivot { pose, torque: 0.8 * reactions.m0z }, &u).1)
            };
            close("by the place", numbers(&linear.reactions_to_clamp(unit(axis)).unwrap()), derivative(by), 1e-8);
        }
        assert!(MultiPoint { rod: Uniform, clamp: SUPPORT, supports }.linearise(&rigid).response_to_torque().is_none());
    }
}

#[test]
fn a_pivot_without_torque_needs_two_contacts() {
    let [(one, guess), (two, both)] = scenes();
    let pivot = Pivot { pose: SUPPORT, torque: 0.0 };
    // bent over three points: force through the pivot
    let (u, reactions) = held(&two, pivot, &both);
    assert!(
        u[1] > 1.0 && u[4] > 0.5 && reactions.m0z.abs() < 1e-13 && reactions.f0y.abs() > 0.5,
        "{u:?} {reactions:?}"
    );
    let start = MultiPoint { rod: Uniform, clamp: pivot, supports: &two }.base(&u);
    assert!(missed(|_, m| m, Pose { phi: start.phi, ..SUPPORT }, &reactions, &two, &u) < 1e-12);
    // on one contact the rod lies straight and without force
    let (u, reactions) = held(&one, pivot, &guess);
    assert!(u[1].abs() < 1e-12 && numbers(&reactions).iter().all(|r| r.abs() < 1e-12), "{u:?}");
    // where its normal goes through the pivot, any force holds it
    let ahead = Pegs(vec![(Hold::Tip, [1.0 + RADIUS, 0.0])]);
    let pose = Pose { phi: 0.0, ..SUPPORT };
    let problem = MultiPoint { rod: Uniform, clamp: Pivot { pose, torque: 0.0 }, supports: &ahead };
    let mut u = vec![-0.5 * PI, 0.5, 0.0];
    let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
    // singular but for the rounding of pi / 2
    assert!(report.status == SolveStatus::Singular || report.condition > 1e15, "{report:?} {u:?}");
    // without any nothing determines its direction
    let none = Pegs(Vec::new());
    assert!(MultiPoint { rod: Uniform, clamp: pivot, supports: &none }.base(&[]).phi.is_nan());
    let free = MultiPoint { rod: Uniform, clamp: Elastic { pose: SUPPORT, compliance: COUPLED }, supports: &none };
    assert_eq!(free.base(&[]), Cut { x: SUPPORT.x, y: SUPPORT.y, phi: SUPPORT.phi, moment: 0.0 });
}

#[test]
fn wrong_stiffnesses_are_errors_that_say_what_was_expected() {
    let text = |result: Result<ElasticClamp, rod_core::RodError>| result.unwrap_err().to_string();
    let positive = "expected a positive number, or infinity for a rigid direction";
    assert_eq!(
        text(ElasticClamp::springs(Some(0.0), None, None)),
        format!("stiffness_x of the clamp is 0.0, {positive}")
    );
    assert_eq!(
        text(ElasticClamp::springs(None, Some(f64::NAN), None)),
        format!("stiffness_y of the clamp is NaN, {positive}")
    );
    assert_eq!(
        text(ElasticClamp::springs(None, None, Some(-2.5))),
        format!("stiffness_phi of the clamp is -2.5, {positive}")
    );
    assert!(ElasticClamp::springs(None, None, Some(f64::NEG_INFINITY)).is_err());
    assert!(ElasticClamp::springs(Some(f64::MIN_POSITIVE * 1e-3), None, None).is_err());
    let matrix = |i: usize, j: usize, value: f64| {
        let mut matrix = [[4.0, 1.0, 0.5], [1.0, 3.0, 0.2], [0.5, 0.2, 2.0]];
        matrix[i][j] = value;
        ElasticClamp::stiffness(matrix)
    };
    assert!(matrix(0, 0, 4.0).is_ok());
    assert!(text(matrix(0, 1, 1.1)).contains("stiffness[0][1] of the clamp is 1.1, expected the same"));
    assert!(text(matrix(2, 2, -1.0)).contains("stiffness[2][2] of the clamp is -1.0, expected a positive"));
    assert!(text(matrix(1, 2, f64::INFINITY)).contains("stiffness[1][2] of the clamp is inf, expected a finite"));
    assert!(text(matrix(2, 2, 0.01)).contains("stiffness[2][2] of the clamp is 0.01, expected more"));
    assert!(text(matrix(0, 0, f64::NAN)).contains("NaN"));
    assert!(matrix(0, 0, 1e-320).is_err());
}
