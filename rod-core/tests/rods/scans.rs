//! Equilibria of scans of object O1 (two parabolas) with a cone, a rod bent at rest, one of two sections, and one on an elastic clamp,
//! from another solver (shooting, with its states integrated again by DOP853): `tests/data/reference/rods`.

use crate::reference::largest;
use rod_core::{
    Bent, Clamp, Cone, Cut, ElasticClamp, Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, RodModel, RodSection,
    Sections, Smooth, Support, Supports, System, Uniform, Units, solve,
};
use serde_json::Value;
use std::path::Path;

/// The parabolas y = 5 (x - vertex)^2 with contacts from the clamp to the tip: t is x.
struct OnParabolas(Vec<(f64, Hold)>);

impl Supports for OnParabolas {
    fn count(&self) -> usize {
        self.0.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.0[j].1
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let slope = 10.0 * (t - self.0[j].0);
        let square = 1.0 + slope * slope;
        let y = 0.05 * slope * slope;
        Support { x: t, y, alpha: slope.atan(), speed: square.sqrt(), turning: 10.0 / square }
    }
}

/// A state of a file: the support of its clamp, the base of the rod, contacts and reactions.
struct State {
    phase: String,
    clamp: Pose,
    base: Pose,
    supports: OnParabolas,
    solution: Vec<f64>,
    reactions: [f64; 3],
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap()
}

fn file(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/reference/rods").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn states(file: &Value) -> Vec<State> {
    let turning_stiffness = file["clamp"]["kphi"].as_f64();
    let state = |state: &Value| {
        let reactions = ["f0x", "f0y", "m0z"].map(|name| number(state, name));
        let (mut supports, mut solution) = (Vec::new(), Vec::new());
        for contact in state["contacts"].as_array().unwrap() {
            let tip = contact["kind"] == "tip";
            let vertex = if contact["piece"] == 1 { 0.0 } else { 0.3 };
            supports.push((vertex, if tip { Hold::Tip } else { Hold::Tangent { offset: 0.0 } }));
            let third = number(contact, if tip { "phi_tip" } else { "s" });
            solution.extend([number(contact, "x"), number(contact, "force_n"), third]);
        }
        // a clamp that gives way is where its spring lets it: phi - m0z / k
        let turned = turning_stiffness.map_or(0.0, |stiffness| reactions[2] / stiffness);
        let clamp = Pose { x: number(state, "x0"), y: number(file, "y0"), phi: number(file, "phi0") };
        State {
            phase: state["phase"].as_str().unwrap().into(),
            clamp,
            base: Pose { phi: clamp.phi - turned, ..clamp },
            supports: OnParabolas(supports),
            solution,
            reactions,
        }
    };
    file["states"].as_array().unwrap().iter().map(state).collect()
}

