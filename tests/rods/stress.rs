//! The largest bending stress of rods that vary, are bent at rest or are on springs, beside dense samples of shapes that DOP853 integrates.

use super::scans::o1;
use std::f64::consts::{FRAC_PI_2, PI};
use vibrissa::rod::{
    Cut, ElasticClamp, Elastica, Method, Mounted, Ode, PhysicalRod, Pose, Propagator, RodSection, Segment,
};
use vibrissa::{ClampPath, Rod, State, Sweep};

/// Young's modulus by which a wire of diameter `CLAMP` has E I = 1.
const CLAMP: f64 = 0.01;
const MODULUS: f64 = 64.0 / (PI * CLAMP * CLAMP * CLAMP * CLAMP);
/// Intervals of a part of the rod between joints and contacts.
const SAMPLES: usize = 400;
/// What the sampled maximum may miss, relative: the square of an interval of the second pass, and the integrator's tolerance.
const ERROR: f64 = 1e-9;

fn states(rod: &impl PhysicalRod) -> Vec<State> {
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    Sweep::new(rod, &o1(), ClampPath::new(at(0.8), at(-0.9)).unwrap(), 0.03).unwrap().run().states
}

/// The largest E d |kappa - kappa0| / 2 of a state, and whether it is between the ends of a part. The rod is given by its diameter and its
/// curvature at rest, its clamp by what it yields to each reaction.
fn sampled(
    state: &State,
    yields: [f64; 3],
    diameter: &dyn Fn(f64) -> f64,
    at_rest: &dyn Fn(f64) -> f64,
    joints: &[f64],
) -> (f64, bool) {
    let stiffness = |s: f64| (diameter(s) / CLAMP).powi(4);
    let ode = Ode::with_law(|s, m| m / stiffness(s) + at_rest(s), Method::Dop853, 1e-14).unwrap();
    let felt = [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z];
    let Pose { x, y, phi } = state.pose;
    let mut cut = Cut {
        x: x - yields[0] * felt[0],
        y: y - yields[1] * felt[1],
        phi: phi - yields[2] * felt[2],
        moment: -felt[2],
    };
    let (mut a, mut b, mut from) = (felt[1], -felt[0], 0.0);
    let (mut most, mut inner) = (0.0_f64, false);
    for contact in state.contacts.iter().map(Some).chain([None]) {
        let to = contact.map_or(1.0, |contact| contact.s);
        let ends = joints.iter().copied().filter(|joint| *joint > from && *joint < to).chain([to]);
        for end in ends.collect::<Vec<_>>() {
            // the law is asked at the ends of a step: one side of a joint
            let beside = |s: f64, inwards: f64| if joints.contains(&s) { s + inwards * 1e-12 } else { s };
            let (start, stop) = (beside(from, 1.0), beside(end, -1.0));
            let h = (stop - start) / SAMPLES as f64;
            let stress = |s: f64, cut: &Cut| {
                let kappa = cut.moment / stiffness(s) + at_rest(s);
                0.5 * MODULUS * diameter(s) * (kappa - at_rest(s)).abs()
            };
            let sample = |(start, cut): (f64, Cut), h: f64, count: usize| {
                let mut along = vec![(start, cut)];
                for k in 0..count {
                    let (s, cut) = along[k];
                    along.push((start + h * (k + 1) as f64, ode.advance(s, &cut, a, b, h).unwrap()));
                }
                along
            };
            let best = |along: &[(f64, Cut)]| {
                let size = |k: usize| stress(along[k].0, &along[k].1);
                (0..along.len()).fold(0, |best, k| if size(k) > size(best) { k } else { best })
            };
            let along = sample((start, cut), h, SAMPLES);
            cut = along[SAMPLES].1;
            // once more around the largest
            let k = best(&along);
            let around = sample(along[k.saturating_sub(1)], 2.0 * h / SAMPLES as f64, SAMPLES);
            let here = around.iter().chain([&along[k]]).map(|(s, cut)| stress(*s, cut)).fold(0.0, f64::max);
            let is_inner = k > 0 && k < SAMPLES;
            if here > most {
                (most, inner) = (here, is_inner);
            }
            from = end;
        }
        let Some(contact) = contact else { break };
        // what the contact pushes with is not carried beyond it
        a -= contact.force * contact.alpha.cos();
        b -= contact.force * contact.alpha.sin();
    }
    (most, inner)
}

/// How many states have their largest stress inside, and how many at an end or a contact.
fn judged(
    name: &str,
    rod: &impl PhysicalRod,
    yields: [f64; 3],
    diameter: impl Fn(f64) -> f64,
    at_rest: impl Fn(f64) -> f64,
    joints: &[f64],
) -> [usize; 2] {
    let (mut counts, mut worst) = ([0, 0], 0.0_f64);
    for state in states(rod) {
        let found = state.max_stress.unwrap();
        if state.contacts.is_empty() {
            assert_eq!(found, 0.0, "{name}: nothing is bent but as at rest");
            continue;
        }
        let (most, inner) = sampled(&state, yields, &diameter, &at_rest, joints);
        worst = worst.max((found / most - 1.0).abs());
        counts[usize::from(!inner)] += 1;
    }
    println!("{name}: largest inside {}, at an end {}; off by {worst:.1e} at most", counts[0], counts[1]);
    assert!(worst < ERROR, "{name}: {worst:e}");
    counts
}

