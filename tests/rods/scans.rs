//! Scans of object O1 with a cone, a rod bent at rest, one of two sections and one on a spring, against another solver whose states were integrated
//! again by DOP853: `tests/data/reference/rods`.

use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use vibrissa::rod::{ElasticClamp, Mounted, PhysicalRod, Pose, RodSection, VaryingRod};
use vibrissa::{ClampPath, Composite, Parabola, Rod, State, Sweep};

fn file(name: &str) -> Value {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/reference/rods").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Cone of base diameter d and length 1 with E I = 1 at the clamp.
pub fn cone(taper: f64) -> VaryingRod {
    let base = 0.01_f64;
    let youngs_modulus = 64.0 / (std::f64::consts::PI * base.powi(4));
    Rod::tapered(1.0, base, base * (1.0 - taper), youngs_modulus).unwrap()
}

pub fn two_sections() -> VaryingRod {
    let section = |bending_stiffness| RodSection { length: 0.5, bending_stiffness, natural_curvature: 0.0 };
    Rod::sections(1.0, &[section(1.0), section(0.25)]).unwrap()
}

pub fn o1() -> Composite {
    let parabola = |x| Box::new(Parabola::new([x, 0.0], 5.0).unwrap()) as _;
    Composite::joined(vec![parabola(0.0), parabola(0.3)]).unwrap()
}

pub fn bent() -> VaryingRod {
    Rod::new(1.0, 1.0).unwrap().with_natural_curvature(0.5).unwrap()
}

fn compare(name: &str, rod: &impl PhysicalRod) {
    let file = file(name);
    let number = |value: &Value, field: &str| value[field].as_f64().unwrap();
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    let object = o1();
    let path = ClampPath::new(at(1.0), at(-1.0)).unwrap();
    let outcome = Sweep::new(rod, &object, path, 0.05).unwrap().run();
    assert!(outcome.stop.is_none(), "{name}: {:?}", outcome.stop);
    let reactions = |state: &State, known: [&Value; 3]| {
        let found = [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z];
        for (found, known) in found.into_iter().zip(known.map(|known| known.as_f64().unwrap())) {
            assert!((found - known).abs() < 1e-9 * (1.0 + known.abs()), "{name} at {}: {found} {known}", state.pose.x);
        }
    };
    let events = file["events"].as_array().unwrap();
    assert_eq!(outcome.events.len(), events.len(), "{name}");
    for (event, known) in outcome.events.iter().zip(events) {
        assert!((event.pose().x - number(known, "x0")).abs() < 1e-9, "{name}: {known}");
        // the file names where a snap leads only if that is not the free rod
        let to = known["to"].as_str().unwrap().trim_end_matches("(snap)").trim();
        assert_eq!(event.to().to_string(), if to.is_empty() { "free" } else { to }, "{name}");
        if let Some(landing) = known["landing"]["R"].as_array() {
            reactions(&event.after, [&landing[0], &landing[1], &landing[2]]);
        }
    }
    let mut compared = 0;
    for known in file["states"].as_array().unwrap() {
        let Some(state) = outcome.states.iter().find(|state| (state.pose.x - number(known, "x0")).abs() < 1e-9) else {
            continue;
        };
        reactions(state, ["f0x", "f0y", "m0z"].map(|field| &known[field]));
        compared += 1;
    }
    assert!(compared > 15, "{name}: {compared}");
}

/// A spring of 20 E I / L against turning.
pub fn on_a_spring() -> Mounted<Rod> {
    Mounted::new(Rod::new(1.0, 1.0).unwrap(), ElasticClamp::springs(None, None, Some(20.0)).unwrap())
}

#[test]
fn a_cone() {
    compare("cone_0.8.json", &cone(0.8));
}

#[test]
fn a_rod_bent_at_rest() {
    compare("curved_0.5.json", &bent());
}

#[test]
fn two_sections_of_different_stiffness() {
    compare("two_sections.json", &two_sections());
}

#[test]
fn a_clamp_on_a_spring() {
    compare("elastic_clamp_20.json", &on_a_spring());
}

/// Of a clamp whose springs are rigid nothing is left, to the last bit.
#[test]
fn a_rigid_clamp_is_none() {
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    let (object, path) = (o1(), ClampPath::new(at(1.0), at(-1.0)).unwrap());
    let alone = Sweep::new(&cone(0.5), &object, path, 0.05).unwrap().run();
    let mounted = Mounted::new(cone(0.5), ElasticClamp::default());
    assert_eq!(Sweep::new(&mounted, &object, path, 0.05).unwrap().run(), alone);
}
