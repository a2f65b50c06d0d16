//! What of the objects of a scene scans can touch: what `vibrissa reach` writes.

mod files;
mod report;

use crate::{Interrupt, Scene};
use vibrissa::Composite;
use vibrissa::plan::{IntervalSet, PlanError, Reach, ReachGrid, Touched, reach};
use vibrissa::rod::AnyRod;

/// The distances that are tried unless others are given, in rod lengths: from where to where, and how many. Nearer, the rod is bent more than
/// most rods bear; farther, it hardly reaches the object.
const DISTANCES: (f64, f64, u32) = (0.1, 0.9, 33);

/// What scans of a grid of distances and angles touch of the objects of a scene.
#[derive(Clone, Debug)]
pub struct Reached {
    /// Name of the scene.
    pub name: String,
    /// The objects.
    pub objects: Vec<Composite>,
    /// The scans that were asked for.
    pub grid: ReachGrid,
    /// What they touch.
    pub found: Reach,
    /// What they touch together.
    pub union: Touched,
}

/// How a part of an outline is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// By some scan with one contact.
    Single,
    /// Only while the rod has several contacts.
    Several,
    /// By none of the scans.
    Never,
}

/// Its name in files: `single`, `several` or `never`.
impl std::fmt::Display for Touch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Single => "single",
            Self::Several => "several",
            Self::Never => "never",
        })
    }
}

impl Scene {
    /// Sweeps the rod past the objects on straight scans at all `distances` (m, by default 0.1 to 0.9 of the rod's length) and `angles` (rad,
    /// by default that of the scene's path), both ways. The path of the scene is not used. Interrupted, it has fewer scans.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn reach(
        &self,
        distances: Option<Vec<f64>>,
        angles: Option<Vec<f64>>,
        interrupt: &Interrupt,
    ) -> Result<Reached, PlanError> {
        let angles = angles.unwrap_or_else(|| vec![self.path.at(0.0).phi]);
        Reached::new(&self.name, &self.rod, self.objects.clone(), distances, angles, interrupt)
    }
}

/// A part of an outline that is touched in one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlinePart {
    /// Number of the object, from 0.
    pub object: usize,
    /// Arc length from the start of the outline, m.
    pub from: f64,
    /// m
    pub to: f64,
    /// How it is touched.
    pub touch: Touch,
    /// Its ends, m.
    pub ends: [[f64; 2]; 2],
}

impl Reached {
    /// What scans at all `distances` (m, by default 0.1 to 0.9 of the rod's length) and `angles` (rad) touch of objects. Interrupted, there are
    /// fewer scans.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn new(
        name: &str,
        rod: &AnyRod,
        objects: Vec<Composite>,
        distances: Option<Vec<f64>>,
        angles: Vec<f64>,
        interrupt: &Interrupt,
    ) -> Result<Self, PlanError> {
        let length = rod.units().length;
        let (from, to, count) = DISTANCES;
        let share = |k: u32| f64::from(k) / f64::from(count - 1);
        let usual = || (0..count).map(|k| length * (from + (to - from) * share(k))).collect();
        let grid = ReachGrid { distances: distances.unwrap_or_else(usual), angles, ..ReachGrid::of(rod) };
        let all = (2 * grid.distances.len() * grid.angles.len()) as f64;
        let found = reach(rod, &objects, &grid, &|done| {
            interrupt.pass(done as f64 / all);
            !interrupt.is_raised()
        })?;
        let union = found.union();
        Ok(Self { name: name.to_owned(), objects, grid, found, union })
    }

    /// The outlines in parts, object after object, in order.
    pub fn outline_parts(&self) -> Vec<OutlinePart> {
        let mut all = Vec::new();
        for (object, (shape, outline)) in self.objects.iter().zip(&self.found.outlines).enumerate() {
            let mut parts: Vec<(f64, f64, Touch)> = Vec::new();
            for touch in [Touch::Single, Touch::Several, Touch::Never] {
                parts.extend(self.parts(object, touch).parts().iter().map(|(from, to)| (*from, *to, touch)));
            }
            parts.sort_by(|one, other| one.0.total_cmp(&other.0));
            let end = |place: f64| {
                let frame = outline.frame(shape, place);
                [frame.x, frame.y]
            };
            let part = |(from, to, touch): (f64, f64, Touch)| OutlinePart {
                object,
                from,
                to,
                touch,
                ends: [from, to].map(end),
            };
            all.extend(parts.into_iter().map(part));
        }
        all
    }

    /// Whether all scans were made.
    fn is_complete(&self) -> bool {
        self.found.scans.len() == 2 * self.grid.distances.len() * self.grid.angles.len()
    }

    /// The parts of the outline of an object (by its number from 0) that are touched so by any scan.
    pub fn parts(&self, object: usize, touch: Touch) -> IntervalSet {
        let (single, all) = (&self.union.single[object], self.union.all(object));
        match touch {
            Touch::Single => single.clone(),
            Touch::Several => all.without(single),
            Touch::Never => IntervalSet::of(0.0, self.found.outlines[object].length()).without(&all),
        }
    }

    /// Share of all outlines that is touched so by any scan.
    pub fn share(&self, touch: Touch) -> f64 {
        let length: f64 = (0..self.objects.len()).map(|object| self.parts(object, touch).length()).sum();
        length / self.found.length()
    }

    /// Share of all outlines that two passes at one distance and angle touch, with one contact and at all: those of the scans `2 cell` and
    /// `2 cell + 1`.
    pub fn shares_of_cell(&self, cell: usize) -> [f64; 2] {
        let mut touched = Touched::nothing(self.objects.len());
        self.found.scans.iter().skip(2 * cell).take(2).for_each(|scan| touched.extend(&scan.found.touched));
        self.shares_of(&touched)
    }

    /// Share of all outlines that is touched with one contact, and at all.
    pub fn shares_of(&self, touched: &Touched) -> [f64; 2] {
        let single: f64 = touched.single.iter().map(IntervalSet::length).sum();
        let all: f64 = (0..self.objects.len()).map(|object| touched.all(object).length()).sum();
        [single, all].map(|length| length / self.found.length())
    }
}
