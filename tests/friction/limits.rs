//! Limits and symmetries of friction: none, mirrored, back along a roll, pushed on end, into a notch, restarted, step by step.

use super::judge::{Judge, Shape};
use crate::rods::scans::{cone, o1};
use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::{Chain, ContactKind, EventKind, Friction, Item, Outcome, SlipMode, StopReason};
use vibrissa::rod::{ElasticClamp, Mounted, PhysicalRod, Pose};
use vibrissa::{CircularArc, ClampPath, Composite, Follower, Parabola, Rod, State, Sweep};

fn at(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

fn uniform() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

/// The clamp goes through these x at y = -0.4.
fn through(rod: &impl PhysicalRod, object: &Composite, ways: &[f64], step: f64, law: impl Friction) -> Outcome {
    let path = Chain::polyline(&ways.iter().map(|x| at(*x)).collect::<Vec<_>>()).unwrap();
    Sweep::new(rod, object, path, step).unwrap().with_friction(law).unwrap().run()
}

fn felt(state: &State) -> [f64; 3] {
    [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z]
}

fn same(a: [f64; 3], b: [f64; 3], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance * (1.0 + b.abs()))
}

fn modes(state: &State) -> Vec<SlipMode> {
    state.contacts.iter().filter_map(|contact| contact.friction).map(|friction| friction.mode).collect()
}

#[test]
fn hardly_any_friction_is_none() {
    let object = o1();
    let path = ClampPath::new(at(1.0), at(-1.0)).unwrap();
    let none = Sweep::new(&uniform(), &object, path, 0.05).unwrap().run();
    let hardly = through(&uniform(), &object, &[1.0, -1.0], 0.05, 1e-10);
    assert!(hardly.stop.is_none() && none.events.len() == 7);
    assert_eq!(none.events.len(), hardly.events.len());
    for (none, hardly) in none.events.iter().zip(&hardly.events) {
        assert_eq!((none.kind, none.to()), (hardly.kind, hardly.to()));
        assert!((none.pose().x - hardly.pose().x).abs() < 1e-8, "{} {}", none.pose().x, hardly.pose().x);
    }
    assert_eq!(none.states.len(), hardly.states.len());
    for (none, hardly) in none.states.iter().zip(&hardly.states) {
        assert!(same(felt(none), felt(hardly), 1e-8), "{:?}", none.pose);
        assert!((none.energy - hardly.energy).abs() < 1e-8);
    }
}

#[test]
fn a_mirror_exchanges_the_senses() {
    let parabola = |x| Box::new(Parabola::new([x, 0.0], 5.0).unwrap()) as _;
    let mirrored = Composite::joined(vec![parabola(-0.3), parabola(0.0)]).unwrap();
    for turn in [0.0, -0.47, -0.53, -0.8] {
        let ways = [1.0, turn, turn + 0.02, -1.0];
        let one = through(&uniform(), &o1(), &ways, 0.01, 0.1);
        let other = through(&uniform(), &mirrored, &ways.map(|x| -x), 0.01, 0.1);
        assert!(one.stop.is_none() && other.stop.is_none());
        let kinds = |outcome: &Outcome| outcome.events.iter().map(|event| event.kind).collect::<Vec<_>>();
        assert_eq!(kinds(&one), kinds(&other));
        let at_events = |outcome: &Outcome| {
            let events = outcome.events.iter().flat_map(|event| [event.before.clone(), event.after.clone()]);
            outcome.states.iter().cloned().chain(events).collect::<Vec<_>>()
        };
        let (one, other) = (at_events(&one), at_events(&other));
        assert_eq!(one.len(), other.len());
        let mut rubbing = 0;
        for (one, other) in one.iter().zip(&other) {
            let [x, y, m] = felt(other);
            assert!(same(felt(one), [-x, y, -m], 1e-9), "{:?}", one.pose);
            let exchanged = modes(other).into_iter().map(|mode| match mode {
                SlipMode::Forward => SlipMode::Backward,
                SlipMode::Backward => SlipMode::Forward,
                other => other,
            });
            assert_eq!(modes(one), exchanged.collect::<Vec<_>>(), "{:?}", one.pose);
            rubbing += modes(one).len();
        }
        assert!(rubbing > 50);
    }
}

