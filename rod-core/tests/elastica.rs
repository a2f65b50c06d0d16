//! Equilibria without contacts: closed forms, buckling loads, balances, symmetries.

use rod_core::{
    DeadLoad, ElasticClamp, Elastica, ElasticaArgument, ElasticaEquilibrium, ElasticaError, Load, Mounted, Pose, Rod,
    RodModel, RodSection, Tip, TipEnd, Units, elastica_equilibria,
};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const CLAMP: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
/// Least solution of tan(q) = q, squared: the buckling load of a rod that is clamped at one end and pinned at the other.
const CLAMPED_PINNED: f64 = 20.190_728_556_426_63;

fn found(loads: &[DeadLoad], tip: &Tip) -> Vec<ElasticaEquilibrium> {
    elastica_equilibria(&Rod::new(1.0, 1.0).unwrap(), CLAMP, loads, tip).unwrap()
}

fn tip_place<M: RodModel>(one: &ElasticaEquilibrium<M>) -> [f64; 2] {
    let tip = one.shape.at(one.shape.length());
    [tip.x, tip.y]
}

#[test]
fn a_cantilever_is_that_of_bisshopp_and_drucker() {
    for (force, deflection, projection) in [(1.0, 0.301_720_774, 0.943_566), (10.0, 0.810_609, 0.445_0)] {
        let all = found(&[], &Tip::loaded(0.0, -force, 0.0));
        assert!(all.len() == 1 && all[0].stable && all[0].residual < 1e-14);
        let [x, y] = tip_place(&all[0]);
        assert!((y + deflection).abs() < 1e-5 && (x - projection).abs() < 1e-4, "{x} {y}");
        let (shape, _) = Elastica::under_loads(Units::ONE, CLAMP, &[Load { s: 1.0, force, alpha: 0.0 }]).unwrap();
        assert!((shape.reactions().m0z - all[0].reactions.m0z).abs() < 1e-13);
        assert!((shape.at(1.0).x - x).abs() < 1e-14 && (shape.at(1.0).y - y).abs() < 1e-14);
    }
}

#[test]
fn a_moment_bends_the_rod_to_an_arc() {
    for moment in [-9.0, 0.5, TAU] {
        let all = found(&[], &Tip::loaded(0.0, 0.0, moment));
        let [x, y] = tip_place(&all[0]);
        assert!((x - moment.sin() / moment).abs() < 1e-14 && (y - (1.0 - moment.cos()) / moment).abs() < 1e-14);
        assert!(all.len() == 1 && all[0].stable && (all[0].reactions.m0z + moment).abs() < 1e-14);
        assert!((all[0].potential_energy + 0.5 * moment * moment).abs() < 1e-13);
    }
}

#[test]
fn columns_buckle_at_the_loads_of_euler() {
    let held = TipEnd::Held(0.0);
    let free = TipEnd::Loaded(0.0);
    for (y, phi, critical) in
        [(free, free, PI * PI / 4.0), (free, held, PI * PI), (held, free, CLAMPED_PINNED), (held, held, 4.0 * PI * PI)]
    {
        for (factor, stable) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
            let all = found(&[], &Tip { x: TipEnd::Loaded(-factor * critical), y, phi });
            let straight = all.iter().find(|one| one.bending_energy < 1e-12).unwrap();
            assert_eq!((straight.stable, straight.unstable_directions), (stable, usize::from(!stable)), "{critical}");
        }
        let all = found(&[], &Tip { x: TipEnd::Loaded(-1.01 * critical), y, phi });
        let near = |one: &&ElasticaEquilibrium| (1e-6..0.2).contains(&(1.0 - tip_place(one)[0]));
        let buckled: Vec<_> = all.iter().filter(near).collect();
        assert!(buckled.len() == 2 && buckled.iter().all(|one| one.stable), "{critical}");
        assert!((buckled[0].reactions.m0z + buckled[1].reactions.m0z).abs() < 1e-10);
        assert!(buckled[0].reactions.m0z < 0.0 && buckled[0].potential_energy < 0.0);
    }
}

#[test]
fn higher_modes_are_less_stable() {
    // between the third and the fourth buckling load of a cantilever: (2 k - 1)^2 pi^2 / 4
    let all = found(&[], &Tip::loaded(-30.0 * PI * PI / 4.0, 0.0, 0.0));
    let directions: Vec<usize> = all.iter().map(|one| one.unstable_directions).collect();
    assert_eq!(directions, [0, 0, 1, 1, 2, 2, 3]);
    assert!(all.is_sorted_by(|one, other| one.potential_energy <= other.potential_energy + 1e-10));
    // and of a rod between two clamps, its tip held at 0.9 L
    let all = found(&[], &Tip::pose(Pose { x: 0.9, y: 0.0, phi: 0.0 }));
    let directions: Vec<usize> = all.iter().map(|one| one.unstable_directions).collect();
    assert_eq!(directions[..6], [0, 0, 1, 1, 2, 2]);
}

