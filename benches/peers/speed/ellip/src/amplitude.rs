//! Jacobi's amplitude, which the crate `ellip` has not: the inverse of Legendre's first integral.

use ellip::{StrErr, ellipk};

/// am(u, m) by the arithmetic-geometric mean, DLMF 22.20(ii), for 0 < m < 1.
pub fn amplitude(u: f64, m: f64) -> Result<f64, StrErr> {
    // whole periods apart, or powers of two would cost the digits of u
    let period = 2.0 * ellipk(m)?;
    let turns = (u / period).round();
    let u = u - turns * period;
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    let mut ratios = [0.0; 12];
    let mut n = 0;
    while n < ratios.len() {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        ratios[n] = c / a;
        n += 1;
        if c.abs() < 1e-16 * a {
            break;
        }
    }
    let mut phi = u * a * f64::from(1_u32 << n);
    for ratio in ratios[..n].iter().rev() {
        phi = 0.5 * (phi + (ratio * phi.sin()).asin());
    }
    Ok(phi + turns * std::f64::consts::PI)
}
