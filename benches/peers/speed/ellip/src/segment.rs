//! One segment of an elastica as a pendulum arc, by the cases of the textbooks.
//!
//! With P = hypot(a, b), beta = atan2(b, a), delta = phi - beta - pi/2 it is delta'' = -P sin delta, and
//! M = kappa^2 / 4 + P sin^2(delta / 2) is conserved.

use crate::amplitude::amplitude;
use ellip::{StrErr, ellipeinc, ellipf};
use std::f64::consts::{FRAC_PI_2, PI};

/// Where the cases meet, relative: an elastica so near to the separatrix is taken for it, or a modulus of 1 would have no
/// period; and one so little bent by its force for a circle, or Legendre's integrals would leave no digit.
const SEPARATRIX: f64 = 1e-15;
const CIRCLE: f64 = 1e-10;

/// x, y, phi, kappa.
pub type Section = [f64; 4];

pub fn advance([x, y, phi, kappa]: Section, a: f64, b: f64, s: f64) -> Result<Section, StrErr> {
    let force = a.hypot(b);
    let axis = b.atan2(a) + FRAC_PI_2;
    // delta in (-pi, pi]: whole turns are added again
    let turns = ((phi - axis) / (2.0 * PI)).round();
    let delta = phi - axis - 2.0 * PI * turns;
    let sin = (0.5 * delta).sin();
    let q = 0.5 * kappa;
    let m = q * q + force * sin * sin;
    if m == 0.0 || force * s * s < CIRCLE {
        return Ok(arc([x, y, phi, kappa], a, b, s));
    }
    // half of the angle and the curvature at the end, and the integral of sin^2(delta / 2)
    let (half, q1, square) = if (m - force).abs() <= SEPARATRIX * m {
        separatrix(delta, q, force, s)
    } else if m < force {
        inflectional(sin, q, force, m, s)?
    } else {
        orbit(0.5 * delta, q, force, m, s)?
    };
    let (along, across) = (s - 2.0 * square, 2.0 * (q - q1) / force);
    let (sin, cos) = axis.sin_cos();
    Ok([x + along * cos - across * sin, y + along * sin + across * cos, 2.0 * half + axis + 2.0 * PI * turns, 2.0 * q1])
}

/// With inflections: sin(delta / 2) = k sin psi, kappa = 2 k sqrt P cos psi, k^2 = M / P.
fn inflectional(sin: f64, q: f64, force: f64, m: f64, s: f64) -> Result<(f64, f64, f64), StrErr> {
    let (root, k2) = (force.sqrt(), m / force);
    let k = k2.sqrt();
    let psi = (sin / k).atan2(q / (k * root));
    let psi1 = amplitude(ellipf(psi, k2)? + root * s, k2)?;
    let (sin1, cos1) = psi1.sin_cos();
    // k^2 sin^2 psi = 1 - (1 - k^2 sin^2 psi), and the integral of the latter is Legendre's second
    let square = s - (ellipeinc(psi1, k2)? - ellipeinc(psi, k2)?) / root;
    Ok(((k * sin1).asin(), k * root * cos1, square))
}

/// Without inflections: delta / 2 = theta, kappa = 2 sqrt M sqrt(1 - sin^2 theta P / M), either way round.
fn orbit(theta: f64, q: f64, force: f64, m: f64, s: f64) -> Result<(f64, f64, f64), StrErr> {
    let (root, k2, way) = (m.sqrt(), force / m, q.signum());
    let theta1 = amplitude(ellipf(theta, k2)? + way * root * s, k2)?;
    let sin1 = theta1.sin();
    let square = (s - way * (ellipeinc(theta1, k2)? - ellipeinc(theta, k2)?) / root) / k2;
    Ok((theta1, way * root * (1.0 - k2 * sin1 * sin1).sqrt(), square))
}

/// Between the two: sin(delta / 2) = tanh u.
fn separatrix(delta: f64, q: f64, force: f64, s: f64) -> (f64, f64, f64) {
    let (root, way) = (force.sqrt(), q.signum());
    let u = (0.5 * delta).sin().atanh();
    let u1 = u + way * root * s;
    let square = s - way * (u1.tanh() - u.tanh()) / root;
    (u1.sinh().atan(), way * root / u1.cosh(), square)
}

/// A circle, or a straight line: the force is left out, but for the curvature at the end.
fn arc([x, y, phi, kappa]: Section, a: f64, b: f64, s: f64) -> Section {
    let (turn, half) = (kappa * s, 0.5 * kappa * s);
    let chord = if half.abs() < 1e-8 { s } else { s * half.sin() / half };
    let (sin, cos) = (phi + half).sin_cos();
    let [dx, dy] = [chord * cos, chord * sin];
    // moment balance
    [x + dx, y + dy, phi + turn, kappa + a * dx + b * dy]
}
