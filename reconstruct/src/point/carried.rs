//! Numbers with derivatives, carried along any rod.

use rod_core::{Cut, CutSensitivities, Dual, RodModel, Scalar};

/// Step of the differences of exact derivatives, relative to the largest rate of what is carried, 1 at least. Larger: truncation; smaller:
/// rounding. Both are 1e-8 of a second derivative here.
const STEP: f64 = 1e-4;

/// A cross-section of a bent rod.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CrossSection<T = f64> {
    pub x: T,
    pub y: T,
    pub phi: T,
    /// What the rod is followed by: its curvature where it is uniform, its moment otherwise.
    pub bend: T,
}

impl<T> CrossSection<T> {
    /// Its numbers, each changed alike.
    pub fn map<U>(self, mut change: impl FnMut(T) -> U) -> CrossSection<U> {
        let Self { x, y, phi, bend } = self;
        CrossSection { x: change(x), y: change(y), phi: change(phi), bend: change(bend) }
    }
}

/// An interval of a rod: its ends, and the force (A, B) that it carries.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RodInterval<T> {
    pub from: T,
    pub to: T,
    pub force: [T; 2],
}

impl<T> RodInterval<T> {
    fn map<U>(self, mut change: impl FnMut(T) -> U) -> RodInterval<U> {
        let Self { from, to, force } = self;
        RodInterval { from: change(from), to: change(to), force: force.map(change) }
    }
}

/// A number that any rod carries: a plain one, or one with derivatives, of which those that the rod's own sensitivities tell are exact.
pub(crate) trait Carried: Scalar {
    /// The cross-section at the end of an interval that starts with `start`.
    fn carry<M: RodModel>(model: &M, start: &CrossSection<Self>, along: &RodInterval<Self>) -> CrossSection<Self>;
}

impl Carried for f64 {
    fn carry<M: RodModel>(model: &M, start: &CrossSection, along: &RodInterval<f64>) -> CrossSection {
        let RodInterval { from, to, force: [a, b] } = *along;
        of_cut(model.carry(from, &cut(start), a, b, to - from))
    }
}

/// First derivatives are exact.
impl<const N: usize> Carried for Dual<f64, N> {
    fn carry<M: RodModel>(model: &M, start: &CrossSection<Self>, along: &RodInterval<Self>) -> CrossSection<Self> {
        let (end, by) = sensitive(model, &start.map(|v| v.value), &along.map(|v| v.value));
        with_derivatives(end, &by, start, along)
    }
}

fn with_derivatives<const N: usize>(
    end: CrossSection,
    by: &CutSensitivities,
    start: &CrossSection<Dual<f64, N>>,
    along: &RodInterval<Dual<f64, N>>,
) -> CrossSection<Dual<f64, N>> {
    let mut end = end.map(Dual::constant);
    for i in 0..N {
        let [x, y, phi, bend] = end_change(by, &start.map(|v| v.derivatives[i]), &along.map(|v| v.derivatives[i]));
        (end.x.derivatives[i], end.y.derivatives[i]) = (x, y);
        (end.phi.derivatives[i], end.bend.derivatives[i]) = (phi, bend);
    }
    end
}

/// A rate whose derivatives are known. Derivatives are symmetric: how the rate changes with a number is how the derivative by that number
/// changes along the rate. So one difference of the exact sensitivities is enough for all of them. First derivatives, and so the rate
/// itself, are exact.
impl<const N: usize> Carried for Dual<Dual<f64, N>, 1> {
    fn carry<M: RodModel>(model: &M, start: &CrossSection<Self>, along: &RodInterval<Self>) -> CrossSection<Self> {
        let (at, on) = (start.map(|v| v.value.value), along.map(|v| v.value.value));
        let rate = (start.map(|v| v.derivatives[0].value), along.map(|v| v.derivatives[0].value));
        let (end, here) = sensitive(model, &at, &on);
        let value = with_derivatives(end, &here, &start.map(|v| v.value), &along.map(|v| v.value));
        let size =
            [rate.0.x, rate.0.y, rate.0.phi, rate.0.bend, rate.1.from, rate.1.to, rate.1.force[0], rate.1.force[1]];
        let h = STEP / size.into_iter().fold(1.0, |most: f64, rate| most.max(rate.abs()));
        let beside = [h, -h].map(|h| {
            let moved = |value: f64, rate: f64| value + h * rate;
            let start =
                CrossSection { x: at.x, y: at.y, phi: moved(at.phi, rate.0.phi), bend: moved(at.bend, rate.0.bend) };
            let force = [0, 1].map(|i| moved(on.force[i], rate.1.force[i]));
            let along = RodInterval { from: moved(on.from, rate.1.from), to: moved(on.to, rate.1.to), force };
            sensitive(model, &start, &along).1
        });
        let mut rates = end_change(&here, &rate.0, &rate.1).map(Dual::<f64, N>::constant);
        for i in 0..N {
            let own = end_change(
                &here,
                &start.map(|v| v.derivatives[0].derivatives[i]),
                &along.map(|v| v.derivatives[0].derivatives[i]),
            );
            let (start, along) = (start.map(|v| v.value.derivatives[i]), along.map(|v| v.value.derivatives[i]));
            let [ahead, behind] = beside.map(|by| end_change(&by, &start, &along));
            for (k, rate) in rates.iter_mut().enumerate() {
                rate.derivatives[i] = own[k] + (ahead[k] - behind[k]) / (2.0 * h);
            }
        }
        let [x, y, phi, bend] = rates;
        let with = |value, rate| Dual { value, derivatives: [rate] };
        let CrossSection { x: at_x, y: at_y, phi: at_phi, bend: at_bend } = value;
        CrossSection { x: with(at_x, x), y: with(at_y, y), phi: with(at_phi, phi), bend: with(at_bend, bend) }
    }
}

