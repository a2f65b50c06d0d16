//! Rods that run through a roller ahead of the clamp, against the integration of the differential equation from the clamp, the gradient of
//! the energy, limits, symmetry and a beam in closed form.

use super::scans::{bent, cone, o1, two_sections};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use vibrissa::contact::{ContactKind, Derivatives, EventKind, Outcome, StopReason};
use vibrissa::rod::{
    Cut, Guided, Hold, Method, MultiPoint, NewtonOptions, NewtonWorkspace, Ode, PhysicalRod, Propagator, Support,
    Supports, Uniform, Units, solve,
};
use vibrissa::{CircularArc, ClampPath, Composite, Pose, Rod, State, Sweep, equilibrium};

/// The law of a rod of length 1, as the judge knows it: curvature by arc length and moment.
pub type Law<'a> = &'a dyn Fn(f64, f64) -> f64;

/// What may be off (L, rad, E I / L), where the integrator's tolerance is 1e-14 a step.
const ERROR: f64 = 1e-9;

fn at(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

fn scan(rod: &impl PhysicalRod, step: f64) -> Outcome {
    Sweep::new(rod, &o1(), ClampPath::new(at(0.8), at(-0.9)).unwrap(), step).unwrap().run()
}

fn phases(outcome: &Outcome) -> Vec<String> {
    outcome.events.iter().map(|event| event.to().to_string()).collect()
}

/// The rod walked from the clamp under what clamp, roller and contacts push with: how far it misses the roller, its contacts, and the end
/// without force and moment. `jumps` are the places where the law jumps.
pub fn missed(state: &State, law: Law<'_>, jumps: &[f64], distance: f64) -> f64 {
    let ode = Ode::with_law(law, Method::Dop853, 1e-14).unwrap();
    let carry = |mut from: f64, mut cut: Cut, a: f64, b: f64, to: f64| {
        let borders: Vec<f64> = jumps.iter().copied().filter(|jump| (from..to).contains(jump)).chain([to]).collect();
        for border in borders {
            // the law is asked at the ends of a step, and has two values at a jump
            let inside = 1e-14 * f64::from(u8::from(jumps.contains(&from)));
            cut = ode.advance(from + inside, &cut, a, b, border - from - inside).unwrap();
            from = border;
        }
        cut
    };
    let Pose { x, y, phi } = state.pose;
    let mut cut = Cut { x, y, phi, moment: -state.reactions.m0z };
    let (mut a, mut b) = (state.reactions.f0y, -state.reactions.f0x);
    let roller = state.roller.as_ref().unwrap();
    // where the unloaded rod is
    let rest = carry(0.0, Cut { moment: 0.0, ..cut }, 0.0, 0.0, distance);
    cut = carry(0.0, cut, a, b, roller.s);
    let mut worst = (cut.x - rest.x).hypot(cut.y - rest.y);
    worst = worst.max((roller.x - rest.x).hypot(roller.y - rest.y)).max((roller.alpha - cut.phi).abs());
    (a, b) = (a - roller.force * cut.phi.cos(), b - roller.force * cut.phi.sin());
    let mut s = roller.s;
    for contact in &state.contacts {
        cut = carry(s, cut, a, b, contact.s);
        s = contact.s;
        worst = worst.max((cut.x - contact.x).hypot(cut.y - contact.y));
        if contact.kind == ContactKind::Tangent {
            worst = worst.max((cut.phi - contact.alpha).sin().abs());
        }
        assert!(contact.force > -1e-12 && contact.s > roller.s);
        (a, b) = (a - contact.force * contact.alpha.cos(), b - contact.force * contact.alpha.sin());
    }
    worst.max(cut.moment.abs()).max(a.abs()).max(b.abs())
}

fn judged(name: &str, rod: &impl PhysicalRod, law: Law<'_>, jumps: &[f64], distance: f64, step: f64) -> Outcome {
    let outcome = scan(rod, step);
    assert!(outcome.stop.is_none(), "{name}: {:?} after {:?}", outcome.stop, outcome.states.last());
    let at_events = outcome.events.iter().flat_map(|event| [&event.before, &event.after]);
    let (mut worst, mut largest, mut count) = (0.0_f64, 0.0_f64, 0);
    for state in outcome.states.iter().chain(at_events) {
        let missed = missed(state, law, jumps, distance);
        let scale = 1.0 + state.contacts.iter().map(|contact| contact.force).sum::<f64>();
        assert!(missed < ERROR * scale, "{name} at {:?}: {missed:e}, {state:?}", state.pose);
        let certificate = &state.certificate;
        assert!(certificate.residual < 1e-10 && certificate.stable && certificate.min_gap.lower > -1e-9);
        assert!(certificate.first_integral.is_none_or(|change| change < 1e-10 * scale), "{state:?}");
        let shape = state.elastica(rod).unwrap();
        assert!(shape.moment(1.0).abs() < ERROR * scale);
        worst = worst.max(missed);
        largest = largest.max(state.roller.as_ref().unwrap().force.abs());
        count += 1;
    }
    println!(
        "{name}, roller at {distance}: {count} states and sides of events, missed by {worst:e} at most, |R| up to {largest:.3}, {:?}",
        phases(&outcome)
    );
    outcome
}

#[test]
fn scans_agree_with_the_integration_from_the_clamp() {
    let uniform = Rod::new(1.0, 1.0).unwrap();
    for distance in [0.05, 0.2, 0.3] {
        let rod = Guided::new(uniform, distance).unwrap();
        let outcome = judged("uniform", &rod, &|_, m| m, &[], distance, 0.005);
        assert!(outcome.events.len() >= 5 && outcome.events.iter().any(|event| event.kind == EventKind::SnapOff));
        assert!(outcome.states.iter().any(|state| state.contacts.len() == 2));
        // the branch ends in a fold, where its equations are singular, and not where the second variation says so
        let last = outcome.events.last().unwrap();
        assert!(last.before.certificate.condition > 1e5 * last.before.contacts[0].force, "{last:?}");
        assert!(outcome.states.iter().any(|state| state.roller.as_ref().unwrap().force.abs() > 1.0));
    }
    let rod = Guided::new(cone(0.5), 0.2).unwrap();
    judged("cone to 1/2", &rod, &|s, m| m / (1.0 - 0.5 * s).powi(4), &[], 0.2, 0.01);
    let rod = Guided::new(bent(), 0.2).unwrap();
    judged("bent at rest", &rod, &|_, m| m + 0.5, &[], 0.2, 0.01);
    let rod = Guided::new(two_sections(), 0.2).unwrap();
    judged("two sections", &rod, &|s, m| if s < 0.5 { m } else { 4.0 * m }, &[0.5], 0.2, 0.01);
}

/// What clamp and roller push with together, about the clamp: the derivatives of the energy by its pose.
fn whole(state: &State) -> [f64; 3] {
    let (roller, Pose { x, y, .. }) = (state.roller.as_ref().unwrap(), state.pose);
    let (sin, cos) = roller.alpha.sin_cos();
    let (px, py) = (roller.force * sin, -roller.force * cos);
    let r = &state.reactions;
    [r.f0x + px, r.f0y + py, r.m0z + (roller.x - x) * py - (roller.y - y) * px]
}

#[test]
fn clamp_and_roller_together_are_the_gradient_of_the_energy() {
    let object = o1();
    let rod = Guided::new(Rod::new(1.0, 1.0).unwrap(), 0.2).unwrap();
    let outcome = scan(&rod, 0.1);
    let mut checked = 0;
    for state in outcome.states.iter().filter(|state| !state.contacts.is_empty()) {
        let energy = |pose| {
            let found = equilibrium(&rod, &object, pose, &state.contacts).unwrap();
            assert!(found.report.status.is_solved());
            found.state.energy
        };
        let h = 1e-3;
        for (axis, felt) in whole(state).into_iter().enumerate() {
            let moved = |by: f64| {
                let [x, y, phi] = [0, 1, 2].map(|i| if i == axis { by } else { 0.0 });
                Pose { x: state.pose.x + x, y: state.pose.y + y, phi: state.pose.phi + phi }
            };
            let pairs = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)];
            let difference: f64 =
                pairs.iter().map(|(n, w)| w * (energy(moved(n * h)) - energy(moved(-n * h))) / h).sum();
            assert!((difference - felt).abs() < 1e-8 * (1.0 + felt.abs()), "{axis}: {difference} {felt} {state:?}");
        }
        // and not those of the clamp alone
        assert!((whole(state)[2] - state.reactions.m0z).abs() > 1e-3);
        checked += 1;
    }
    assert!(checked > 8, "{checked}");
}

