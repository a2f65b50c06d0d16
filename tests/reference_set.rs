//! The open reference set, `tests/reference/`: how far every handle of the library is from solutions of 30 digits, in units
//! of what the condition of a problem leaves to a solver in double precision.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use crate::common::Scene;
use crate::common::exact::Exact;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;
use vibrissa::contact::{Contact, ContactKind, EventKind, Outcome};
use vibrissa::rod::{
    Hold, MultiPoint, NewtonOptions, NewtonWorkspace, PhysicalRod, RodModel, RodSection, Section, Support, Supports,
    Uniform, VaryingRod, advance, solve,
};
use vibrissa::{CircularArc, ClampPath, Composite, Contour, Line, Parabola, Pose, Rod, State, Sweep, equilibrium};

/// The largest error that passes, in units of condition * epsilon.
const MOST: f64 = 10.0;

/// A handle, a problem, the units of condition * epsilon that it may be off instead, and why.
const EXCEPTIONS: &[(&str, &str, f64, &str)] = &[(
    "sweep",
    "o1-q60-snap-a-to-ba",
    40.0,
    "the fold is where the slope of the path parameter vanishes, which carries the rounding of the inverse of the Jacobian",
)];

/// Equilibria of the set that are not stable.
const UNSTABLE: [&str; 1] = ["a-strong-circle"];

/// Start values are off by this much of their natural size.
const PERTURBATION: f64 = 1e-3;

#[test]
fn digits_beyond_those_of_a_double_are_kept() {
    // 0.1 as a double is 0.1000000000000000055511151231257827...
    for (text, ours, error) in [
        ("0.1", 0.1, 5.551_115_123_125_783e-18 / 1.1),
        ("1.0e-1", 0.1, 5.551_115_123_125_783e-18 / 1.1),
        ("-0.100000000000000005551115123125782702", -0.1, 0.0),
        ("3000.00000000000000000000000000001", 3000.0, 1e-29 / 3001.0),
        ("2.5e-13", 2.5e-13 + 1e-20, 1e-20),
        ("0", 1e-30, 1e-30),
    ] {
        let found = Exact::parse(text).error(ours);
        assert!((found - error).abs() <= 1e-6 * error + 1e-36, "{text}: {found:e} against {error:e}");
    }
}

/// A file of the set.
struct Problem {
    name: String,
    kind: String,
    condition: f64,
    value: Value,
}

