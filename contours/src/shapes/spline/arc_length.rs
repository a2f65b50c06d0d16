//! Arc lengths of cubics and of splines.

use crate::point::dot;
use crate::shapes::cubic::{Cubic, Velocity};

/// Nodes and weights of the Gauss-Legendre rule with 8 nodes on -1 to 1, symmetric about 0 (Abramowitz and Stegun,
/// table 25.4).
const RULE: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Difference of a rule from the sum of its halves, relative, at which the halves are right to rounding: their error is
/// less by a factor of about 2^16.
const ACCURACY: f64 = 1e-12;

/// Times a part is halved; the speed of a near cusp varies over 1e-9 of the cubic.
const HALVINGS: u32 = 40;

/// The lengths from the start to each point.
pub(super) fn lengths(cubics: impl Iterator<Item = Cubic>) -> Vec<f64> {
    let mut lengths = vec![0.0];
    // What rounding took off the sum so far: a hundred thousand equal cubics would add up to 1e-12.
    let (mut sum, mut lost) = (0.0, 0.0);
    for cubic in cubics {
        let length: f64 = length_to(&cubic, 1.0);
        let next = sum + length;
        lost += if sum >= length { (sum - next) + length } else { (length - next) + sum };
        sum = next;
        lengths.push(sum + lost);
    }
    lengths
}

/// The length of all cubics by one rule for each: finite where the length is.
pub(super) fn rough_length(cubics: impl Iterator<Item = Cubic>) -> f64 {
    cubics.map(|cubic| cubic.width * gauss(&cubic.velocity(), 0.0, 1.0)).sum()
}

/// The length of a cubic from its start to the fraction `s`.
pub(super) fn length_to(cubic: &Cubic, s: f64) -> f64 {
    let velocity = cubic.velocity();
    cubic.width * integrate_speed(&velocity, 0.0, s, gauss(&velocity, 0.0, s), HALVINGS)
}

/// The integral of the speed, of which the rule gives `whole`.
fn integrate_speed(velocity: &Velocity, from: f64, to: f64, whole: f64, halvings: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let (left, right) = (gauss(velocity, from, middle), gauss(velocity, middle, to));
    let sum = left + right;
    if (sum - whole).abs() <= ACCURACY * sum.abs() || halvings == 0 || !sum.is_finite() {
        return sum;
    }
    integrate_speed(velocity, from, middle, left, halvings - 1)
        + integrate_speed(velocity, middle, to, right, halvings - 1)
}

fn gauss(velocity: &Velocity, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let speed = |s: f64| {
        let here = velocity.at(s);
        dot(here, here).sqrt()
    };
    half * RULE
        .iter()
        .map(|&(node, weight)| weight * (speed(middle - half * node) + speed(middle + half * node)))
        .sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_for_polynomials() {
        for power in (0..16).step_by(2) {
            let sum: f64 = RULE.iter().map(|&(node, weight)| 2.0 * weight * node.powi(power)).sum();
            assert!((sum - 2.0 / f64::from(power + 1)).abs() < 4e-16, "{power}: {sum}");
        }
    }

    #[test]
    fn a_parabola_has_its_closed_form() {
        // (t, t^2) from 0 to 1 as a cubic, and a very flat and a very steep one.
        for c in [1.0, 1e-4, 1e3, 1e7] {
            let control = [[-1.0, c], [-1.0 / 3.0, -c / 3.0], [1.0 / 3.0, -c / 3.0], [1.0, c]];
            let cubic = Cubic { control, from: -1.0, width: 2.0 };
            let k: f64 = 2.0 * c;
            let exact = (1.0 + k * k).sqrt() + k.asinh() / k;
            let error = length_to(&cubic, 1.0) / exact - 1.0;
            assert!(error.abs() < 5e-14, "{c:e}: {error:e}");
        }
    }
}
