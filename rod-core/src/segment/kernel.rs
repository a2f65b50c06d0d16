//! One segment between two contacts, exactly: the elastica under a constant force.
//!
//! Between contacts kappa' = A cos phi + B sin phi with A and B constant (Merker et al. 2020, eq. 10), a pendulum arc.
//! It is evaluated by the addition theorem of its flow, without any case distinction.

use super::basis::{Basis, agm, basis};
use super::dual::Dual;
use super::scalar::Scalar;

/// A cross-section of the rod: where it is, where it points, how it bends. Dimensionless (length of the rod = bending
/// stiffness = 1) inside the library; the kernel itself takes any consistent units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section<T = f64> {
    /// Position along x.
    pub x: T,
    /// Position along y.
    pub y: T,
    /// Slope angle, radians, unwrapped along the rod.
    pub phi: T,
    /// Curvature d phi / d s.
    pub kappa: T,
}

/// A part of the rod between two contacts, along which the force is constant: where it starts (at its end nearer to the clamp)
/// and the force. Dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<S = Section> {
    /// Arc length of its start.
    pub s: f64,
    /// The section where it starts.
    pub start: S,
    /// Force A: what the contacts ahead push with along x.
    pub a: f64,
    /// Force B, along y.
    pub b: f64,
}

/// Derivatives of the end of a segment, each as (x, y, phi, kappa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivities<T = f64> {
    /// By the slope angle at the start.
    pub by_phi: [T; 4],
    /// By the curvature at the start.
    pub by_kappa: [T; 4],
    /// By the force component A.
    pub by_a: [T; 4],
    /// By the force component B.
    pub by_b: [T; 4],
    /// By the length of the segment.
    pub by_s: [T; 4],
}

/// The end of the segment of length `s` (negative: backwards) that starts at `start` and carries the force (A, B):
/// kappa' = A cos phi + B sin phi.
///
/// Accuracy, absolute, measured against a solution of 32 digits on 10^4 random segments with |A|, |B| <= 20, |kappa| <= 6,
/// |phi| <= pi, |s| <= 1: 1e-15 in the median and 2e-14 at worst in `f64`, which is the conditioning of the problem; in
/// `f32` 5e-7 and 1e-5. Stronger forces let the rounding of the start grow like exp(sqrt(P) |s|) near the unstable direction. P = 0,
/// kappa = 0, s = 0 (the start, exactly) and coils need no special treatment. No allocation.
///
/// Derivatives through [`Dual`] arguments are exact except at A = B = 0, where the norm of (A, B) has none; there and
/// everywhere, [`advance_with_sensitivities`] is exact.
///
/// ```
/// use rod_core::{Section, advance};
/// // no force: a circular arc, a quarter of it
/// let start = Section { x: 0.0, y: 0.0, phi: 0.0, kappa: 2.0 };
/// let end = advance(&start, 0.0, 0.0, std::f64::consts::FRAC_PI_4);
/// assert!((end.x - 0.5).abs() < 1e-15 && (end.y - 0.5).abs() < 1e-15);
/// ```
#[inline]
pub fn advance<T: Scalar>(start: &Section<T>, a: T, b: T, s: T) -> Section<T> {
    let (sin, cos) = start.phi.sin_cos();
    let (c, d) = in_frame((a, b), (sin, cos));
    let p = (c * c + d * d).sqrt();
    let (ec, ed) = unit(c, d, p);
    let arc = Arc { q: start.kappa * T::from_f64(0.5), c, d, p, w: axial(c, d, p), cc: c * ec, cd: c * ed };
    let excess = arc.excess();
    let local = arc.end(&basis(p, excess, s));
    let angle = local.angle();
    Section {
        x: start.x + (cos * local.x - sin * local.y),
        y: start.y + (sin * local.x + cos * local.y),
        phi: start.phi + angle + whole_turns(start.kappa, (p, excess), angle, s),
        kappa: local.kappa,
    }
}

