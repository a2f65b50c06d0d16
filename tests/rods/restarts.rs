//! What goes on from a state, and its derivatives, with rods that are not uniform.

use super::scans::{bent, cone, o1, two_sections};
use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::{Derivatives, Quantity};
use vibrissa::rod::{ElasticClamp, Mounted, PhysicalRod, Pose, VaryingRod};
use vibrissa::{ClampPath, Follower, State, Sweep, equilibrium};

fn at(x: f64) -> Pose {
    Pose { x, y: -0.4, phi: FRAC_PI_2 }
}

/// The states in contact of a scan of O1, not at an event.
fn held(rod: &impl PhysicalRod) -> Vec<State> {
    let path = ClampPath::new(at(1.0), at(-1.0)).unwrap();
    let outcome = Sweep::new(rod, &o1(), path, 0.047).unwrap().run();
    outcome.states.into_iter().filter(|state| !state.contacts.is_empty()).collect()
}

/// Three on rigid clamps, two on springs.
fn rods() -> [(&'static str, Mounted<VaryingRod>); 5] {
    let rigid = |rod| Mounted::new(rod, ElasticClamp::default());
    let beam = ElasticClamp::stiffness([[300.0, 0.0, 0.0], [0.0, 200.0, -30.0], [0.0, -30.0, 9.0]]).unwrap();
    let soft = ElasticClamp::springs(Some(40.0), None, Some(8.0)).unwrap();
    [
        ("cone", rigid(cone(0.8))),
        ("bent", rigid(bent())),
        ("sections", rigid(two_sections())),
        ("cone on a beam", Mounted::new(cone(0.5), beam)),
        ("bent on springs", Mounted::new(bent(), soft)),
    ]
}

fn distance(one: &State, other: &State) -> f64 {
    let felt = |state: &State| [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z];
    felt(one).into_iter().zip(felt(other)).map(|(u, v)| (u - v).abs() / (1.0 + v.abs())).fold(0.0, f64::max)
}

#[test]
fn a_state_goes_on_there_and_back() {
    let object = o1();
    for (name, rod) in rods() {
        let states = held(&rod);
        for pair in states.windows(2).filter(|pair| pair[0].phase() == pair[1].phase()) {
            for (from, to) in [(&pair[0], &pair[1]), (&pair[1], &pair[0])] {
                let path = ClampPath::new(from.pose, to.pose).unwrap();
                let step = path.length();
                let reached = Sweep::from_state(&rod, &object, from, path, step).unwrap().run();
                let mut follower = Follower::from_state(&rod, &object, from).unwrap();
                follower.to(to.pose).unwrap();
                // not over an event, which may lie between two states of one phase
                if reached.events.is_empty() {
                    let off = distance(reached.states.last().unwrap(), to).max(distance(follower.state(), to));
                    assert!(off < 1e-9, "{name} from {} to {}: {off:e}", from.pose.x, to.pose.x);
                }
            }
        }
    }
}

#[test]
fn derivatives_are_those_of_equilibria() {
    let object = o1();
    let (mut compared, mut worst) = (0, 0.0_f64);
    for (name, rod) in rods() {
        for state in held(&rod).iter().step_by(2) {
            let Ok(derivatives) = Derivatives::new(&rod, &object, state) else { continue };
            if derivatives.condition() > 1e4 {
                continue;
            }
            let stiffness = derivatives.stiffness().unwrap();
            let moved = derivatives.by(Quantity::ObjectX(0)).unwrap();
            // differences of order 6 of the equilibria beside it
            let h = 2e-4;
            let felt = |steps: f64| {
                let pose = Pose { x: state.pose.x + steps * h, ..state.pose };
                let found = equilibrium(&rod, &object, pose, &state.contacts).unwrap();
                assert!(found.report.status.is_solved(), "{name}");
                [found.state.reactions.f0x, found.state.reactions.f0y, found.state.reactions.m0z]
            };
            let [a, b, c] = [1.0, 2.0, 3.0].map(|steps| (felt(steps), felt(-steps)));
            for i in 0..3 {
                let across = |pair: &([f64; 3], [f64; 3])| pair.0[i] - pair.1[i];
                let slope = (45.0 * across(&a) - 9.0 * across(&b) + across(&c)) / (60.0 * h);
                let scale = 1.0 + stiffness.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
                worst = worst.max((stiffness[i][0] - slope).abs() / scale);
            }
            // moving the object is moving the clamp the other way
            let scale = 1.0 + stiffness[0][0].abs();
            worst = worst.max((moved.reactions.f0x + stiffness[0][0]).abs() / scale);
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                let scale = 1.0 + stiffness[i][j].abs();
                assert!((stiffness[i][j] - stiffness[j][i]).abs() < 1e-9 * scale, "{name}: {stiffness:?}");
            }
            compared += 1;
        }
    }
    assert!(compared > 20 && worst < 1e-7, "{compared} {worst:e}");
}

/// Back from the second part of phase B, which ends in a fold, the rod snaps onto the first part at the same pose.
#[test]
fn a_snap_lands_behind_the_next_fold() {
    let (object, rod) = (o1(), two_sections());
    let state = held(&rod).pop().unwrap();
    let path = ClampPath::new(state.pose, at(-0.4)).unwrap();
    let events = Sweep::from_state(&rod, &object, &state, path, 0.01).unwrap().run().events;
    let (snap, touch) = (&events[0], &events[1]);
    // of the other solver: backward_fold_of_second_B_branch, and the release of the scan forwards
    assert!((snap.pose().x + 0.5627337329734604).abs() < 1e-9 && (touch.pose().x + 0.46725333301621025).abs() < 1e-9);
    assert!((0.82..0.83).contains(&snap.after.contacts[0].s) && snap.after.pose == snap.before.pose);
    assert!(snap.after.energy < snap.before.energy && touch.to().to_string() == "BB");
}