#[test]
fn an_s_between_two_clamps_is_two_cantilevers() {
    let all = found(&[], &Tip::pose(Pose { x: 0.7, y: 0.4, phi: 0.0 }));
    let is_s = |one: &&ElasticaEquilibrium| one.shape.moment(0.5).abs() < 1e-12;
    let s = all.iter().find(is_s).unwrap();
    // half of the rod, of length 1 again: forces by 4, moments by 2
    let force = [s.tip.fx / 4.0, s.tip.fy / 4.0];
    let half = found(&[], &Tip::loaded(force[0], force[1], 0.0));
    let same = |one: &&ElasticaEquilibrium| (one.reactions.m0z - 0.5 * s.reactions.m0z).abs() < 1e-12;
    let [x, y] = tip_place(half.iter().find(same).unwrap());
    assert!((x - 0.7).abs() < 1e-13 && (y - 0.4).abs() < 1e-13);
}

fn wire() -> Rod {
    Rod::new(0.1, 6.3e-4).unwrap()
}

const LOADS: [DeadLoad; 3] = [
    DeadLoad { s: 0.06, fx: -0.3, fy: 0.4 },
    DeadLoad { s: 0.0, fx: 0.1, fy: 0.2 },
    DeadLoad { s: 0.02, fx: 0.2, fy: -0.5 },
];

#[test]
fn forces_and_moments_balance() {
    let pose = Pose { x: 0.01, y: -0.02, phi: 0.6 };
    let tips = [
        Tip::loaded(0.2, -0.3, 2e-3),
        Tip::place(0.06, 0.03),
        Tip::pose(Pose { x: 0.06, y: 0.03, phi: -1.0 }),
        Tip { x: TipEnd::Held(0.05), y: TipEnd::Loaded(0.1), phi: TipEnd::Held(0.3) },
    ];
    for tip in tips {
        let all = elastica_equilibria(&wire(), pose, &LOADS, &tip).unwrap();
        assert!(!all.is_empty());
        for one in &all {
            let end = one.shape.at(0.1);
            let at_tip = DeadLoad { s: 0.1, fx: one.tip.fx, fy: one.tip.fy };
            let (mut fx, mut fy, mut moment) =
                (one.reactions.f0x, one.reactions.f0y, one.reactions.m0z + one.tip.moment);
            for load in LOADS.iter().chain([&at_tip]) {
                let at = one.shape.at(load.s);
                (fx, fy) = (fx + load.fx, fy + load.fy);
                moment += (at.x - pose.x) * load.fy - (at.y - pose.y) * load.fx;
            }
            let size = 1.0 + one.tip.fx.hypot(one.tip.fy);
            assert!(fx.abs() < 1e-14 * size && fy.abs() < 1e-14 * size && moment.abs() < 1e-14 * size, "{moment}");
            assert!(one.residual < 1e-13 && (one.shape.moment(0.1) - one.tip.moment).abs() < 1e-14);
            for (given, value) in [(tip.x, end.x), (tip.y, end.y), (tip.phi, end.phi)] {
                assert!(!matches!(given, TipEnd::Held(held) if (held - value).abs() > 1e-13), "{given:?} {value}");
            }
        }
    }
}

#[test]
fn the_tip_force_is_the_slope_of_the_energy() {
    let energy = |x: f64, y: f64, phi: f64| {
        let all = found(&[], &Tip::pose(Pose { x, y, phi }));
        (all[0].bending_energy, all[0].tip)
    };
    let (x, y, phi, h) = (0.6, 0.3, 1.2, 1e-4);
    let slope = |u: f64, v: f64, w: f64| {
        let [near, far] = [1.0, 2.0].map(|k| {
            energy(x + k * h * u, y + k * h * v, phi + k * h * w).0
                - energy(x - k * h * u, y - k * h * v, phi - k * h * w).0
        });
        (8.0 * near - far) / (12.0 * h)
    };
    let tip = energy(x, y, phi).1;
    let differences = [slope(1.0, 0.0, 0.0) - tip.fx, slope(0.0, 1.0, 0.0) - tip.fy, slope(0.0, 0.0, 1.0) - tip.moment];
    assert!(differences.iter().all(|difference| difference.abs() < 1e-8), "{differences:?}");
}