/// The end of a segment as [`advance`] gives it, with its exact derivatives by everything it depends on.
///
/// Every derivative is a sum of bounded terms: none is divided by P, M or kappa, so that a vanishing force (first contact,
/// release) is as good as any other. By `s` it is the differential equation itself, by the angle the rotation symmetry.
///
/// ```
/// use rod_core::{Section, advance_with_sensitivities};
/// // an unloaded straight rod of length 1: a force F across the tip's arm bends it like a cantilever does
/// let start = Section { x: 0.0, y: 0.0, phi: 0.0, kappa: 0.0 };
/// let (end, d) = advance_with_sensitivities(&start, 0.0, 0.0, 1.0_f64);
/// assert_eq!(end.x, 1.0);
/// assert!((d.by_a[1] - 1.0 / 6.0).abs() < 1e-15); // y by A: s^3 / 6
/// ```
#[inline]
pub fn advance_with_sensitivities<T: Scalar>(start: &Section<T>, a: T, b: T, s: T) -> (Section<T>, Sensitivities<T>) {
    let n = T::from_f64;
    let (zero, one, half) = (n(0.0), n(1.0), n(0.5));
    let (sin, cos) = start.phi.sin_cos();
    let (c, d) = in_frame((a, b), (sin, cos));
    let p = (c * c + d * d).sqrt();
    // Direction of the force. Where it vanishes any direction serves: the flow is smooth in (A, B), only its parts are not.
    let (ec, ed) = unit(c, d, p);

    // Three variables: kappa at the start and the force (c, d) in the frame of the start.
    let dual = |value, by_c, by_d| Dual { value, derivatives: [zero, by_c, by_d] };
    let q = Dual { value: start.kappa * half, derivatives: [half, zero, zero] };
    let arc = Arc {
        q,
        c: dual(c, one, zero),
        d: dual(d, zero, one),
        p: dual(p, ec, ed),
        w: dual(axial(c, d, p), (ec + one) * half, ed * half),
        cc: dual(c * ec, (n(2.0) - ec * ec) * ec, -ec * ec * ed),
        cd: dual(c * ed, ed * ed * ed, ec * ec * ec),
    };
    let excess = arc.excess();

    // The basis depends on these three through P and M - P only: two variables are enough for its expensive part.
    let flat = basis(Dual::variable(p, 0), Dual::variable(excess.value, 1), Dual::constant(s));
    let lift = |f: Dual<T, 2>| Dual {
        value: f.value,
        derivatives: core::array::from_fn(|i| {
            f.derivatives[0] * arc.p.derivatives[i] + f.derivatives[1] * excess.derivatives[i]
        }),
    };
    let local = arc.end(&Basis { s: lift(flat.s), c: lift(flat.c), d: lift(flat.d), v: lift(flat.v), k: lift(flat.k) });

    let (x, y) = (cos * local.x.value - sin * local.y.value, sin * local.x.value + cos * local.y.value);
    let angle = local.angle();
    let phi = start.phi + angle.value + whole_turns(start.kappa, (p, excess.value), angle.value, s);
    let kappa = local.kappa.value;
    let column = |i: usize| {
        let (dx, dy) = (local.x.derivatives[i], local.y.derivatives[i]);
        [cos * dx - sin * dy, sin * dx + cos * dy, angle.derivatives[i], local.kappa.derivatives[i]]
    };
    let (by_kappa, by_c, by_d) = (column(0), column(1), column(2));
    let combine = |u: T, v: T| core::array::from_fn(|i| u * by_c[i] + v * by_d[i]);
    let turned: [T; 4] = combine(-d, c);
    let (sin_end, cos_end) = phi.sin_cos();
    (
        Section { x: start.x + x, y: start.y + y, phi, kappa },
        Sensitivities {
            by_phi: [turned[0] - y, turned[1] + x, turned[2] + one, turned[3]],
            by_kappa,
            by_a: combine(sin, -cos),
            by_b: combine(-cos, -sin),
            by_s: [cos_end, sin_end, kappa, a * cos_end + b * sin_end],
        },
    )
}

/// The force (A, B) as (c, d) of [`Arc`] in the frame of a section with this direction (sine, cosine).
#[inline(always)]
pub(crate) fn in_frame<T: Scalar>((a, b): (T, T), (sin, cos): (T, T)) -> (T, T) {
    (a * sin - b * cos, -(a * cos + b * sin))
}

/// Direction (c, d) / P, and a fixed one where P = 0.
#[inline(always)]
fn unit<T: Scalar>(c: T, d: T, p: T) -> (T, T) {
    if p > T::from_f64(0.0) { (c / p, d / p) } else { (T::from_f64(1.0), T::from_f64(0.0)) }
}

/// P cos^2(delta / 2) = (P + c) / 2, written so that it does not cancel where the rod points against the force.
#[inline(always)]
pub(crate) fn axial<T: Scalar>(c: T, d: T, p: T) -> T {
    // Both forms and a look-up: which one it is cannot be predicted, and a wrong guess costs more than the division.
    let half = T::from_f64(0.5);
    [half * (p + c), half * d * d / (p - c)][usize::from(c < T::from_f64(0.0))]
}

