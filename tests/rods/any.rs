//! A rod of any kind on any clamp sweeps as that of its own type, to the last bit.

use vibrissa::contact::Outcome;
use vibrissa::rod::{AnyRod, ElasticClamp, Guided, Mounted, PhysicalRod, RodSection};
use vibrissa::{ClampPath, Composite, Parabola, Pose, Rod, Sweep};

/// Past two parabolas: A, B, BB, BA and a snap or two.
fn swept<R: PhysicalRod>(rod: &R) -> Outcome {
    let parabola = |x| Box::new(Parabola::new([x, 0.0], 50.0).unwrap());
    let object = Composite::joined(vec![parabola(0.0), parabola(0.03)]).unwrap();
    let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    Sweep::new(rod, &object, ClampPath::new(clamp(0.08), clamp(-0.09)).unwrap(), 2e-3).unwrap().run()
}

fn alike(own: &Outcome, any: &Outcome) {
    assert!(own.events.len() > 3 && !own.states.is_empty());
    assert_eq!(format!("{:?}", own.events), format!("{:?}", any.events));
    assert_eq!(format!("{:?}", own.states), format!("{:?}", any.states));
}

#[test]
fn any_rod_is_that_of_its_own_type() {
    let wire = Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap();
    let cone = Rod::tapered(0.1, 0.5e-3, 0.3e-3, 206e9).unwrap().with_natural_curvature(1.0).unwrap();
    let section = |length, bending_stiffness| RodSection { length, bending_stiffness, natural_curvature: 0.0 };
    let sections = Rod::sections(0.1, &[section(0.06, 6e-4), section(0.04, 2e-4)]).unwrap();
    let springs = ElasticClamp::springs(Some(500.0), None, Some(0.4)).unwrap();
    alike(&swept(&wire), &swept(&AnyRod::from(wire)));
    alike(&swept(&cone), &swept(&AnyRod::from(cone.clone())));
    alike(&swept(&sections), &swept(&AnyRod::from(sections.clone())));
    alike(&swept(&Mounted::new(wire, springs)), &swept(&AnyRod::from(wire).with_springs(springs)));
    alike(&swept(&Mounted::new(cone.clone(), springs)), &swept(&AnyRod::from(cone).with_springs(springs)));
    alike(&swept(&Guided::new(wire, 0.02).unwrap()), &swept(&AnyRod::from(wire).with_roller(0.02).unwrap()));
    alike(
        &swept(&Guided::new(sections.clone(), 0.02).unwrap()),
        &swept(&AnyRod::from(sections).with_roller(0.02).unwrap()),
    );
}
