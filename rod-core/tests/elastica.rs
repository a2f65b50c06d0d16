//! Equilibria without contacts: closed forms, buckling loads, balances, symmetries.

use rod_core::{
    DeadLoad, ElasticaArgument, ElasticaEquilibrium, ElasticaError, PhysicalRod, Pose, Rod, RodModel, RodSection, Tip,
    TipEnd, Units, VaryingRod, elastica_equilibria,
};
use std::f64::consts::{FRAC_PI_2, PI};

const CLAMP: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };

fn unit() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

fn found(loads: &[DeadLoad], tip: &Tip) -> Vec<ElasticaEquilibrium> {
    elastica_equilibria(&unit(), CLAMP, loads, tip).unwrap()
}

#[test]
fn experiments() {
    let show = |name: &str, tip: &Tip, loads: &[DeadLoad]| {
        let start = std::time::Instant::now();
        let all = elastica_equilibria(&unit(), CLAMP, loads, tip);
        println!("{name}: {:?}", start.elapsed());
        match all {
            Err(error) => println!("  {error}"),
            Ok(all) => {
                for one in all {
                    println!(
                        "  U {:.6} V {:.6} m0 {:.6} f ({:.4}, {:.4}, {:.4}) unstable {} {} residual {:.1e}",
                        one.bending_energy, one.potential_energy, one.reactions.m0z, one.tip.fx, one.tip.fy, one.tip.moment,
                        one.unstable_directions, one.stable, one.residual
                    );
                }
            }
        }
    };
    let e = PI * PI / 4.0;
    show("free", &Tip::FREE, &[]);
    show("below", &Tip::loaded(-0.99 * e, 0.0, 0.0), &[]);
    show("above", &Tip::loaded(-1.01 * e, 0.0, 0.0), &[]);
    show("second", &Tip::loaded(-10.0 * e, 0.0, 0.0), &[]);
    show("1000", &Tip::loaded(-999.0, 0.0, 0.0), &[]);
    show("tension", &Tip::loaded(0.0, 999.0, 0.0), &[]);
    show("bisshopp", &Tip::loaded(0.0, -10.0, 0.0), &[]);
    show("S", &Tip::pose(Pose { x: 0.8, y: 0.3, phi: 0.0 }), &[]);
    show("column", &Tip::pose(Pose { x: 0.9, y: 0.0, phi: 0.0 }), &[]);
    show("near", &Tip::pose(Pose { x: 0.7, y: 0.7, phi: 0.0 }), &[]);
    show("pinned", &Tip::place(0.8, 0.0), &[]);
    show("pinned loaded", &Tip::place(0.8, 0.0), &[DeadLoad { s: 0.5, fx: 0.0, fy: 30.0 }]);
    show("loop", &Tip::pose(Pose { x: 0.0, y: 0.0, phi: 2.0 * PI }), &[]);
    show("guided", &Tip { x: TipEnd::Loaded(-12.0), y: TipEnd::Held(0.0), phi: TipEnd::Loaded(0.0) }, &[]);
    show("guided clamp", &Tip { x: TipEnd::Loaded(-40.0), y: TipEnd::Held(0.0), phi: TipEnd::Held(0.0) }, &[]);
    let cone = Rod::tapered(1.0, 0.01, 0.001, 1e9).unwrap();
    let start = std::time::Instant::now();
    let all = elastica_equilibria(&cone, CLAMP, &[], &Tip::place(0.8, 0.0)).unwrap();
    println!("cone {:?}", start.elapsed());
    for one in all { println!("{:?} {} {}", one.reactions, one.unstable_directions, one.residual); }
    show("angle", &Tip { x: TipEnd::Loaded(-12.0), y: TipEnd::Loaded(0.0), phi: TipEnd::Held(0.0) }, &[]);
}
