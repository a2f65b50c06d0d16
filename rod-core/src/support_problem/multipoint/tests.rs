//! The Jacobian of the boundary-value problem against differences.

use super::*;
use crate::clamp::{Elastic, Pivot};
use proptest::prelude::*;

/// What friction does at each support.
#[derive(Clone, Copy, Debug)]
enum Rubs {
    No,
    Slips(f64),
    Sticks(f64, f64),
}

/// Circles: r = centre + radius (sin t, -cos t), travelled counter-clockwise, tangent angle t.
struct Circles(Vec<(Hold, [f64; 3], Rubs)>);

impl Supports for Circles {
    fn count(&self) -> usize {
        self.0.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.0[j].0
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let [x, y, radius] = self.0[j].1;
        Support { x: x + radius * t.sin(), y: y - radius * t.cos(), alpha: t, speed: radius, turning: 1.0 }
    }
    fn grip(&self, j: usize) -> Grip {
        match self.0[j].2 {
            Rubs::No => Grip::SMOOTH,
            Rubs::Slips(ratio) => Grip::Slips { ratio },
            Rubs::Sticks(t, s) => Grip::Sticks { t, s },
        }
    }
}

fn rubs() -> impl Strategy<Value = Rubs> {
    prop_oneof![
        Just(Rubs::No),
        (-1.0..1.0_f64).prop_map(Rubs::Slips),
        (-1.0..1.0_f64, 0.0..1.0_f64).prop_map(|(t, s)| Rubs::Sticks(t, s)),
    ]
}

proptest! {
    #[test]
    fn jacobian_is_the_derivative(
        unknowns in prop::collection::vec((-1.0..1.0_f64, -4.0..4.0_f64, 0.1..0.4_f64, 0.05..2.0_f64), 1..5),
        tip: bool,
        phi in 0.0..3.0_f64,
        springs in prop::array::uniform3(prop::array::uniform3(-0.3..0.3_f64)),
        rubs in prop::collection::vec(rubs(), 4),
        friction in prop::array::uniform4(-2.0..2.0_f64),
    ) {
        let n = unknowns.len();
        let mut s = 0.0;
        let (mut u, mut circles) = (Vec::new(), Vec::new());
        for (j, (t, f, ds, radius)) in unknowns.into_iter().enumerate() {
            s += ds;
            let at_tip = tip && j + 1 == n;
            u.extend([t, f, if at_tip { phi } else { s }]);
            let offset = if j % 2 == 0 { 0.0 } else { std::f64::consts::PI };
            let rubs = match rubs[j] {
                // the tip stays the tip: elsewhere the equation jumps where the rod stands across the curve
                Rubs::Sticks(t, _) if at_tip => Rubs::Sticks(t, 1.0),
                rubs => rubs,
            };
            circles.push((if at_tip { Hold::Tip } else { Hold::Tangent { offset } }, [0.3 * j as f64, 0.2, radius], rubs));
        }
        u.extend(friction.into_iter().zip(&rubs[..n]).filter(|(_, rubs)| matches!(rubs, Rubs::Sticks(..))).map(|(f, _)| f));
        let supports = Circles(circles);
        let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 };
        the_jacobian_is_the_derivative(&MultiPoint { rod: Uniform, clamp: pose, supports: &supports }, &u)?;
        let compliance = springs;
        the_jacobian_is_the_derivative(&MultiPoint { rod: Uniform, clamp: Elastic { pose, compliance }, supports: &supports }, &u)?;
        the_jacobian_is_the_derivative(&MultiPoint { rod: Uniform, clamp: Pivot { pose, torque: 0.7 }, supports: &supports }, &u)?;
    }
}

/// Central differences of order 6.
fn the_jacobian_is_the_derivative<C: Clamp>(
    problem: &MultiPoint<'_, Circles, Uniform, C>,
    u: &[f64],
) -> Result<(), TestCaseError> {
    let size = u.len();
    let (mut residual, mut jacobian) = (vec![0.0; size], vec![f64::NAN; size * size]);
    problem.evaluate(u, &mut residual, Some(&mut jacobian));
    let mut plain = vec![0.0; size];
    problem.evaluate(u, &mut plain, None);
    prop_assert_eq!(&plain, &residual);
    if problem.sticking().next().is_none() {
        let (mut links, mut by_links, mut of_links) = (Links::default(), vec![0.0; size], vec![f64::NAN; size * size]);
        problem.evaluate_links(u, &mut by_links, &mut links);
        prop_assert_eq!(&by_links, &residual);
        Links::write(links.links(), &mut of_links, size);
        let scale = jacobian.iter().fold(1.0_f64, |most, entry| most.max(entry.abs()));
        for (entry, expected) in of_links.iter().zip(&jacobian) {
            // rounding: sums of moments about another point
            prop_assert!((entry - expected).abs() < 1e-13 * scale, "{entry} {expected}");
        }
    }
    for column in 0..size {
        let h = 1e-3;
        let mut differences = vec![0.0; size];
        for (step, weight) in [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)] {
            for side in [step, -step] {
                let mut moved = u.to_vec();
                moved[column] += side * h;
                let (mut there, weight) = (vec![0.0; size], weight * side.signum() / h);
                problem.evaluate(&moved, &mut there, None);
                differences.iter_mut().zip(there).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        for row in 0..size {
            let (difference, ours) = (differences[row], jacobian[column * size + row]);
            prop_assert!((difference - ours).abs() < 1e-9 * (1.0 + ours.abs()), "{row} {column}: {ours} {difference}");
        }
    }
    Ok(())
}
