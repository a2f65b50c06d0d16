//! The elastica from its clamp by Taylor's series, step by step: x' = cos phi, y' = sin phi, phi' = kappa,
//! kappa' = A cos phi + B sin phi, dimensionless.

/// Terms of the series: with steps of half a radian the last one is 1e-16 of the first.
const TERMS: usize = 18;

/// A section of the rod.
#[derive(Clone, Copy, Debug)]
pub struct At {
    pub x: f64,
    pub y: f64,
    pub phi: f64,
    pub kappa: f64,
}

/// A point force f (sin alpha, -cos alpha) at s.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    pub s: f64,
    pub force: f64,
    pub alpha: f64,
}

/// The series of x, y, phi and kappa from s on.
#[derive(Clone, Debug)]
struct Step {
    s: f64,
    series: [[f64; TERMS]; 4],
}

impl Step {
    fn new(s: f64, start: At, a: f64, b: f64) -> Self {
        let [mut x, mut y, mut phi, mut kappa] = [[0.0; TERMS]; 4];
        let [mut cos, mut sin] = [[0.0; TERMS]; 2];
        (x[0], y[0], phi[0], kappa[0]) = (start.x, start.y, start.phi, start.kappa);
        (sin[0], cos[0]) = start.phi.sin_cos();
        for n in 0..TERMS - 1 {
            let next = (n + 1) as f64;
            x[n + 1] = cos[n] / next;
            y[n + 1] = sin[n] / next;
            phi[n + 1] = kappa[n] / next;
            kappa[n + 1] = (a * cos[n] + b * sin[n]) / next;
            // (cos phi)' = -kappa sin phi
            let product = |with: &[f64; TERMS]| (0..=n).map(|k| kappa[k] * with[n - k]).sum::<f64>() / next;
            (cos[n + 1], sin[n + 1]) = (-product(&sin), product(&cos));
        }
        Self { s, series: [x, y, phi, kappa] }
    }

    fn at(&self, s: f64) -> At {
        let h = s - self.s;
        let [x, y, phi, kappa] = self.series.map(|c| c.iter().rev().fold(0.0, |sum, c| sum * h + c));
        At { x, y, phi, kappa }
    }
}

/// A rod of length 1.
#[derive(Clone, Debug)]
pub struct Rod {
    steps: Vec<Step>,
}

impl Rod {
    /// From the section at the clamp and the force (A, B) behind it; `loads` in order.
    pub fn new(clamp: At, (mut a, mut b): (f64, f64), loads: &[Load]) -> Self {
        let (mut steps, mut at, mut s) = (Vec::new(), clamp, 0.0);
        let ends = loads.iter().map(|load| load.s).chain([1.0]);
        for (j, end) in ends.enumerate() {
            // kappa^2 / 2 changes by no more than twice the force
            let rate = (at.kappa * at.kappa + 4.0 * a.hypot(b)).sqrt().max(1.0);
            let count = ((end - s) * rate / 0.5).ceil().max(1.0);
            let h = (end - s) / count;
            for _ in 0..count as usize {
                let step = Step::new(s, at, a, b);
                s += h;
                at = step.at(s);
                steps.push(step);
            }
            s = end;
            if let Some(load) = loads.get(j) {
                a -= load.force * load.alpha.cos();
                b -= load.force * load.alpha.sin();
            }
        }
        steps.push(Step::new(1.0, at, 0.0, 0.0));
        Self { steps }
    }

    /// The section at s.
    pub fn at(&self, s: f64) -> At {
        let after = self.steps.partition_point(|step| step.s <= s);
        self.steps[after.saturating_sub(1)].at(s)
    }

    /// The section at s as it is before a force there: curvature and position do not jump.
    pub fn tip(&self) -> At {
        self.at(1.0)
    }
}
