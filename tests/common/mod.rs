//! Scenes, and a judge of states that shares no code with the solver.
// each test takes what it needs
#![allow(dead_code)]

pub mod bumps;
pub mod exact;
pub mod golden;
pub mod judge;
pub mod numbers;

use bumps::Bumps;
use vibrissa::contact::{Item, Outcome};
use vibrissa::{ClampPath, Pose, Rod, State, Sweep};

pub const UP: f64 = std::f64::consts::FRAC_PI_2;

/// The three objects of the paper, in lengths of the rod: heights of the two vertices.
pub const OBJECTS: [(&str, f64, f64); 3] = [("O1", 0.0, 0.0), ("O2", 0.0, 0.1), ("O3", 0.1, 0.0)];

/// The paper's object with vertices at these heights.
pub fn object(first: f64, second: f64) -> Bumps {
    Bumps::new(&[(0.0, first, 5.0), (0.3, second, 5.0)]).expect("the two parabolas cross")
}

/// Everything a sweep needs, in one unit of length.
#[derive(Clone, Debug)]
pub struct Scene {
    pub length: f64,
    pub stiffness: f64,
    pub bumps: Bumps,
    pub from: Pose,
    pub to: Pose,
    /// Distance of the reported states: a length, or an angle where the clamp only turns.
    pub step: f64,
}

impl Scene {
    /// A dimensionless scan of the paper: the clamp, pointing up, at the distance `q` below the object.
    pub fn paper(first: f64, second: f64, q: f64) -> Self {
        let y = first.min(second) - q;
        Self {
            length: 1.0,
            stiffness: 1.0,
            bumps: object(first, second),
            from: Pose { x: 0.8, y, phi: UP },
            to: Pose { x: -1.0, y, phi: UP },
            step: 0.01,
        }
    }

    pub fn rod(&self) -> Rod {
        Rod::new(self.length, self.stiffness).expect("a rod")
    }

    pub fn path(&self) -> ClampPath {
        ClampPath::new(self.from, self.to).expect("a path")
    }

    pub fn run(&self) -> Outcome {
        let contour = self.bumps.contour().expect("the pieces cross");
        Sweep::new(&self.rod(), &contour, self.path(), self.step).expect("a step").run()
    }

    /// The same sweep, that must come to its end.
    pub fn run_through(&self) -> Outcome {
        let outcome = self.run();
        if let Some(stop) = &outcome.stop {
            panic!("{stop}\n{}", self.code());
        }
        outcome
    }

    /// States and events in the order in which they come.
    pub fn items(&self) -> Vec<Item> {
        let contour = self.bumps.contour().expect("the pieces cross");
        let sweep = Sweep::new(&self.rod(), &contour, self.path(), self.step).expect("a step");
        sweep.collect::<Result<_, _>>().unwrap_or_else(|stop| panic!("{stop}\n{}", self.code()))
    }

    /// The same scene in another unit: lengths times `scale`, and another stiffness.
    pub fn scaled(&self, scale: f64, stiffness: f64) -> Self {
        let pose = |p: Pose| Pose { x: p.x * scale, y: p.y * scale, ..p };
        let step = if self.path().turns_only() { self.step } else { self.step * scale };
        let bumps = self.bumps.scaled(scale);
        Self { length: self.length * scale, stiffness, bumps, from: pose(self.from), to: pose(self.to), step }
    }

    /// The scene seen in a mirror: x becomes -x.
    pub fn mirrored(&self) -> Self {
        let pose = |p: Pose| Pose { x: -p.x, y: p.y, phi: std::f64::consts::PI - p.phi };
        Self { bumps: self.bumps.mirrored(), from: pose(self.from), to: pose(self.to), ..self.clone() }
    }

    /// The same path the other way.
    pub fn backwards(&self) -> Self {
        Self { from: self.to, to: self.from, ..self.clone() }
    }

    /// The scene as code, for messages.
    pub fn code(&self) -> String {
        let Self { length, stiffness, bumps, from, to, step } = self;
        let pieces: Vec<_> = bumps
            .pieces
            .iter()
            .map(|b| format!("Box::new(Parabola::new([{:?}, {:?}], {:?})?)", b.x, b.y, b.coefficient))
            .collect();
        format!(
            "let contour = Composite::joined(vec![{}])?;\nlet path = ClampPath::new({from:?}, {to:?})?;\n\
             Sweep::new(&Rod::new({length:?}, {stiffness:?})?, &contour, path, {step:?})?",
            pieces.join(", ")
        )
    }
}

/// Whether two numbers agree to `tolerance`, relative to 1 + their size.
pub fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + b.abs())
}

/// What is different in two states of the same dimensionless rod, if anything.
pub fn difference(a: &State, b: &State, tolerance: f64) -> Option<String> {
    if a.phase() != b.phase() {
        return Some(format!("phase {} against {}", a.phase(), b.phase()));
    }
    let numbers = |s: &State| {
        let mut all = vec![
            ("x0", s.pose.x),
            ("y0", s.pose.y),
            ("phi0", s.pose.phi),
            ("f0x", s.reactions.f0x),
            ("f0y", s.reactions.f0y),
            ("m0z", s.reactions.m0z),
            ("energy", s.energy),
        ];
        for c in &s.contacts {
            all.extend([("s", c.s), ("x", c.x), ("y", c.y), ("alpha", c.alpha), ("force", c.force)]);
            all.push(("piece", c.piece as f64));
        }
        all
    };
    let (a, b) = (numbers(a), numbers(b));
    a.iter()
        .zip(&b)
        .find(|((_, u), (_, v))| !close(*u, *v, tolerance))
        .map(|((what, u), (_, v))| format!("{what} is {u:?} against {v:?}"))
}