#[test]
fn turned_mirrored_and_scaled_problems_have_the_same_equilibria() {
    let (pose, turn) = (Pose { x: 0.01, y: -0.02, phi: 0.6 }, 2.0);
    let tip = Tip { phi: TipEnd::Loaded(1e-3), ..Tip::place(0.06, 0.03) };
    let all = elastica_equilibria(&wire(), pose, &LOADS, &tip).unwrap();
    let (sin, cos) = f64::sin_cos(turn);
    let turned_loads =
        LOADS.map(|DeadLoad { s, fx, fy }| DeadLoad { s, fx: cos * fx - sin * fy, fy: sin * fx + cos * fy });
    let (dx, dy) = (0.06 - pose.x, 0.03 - pose.y);
    let turned = Tip { phi: TipEnd::Loaded(1e-3), ..Tip::place(cos * dx - sin * dy, sin * dx + cos * dy) };
    let turned_pose = Pose { x: 0.0, y: 0.0, phi: pose.phi + turn };
    let others = elastica_equilibria(&wire(), turned_pose, &turned_loads, &turned).unwrap();
    let mirrored_loads = LOADS.map(|load| DeadLoad { fy: -load.fy, ..load });
    let mirrored = Tip { phi: TipEnd::Loaded(-1e-3), ..Tip::place(0.06, -0.03) };
    let mirrored_pose = Pose { x: pose.x, y: -pose.y, phi: -pose.phi };
    let images = elastica_equilibria(&wire(), mirrored_pose, &mirrored_loads, &mirrored).unwrap();
    assert!(all.len() >= 4 && all.len() == others.len() && all.len() == images.len());
    for ((one, other), image) in all.iter().zip(&others).zip(&images) {
        assert!((one.reactions.m0z - other.reactions.m0z).abs() < 1e-13 && one.stable == other.stable);
        assert!((one.reactions.m0z + image.reactions.m0z).abs() < 1e-13 && one.stable == image.stable);
        assert!((one.potential_energy - other.potential_energy).abs() < 1e-14);
    }
    // twice as long and three times as stiff
    let (force, moment) = (3.0 / 4.0, 3.0 / 2.0);
    let long_loads = LOADS.map(|DeadLoad { s, fx, fy }| DeadLoad { s: 2.0 * s, fx: force * fx, fy: force * fy });
    let long = Tip { phi: TipEnd::Loaded(moment * 1e-3), ..Tip::place(0.12, 0.06) };
    let long_pose = Pose { x: 0.02, y: -0.04, phi: 0.6 };
    let others = elastica_equilibria(&Rod::new(0.2, 18.9e-4).unwrap(), long_pose, &long_loads, &long).unwrap();
    assert!(
        all.iter().zip(&others).all(|(one, other)| (moment * one.reactions.m0z - other.reactions.m0z).abs() < 1e-13)
    );
}

#[test]
fn rods_that_vary_in_name_only_are_uniform_ones() {
    let section = |length| RodSection { length, bending_stiffness: 6.3e-4, natural_curvature: 0.0 };
    let sections = Rod::sections(0.1, &[section(0.03), section(0.07)]).unwrap();
    let tip = Tip::pose(Pose { x: 0.07, y: 0.03, phi: 0.5 });
    let all = elastica_equilibria(&wire(), CLAMP, &LOADS, &tip).unwrap();
    let others = elastica_equilibria(&sections, CLAMP, &LOADS, &tip).unwrap();
    assert!(all.len() >= 4 && all.len() == others.len());
    for (one, other) in all.iter().zip(&others) {
        assert!((one.reactions.m0z - other.reactions.m0z).abs() < 1e-13);
        assert_eq!(one.unstable_directions, other.unstable_directions);
    }
}

#[test]
fn whiskers_taper_and_are_bent_at_rest() {
    let cone = Rod::tapered(0.04, 1e-4, 1e-5, 3e9).unwrap();
    let pinned = elastica_equilibria(&cone, CLAMP, &[], &Tip::place(0.035, 0.0)).unwrap();
    let directions: Vec<usize> = pinned.iter().map(|one| one.unstable_directions).collect();
    assert_eq!(directions[..4], [0, 0, 1, 1]);
    let bent = cone.with_natural_curvature(20.0).unwrap();
    let rest = elastica_equilibria(&bent, CLAMP, &[], &Tip::FREE).unwrap();
    assert!(rest.len() == 1 && rest[0].stable && rest[0].bending_energy == 0.0);
    let tip = rest[0].shape.at(0.04);
    assert!((tip.phi - 0.8).abs() < 1e-12);
    // the tip pinned where it is at rest
    let pinned = elastica_equilibria(&bent, CLAMP, &[], &Tip::place(tip.x, tip.y)).unwrap();
    assert!(pinned[0].bending_energy < 1e-25 && pinned[0].stable);
    // a load half way: the tip part stays as at rest
    let load = DeadLoad { s: 0.02, fx: 0.0, fy: -2e-6 };
    let loaded = elastica_equilibria(&bent, CLAMP, &[load], &Tip::FREE).unwrap();
    assert!(loaded.len() == 1 && (loaded[0].shape.at(0.03).kappa - 20.0).abs() < 1e-9);
}

