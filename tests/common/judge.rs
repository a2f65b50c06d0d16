//! Whether a reported state is an equilibrium, from its numbers and the object alone.

use super::Scene;
use vibrissa::State;
use vibrissa::contact::ContactKind;

/// Points of the rod whose gap is measured.
const SAMPLES: usize = 300;

/// Everything that must hold of a reported state; the error says what does not.
pub fn judge(scene: &Scene, state: &State) -> Result<(), String> {
    let outcome = balances(scene, state).and_then(|()| contacts(scene, state)).and_then(|()| outside(scene, state));
    outcome.map_err(|what| located(scene, state, &what))
}

/// Whether the certificate knows the smallest gap of the whole rod.
pub fn judge_certified_gap(scene: &Scene, state: &State) -> Result<(), String> {
    let certified = state.certificate.min_gap.lower;
    let (least, s) = least_gap(scene, state)?;
    hold(certified <= least + 1e-9 * scene.length, || {
        located(scene, state, &format!("the gap at s = {s} is {least:e}, certified {certified:e}"))
    })
}

fn located(scene: &Scene, state: &State, what: &str) -> String {
    format!("{what}\nin phase {} at {:?}: {:?}\n{}", state.phase(), state.pose, state, scene.code())
}

fn hold(condition: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if condition { Ok(()) } else { Err(what()) }
}

/// Forces and moments about the clamp add up to nothing, nothing pulls, and the certificate says so.
fn balances(scene: &Scene, state: &State) -> Result<(), String> {
    let units = scene.rod().units();
    let (mut fx, mut fy, mut m) = (state.reactions.f0x, state.reactions.f0y, state.reactions.m0z);
    let (mut total, mut least) = (0.0, f64::INFINITY);
    for c in &state.contacts {
        let (px, py) = (c.force * c.alpha.sin(), -c.force * c.alpha.cos());
        (fx, fy) = (fx + px, fy + py);
        m += (c.x - state.pose.x) * py - (c.y - state.pose.y) * px;
        total += c.force.abs();
        least = f64::min(least, c.force);
    }
    hold(fx.abs() <= 1e-12 * total && fy.abs() <= 1e-12 * total, || format!("forces leave ({fx:e}, {fy:e})"))?;
    hold(m.abs() <= 1e-11 * total * units.length, || format!("moments leave {m:e}"))?;
    hold(least >= -1e-11 * units.force, || format!("a contact pulls with {least:e}"))?;
    let certificate = &state.certificate;
    hold(certificate.min_force.unwrap_or(f64::INFINITY) == least, || format!("the smallest force is {least:e}"))?;
    hold(certificate.residual <= 1e-10, || format!("residual {:e}", certificate.residual))?;
    let scale = 1.0 + total / units.force;
    let first_integral = certificate.first_integral.unwrap_or(0.0);
    hold(first_integral <= 1e-10 * scale, || format!("first integral {first_integral:e}"))?;
    hold(certificate.stable, || "not stable".into())?;
    hold(certificate.condition >= 1.0, || format!("condition {}", certificate.condition))?;
    hold(state.energy >= 0.0 && state.energy.is_finite(), || format!("energy {}", state.energy))
}

/// The contacts lie on the object in order, and the elastica meets them and ends without moment.
fn contacts(scene: &Scene, state: &State) -> Result<(), String> {
    let Scene { length, bumps, .. } = scene;
    let units = scene.rod().units();
    let rod = state.elastica(&scene.rod()).map_err(|e| e.to_string())?;
    let scale = 1.0 + rod.largest_curvature() * length;
    let mut before = 0.0;
    for (j, c) in state.contacts.iter().enumerate() {
        hold(before < c.s && c.s <= *length, || format!("contact {j} at s = {} after {before}", c.s))?;
        before = c.s;
        let last = j + 1 == state.contacts.len();
        let at = rod.at(c.s);
        let off = (at.x - c.x).hypot(at.y - c.y);
        hold(off <= 1e-9 * length, || format!("the rod misses contact {j} by {off:e}"))?;
        let piece = bumps.pieces[c.piece];
        // off the piece by rounding of the coordinates, which a steep flank amplifies
        let above = (c.y - piece.height(c.x)) / piece.slope(c.x).hypot(1.0);
        hold(above.abs() <= 1e-11 * (length + c.x.abs() + c.y.abs()), || format!("contact {j} off by {above:e}"))?;
        let angle = piece.slope(c.x).atan();
        match c.kind {
            ContactKind::Tangent | ContactKind::Tip => {
                hold((c.alpha - angle).sin().abs() <= 1e-9, || format!("contact {j}: alpha {} {angle}", c.alpha))?;
                let k = bumps.breaks.partition_point(|b| *b < c.x);
                let beside = |k: usize| bumps.breaks.get(k).is_some_and(|b| (b - c.x).abs() < 1e-9 * length);
                hold(k == c.piece || beside(k) || k.checked_sub(1).is_some_and(beside), || {
                    format!("contact {j} at x = {} is not on piece {}", c.x, c.piece)
                })?;
            }
            ContactKind::Notch => {
                let next = bumps.pieces[c.piece + 1].slope(c.x).atan();
                hold((c.x - bumps.breaks[c.piece]).abs() <= 1e-9 * length, || format!("notch {j} at x = {}", c.x))?;
                let inside = next - 1e-9 <= c.alpha && c.alpha <= angle + 1e-9;
                hold(inside, || format!("notch {j}: alpha {} not within {next} and {angle}", c.alpha))?;
            }
            kind => return Err(format!("a {kind} where parabolas only make notches")),
        }
        let lies = (at.phi - c.alpha).sin().abs();
        match c.kind {
            ContactKind::Tangent => hold(lies <= 1e-9 * scale, || format!("contact {j} crosses by {lies:e}"))?,
            _ => hold(last && c.s == *length, || format!("contact {j}, {:?}, is not the tip", c.kind))?,
        }
    }
    let moment = rod.moment(*length).abs();
    hold(moment <= 1e-9 * units.moment * scale, || format!("the tip carries the moment {moment:e}"))?;
    let reactions = rod.reactions();
    let same = |a: f64, b: f64, unit: f64| (a - b).abs() <= 1e-11 * unit * scale * scale;
    hold(
        same(reactions.f0x, state.reactions.f0x, units.force)
            && same(reactions.f0y, state.reactions.f0y, units.force)
            && same(reactions.m0z, state.reactions.m0z, units.moment),
        || format!("the elastica's reactions are {reactions:?}"),
    )
}

/// Nothing penetrates, neither by the certificate nor by the brute force.
fn outside(scene: &Scene, state: &State) -> Result<(), String> {
    let Scene { length, .. } = scene;
    let certified = state.certificate.min_gap.lower;
    hold(certified >= -1e-9 * length, || format!("the certificate's gap is {certified:e}"))?;
    let (least, s) = least_gap(scene, state)?;
    hold(least >= -1e-9 * length, || format!("the rod goes through the object by {least:e} at s = {s}"))
}

/// Smallest gap over samples of the rod, and where.
fn least_gap(scene: &Scene, state: &State) -> Result<(f64, f64), String> {
    let rod = state.elastica(&scene.rod()).map_err(|e| e.to_string())?;
    let gaps = rod.sample(SAMPLES).map(|at| scene.bumps.gap(at.x, at.y)).enumerate();
    let least = gaps.min_by(|a, b| a.1.total_cmp(&b.1));
    let (i, least) = least.ok_or("a rod without points")?;
    Ok((least, scene.length * i as f64 / (SAMPLES - 1) as f64))
}