#[test]
fn a_roll_goes_back_the_way_it_came() {
    let outcome = through(&uniform(), &o1(), &[1.0, 0.0, 0.0008, -0.01], 1e-4, 0.1);
    let leg = |leg: usize| outcome.states.iter().filter(move |state| state.leg == leg);
    let mut compared = 0;
    for there in leg(1) {
        let Some(back) = leg(2).find(|back| (back.pose.x - there.pose.x).abs() < 1e-12) else { continue };
        assert_eq!(modes(there), [SlipMode::Stick]);
        assert!(same(felt(there), felt(back), 1e-10), "{:?}", there.pose);
        assert!((there.contacts[0].s - back.contacts[0].s).abs() < 1e-10);
        compared += 1;
    }
    assert!(compared > 6, "{compared}");
    // and slips on where it had stopped
    let first = outcome.events.iter().find(|event| event.leg() == 2).unwrap();
    assert_eq!(first.kind, EventKind::Slip);
    assert!(first.pose().x.abs() < 1e-9, "{:?}", first.pose());
    let straight = through(&uniform(), &o1(), &[1.0, -0.01], 1e-3, 0.1);
    let [one, other] = [&outcome, &straight].map(|outcome| felt(outcome.states.last().unwrap()));
    assert!(same(one, other, 1e-9));
}

/// The clamp moves across the straight rod: its tip slips by -(3/5) delta^2 / cos chi, chi between the rod and the contour's tangent.
#[test]
fn the_first_slip_is_of_second_order() {
    let path = ClampPath::new(at(1.0), at(0.6)).unwrap();
    let object = o1();
    let outcome = Sweep::new(&uniform(), &object, path, 1.0).unwrap().with_friction(0.2).unwrap().run();
    let touch = &outcome.events[0];
    let (x, chi) = (touch.pose().x, FRAC_PI_2 - touch.after.contacts[0].alpha);
    let slip_of = |contact: &vibrissa::contact::Contact| contact.friction.unwrap().slip;
    let mut before = f64::INFINITY;
    for delta in [4e-3, 2e-3, 1e-3] {
        let path = ClampPath::new(at(1.0), at(x - delta)).unwrap();
        let states = Sweep::new(&uniform(), &object, path, 1.0).unwrap().with_friction(0.2).unwrap().run().states;
        let slip = slip_of(&states.last().unwrap().contacts[0]) - slip_of(&touch.after.contacts[0]);
        let off = (slip * chi.cos() / (-0.6 * delta * delta) - 1.0).abs();
        // the next order is relative to the first one as delta to 1
        assert!(off < 0.1 && off < 0.6 * before, "{delta}: {slip:e} {off:e}");
        before = off;
    }
}

#[test]
fn a_rod_pushed_on_end_jams_within_the_cone() {
    let disc = Composite::single(CircularArc::new([0.05, 1.3], 0.2, 0.0, std::f64::consts::TAU).unwrap()).unwrap();
    let pushed = |mu: f64| {
        let pose = |y: f64| Pose { x: 0.0, y, phi: FRAC_PI_2 };
        let path = ClampPath::new(pose(0.0), pose(0.2)).unwrap();
        Sweep::new(&uniform(), &disc, path, 0.01).unwrap().with_friction(mu).unwrap().run()
    };
    // the normal at the tip leans by asin(1/4)
    let limit = 0.25_f64.asin().tan();
    let jams = pushed(1.01 * limit);
    assert_eq!(jams.stop.unwrap().reason, StopReason::Jammed);
    assert!(jams.states.iter().all(|state| state.contacts.is_empty()));
    let slips = pushed(0.9 * limit);
    assert!(slips.stop.is_none(), "{:?}", slips.stop);
    assert_eq!(modes(slips.states.iter().find(|state| !state.contacts.is_empty()).unwrap()).len(), 1);
}

/// States, events and energy of O1 with other rods and clamps.
#[test]
fn a_cone_and_springs_obey_coulomb_too() {
    let shapes = [Shape::Parabolas(vec![([0.0, 0.0], 5.0), ([0.3, 0.0], 5.0)])];
    let object = o1();
    let ways = [1.0, 0.1, 0.13, 0.1, -0.47, -0.44, -1.0];
    let path = || Chain::polyline(&ways.map(at)).unwrap();
    let clamp = ElasticClamp::springs(Some(200.0), Some(500.0), Some(20.0)).unwrap();
    let stiff = [[0.0; 3]; 3];
    let soft = [[1.0 / 200.0, 0.0, 0.0], [0.0, 1.0 / 500.0, 0.0], [0.0, 0.0, 1.0 / 20.0]];
    let cone_law = |s: f64, m: f64| m / (1.0 - 0.5 * s).powi(4);
    let laws: [(&dyn Fn(f64, f64) -> f64, _); 3] = [(&cone_law, stiff), (&|_, m| m, soft), (&cone_law, soft)];
    for (k, (law, compliance)) in laws.into_iter().enumerate() {
        let judge = Judge { law, compliance, shapes: &shapes, mu: &[0.3] };
        let items: Vec<Result<Item, _>> = match k {
            0 => Sweep::new(&cone(0.5), &object, path(), 2e-3).unwrap().with_friction(0.3).unwrap().collect(),
            1 => {
                let rod = Mounted::new(uniform(), clamp);
                Sweep::new(&rod, &object, path(), 2e-3).unwrap().with_friction(0.3).unwrap().collect()
            }
            _ => {
                let rod = Mounted::new(cone(0.5), clamp);
                Sweep::new(&rod, &object, path(), 2e-3).unwrap().with_friction(0.3).unwrap().collect()
            }
        };
        let (counts, wrong) = judge.run(items.into_iter());
        assert!(wrong.is_empty(), "{k}: {wrong:#?}");
        assert!(counts.stops.is_empty() && counts.rolls > 3 && counts.slips > 200, "{k}: {counts:?}");
        assert!(counts.events["slip"] >= 2 && counts.balanced > 5, "{k}: {counts:?}");
    }
}