#[test]
fn a_roller_at_the_clamp_is_a_rigid_clamp() {
    let uniform = Rod::new(1.0, 1.0).unwrap();
    let rigid = scan(&uniform, 0.05);
    let mut last = f64::INFINITY;
    for distance in [4e-3, 2e-3, 1e-3] {
        let outcome = scan(&Guided::new(uniform, distance).unwrap(), 0.05);
        assert_eq!(phases(&outcome), phases(&rigid));
        let mut off = 0.0_f64;
        for (ours, theirs) in outcome.states.iter().zip(&rigid.states).filter(|(a, b)| a.phase() == b.phase()) {
            for (ours, theirs) in
                whole(ours).into_iter().zip([theirs.reactions.f0x, theirs.reactions.f0y, theirs.reactions.m0z])
            {
                off = off.max((ours - theirs).abs());
            }
        }
        let events = outcome.events.iter().zip(&rigid.events).map(|(a, b)| (a.pose().x - b.pose().x).abs());
        off = off.max(events.fold(0.0, f64::max));
        // half the distance, half the difference
        assert!(off < 40.0 * distance && off < 0.6 * last, "{distance}: {off}");
        last = off;
    }
}

#[test]
fn mirror_images_are_the_same() {
    let rod = Guided::new(Rod::new(1.0, 1.0).unwrap(), 0.2).unwrap();
    let disc = |x| Composite::single(CircularArc::new([x, 0.75], 0.06, 0.0, TAU).unwrap()).unwrap();
    let run = |sign: f64| {
        let pose = |x: f64| Pose { x: sign * x, y: 0.0, phi: FRAC_PI_2 - sign * 0.1 };
        Sweep::new(&rod, &disc(sign * 0.1), ClampPath::new(pose(0.6), pose(-0.6)).unwrap(), 0.02).unwrap().run()
    };
    let (one, other) = (run(1.0), run(-1.0));
    assert!(one.stop.is_none() && phases(&one) == phases(&other) && one.states.len() == other.states.len());
    let mut largest = 0.0_f64;
    for (a, b) in one.states.iter().zip(&other.states) {
        let [r, m] = [a, b].map(|state| state.roller.as_ref().unwrap());
        assert!(
            (r.force + m.force).abs() < 1e-9 && (r.s - m.s).abs() < 1e-11 && (r.alpha + m.alpha - PI).abs() < 1e-11
        );
        assert!((a.reactions.f0x + b.reactions.f0x).abs() < 1e-9 && (a.reactions.m0z + b.reactions.m0z).abs() < 1e-10);
        largest = largest.max(r.force.abs());
    }
    assert!(largest > 1.0);
}

