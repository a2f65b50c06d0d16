//! Random rods past random discs, judged by an integrator of its own: DOP853 along E I(s) and kappa0(s), written down here once more.

use crate::common::numbers::Numbers;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use vibrissa::contact::{ContactKind, RollerContact};
use vibrissa::rod::{Cut, ElasticClamp, Guided, Method, Mounted, Ode, Pose, Propagator, RodSection, VaryingRod};
use vibrissa::{CircularArc, ClampPath, Composite, Rod, State, Sweep};

/// Points of a segment at which the gap is measured.
const SAMPLES: usize = 60;
/// What may be off (L, rad), relative to 1 + the largest curvature: the integrator's tolerance is 1e-12 a step.
const ERROR: f64 = 1e-8;

type Function = Box<dyn Fn(f64) -> f64>;

/// A rod of length 1 with E I = 1 at the clamp, its E I and its natural curvature as functions, and where these jump.
fn rod(numbers: &mut Numbers) -> (VaryingRod, Function, Function, Vec<f64>) {
    let bend = numbers.within(-1.5, 1.5);
    match numbers.next() % 3 {
        0 => {
            let (taper, base) = (numbers.within(-0.3, 0.85), 0.01_f64);
            let youngs_modulus = 64.0 / (PI * base.powi(4));
            let rod = Rod::tapered(1.0, base, base * (1.0 - taper), youngs_modulus).unwrap();
            let rod = rod.with_natural_curvature(bend).unwrap();
            (rod, Box::new(move |s| (1.0 - taper * s).powi(4)), Box::new(move |_| bend), Vec::new())
        }
        1 => {
            let joint = numbers.within(0.2, 0.8);
            let stiff = [1.0, numbers.within(0.1, 2.0)];
            let bent = [bend, numbers.within(-1.5, 1.5)];
            let section =
                |i: usize, length| RodSection { length, bending_stiffness: stiff[i], natural_curvature: bent[i] };
            let rod = Rod::sections(1.0, &[section(0, joint), section(1, 1.0 - joint)]).unwrap();
            let of = move |values: [f64; 2]| move |s: f64| values[usize::from(s >= joint)];
            (rod, Box::new(of(stiff)), Box::new(of(bent)), vec![joint])
        }
        _ => {
            let grows = numbers.within(-2.0, 2.0);
            let rod = Rod::new(1.0, 1.0).unwrap().with_natural_curvature(move |s: f64| bend + grows * s).unwrap();
            (rod, Box::new(|_| 1.0), Box::new(move |s| bend + grows * s), Vec::new())
        }
    }
}

/// Discs: centre and radius.
type Discs = Vec<([f64; 2], f64)>;

/// The displacement of the base by each reaction, three springs or coupled ones: K^-1 of a K that is B B' + a diagonal.
fn compliance(numbers: &mut Numbers) -> [[f64; 3]; 3] {
    let mut compliance = [[0.0; 3]; 3];
    for (i, row) in compliance.iter_mut().enumerate() {
        row[i] = 10.0_f64.powf(if i == 2 { numbers.within(-2.0, 0.0) } else { numbers.within(-4.0, -1.5) });
    }
    if numbers.next().is_multiple_of(2) {
        // a soft beam in some direction: end load and end moment
        let (size, turn) = (10.0_f64.powf(numbers.within(-2.0, -0.5)), numbers.within(-PI, PI));
        let way = [0.3 * turn.cos(), 0.3 * turn.sin(), 1.0];
        for (i, row) in compliance.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += size * way[i] * way[j];
            }
        }
    }
    compliance
}

/// Solves the three equations of a matrix by Cramer's rule.
fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |i: usize, j: usize| {
        let [a, b] = [(i + 1) % 3, (i + 2) % 3];
        let [c, d] = [(j + 1) % 3, (j + 2) % 3];
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}

