//! The golden-section search of both packages' judges.

/// The minimum of `f` between `a` and `b` by golden sections, to half the digits.
pub fn golden(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    const SHARE: f64 = 0.381_966_011_250_105_1;
    let mut u = a + SHARE * (b - a);
    let mut v = b - SHARE * (b - a);
    let (mut at_u, mut at_v) = (f(u), f(v));
    for _ in 0..45 {
        if at_u < at_v {
            (b, v, at_v) = (v, u, at_u);
            u = a + SHARE * (b - a);
            at_u = f(u);
        } else {
            (a, u, at_u) = (u, v, at_v);
            v = b - SHARE * (b - a);
            at_v = f(v);
        }
    }
    if at_u < at_v { u } else { v }
}