/// The largest difference of solutions and reactions, each relative to 1 + |value|, and the largest moment and the largest miss of the
/// contacts where the rod is walked from the clamp under the reactions of the file.
fn compare<C: Clamp>(name: &str, rod: &impl RodModel, held: impl Fn(Pose) -> C) -> [f64; 2] {
    let (mut solved, mut walked): (f64, f64) = (0.0, 0.0);
    let states = states(&file(name));
    assert!(states.len() > 20);
    for State { clamp, base, supports, solution, reactions, .. } in &states {
        let problem = MultiPoint { rod, clamp: held(*clamp), supports };
        // nearby
        let mut u: Vec<f64> = solution.iter().enumerate().map(|(i, v)| v + 1e-3 * [1.0, -1.0][i % 2]).collect();
        let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        assert!(report.status.is_solved() && report.residual < 1e-12, "{name} {}: {report:?}", clamp.x);
        let mut differ = |ours: f64, theirs: f64| solved = solved.max((ours - theirs).abs() / (1.0 + theirs.abs()));
        u.iter().zip(solution).for_each(|(ours, theirs)| differ(*ours, *theirs));
        let nodes: Vec<Support> = (0..supports.count()).map(|j| supports.support(j, u[3 * j])).collect();
        let sum = |part: &dyn Fn(&Support) -> f64| {
            nodes.iter().zip(u[1..].iter().step_by(3)).map(|(n, f)| f * part(n)).sum::<f64>()
        };
        differ(-sum(&|node| node.alpha.sin()), reactions[0]);
        differ(sum(&|node| node.alpha.cos()), reactions[1]);
        differ(-problem.clamp_moment(&u), reactions[2]);
        let ours = problem.base(&u);
        differ(ours.x, base.x);
        differ(ours.y, base.y);
        differ(ours.phi, base.phi);

        // from the clamp, with nothing but the reactions and where the contacts are along the rod
        let [f0x, f0y, m0z] = *reactions;
        let (mut a, mut b) = (f0y, -f0x);
        let (mut s, mut cut) = (0.0, Cut { x: base.x, y: base.y, phi: base.phi, moment: -m0z });
        for (j, contact) in solution.chunks_exact(3).enumerate() {
            let tip = supports.hold(j) == Hold::Tip;
            let to = if tip { 1.0 } else { contact[2] };
            cut = rod.carry(s, &cut, a, b, to - s);
            s = to;
            let on = supports.support(j, contact[0]);
            let phi = if tip { contact[2] } else { on.alpha };
            walked = walked.max(largest([cut.x - on.x, cut.y - on.y, cut.phi - phi, 0.0].map(f64::abs)));
            a -= contact[1] * on.alpha.cos();
            b -= contact[1] * on.alpha.sin();
        }
        walked = walked.max(cut.moment.abs()).max(a.hypot(b));
    }
    println!("{name}: {} states, solved {solved:.1e}, walked from the clamp {walked:.1e}", states.len());
    [solved, walked]
}

/// What holds at an event, besides the equations of the equilibrium.
#[derive(Clone, Copy)]
enum Condition {
    /// An unknown of the contacts has a value.
    Fixed(usize, f64),
    /// The rod is tangential at its tip.
    TipTangent,
}

/// The equilibrium with the place of the clamp, which comes last, for one more unknown, and a condition for it.
struct Located<'a, M, H> {
    rod: &'a M,
    clamp: Pose,
    held: &'a H,
    supports: &'a OnParabolas,
    condition: Condition,
}

impl<M: RodModel, C: Clamp, H: Fn(Pose) -> C> System for Located<'_, M, H> {
    fn dimension(&self) -> usize {
        3 * self.supports.count() + 1
    }

    fn evaluate(&self, z: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        let (n, size) = (z.len() - 1, z.len());
        let clamp = (self.held)(Pose { x: z[n], ..self.clamp });
        let problem = MultiPoint { rod: self.rod, clamp, supports: self.supports };
        let last = self.supports.support(self.supports.count() - 1, z[n - 3]);
        residual[n] = match self.condition {
            Condition::Fixed(unknown, value) => z[unknown] - value,
            Condition::TipTangent => z[n - 1] - last.alpha,
        };
        let Some(matrix) = jacobian else { return problem.evaluate_into(&z[..n], residual, None) };
        matrix.fill(0.0);
        problem.evaluate_into(&z[..n], residual, Some((matrix, size)));
        matrix[n * size] = -1.0;
        match self.condition {
            Condition::Fixed(unknown, _) => matrix[unknown * size + n] = 1.0,
            Condition::TipTangent => {
                matrix[(n - 1) * size + n] = 1.0;
                matrix[(n - 3) * size + n] = -last.turning;
            }
        }
    }
}

