//! Contacts that slide the same way along the rod, against sweeps with Coulomb friction.

use rod_contours::{CircularArc, Composite, Contour, Parabola};
use rod_core::{Pose, Reactions, Rod};
use std::f64::consts::{FRAC_PI_2, TAU};
use vibrissa::contact::{ClampPath, EventKind, Follower, State, Sweep};

fn clamp(x: f64) -> Pose {
    Pose { x, y: -0.04, phi: FRAC_PI_2 }
}

/// Object O2 of Merker et al. (2020), whose scan has BB, and two pegs: BB and BA.
fn scenes() -> [Vec<Composite>; 2] {
    let parabola = |vertex| -> Box<dyn Contour> { Box::new(Parabola::new(vertex, 50.0).unwrap()) };
    let o2 = Composite::joined(vec![parabola([0.0, 0.0]), parabola([0.03, 0.01])]).unwrap();
    let peg = |x, y| Composite::single(CircularArc::new([x, y], 0.004, 0.0, TAU).unwrap()).unwrap();
    [vec![o2], vec![peg(0.0, 0.02), peg(0.02, 0.05)]]
}

fn off(one: &Reactions, other: &Reactions) -> f64 {
    (one.f0x - other.f0x).abs().max((one.f0y - other.f0y).abs()).max(10.0 * (one.m0z - other.m0z).abs())
}

/// There and back from jump to jump.
#[test]
fn the_states_of_a_rod_that_is_drawn_past_are_those_of_coulombs_law() {
    let rod = Rod::new(0.1, 6.32e-4).unwrap();
    for (scene, mu) in scenes().iter().zip([0.3, 0.2]) {
        let path = ClampPath::new(clamp(0.08), clamp(-0.09)).unwrap();
        let swept = Sweep::new(&rod, scene, path, 1e-3).unwrap().with_friction(mu).unwrap().run();
        let jumps = swept.events.iter().filter(|event| matches!(event.kind, EventKind::Snap | EventKind::SnapOff));
        let jumps: Vec<f64> = jumps.map(|event| event.pose().x).collect();
        let part = |state: &&State| jumps.iter().filter(|jump| state.pose.x < **jump).count();
        let touching: Vec<&State> = swept.states.iter().filter(|state| !state.contacts.is_empty()).collect();
        let (mut several, mut parts) = (0, 0);
        for states in touching.chunk_by(|one, other| part(one) == part(other)) {
            let at = |state: &State| Follower::from_state(&rod, scene, state).unwrap().sliding(mu).unwrap();
            let (mut there, mut back) = (at(states[0]), at(states[states.len() - 1]));
            for (on, before) in states.iter().zip(states.iter().rev()) {
                for (rod, state) in [(&mut there, on), (&mut back, before)] {
                    rod.to(state.pose).unwrap();
                    assert!(off(&rod.state().reactions, &state.reactions) < 1e-9, "{state:?}");
                    assert_eq!(rod.state().phase(), state.phase());
                }
            }
            several += states.iter().filter(|state| state.contacts.len() > 1).count();
            parts += 1;
        }
        println!("{} states, {several} with several contacts, in {parts} parts", touching.len());
        assert!(several > 5, "{several}");
    }
}
