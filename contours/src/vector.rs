//! Sums, products and distances of plane vectors.

/// From `p` to `q` by the fraction `t`; both come out exactly.
pub(crate) fn between(p: [f64; 2], q: [f64; 2], t: f64) -> [f64; 2] {
    [0, 1].map(|k| p[k] * (1.0 - t) + q[k] * t)
}

/// `p + s q`.
pub(crate) fn plus(p: [f64; 2], s: f64, q: [f64; 2]) -> [f64; 2] {
    [p[0] + s * q[0], p[1] + s * q[1]]
}

pub(crate) fn minus(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

pub(crate) fn scaled(factor: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [factor * x, factor * y]
}

pub(crate) fn dot(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[0] + p[1] * q[1]
}

/// The distance between two points, without overflow.
pub(crate) fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    let [x, y] = minus(q, p);
    x.hypot(y)
}

/// Positive where `q` is to the left of `p`.
pub(crate) fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}