/// The start of a segment in its own frame: force components c = P cos delta, d = P sin delta where delta is the angle
/// of the rod to the stable direction of the pendulum, and q = kappa / 2.
#[derive(Clone, Copy)]
pub(crate) struct Arc<T> {
    pub q: T,
    pub c: T,
    pub d: T,
    pub p: T,
    /// P cos^2(delta / 2).
    pub w: T,
    /// c^2 / P.
    pub cc: T,
    /// c d / P.
    pub cd: T,
}

/// The end of a segment in the frame of its start.
pub(crate) struct End<T> {
    pub x: T,
    pub y: T,
    /// Sine of half the turning angle, over `inverse`.
    pub sin: T,
    /// Cosine of half the turning angle, over `inverse`.
    pub cos: T,
    /// Reciprocal of the denominator that all of it shares.
    pub inverse: T,
    pub kappa: T,
}

impl<T: Scalar> End<T> {
    /// Turning angle, up to multiples of 4 pi.
    #[inline(always)]
    pub fn angle(&self) -> T {
        T::from_f64(2.0) * self.sin.atan2(self.cos)
    }
}

impl<T: Scalar> Arc<T> {
    /// M - P = q^2 - P cos^2(delta / 2), conserved along the segment: it tells how far the arc is from the separatrix.
    #[inline(always)]
    pub fn excess(&self) -> T {
        self.q * self.q - self.w
    }

    /// End of the segment in the frame of its start.
    ///
    /// With a = sin(delta / 2), b = cos(delta / 2) the flow's addition theorem gives a, b, q at the end; products are
    /// grouped so that a and b appear only with a factor P, which keeps every term bounded and smooth where P vanishes.
    /// In the half angle, C + V w stands for 1 - V P sin^2(delta / 2): close to the separatrix all of it is small, and
    /// the sum does not cancel.
    #[inline(always)]
    pub fn end(&self, at: &Basis<T>) -> End<T> {
        let (two, half) = (T::from_f64(2.0), T::from_f64(0.5));
        let Basis { s, c: cn, d: dn, v, k } = *at;
        let Arc { q, c, d, p: _, w, cc, cd } = *self;
        let w2 = d * half;
        let (sd, qs) = (s * dn, q * s);
        let inverse = T::from_f64(1.0) / (dn * dn + qs * qs);
        let (vsd, s3cd, qv2) = (v * sd, s * s * cn * sd, q * v * v);
        End {
            x: (sd - cc * vsd - half * (c - cc) * s3cd + d * qv2) * inverse + c * k,
            y: (qs * s + cd * vsd + half * (d - cd) * s3cd + c * qv2) * inverse - d * k,
            sin: qs * (cn + v * w) - v * w2 * dn,
            cos: dn * (cn + v * w) + v * w2 * qs,
            inverse,
            kappa: two * (q * cn - w2 * sd) * inverse,
        }
    }
}

/// What to add to the turning angle, known up to 4 pi, of a rod that coils.
#[inline(always)]
fn whole_turns<T: Scalar>(kappa: T, (p, excess): (T, T), angle: T, s: T) -> T {
    let zero = T::from_f64(0.0);
    let m = p + excess;
    // A pendulum that swings (M <= P) stays within a turn of the rod on either side: only one that goes round can coil.
    if excess > zero && m * s * s >= T::from_f64(LEAST_COIL) { counted_turns(kappa, m, excess, angle, s) } else { zero }
}

/// The same where it may coil: the half angle grows by pi in pi / agm(sqrt M, sqrt(M - P)), and in between runs ahead of that
/// mean, or behind it, by less than half of pi. So the whole angle is known to less than 2 pi.
#[cold]
#[inline(never)]
fn counted_turns<T: Scalar>(kappa: T, m: T, excess: T, angle: T, s: T) -> T {
    let rate = 2.0 * agm(m.sqrt(), excess.sqrt()).to_f64();
    let mean = if kappa < T::from_f64(0.0) { -rate } else { rate } * s.to_f64();
    let turn = 4.0 * core::f64::consts::PI;
    T::from_f64(turn * num_traits::Float::round((mean - angle.to_f64()) / turn))
}