#[test]
fn the_largest_stress_is_that_of_dense_samples() {
    let straight = |_| 0.0;
    let rigid = [0.0; 3];
    let mut counts = Vec::new();
    for taper in [0.8, 0.4, -0.3] {
        let cone = Rod::tapered(1.0, CLAMP, CLAMP * (1.0 - taper), MODULUS).unwrap();
        let diameter = move |s: f64| CLAMP * (1.0 - taper * s);
        counts.push(judged(&format!("cone {taper}"), &cone, rigid, diameter, straight, &[]));
        let bent = cone.with_natural_curvature(|s: f64| 0.4 - 0.3 * s).unwrap();
        let at_rest = |s: f64| 0.4 - 0.3 * s;
        counts.push(judged(&format!("bent cone {taper}"), &bent, rigid, diameter, at_rest, &[]));
    }
    let wire = Rod::from_diameter(1.0, CLAMP, MODULUS).unwrap();
    let arc = wire.with_natural_curvature(0.5).unwrap();
    counts.push(judged("arc", &arc, rigid, |_| CLAMP, |_| 0.5, &[]));
    let soft = ElasticClamp::springs(Some(40.0), Some(30.0), Some(8.0)).unwrap();
    let yields = [1.0 / 40.0, 1.0 / 30.0, 1.0 / 8.0];
    counts.push(judged("on springs", &Mounted::new(wire, soft), yields, |_| CLAMP, straight, &[]));
    counts.push(judged("arc on springs", &Mounted::new(arc, soft), yields, |_| CLAMP, |_| 0.5, &[]));

    let thin = 0.6 * CLAMP;
    let section = |length, diameter: f64, natural_curvature| RodSection {
        length,
        bending_stiffness: (diameter / CLAMP).powi(4),
        natural_curvature,
    };
    let wires = Rod::sections(1.0, &[section(0.45, CLAMP, 0.0), section(0.55, thin, 0.3)]).unwrap();
    let diameter = move |s: f64| if s < 0.45 { CLAMP } else { thin };
    let wires = wires.with_section_diameters(&[CLAMP, thin]).unwrap();
    counts.push(judged("sections", &wires, rigid, diameter, |s| if s < 0.45 { 0.0 } else { 0.3 }, &[0.45]));
    let curled = wires.with_natural_curvature(|s: f64| 0.2 * s).unwrap();
    counts.push(judged("curled sections", &curled, rigid, diameter, |s| 0.2 * s, &[0.45]));
    let [inside, at_end] = counts.iter().fold([0, 0], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
    assert!(inside > 50 && at_end > 50, "{inside} {at_end}");
}

#[test]
fn without_diameters_there_is_no_stress() {
    let section = RodSection { length: 1.0, bending_stiffness: 1.0, natural_curvature: 0.2 };
    let unknown = [
        Rod::sections(1.0, &[section]).unwrap(),
        Rod::varying(1.0, |s| 1.0 - 0.5 * s, &[]).unwrap(),
        Rod::new(1.0, 1.0).unwrap().with_natural_curvature(0.5).unwrap(),
    ];
    for rod in unknown {
        assert!(rod.bending_stress(0.5, 1.0).is_none());
        assert!(states(&rod).iter().all(|state| state.max_stress.is_none()));
    }
    let refused = Rod::varying(1.0, |s| 1.0 - 0.5 * s, &[]).unwrap().with_section_diameters(&[CLAMP]).unwrap_err();
    assert!(refused.to_string().contains("for 1 sections, expected one for each of the 0 sections"), "{refused}");
    let refused = Rod::sections(1.0, &[section]).unwrap().with_section_diameters(&[-1.0]).unwrap_err();
    assert!(refused.to_string().contains("diameter of section 0 is -1, expected a positive"), "{refused}");
}

/// A wrong guess of the contacts gives a solution with a contact beyond the tip, whose stress is that of the parts on the rod.
#[test]
fn a_contact_beyond_the_tip_adds_no_stress() {
    let rod = super::scans::cone(0.8);
    let start = Cut { x: 0.0, y: 0.0, phi: 1.5, moment: 0.7 };
    let segment = |s: f64, b: f64| Segment { s, start, a: 0.0, b };
    let shape = |segments: Vec<Segment<Cut>>| Elastica::of_segments(rod.model().clone(), rod.units(), segments);
    let on_rod = rod.largest_stress(&shape(vec![segment(0.0, 3.0), segment(1.0, 0.0)])).unwrap();
    let beyond = [segment(0.0, 3.0), segment(1.0, 5.0), segment(0.8, 2.0), segment(0.79, 0.0)];
    let found = rod.largest_stress(&shape(beyond.to_vec())).unwrap();
    assert!(found.is_finite() && found >= on_rod, "{found} {on_rod}");
}