/// Two parabolas meet in a notch at (0, 0.5), whose walls have the slopes 2 and -2.
#[test]
fn a_tip_goes_into_a_notch_and_out_again() {
    let vertices = [-0.5, 0.5];
    let shapes = [Shape::Parabolas(vertices.map(|x| ([x, 0.0], 2.0)).to_vec())];
    let pieces = vertices.map(|x| Box::new(Parabola::new([x, 0.0], 2.0).unwrap()) as _);
    let object = Composite::joined(pieces.into()).unwrap();
    let pose = |x, y| Pose { x, y, phi: FRAC_PI_2 };
    for mu in [0.05, 0.3] {
        let poses = [pose(0.04, -1.0), pose(0.04, -0.485), pose(-0.02, -0.49), pose(-0.02, -1.0)];
        let path = Chain::polyline(&poses).unwrap();
        let mut sweep = Sweep::new(&uniform(), &object, path, 2e-3).unwrap().with_friction(mu).unwrap();
        let items: Vec<_> = std::iter::from_fn(|| sweep.next()).collect();
        let judge = Judge { law: &|_, m| m, compliance: [[0.0; 3]; 3], shapes: &shapes, mu: &[mu] };
        let in_notch = |item: &Result<Item, _>| matches!(item, Ok(Item::State(state)) if state.contacts.iter().any(|c| c.kind == ContactKind::Notch));
        let rested = items.iter().filter(|item| in_notch(item)).count();
        let (counts, wrong) = judge.run(items.into_iter());
        assert!(wrong.is_empty(), "{mu}: {wrong:#?}");
        assert!(rested > 10 && counts.stops.is_empty() && counts.slips > 5, "{mu}: {rested} {counts:?}");
        assert!(counts.events["piece"] >= 2, "{mu}: {counts:?}");
    }
}

#[test]
fn a_stick_interval_is_gone_on_with() {
    let object = o1();
    let whole = through(&uniform(), &object, &[1.0, 0.0, 0.01], 5e-4, 0.1);
    let slip = whole.events.iter().find(|event| event.leg() == 1 && event.kind == EventKind::Slip).unwrap();
    let middle = whole.states.iter().find(|state| state.leg == 1 && (state.pose.x - 5e-4).abs() < 1e-12).unwrap();
    assert_eq!(modes(middle), [SlipMode::Stick]);
    let path = ClampPath::new(middle.pose, at(0.01)).unwrap();
    let rest = Sweep::from_state(&uniform(), &object, middle, path, 5e-4).unwrap().with_friction(0.1).unwrap().run();
    let again = &rest.events[0];
    assert_eq!(again.kind, EventKind::Slip);
    assert!((again.pose().x - slip.pose().x).abs() < 1e-9, "{} {}", again.pose().x, slip.pose().x);
    assert!(same(felt(rest.states.last().unwrap()), felt(whole.states.last().unwrap()), 1e-9));
}

#[test]
fn a_follower_is_a_sweep() {
    let object = o1();
    let ways = [1.0, 0.0, 0.004, -0.47, -0.46, -0.5];
    let sweep = through(&uniform(), &object, &ways, 1e-3, 0.1);
    let mut follower = Follower::new(&uniform(), &object, at(1.0)).unwrap().with_friction(0.1).unwrap();
    let mut kinds = Vec::new();
    for state in sweep.states.iter().skip(1) {
        let items = follower.to(state.pose).unwrap();
        kinds.extend(
            items.iter().filter_map(|item| if let Item::Event(event) = item { Some(event.kind) } else { None }),
        );
        assert!(same(felt(follower.state()), felt(state), 1e-8), "{:?}", state.pose);
        assert_eq!(modes(follower.state()), modes(state), "{:?}", state.pose);
    }
    assert_eq!(kinds, sweep.events.iter().map(|event| event.kind).collect::<Vec<_>>());
    // made of a state in a stick interval
    let stuck = sweep.states.iter().find(|state| modes(state) == [SlipMode::Stick]).unwrap();
    let mut again = Follower::from_state(&uniform(), &object, stuck).unwrap().with_friction(0.1).unwrap();
    again.to(at(0.004)).unwrap();
    let known = sweep.states.iter().find(|state| state.leg == 1 && (state.pose.x - 0.004).abs() < 1e-12).unwrap();
    assert!(same(felt(again.state()), felt(known), 1e-9));
}