/// Half the turning angle of a segment is at most sqrt(M) |s|; where M s^2 is below this it is known without counting turns.
pub(crate) const LEAST_COIL: f64 = core::f64::consts::PI * core::f64::consts::PI;

#[cfg(test)]
mod tests {
    use super::*;

    fn rk4(start: Section, a: f64, b: f64, s: f64, n: usize) -> Section {
        let f = |v: [f64; 4]| [v[2].cos(), v[2].sin(), v[3], a * v[2].cos() + b * v[2].sin()];
        let h = s / n as f64;
        let mut v = [start.x, start.y, start.phi, start.kappa];
        let add = |v: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| v[i] + h * k[i]);
        for _ in 0..n {
            let k1 = f(v);
            let k2 = f(add(v, k1, 0.5 * h));
            let k3 = f(add(v, k2, 0.5 * h));
            let k4 = f(add(v, k3, h));
            v = std::array::from_fn(|i| v[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        Section { x: v[0], y: v[1], phi: v[2], kappa: v[3] }
    }

    #[test]
    fn agrees_with_runge_kutta_in_every_regime() {
        for (phi, kappa, a, b) in [
            (0.3, 0.0, 0.0, 0.0),
            (0.3, 1.0, 0.0, 0.0),
            (1.0, 0.5, 3.0, -2.0),
            (1.5, -2.0, 4.0, 0.2),
            (0.0, 6.0, 20.0, 20.0),
            (-2.0, -6.0, 1e-9, 1e-12),
            (0.0, 14.0, 3.0, 1.0),
            (std::f64::consts::FRAC_PI_2, 0.0, 0.0, 5.0),
            (std::f64::consts::FRAC_PI_2, 0.0, 1e-9, -15.0),
        ] {
            let start = Section { x: 0.1, y: -0.2, phi, kappa };
            for s in [1.0, 0.35, -0.8] {
                let (e, r) = (advance(&start, a, b, s), rk4(start, a, b, s, 4000));
                for (u, v) in [(e.x, r.x), (e.y, r.y), (e.phi, r.phi), (e.kappa, r.kappa)] {
                    assert!((u - v).abs() < 2e-11 * (1.0 + v.abs()), "{phi} {kappa} {a} {b} {s}: {e:?} {r:?}");
                }
            }
        }
    }

    #[test]
    fn sensitivities_are_the_dual_derivatives() {
        for (phi, kappa, a, b, s) in [
            (0.3, 1.0, 2.0, 1.0, 0.7),
            (1.5, -2.0, 4.0, 0.2, -0.9),
            (0.0, 6.0, 20.0, 20.0, 1.0),
            (2.0, 9.0, 1.0, 1e-7, 1.0),
        ] {
            let start = Section { x: 0.0, y: 0.0, phi, kappa };
            let (end, d) = advance_with_sensitivities(&start, a, b, s);
            let v = |value, i| Dual::<f64, 5>::variable(value, i);
            let zero = Dual::constant(0.0);
            let e =
                advance(&Section { x: zero, y: zero, phi: v(phi, 0), kappa: v(kappa, 1) }, v(a, 2), v(b, 3), v(s, 4));
            assert_eq!(end, advance(&start, a, b, s));
            for (i, column) in [d.by_phi, d.by_kappa, d.by_a, d.by_b].into_iter().enumerate() {
                for (ours, dual) in column.into_iter().zip([e.x, e.y, e.phi, e.kappa]) {
                    let exact = dual.derivatives[i];
                    assert!((ours - exact).abs() < 1e-12 * (1.0 + exact.abs()), "{phi} {i}: {ours} {exact}");
                }
            }
        }
    }

    #[test]
    fn sensitivities_hold_where_the_force_vanishes() {
        for kappa in [0.0, 1.3, -7.0] {
            let start = Section { x: 0.0, y: 0.0, phi: 0.4, kappa };
            let (_, d) = advance_with_sensitivities(&start, 0.0, 0.0, 0.9);
            let h = 1e-4_f64;
            for (column, a, b) in [(d.by_a, h, 0.0), (d.by_b, 0.0, h)] {
                let (u, v) = (advance(&start, a, b, 0.9), advance(&start, -a, -b, 0.9));
                for (ours, diff) in column.into_iter().zip([u.x - v.x, u.y - v.y, u.phi - v.phi, u.kappa - v.kappa]) {
                    assert!((ours - diff / (2.0 * h)).abs() < 3e-9, "{kappa}: {ours} {}", diff / (2.0 * h));
                }
            }
        }
    }
}