fn problems(kind: &str) -> Vec<Problem> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/problems");
    let read = |path| serde_json::from_str::<Value>(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut all: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| read(entry.unwrap().path()))
        .map(|value| Problem {
            name: value["name"].as_str().unwrap().to_owned(),
            kind: value["kind"].as_str().unwrap().to_owned(),
            condition: number(&value["condition"]),
            value,
        })
        .filter(|problem| problem.kind == kind)
        .collect();
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn exact(value: &Value) -> Exact {
    Exact::parse(value.as_str().unwrap())
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn point(value: &Value) -> [f64; 2] {
    [number(&value[0]), number(&value[1])]
}

/// The errors of one handle.
struct Table {
    handle: &'static str,
    rows: Vec<(String, f64, f64, String)>,
}

impl Table {
    fn new(handle: &'static str) -> Self {
        Self { handle, rows: Vec::new() }
    }

    /// Takes the largest of the errors, each with what is wrong by it.
    fn add(&mut self, problem: &Problem, errors: impl IntoIterator<Item = (String, f64)>) {
        let (what, error) = errors
            .into_iter()
            .fold((String::new(), 0.0), |most, next| if next.1 > most.1 || next.1.is_nan() { next } else { most });
        self.rows.push((problem.name.clone(), error, problem.condition, what));
    }

    /// Prints all, and fails where an error is larger than it may be.
    fn judge(self) {
        println!("{:38} {:>9} {:>9} {:>8}  largest of", self.handle, "error", "condition", "units");
        let mut wrong = Vec::new();
        for (name, error, condition, what) in self.rows {
            let units = error / (condition * f64::EPSILON);
            let exception = EXCEPTIONS.iter().find(|e| e.0 == self.handle && e.1 == name);
            let why = exception.map_or(String::new(), |e| format!(": {}", e.3));
            println!("{name:38} {error:9.1e} {condition:9.2e} {units:8.2}  {what}{why}");
            if units.is_nan() || units > exception.map_or(MOST, |e| e.2) {
                wrong.push(format!("{}, {name}: {what} is off by {error:e}, {units:.1} units", self.handle));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

#[test]
fn segments() {
    let mut table = Table::new("advance");
    for problem in problems("segment") {
        let value = &problem.value;
        let [x, y, phi, kappa] = ["x", "y", "phi", "kappa"].map(|key| number(&value["start"][key]));
        let (a, b) = (number(&value["force"]["a"]), number(&value["force"]["b"]));
        let end = advance(&Section { x, y, phi, kappa }, a, b, number(&value["length"]));
        let ours = [("x", end.x), ("y", end.y), ("phi", end.phi), ("kappa", end.kappa)];
        table.add(&problem, ours.map(|(key, v)| (key.to_owned(), exact(&value["end"][key]).error(v))));
    }
    assert!(table.rows.len() >= 15);
    table.judge();
}

/// A shape of the set, with what a solver needs of it.
#[derive(Clone, Copy)]
enum Shape {
    Parabola { vertex: [f64; 2], coefficient: f64 },
    Circle { centre: [f64; 2], radius: f64 },
    Line { point: [f64; 2], angle: f64 },
    Vertex { point: [f64; 2] },
}

impl Shape {
    fn read(value: &Value) -> Self {
        match value["shape"].as_str().unwrap() {
            "parabola" => {
                Self::Parabola { vertex: point(&value["vertex"]), coefficient: number(&value["coefficient"]) }
            }
            "circle" => Self::Circle { centre: point(&value["centre"]), radius: number(&value["radius"]) },
            "line" => Self::Line { point: point(&value["point"]), angle: number(&value["angle"]) },
            "vertex" => Self::Vertex { point: point(&value["point"]) },
            other => panic!("{other}"),
        }
    }

    /// By the abscissa from the vertex, the tangent angle, or the distance.
    fn support(self, t: f64) -> Support {
        match self {
            Self::Parabola { vertex: [x, y], coefficient } => {
                let slope = 2.0 * coefficient * t;
                let speed = slope.hypot(1.0);
                let turning = 2.0 * coefficient / (speed * speed);
                Support { x: x + t, y: y + coefficient * t * t, alpha: slope.atan(), speed, turning }
            }
            Self::Circle { centre: [x, y], radius } => {
                let (sin, cos) = t.sin_cos();
                Support { x: x + radius * sin, y: y - radius * cos, alpha: t, speed: radius, turning: 1.0 }
            }
            Self::Line { point: [x, y], angle } => {
                let (sin, cos) = angle.sin_cos();
                Support { x: x + t * cos, y: y + t * sin, alpha: angle, speed: 1.0, turning: 0.0 }
            }
            Self::Vertex { point: [x, y] } => Support { x, y, alpha: t, speed: 0.0, turning: 1.0 },
        }
    }

    /// The parameter of a contact.
    fn parameter(self, contact: &Value) -> f64 {
        let [x, y, alpha] = ["x", "y", "alpha"].map(|key| exact(&contact[key]).high);
        match self {
            Self::Parabola { vertex, .. } => x - vertex[0],
            Self::Circle { .. } | Self::Vertex { .. } => alpha,
            Self::Line { point, angle } => (x - point[0]) * angle.cos() + (y - point[1]) * angle.sin(),
        }
    }
}

fn shapes(problem: &Problem) -> Vec<Shape> {
    list(&problem.value["supports"]).iter().map(Shape::read).collect()
}

/// Where two parabolas of the same coefficient cross.
fn crossing(first: Shape, second: Shape) -> [f64; 2] {
    let (Shape::Parabola { vertex: u, coefficient: c }, Shape::Parabola { vertex: v, coefficient: d }) =
        (first, second)
    else {
        panic!("a notch of other shapes")
    };
    assert_eq!(c, d);
    let way = 0.5 * (v[0] - u[0]) + 0.5 * (v[1] - u[1]) / (c * (v[0] - u[0]));
    [u[0] + way, u[1] + c * way * way]
}

/// The contacts of a problem as supports.
struct Held(Vec<(Shape, Hold)>);

impl Held {
    fn new(problem: &Problem) -> Self {
        let shapes = shapes(problem);
        let held = |contact: &Value| match contact["hold"].as_str().unwrap() {
            "notch" => {
                let [i, j] = [0, 1].map(|k| contact["supports"][k].as_u64().unwrap() as usize);
                (Shape::Vertex { point: crossing(shapes[i], shapes[j]) }, Hold::Tip)
            }
            hold => {
                let shape = shapes[contact["support"].as_u64().unwrap() as usize];
                let offset = || contact["turns"].as_i64().unwrap() as f64 * PI;
                (shape, if hold == "tip" { Hold::Tip } else { Hold::Tangent { offset: offset() } })
            }
        };
        Self(list(&problem.value["contacts"]).iter().map(held).collect())
    }
}

impl Supports for Held {
    fn count(&self) -> usize {
        self.0.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.0[j].1
    }
    fn support(&self, j: usize, t: f64) -> Support {
        self.0[j].0.support(t)
    }
}

fn clamp(problem: &Problem) -> Pose {
    let [x, y, phi] = ["x", "y", "phi"].map(|key| number(&problem.value["clamp"][key]));
    Pose { x, y, phi }
}

/// The rod of a problem that has one.
fn rod(problem: &Problem) -> VaryingRod {
    let rod = &problem.value["rod"];
    let parts = list(&rod["sections"]);
    if !parts.is_empty() {
        let mut from = 0.0;
        let sections = parts.iter().map(|part| {
            let [to, bending_stiffness, natural_curvature] =
                ["to", "stiffness", "curvature"].map(|key| number(&part[key]));
            let length = to - from;
            from = to;
            RodSection { length, bending_stiffness, natural_curvature }
        });
        return Rod::sections(1.0, &sections.collect::<Vec<_>>()).unwrap();
    }
    // of stiffness 1 at the clamp, where the diameter is 1
    let cone = Rod::tapered(1.0, 1.0, 1.0 - number(&rod["taper"]), 64.0 / PI).unwrap();
    let [constant, slope] = point(&rod["curvature"]);
    if [constant, slope] == [0.0; 2] {
        return cone;
    }
    cone.with_natural_curvature(move |s: f64| constant + slope * s).unwrap()
}

/// What is different in the solution of the boundary-value problem.
fn of_the_equations(problem: &Problem, rod: impl RodModel) -> Vec<(String, f64)> {
    let held = Held::new(problem);
    let contacts = list(&problem.value["contacts"]);
    let mut u = Vec::new();
    for (j, contact) in contacts.iter().enumerate() {
        let (shape, hold) = held.0[j];
        let t = shape.parameter(contact);
        let at = shape.support(t);
        let force = exact(&contact["force"]).high;
        let third = exact(&contact[if hold == Hold::Tip { "phi" } else { "s" }]).high;
        u.push(t + PERTURBATION / (at.speed + at.turning.abs()));
        u.push(force + PERTURBATION * (1.0 + force));
        u.push(third - PERTURBATION);
    }
    let system = MultiPoint { rod, clamp: clamp(problem), supports: &held };
    let report = solve(&system, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
    assert!(report.status.is_solved(), "{}: {report:?}", problem.name);
    let mut errors = Vec::new();
    let [mut f0x, mut f0y] = [0.0; 2];
    for (j, contact) in contacts.iter().enumerate() {
        let at = held.support(j, u[3 * j]);
        let (force, third) = (u[3 * j + 1], u[3 * j + 2]);
        let (s, phi) = match held.hold(j) {
            Hold::Tip => (1.0, third),
            Hold::Tangent { offset } => (third, at.alpha + offset),
        };
        f0x -= force * at.alpha.sin();
        f0y += force * at.alpha.cos();
        let ours = [("x", at.x), ("y", at.y), ("alpha", at.alpha), ("force", force), ("s", s), ("phi", phi)];
        errors.extend(ours.map(|(key, v)| (format!("{key} {j}"), exact(&contact[key]).error(v))));
    }
    let ours = [("f0x", f0x), ("f0y", f0y), ("m0z", -system.clamp_moment(&u))];
    errors.extend(ours.map(|(key, v)| (key.to_owned(), exact(&problem.value["reactions"][key]).error(v))));
    errors
}

#[test]
fn contacts_by_the_boundary_value_problem() {
    let mut table = Table::new("solve");
    for problem in problems("contacts") {
        table.add(&problem, of_the_equations(&problem, Uniform));
    }
    for problem in problems("rod-contacts") {
        table.add(&problem, of_the_equations(&problem, rod(&problem)));
    }
    assert!(table.rows.len() >= 28);
    table.judge();
}

/// What is different in a state of a rod of length 1, and stiffness 1 at the clamp.
fn differences(problem: &Problem, rod: &impl PhysicalRod, state: &State) -> Vec<(String, f64)> {
    let contacts = list(&problem.value["contacts"]);
    assert_eq!(state.contacts.len(), contacts.len(), "{}", problem.name);
    let shape = state.elastica(rod).unwrap();
    let mut errors = Vec::new();
    for (j, (ours, contact)) in state.contacts.iter().zip(contacts).enumerate() {
        // a closed contour may count its angle from another turn
        let turned = |ours: f64, key: &str| ours - TAU * ((ours - exact(&contact[key]).high) / TAU).round();
        let all = [
            ("x", ours.x),
            ("y", ours.y),
            ("alpha", turned(ours.alpha, "alpha")),
            ("force", ours.force),
            ("s", ours.s),
            ("phi", shape.at(ours.s).phi),
        ];
        errors.extend(all.map(|(key, v)| (format!("{key} {j}"), exact(&contact[key]).error(v))));
    }
    let found = state.reactions;
    let ours = [("f0x", found.f0x), ("f0y", found.f0y), ("m0z", found.m0z)];
    errors.extend(ours.map(|(key, v)| (key.to_owned(), exact(&problem.value["reactions"][key]).error(v))));
    errors
}

/// Half the angle of a solid with a vertex where the set has one, and how long its sides are.
const HALF_ANGLE: f64 = 0.5;
const SIDE: f64 = 0.3;

/// The shapes as contours: parabolas joined, each other shape an object of its own.
fn objects(problem: &Problem) -> Vec<Composite> {
    let shapes = shapes(problem);
    let contacts = list(&problem.value["contacts"]);
    if let Shape::Parabola { .. } = shapes[0] {
        let pieces = shapes.iter().map(|shape| match *shape {
            Shape::Parabola { vertex, coefficient } => {
                Box::new(Parabola::new(vertex, coefficient).unwrap()) as Box<dyn Contour>
            }
            _ => panic!("parabolas and others"),
        });
        return vec![Composite::joined(pieces.collect()).unwrap()];
    }
    let object = |(shape, contact): (&Shape, &Value)| {
        let alpha = exact(&contact["alpha"]).high;
        match *shape {
            // its ends opposite to the contact
            Shape::Circle { centre, radius } => {
                Composite::single(CircularArc::new(centre, radius, alpha + FRAC_PI_2, alpha + FRAC_PI_2 + TAU).unwrap())
                    .unwrap()
            }
            Shape::Line { point: [x, y], angle } => {
                let (sin, cos) = angle.sin_cos();
                let ends = [-2.0, 2.0].map(|way| [x + way * cos, y + way * sin]);
                Composite::single(Line::new(ends[0], ends[1]).unwrap()).unwrap()
            }
            Shape::Vertex { point: [x, y] } => {
                let beside = |turn: f64| {
                    let (sin, cos) = (alpha + FRAC_PI_2 + turn).sin_cos();
                    [x + SIDE * cos, y + SIDE * sin]
                };
                Composite::polygon(&[[x, y], beside(-HALF_ANGLE), beside(HALF_ANGLE)]).unwrap()
            }
            Shape::Parabola { .. } => panic!("parabolas and others"),
        }
    };
    shapes.iter().zip(contacts).map(object).collect()
}

/// What is different in the equilibrium on contours.
fn of_the_contours(problem: &Problem, rod: &impl PhysicalRod) -> Vec<(String, f64)> {
    let shapes = shapes(problem);
    let guess = list(&problem.value["contacts"]).iter().map(|contact| {
        let number = |key: &str| exact(&contact[key]).high;
        let support = contact["support"].as_u64().unwrap_or(0) as usize;
        let (object, piece) = if matches!(shapes[0], Shape::Parabola { .. }) { (0, support) } else { (support, 0) };
        let (kind, piece) = match (contact["hold"].as_str().unwrap(), shapes[support]) {
            ("notch", _) => (ContactKind::Notch, 0),
            ("tip", _) => (ContactKind::Tip, piece),
            // the edge before the first point of a triangle
            (_, Shape::Vertex { .. }) => (ContactKind::Corner, 2),
            _ => (ContactKind::Tangent, piece),
        };
        let force = number("force");
        let shape = shapes[support];
        let t = shape.parameter(contact);
        let at = shape.support(t);
        let at = shape.support(t + PERTURBATION / (at.speed + at.turning.abs()));
        Contact {
            object,
            piece,
            kind,
            s: number("s") - PERTURBATION,
            x: at.x,
            y: at.y,
            alpha: number("alpha"),
            force: force + PERTURBATION * (1.0 + force),
            friction: None,
        }
    });
    let found = equilibrium(rod, &objects(problem), clamp(problem), &guess.collect::<Vec<_>>()).unwrap();
    let certificate = &found.state.certificate;
    assert!(found.report.status.is_solved(), "{}: {:?}", problem.name, found.report);
    assert!(
        certificate.min_gap.lower > -2e-11 && certificate.min_force.is_some_and(|force| force > 0.0),
        "{}: {certificate:?}",
        problem.name
    );
    assert_eq!(certificate.stable, !UNSTABLE.contains(&problem.name.as_str()), "{}", problem.name);
    differences(problem, rod, &found.state)
}

#[test]
fn contacts_on_contours() {
    let mut table = Table::new("equilibrium");
    for problem in problems("contacts") {
        table.add(&problem, of_the_contours(&problem, &Rod::new(1.0, 1.0).unwrap()));
    }
    for problem in problems("rod-contacts") {
        table.add(&problem, of_the_contours(&problem, &rod(&problem)));
    }
    table.judge();
}

/// What is different at the transition that is meant.
fn of_the_scan(problem: &Problem, rod: &impl PhysicalRod, outcome: &Outcome) -> Vec<(String, f64)> {
    let value = &problem.value;
    let phase = |key: &str| value["transition"][key].as_str().unwrap();
    let (from, to) = (phase("from"), phase("to"));
    let tau = exact(&value["tau"]);
    // the pose is clamp + tau motion
    assert_eq!((number(&value["clamp"]["x"]), number(&value["motion"]["x"])), (0.0, -1.0));
    let event = outcome
        .events
        .iter()
        .find(|e| e.from().to_string() == from && e.to().to_string() == to && (e.pose().x + tau.high).abs() < 1e-6)
        .unwrap_or_else(|| panic!("{}: no such event", problem.name));
    let snaps = matches!(event.kind, EventKind::Snap | EventKind::SnapOff);
    assert_eq!(snaps, value["transition"]["condition"] == "fold");
    let with_all =
        [&event.before, &event.after].into_iter().find(|s| s.contacts.len() == list(&value["contacts"]).len());
    let mut errors = differences(problem, rod, with_all.unwrap());
    errors.push(("tau".to_owned(), tau.error(-event.pose().x)));
    errors
}

#[test]
fn transitions_of_scans_with_other_rods() {
    let mut table = Table::new("sweep");
    for problem in problems("rod-transition") {
        let [x, y] = [1.0, number(&problem.value["clamp"]["y"])];
        let path = ClampPath::new(Pose { x, y, phi: FRAC_PI_2 }, Pose { x: -x, y, phi: FRAC_PI_2 }).unwrap();
        let (rod, objects) = (rod(&problem), objects(&problem));
        let outcome = Sweep::new(&rod, &objects, path, 0.01).unwrap().run();
        table.add(&problem, of_the_scan(&problem, &rod, &outcome));
    }
    assert_eq!(table.rows.len(), 4);
    table.judge();
}

#[test]
fn transitions_of_the_scans_of_the_paper() {
    let mut table = Table::new("sweep");
    for problem in problems("transition") {
        let value = &problem.value;
        let shapes = shapes(&problem);
        let heights: Vec<_> = shapes
            .iter()
            .map(|shape| match shape {
                Shape::Parabola { vertex, coefficient: 5.0 } => vertex[1],
                _ => panic!("not of the paper"),
            })
            .collect();
        let scene = Scene::paper(heights[0], heights[1], -number(&value["clamp"]["y"]));
        let outcome = scene.run_through();
        table.add(&problem, of_the_scan(&problem, &Rod::new(1.0, 1.0).unwrap(), &outcome));
    }
    assert!(table.rows.len() >= 10);
    table.judge();
}