/// A beam built in at 0, supported at d and pushed at its end by w: the deflection is that of the overhang c = 1 - d as a cantilever and by
/// the turn at the support, F c^3 / 3 + F c^2 d / 4, the moment at the clamp is half of that at the support, the other way, and the support
/// pushes with F + 3 F c / 2 d.
#[test]
fn a_beam_that_is_pushed_a_little_is_that_of_the_textbook() {
    /// A ceiling y = -w that pushes the tip down.
    struct Ceiling(f64);
    impl Supports for Ceiling {
        fn count(&self) -> usize {
            1
        }
        fn hold(&self, _: usize) -> Hold {
            Hold::Tip
        }
        fn support(&self, _: usize, t: f64) -> Support {
            Support { x: t, y: -self.0, alpha: 0.0, speed: 1.0, turning: 0.0 }
        }
    }
    for d in [0.1, 0.2, 0.5, 0.8] {
        let rod = Guided::new(Rod::new(1.0, 1.0).unwrap(), d).unwrap();
        let problem =
            MultiPoint { rod: Uniform, clamp: rod.clamp(Pose { x: 0.0, y: 0.0, phi: 0.0 }), supports: &Ceiling(1e-4) };
        let mut u = [1.0, 1e-4, 0.0];
        let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        assert!(report.status.is_solved(), "{d}: {report:?}");
        let c = 1.0 - d;
        let force = 1e-4 / (c.powi(3) / 3.0 + c * c * d / 4.0);
        let (roller, felt) = (problem.roller(&u).unwrap(), problem.elastica(&u, Units::ONE).reactions());
        let close = |ours: f64, theirs: f64| (ours - theirs).abs() < 1e-6 * theirs.abs();
        assert!(close(u[1], force), "{d}: {u:?}");
        // the roller pushes up, the contact and the clamp down
        assert!(close(-roller.force, force * (1.0 + 1.5 * c / d)), "{d}: {roller:?}");
        assert!(close(felt.f0y, -1.5 * force * c / d), "{d}: {felt:?}");
        assert!(close(felt.m0z, -0.5 * force * c), "{d}: {felt:?}");
    }
}