/// The cut at a cross-section that is followed by its moment.
pub(super) fn cut(&CrossSection { x, y, phi, bend }: &CrossSection) -> Cut {
    Cut { x, y, phi, moment: bend }
}

/// The cross-section at a cut.
pub(super) fn of_cut(Cut { x, y, phi, moment }: Cut) -> CrossSection {
    CrossSection { x, y, phi, bend: moment }
}

fn sensitive<M: RodModel>(
    model: &M,
    start: &CrossSection,
    along: &RodInterval<f64>,
) -> (CrossSection, CutSensitivities) {
    let RodInterval { from, to, force: [a, b] } = *along;
    let (end, by) = model.carry_with_sensitivities(from, &cut(start), a, b, to - from);
    (of_cut(end), by)
}

/// How the end changes where the start and the interval change so.
fn end_change(by: &CutSensitivities, start: &CrossSection, along: &RodInterval<f64>) -> [f64; 4] {
    let [a, b] = along.force;
    let shift = [start.x, start.y, 0.0, 0.0];
    std::array::from_fn(|k| {
        let turned = shift[k] + start.phi * by.by_phi[k] + start.bend * by.by_moment[k];
        turned + a * by.by_a[k] + b * by.by_b[k] + along.from * by.by_from[k] + along.to * by.by_to[k]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_core::{Rod, Uniform, advance};

    type By = Dual<f64, 6>;
    type Rate = Dual<By, 1>;

    /// Of the uniform rod the closed form tells all derivatives; of a cone a shorter difference tells the second ones.
    #[test]
    fn derivatives_and_rates_along_a_rod_are_those_of_the_closed_form_and_of_differences() {
        let values = [0.3, 0.7, 1.9, 0.2, 0.8, 1.4];
        let rates = [1.1, -0.4, 3.0, 0.3, -0.2, 0.9];
        let of = |values: [f64; 6]| {
            let v: [Rate; 6] = std::array::from_fn(|i| Dual {
                value: By::variable(values[i], i),
                derivatives: [By::constant(rates[i])],
            });
            let start = CrossSection { x: v[1] * v[1], y: v[0], phi: v[5], bend: v[2] * v[3] };
            (start, RodInterval { from: v[3], to: v[4] + v[3] * v[0], force: [v[2], v[0] * v[1]] })
        };
        let all = |end: &CrossSection<Rate>| [end.x, end.y, end.phi, end.bend];
        let (start, along) = of(values);
        let found = Rate::carry(&Uniform, &start, &along);
        let CrossSection { x, y, phi, bend } = start;
        let section = rod_core::Section { x, y, phi, kappa: bend };
        let closed = advance(&section, along.force[0], along.force[1], along.to - along.from);
        for (found, closed) in all(&found).iter().zip([closed.x, closed.y, closed.phi, closed.kappa]) {
            assert!((found.value.value - closed.value.value).abs() < 1e-14);
            assert!((found.derivatives[0].value - closed.derivatives[0].value).abs() < 1e-13);
            for i in 0..6 {
                assert!((found.value.derivatives[i] - closed.value.derivatives[i]).abs() < 1e-13);
                let by_rate = closed.derivatives[0].derivatives[i];
                assert!((found.derivatives[0].derivatives[i] - by_rate).abs() < 1e-7 * (1.0 + by_rate.abs()));
            }
        }
        let cone = Rod::tapered(1.0, 0.01, 0.004, 1.0).unwrap();
        let found = Rate::carry(&cone, &start, &along);
        for i in 0..6 {
            let beside = [1e-6, -1e-6].map(|h| {
                let mut values = values;
                values[i] += h;
                let (start, along) = of(values);
                all(&Rate::carry(&cone, &start, &along)).map(|v| v.derivatives[0].value)
            });
            for (k, found) in all(&found).iter().enumerate() {
                let difference = (beside[0][k] - beside[1][k]) / 2e-6;
                let exact = found.derivatives[0].derivatives[i];
                assert!((difference - exact).abs() < 1e-6 * (1.0 + exact.abs()), "{i} {k}: {difference} {exact}");
            }
        }
    }
}