#[test]
fn strong_loads_and_a_tip_near_full_extension() {
    let across = found(&[], &Tip::loaded(0.0, 900.0, 0.0));
    // aligned with the force but for a boundary layer at the clamp: m0 = 2 sqrt(f) sin(pi / 4)
    assert!(across[0].stable && (across[0].reactions.m0z + 2.0 * 900.0_f64.sqrt() * (PI / 4.0).sin()).abs() < 1e-9);
    let stretched = found(&[], &Tip::pose(Pose { x: 0.7, y: 0.7, phi: 0.0 }));
    assert!(stretched[0].stable && stretched[0].tip.fx > 500.0 && stretched[0].residual < 1e-13);
}

fn refused(pose: Pose, loads: &[DeadLoad], tip: &Tip) -> (ElasticaArgument, String) {
    match elastica_equilibria(&wire(), pose, loads, tip) {
        Err(ElasticaError::Argument { argument, message }) => (argument, message),
        other => panic!("{other:?}"),
    }
}

#[test]
fn wrong_arguments_are_named() {
    let load = |s, fx| DeadLoad { s, fx, fy: 0.0 };
    let lost = Pose { x: f64::NAN, ..CLAMP };
    for (pose, loads, tip, argument, message) in [
        (lost, vec![], Tip::FREE, ElasticaArgument::Pose, "x is NaN, expected a finite number"),
        (
            CLAMP,
            vec![load(0.1, 1.0), load(0.11, 1.0)],
            Tip::FREE,
            ElasticaArgument::Load(1),
            "s is 0.11 m, expected 0 to 0.1 m, the length of the rod",
        ),
        (
            CLAMP,
            vec![load(0.1, f64::INFINITY)],
            Tip::FREE,
            ElasticaArgument::Load(0),
            "fx is inf, expected a finite number",
        ),
        (
            CLAMP,
            vec![load(0.1, 40.0), load(0.1, 40.0)],
            Tip::FREE,
            ElasticaArgument::Loads,
            "the forces add up to 80.0 N",
        ),
        (
            CLAMP,
            vec![],
            Tip::place(0.1, 0.0),
            ElasticaArgument::Tip,
            "place is (0.1, 0.0) m, 0.1 m from the clamp, expected less than 0.1 m, the length of the rod",
        ),
        (CLAMP, vec![], Tip { x: TipEnd::Held(0.2), ..Tip::FREE }, ElasticaArgument::Tip, "x is 0.2 m, 0.2 m from"),
        (CLAMP, vec![], Tip::loaded(0.0, f64::NAN, 0.0), ElasticaArgument::Tip, "fy is NaN, expected a finite"),
        (CLAMP, vec![], Tip::loaded(0.0, 0.0, 1.0), ElasticaArgument::Tip, "moment is 1.0 N m, expected at most"),
        (CLAMP, vec![], Tip { phi: TipEnd::Held(200.0), ..Tip::FREE }, ElasticaArgument::Tip, "phi is 200.0 rad"),
    ] {
        let (which, said) = refused(pose, &loads, &tip);
        assert!(which == argument && said.starts_with(message), "{which:?}: {said}");
    }
    let springs = Mounted::new(wire(), ElasticClamp::springs(Some(500.0), None, None).unwrap());
    let error = elastica_equilibria(&springs, CLAMP, &[], &Tip::FREE).unwrap_err();
    assert!(matches!(error, ElasticaError::Argument { argument: ElasticaArgument::Rod, .. }), "{error}");
}

#[test]
fn a_closed_ring_and_whole_turns() {
    // a rod whose ends meet, with one turn: a circle; and with none: a figure of eight
    let ring = found(&[], &Tip::pose(Pose { x: 0.0, y: 0.0, phi: TAU }));
    assert!(ring[0].stable && (ring[0].bending_energy - 0.5 * TAU * TAU).abs() < 1e-12);
    let eight = found(&[], &Tip::pose(Pose { x: 0.0, y: 0.0, phi: 0.0 }));
    assert!((eight[0].bending_energy - 56.219_804_87).abs() < 1e-7, "{}", eight[0].bending_energy);
    let quarter = found(&[], &Tip { phi: TipEnd::Held(FRAC_PI_2), ..Tip::FREE });
    assert!(quarter.len() == 1 && (quarter[0].tip.moment - FRAC_PI_2).abs() < 1e-14);
}