/// Whether the state is an equilibrium of such a rod among the discs, its base displaced by `compliance`.
fn judge(
    state: &State,
    compliance: &[[f64; 3]; 3],
    (stiffness, natural, jumps): (&Function, &Function, &[f64]),
    discs: &Discs,
) -> Result<(), String> {
    let ode = Ode::with_law(|s, m| m / stiffness(s) + natural(s), Method::Dop853, 1e-12).unwrap();
    let felt = [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z];
    let [x, y, phi] = compliance.map(|row| row.iter().zip(felt).map(|(entry, felt)| entry * felt).sum::<f64>());
    let (base, moment) = (Pose { x: state.pose.x - x, y: state.pose.y - y, phi: state.pose.phi - phi }, -felt[2]);
    let mut cut = Cut { x: base.x, y: base.y, phi: base.phi, moment };
    let (mut a, mut b, mut from) = (state.reactions.f0y, -state.reactions.f0x, 0.0);
    let scale = 1.0 + state.contacts.iter().map(|contact| contact.force).sum::<f64>();
    let mut least = f64::INFINITY;
    // a roller is judged on its own; here it is a force across the rod
    let roller = state.roller.as_ref().map(|roller| Some((roller.s, None)));
    let ends = state.contacts.iter().map(|contact| Some((contact.s, Some(contact))));
    for end in roller.into_iter().chain(ends).chain([None]) {
        let to = end.map_or(1.0, |(s, _)| s);
        // in small steps, none of them over a jump
        let mut stops: Vec<f64> = (1..=SAMPLES).map(|k| from + (to - from) * k as f64 / SAMPLES as f64).collect();
        stops.extend(jumps.iter().filter(|jump| (from..to).contains(*jump)));
        stops.sort_by(f64::total_cmp);
        let mut at = from;
        for stop in stops.into_iter().filter(|stop| *stop > from) {
            // one side of a jump: the law is asked at the ends of a step
            let inside = 1e-13 * f64::from(u8::from(jumps.contains(&at)));
            cut = ode.advance(at + inside, &cut, a, b, stop - at - 2.0 * inside).map_err(|error| error.to_string())?;
            at = stop;
            for ([x, y], radius) in discs {
                least = least.min((cut.x - x).hypot(cut.y - y) - radius);
            }
        }
        let Some((_, contact)) = end else { break };
        let Some(contact) = contact else {
            let force = state.roller.as_ref().map_or(0.0, |roller| roller.force);
            (a, b, from) = (a - force * cut.phi.cos(), b - force * cut.phi.sin(), to);
            continue;
        };
        let off = (cut.x - contact.x).hypot(cut.y - contact.y);
        if off > ERROR * scale {
            return Err(format!("misses a contact by {off:e}"));
        }
        if contact.kind == ContactKind::Tangent && (cut.phi - contact.alpha).sin().abs() > ERROR * scale {
            return Err(format!("crosses a contact by {:e}", (cut.phi - contact.alpha).sin()));
        }
        if contact.force < -1e-9 {
            return Err(format!("a contact pulls with {:e}", contact.force));
        }
        let ([x, y], radius) = discs[contact.object];
        if ((contact.x - x).hypot(contact.y - y) - radius).abs() > ERROR {
            return Err("a contact is off its disc".into());
        }
        (a, b, from) = (a - contact.force * contact.alpha.cos(), b - contact.force * contact.alpha.sin(), to);
    }
    if cut.moment.abs() > ERROR * scale || a.abs() + b.abs() > ERROR * scale {
        return Err(format!("the tip carries the moment {:e}, the force {a:e}, {b:e}", cut.moment));
    }
    if least < -ERROR * scale {
        return Err(format!("goes through a disc by {least:e}"));
    }
    Ok(())
}

/// Whether the rod, bent by what the clamp feels, runs through the roller, which is where the rod at rest is `distance` from the clamp.
fn judge_roller(
    state: &State,
    at: &RollerContact,
    (stiffness, natural, jumps): (&Function, &Function, &[f64]),
    distance: f64,
) -> Result<(), String> {
    let ode = Ode::with_law(|s, m| m / stiffness(s) + natural(s), Method::Dop853, 1e-12).unwrap();
    let walked = |moment: f64, a: f64, b: f64, to: f64| {
        let mut cut = Cut { x: state.pose.x, y: state.pose.y, phi: state.pose.phi, moment };
        let mut from = 0.0;
        for stop in jumps.iter().copied().filter(|jump| *jump < to).chain([to]) {
            let inside = 1e-13 * f64::from(u8::from(from > 0.0));
            cut = ode.advance(from + inside, &cut, a, b, stop - from - inside).unwrap();
            from = stop;
        }
        cut
    };
    let (rest, bent) = (
        walked(0.0, 0.0, 0.0, distance),
        walked(-state.reactions.m0z, state.reactions.f0y, -state.reactions.f0x, at.s),
    );
    let off = (rest.x - bent.x).hypot(rest.y - bent.y).max((at.x - rest.x).hypot(at.y - rest.y));
    let scale = 1.0 + at.force.abs();
    if off > ERROR * scale || (bent.phi - at.alpha).abs() > ERROR * scale {
        return Err(format!("misses the roller by {off:e}, {:e} rad", bent.phi - at.alpha));
    }
    Ok(())
}

/// What holds the rods.
#[derive(Clone, Copy, PartialEq)]
enum Clamp {
    Rigid,
    Springs,
    Roller,
}