#[test]
fn an_object_before_the_roller_stops_the_sweep() {
    let rod = Guided::new(Rod::new(1.0, 1.0).unwrap(), 0.3).unwrap();
    let disc = Composite::single(CircularArc::new([0.0, 0.15], 0.05, 0.0, TAU).unwrap()).unwrap();
    let pose = |x: f64| Pose { x, y: 0.0, phi: FRAC_PI_2 };
    let path = ClampPath::new(pose(0.5), pose(-0.5)).unwrap();
    let outcome = Sweep::new(&rod, &disc, path, 0.01).unwrap().run();
    assert_eq!(outcome.stop.unwrap().reason, StopReason::BeforeRoller);
    assert!((outcome.states.last().unwrap().pose.x - 0.05).abs() < 0.011);
    // a rod that is held beyond the roller comes upon it as well
    let far = Composite::single(CircularArc::new([0.1, 0.8], 0.05, 0.0, TAU).unwrap()).unwrap();
    let outcome = Sweep::new(&rod, &[far, disc], path, 0.01).unwrap().run();
    assert_eq!(outcome.stop.unwrap().reason, StopReason::BeforeRoller);
    assert_eq!(outcome.states.last().unwrap().contacts.len(), 1);
}

#[test]
fn a_sweep_goes_on_from_a_state() {
    let rod = Guided::new(Rod::new(1.0, 1.0).unwrap(), 0.2).unwrap();
    let (object, whole) = (o1(), scan(&rod, 0.05));
    let mut resumed = 0;
    for state in whole.states.iter().filter(|state| !state.contacts.is_empty()) {
        let rest = ClampPath::new(state.pose, at(-0.9)).unwrap();
        let outcome = Sweep::from_state(&rod, &object, state, rest, 0.05).unwrap().run();
        assert!(outcome.stop.is_none());
        let [here, there] = [&outcome.states[0], state].map(|state| state.roller.as_ref().unwrap().force);
        assert!((here - there).abs() < 1e-10 * (1.0 + there.abs()), "{here} {there}");
        let left: Vec<_> = whole.events.iter().filter(|event| event.pose().x < state.pose.x).collect();
        assert_eq!(outcome.events.len(), left.len());
        for (ours, theirs) in outcome.events.iter().zip(left) {
            assert!((ours.pose().x - theirs.pose().x).abs() < 1e-9 && ours.to() == theirs.to());
        }
        assert!(Derivatives::new(&rod, &object, state).unwrap_err().to_string().contains("roller"));
        resumed += 1;
    }
    assert!(resumed > 15);
}