/// The largest difference of the places of all events but folds, each solved for from the nearest state of the phase that has the
/// contact that comes, goes, or changes. A phase between two states is entered from its end.
fn compare_events<C: Clamp>(name: &str, rod: &impl RodModel, held: impl Fn(Pose) -> C) -> f64 {
    let file = file(name);
    let mut states = states(&file);
    let (mut worst, mut count): (f64, usize) = (0.0, 0);
    for event in file["events"].as_array().unwrap().iter().rev() {
        let [from, to] = ["frm", "to"].map(|name| event[name].as_str().unwrap().replace("free", ""));
        let kind = event["kind"].as_str().unwrap();
        if ["fold", "snap"].iter().any(|jump| kind.contains(jump)) {
            continue;
        }
        let between = !states.iter().any(|state| state.phase == from);
        let phase = if to.len() > from.len() || between && !to.is_empty() { &to } else { &from };
        let place = number(event, "x0");
        let away = |state: &&State| (state.clamp.x - place).abs();
        let nearest = states.iter().filter(|state| state.phase == *phase);
        let State { clamp, supports, solution, .. } = nearest.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
        let weakest =
            (0..supports.count()).min_by(|&i, &j| solution[3 * i + 1].total_cmp(&solution[3 * j + 1])).unwrap();
        let condition = match (from.as_str(), to.as_str()) {
            ("A", "B") => Condition::TipTangent,
            ("BB", "BA") if between => Condition::TipTangent,
            ("B", "A") => Condition::Fixed(2, 1.0),
            // the tip lets go, or the other contact is the one that comes
            ("BA", "B") => Condition::Fixed(4, 0.0),
            ("A", "BA") => Condition::Fixed(1, 0.0),
            _ => Condition::Fixed(3 * weakest + 1, 0.0),
        };
        let mut z = solution.clone();
        z.push(clamp.x);
        let located = Located { rod, clamp: *clamp, held: &held, supports, condition };
        let report = solve(&located, &mut z, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        assert!(report.status.is_solved(), "{name} {from} to {to}: {report:?}");
        let off = (z[z.len() - 1] - place).abs();
        println!("{name}: {from} to {to} at {:.12}, off by {off:.1e}", z[z.len() - 1]);
        worst = worst.max(off);
        count += 1;
        if between && !from.is_empty() {
            let along = supports.0.iter().map(|&(vertex, _)| (vertex, Hold::Tangent { offset: 0.0 }));
            let mut solution = z.clone();
            let x = solution.pop().unwrap();
            *solution.last_mut().unwrap() = 1.0;
            let clamp = Pose { x, ..*clamp };
            let supports = OnParabolas(along.collect());
            states.push(State { phase: from, clamp, base: clamp, supports, solution, reactions: [0.0; 3] });
        }
    }
    assert!(count > 3);
    worst
}

#[test]
fn events_are_where_another_solver_has_them() {
    let section =
        |length, bending_stiffness, natural_curvature| RodSection { length, bending_stiffness, natural_curvature };
    let halves = Sections::new(&[section(0.5, 1.0, 0.0), section(0.5, 0.25, 0.0)]).unwrap();
    let bent = Sections::new(&[section(1.0, 1.0, 0.5)]).unwrap();
    let clamp = ElasticClamp::springs(None, None, Some(20.0)).unwrap();
    for worst in [
        compare_events("two_sections.json", &halves, |pose| pose),
        compare_events("curved_0.5.json", &bent, |pose| pose),
        compare_events("cone_0.8.json", &Smooth::new(Cone { taper: 0.8 }).unwrap(), |pose| pose),
        compare_events("elastic_clamp_20.json", &Uniform, |pose| clamp.at(pose, &Units::ONE)),
    ] {
        assert!(worst < 1e-12, "{worst:e}");
    }
}

#[test]
fn equilibria_and_shapes_are_those_of_another_solver() {
    let section =
        |length, bending_stiffness, natural_curvature| RodSection { length, bending_stiffness, natural_curvature };
    let halves = Sections::new(&[section(0.5, 1.0, 0.0), section(0.5, 0.25, 0.0)]).unwrap();
    let arc = Sections::new(&[section(1.0, 1.0, 0.5)]).unwrap();
    let bent = Smooth::new(Bent::new(Cone { taper: 0.0 }, |_| 0.5)).unwrap();
    let cone = Smooth::new(Cone { taper: 0.8 }).unwrap();
    let clamp = ElasticClamp::springs(None, None, Some(20.0)).unwrap();
    for [solved, walked] in [
        compare("two_sections.json", &halves, |pose| pose),
        compare("curved_0.5.json", &arc, |pose| pose),
        compare("curved_0.5.json", &bent, |pose| pose),
        compare("cone_0.8.json", &cone, |pose| pose),
        compare("elastic_clamp_20.json", &Uniform, |pose| clamp.at(pose, &Units::ONE)),
    ] {
        assert!(solved < 1e-11 && walked < 1e-11, "{solved:e} {walked:e}");
    }
}
