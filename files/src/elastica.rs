//! The equilibria of a rod without contacts, as they are reported and written.

use crate::output::{OutputError, Staged, pretty_json, write_csv};
use crate::scene::ElasticaScene;
use crate::table::Table;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;
use vibrissa::Pose;
use vibrissa::rod::{AnyRod, ElasticaEquilibrium, RodModel, Section};

/// Equilibria of a rod without contacts.
#[derive(Debug)]
pub struct ElasticaRun {
    /// The rod and what is prescribed of it.
    pub scene: ElasticaScene,
    /// The equilibria that are wanted, the lowest potential energy first.
    pub equilibria: Vec<ElasticaEquilibrium<AnyRod>>,
    /// How many were found.
    pub found: usize,
}

/// elastica.json.
#[derive(Serialize)]
struct RunRecord<'a> {
    name: &'a str,
    x0: f64,
    y0: f64,
    phi0: f64,
    found: usize,
    equilibria: Vec<EquilibriumRecord>,
}

#[derive(Serialize)]
struct EquilibriumRecord {
    branch: usize,
    stable: bool,
    unstable_directions: usize,
    critical: bool,
    potential_energy: f64,
    bending_energy: f64,
    f0x: f64,
    f0y: f64,
    m0z: f64,
    tip: TipRecord,
    residual: f64,
}

#[derive(Serialize)]
struct TipRecord {
    x: f64,
    y: f64,
    phi: f64,
    fx: f64,
    fy: f64,
    moment: f64,
}

/// Columns of shapes.csv.
const POINT_COLUMNS: [&str; 7] = ["branch", "s", "x", "y", "phi", "kappa", "moment"];

impl ElasticaRun {
    /// Writes elastica.json and shapes.csv into the staged directory.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged) -> Result<(), OutputError> {
        staged.write(Path::new("elastica.json"), |file| pretty_json(file, &self.record()))?;
        staged.write(Path::new("shapes.csv"), |file| self.write_points(file))
    }

    fn record(&self) -> RunRecord<'_> {
        let Pose { x, y, phi } = self.scene.clamp;
        let record = |(branch, one): (usize, &ElasticaEquilibrium<AnyRod>)| {
            let Section { x, y, phi, .. } = tip(one);
            EquilibriumRecord {
                branch,
                stable: one.stable,
                unstable_directions: one.unstable_directions,
                critical: one.critical,
                potential_energy: one.potential_energy,
                bending_energy: one.bending_energy,
                f0x: one.reactions.f0x,
                f0y: one.reactions.f0y,
                m0z: one.reactions.m0z,
                tip: TipRecord { x, y, phi, fx: one.tip.fx, fy: one.tip.fy, moment: one.tip.moment },
                residual: one.residual,
            }
        };
        let equilibria = self.equilibria.iter().enumerate().map(record).collect();
        RunRecord { name: &self.scene.name, x0: x, y0: y, phi0: phi, found: self.found, equilibria }
    }

    fn write_points(&self, out: &mut dyn Write) -> io::Result<()> {
        let last = (self.scene.points - 1) as f64;
        let rows = self.equilibria.iter().enumerate().flat_map(|(branch, one)| {
            let length = one.shape.length();
            (0..self.scene.points).map(move |k| {
                let s = length * k as f64 / last;
                let Section { x, y, phi, kappa } = one.shape.at(s);
                (branch, s, x, y, phi, kappa, one.shape.moment(s))
            })
        });
        write_csv(out, &POINT_COLUMNS, rows)
    }

    /// What was found, for people to read.
    pub fn report(&self) -> String {
        let mut table = Table::new([
            "branch",
            "stable",
            "potential in J",
            "f0x in N",
            "f0y in N",
            "m0z in N m",
            "x in mm",
            "y in mm",
            "phi in degrees",
        ]);
        for (branch, one) in self.equilibria.iter().enumerate() {
            let at = tip(one);
            // no -0
            let number = |value: f64| format!("{:.6e}", value + 0.0);
            let fixed = |value: f64| format!("{:.4}", (1e4 * value).round() / 1e4 + 0.0);
            let stable = match (one.stable, one.unstable_directions) {
                (true, _) => "yes".to_owned(),
                (false, 0) => "critical".to_owned(),
                (false, directions) => format!("no ({directions})"),
            };
            let reactions = [one.reactions.f0x, one.reactions.f0y, one.reactions.m0z].map(number);
            let places = [1e3 * at.x, 1e3 * at.y, at.phi.to_degrees()].map(fixed);
            let first = [branch.to_string(), stable, number(one.potential_energy)];
            table.row(first.into_iter().chain(reactions).chain(places));
        }
        let found = counted_equilibria(self.found);
        let shown = match self.equilibria.len() {
            shown if shown < self.found => format!("; {shown} shown, see `branches`"),
            _ => String::new(),
        };
        format!("{}: {found}{shown}\n{table}", self.scene.name)
    }
}

fn counted_equilibria(count: usize) -> String {
    if count == 1 { "1 equilibrium found".to_owned() } else { format!("{count} equilibria found") }
}

/// The section at the tip.
fn tip<M: RodModel>(one: &ElasticaEquilibrium<M>) -> Section {
    one.shape.at(one.shape.length())
}