/// Scenes with such seeds, their clamps of one kind: how many states and events were judged, what was wrong, and why sweeps stopped.
fn these(seeds: std::ops::Range<u64>, clamp: Clamp) -> (usize, usize, Vec<String>, Vec<String>) {
    let (mut states, mut events, mut wrong, mut stops) = (0, 0, Vec::new(), Vec::new());
    for seed in seeds {
        let mut numbers = Numbers(seed);
        let (rod, stiffness, natural, jumps) = rod(&mut numbers);
        let count = 1 + numbers.next() % 3;
        let mut discs = Discs::new();
        for _ in 0..count {
            let (centre, radius) = ([numbers.within(-0.5, 0.5), numbers.within(0.3, 1.0)], numbers.within(0.03, 0.2));
            let clear =
                |([x, y], other): &([f64; 2], f64)| (x - centre[0]).hypot(y - centre[1]) > radius + other + 0.02;
            if discs.iter().all(clear) {
                discs.push((centre, radius));
            }
        }
        let objects: Vec<_> = discs
            .iter()
            .map(|(centre, radius)| Composite::single(CircularArc::new(*centre, *radius, 0.0, TAU).unwrap()).unwrap())
            .collect();
        let sign = if numbers.next().is_multiple_of(2) { 1.0 } else { -1.0 };
        let lean = numbers.within(-0.4, 0.4);
        let at = |x: f64| Pose { x, y: 0.0, phi: FRAC_PI_2 + lean };
        let path = ClampPath::new(at(1.6 * sign), at(-1.6 * sign)).unwrap();
        let compliance = if clamp == Clamp::Springs { compliance(&mut numbers) } else { [[0.0; 3]; 3] };
        let roller = numbers.within(0.03, 0.3);
        let outcome = match clamp {
            Clamp::Springs => {
                let clamp = ElasticClamp::stiffness(inverse(compliance)).unwrap();
                Sweep::new(&Mounted::new(rod, clamp), &objects, path, 0.05).unwrap().run()
            }
            Clamp::Rigid => Sweep::new(&rod, &objects, path, 0.05).unwrap().run(),
            Clamp::Roller => Sweep::new(&Guided::new(rod, roller).unwrap(), &objects, path, 0.05).unwrap().run(),
        };
        let at_events = outcome.events.iter().flat_map(|event| [&event.before, &event.after]);
        for state in outcome.states.iter().chain(at_events) {
            let law = (&stiffness, &natural, &jumps[..]);
            assert_eq!(state.roller.is_some(), clamp == Clamp::Roller);
            let through = state.roller.as_deref().map_or(Ok(()), |at| judge_roller(state, at, law, roller));
            if let Err(what) = through.and_then(|()| judge(state, &compliance, law, &discs)) {
                wrong.push(format!("{seed}: {what} in {} at {:?}", state.phase(), state.pose));
            }
        }
        states += outcome.states.len();
        events += outcome.events.len();
        if let Some(stop) = outcome.stop {
            let last = outcome.states.last();
            let (s, through) = (
                last.map(|last| last.contacts.iter().map(|c| (c.s, c.force)).collect::<Vec<_>>()),
                last.and_then(|last| last.roller.clone()),
            );
            stops.push(format!("{seed}: {stop}, after contacts {s:?}, roller {through:?}"));
        }
    }
    (states, events, wrong, stops)
}

#[test]
fn every_state_is_an_equilibrium() {
    for clamp in [Clamp::Rigid, Clamp::Springs, Clamp::Roller] {
        let (states, events, wrong, mut stops) = these(0..60, clamp);
        assert!(states > 3000 && events > 150, "{states} {events}");
        assert!(wrong.is_empty(), "{wrong:#?}");
        // with a roller a disc may come between it and the clamp
        stops.retain(|stop| !stop.contains("between the clamp and its roller"));
        assert!(stops.len() <= 1, "{stops:#?}");
    }
}

/// `ROLLER=1` in place of `SPRINGS=1` puts a roller ahead of the clamp.
/// `SEEDS=0..2000 SPRINGS=1 cargo test -p vibrissa --test suite rods::random::many -- --ignored --nocapture`
#[test]
#[ignore = "takes minutes"]
fn many() {
    let seeds = std::env::var("SEEDS").unwrap_or_else(|_| "0..2000".into());
    let (from, to) = seeds.split_once("..").unwrap();
    let asked = |what: &str| std::env::var(what).is_ok();
    let clamp = if asked("ROLLER") {
        Clamp::Roller
    } else if asked("SPRINGS") {
        Clamp::Springs
    } else {
        Clamp::Rigid
    };
    let (states, events, wrong, stops) = these(from.parse().unwrap()..to.parse().unwrap(), clamp);
    println!("{states} states, {events} events, wrong {}: {wrong:#?}", wrong.len());
    println!("stopped {}: {stops:#?}", stops.len());
    assert!(wrong.is_empty());
}
