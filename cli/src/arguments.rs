//! The command line.

use crate::accuracy_arguments::{Calibrate, Expect};
use crate::guide;
use crate::recording_arguments::{Moved, Written};
use crate::values::Values;
use crate::values::{
    degrees, directory, friction, index, largest_stress, no_quiet, not_negative, number, positive, rectangle, seed,
    speed, values,
};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use rod_files::{LargestStress, SensorAddress, Speed, StageDelay, Whisker};
use std::path::PathBuf;
use vibrissa::plan::Rectangle;
use vibrissa::reconstruct::Friction;
use vibrissa_cli::{FakeProtocol, FirstScene};

/// Simulates a flexible whisker that is dragged past an object, and reconstructs the object from the forces and the moment at
/// the base of the whisker.
#[derive(Debug, Parser)]
#[command(name = "vibrissa", version, after_help = guide::STATUS)]
pub struct Arguments {
    /// Print no report on standard output, only warnings and errors on standard error
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const RECONSTRUCT: &str = "\
Reconstruct contact points, phases and the contour from a recording of clamp reactions.

Writes points.jsonl (one object for each row of the recording, in order: clamp pose, contact point, label, and null with a
reason where there is no answer), contour.csv (stretches of the contour; gaps stay gaps) and report.json (rows, noise,
labels, kinks, gaps, a check by the physics and, with --truth, errors), SI units throughout. One contour is fitted to the whole
recording (fitted.csv). If it explains the recording, labels and points are those of the rod past it; if none does, the place where
the fit fails is named (status 2). Without noise nothing is fitted.

Several recordings are of one object, with one rod in one frame. One contour is fitted to all of them; if none explains all, each keeps
its own. Each recording has a folder of its name, and contour.csv, contour.svg and merged.json beside the folders are of all of them.";

const INSPECT: &str = "\
Look at a recording, a stage or tracked points of any layout: what it holds, what must be corrected, and the command that reads it.

Prints format, rate, gaps and the motion of the clamp, and for each column the meaning, unit, range and noise, with the reason: sure, likely
or open. With --rod the physics of the contacts gives units, axes and signs of the forces. All faults are in one table, with line, field, value and
expectation. A guess that is open is a question, and the option that answers it. Then comes the command line that reads the files; it has
been tried. Exit status 0: that command reads the files. Exit status 2: something must be corrected or answered first.";

const CALIBRATE: &str = "\
Find stiffness, gains, clamp angle and other errors of rod and sensor from recordings.

The errors are those that all samples of a scan share and that stay the same from scan to scan. They are estimated from the
conditions that the phases impose, and from the free rod; the object need not be known. Several recordings count together,
and are compared with each other. Bias and drift are subtracted from each recording, too, but not written. Writes a TOML file with
the rod and with value and standard deviation of each error, which `reconstruct --rod` subtracts from its recording, and
calibration.svg, the conditions before and after. Exit status 2: the recordings contradict each other (then nothing
is written) or their rod, or an estimate is beyond three times its budget.";

const BUDGET: &str = "\
Forecast the accuracy of a reconstruction, by source of error, before and after self-calibration.

Simulates the recording of the scene. From derivatives of the contact points with respect to each systematic error it computes
the standard deviation across the contour, before any correction and after the scan has calibrated itself. Then it draws
all errors from the budget, adds them to the recording and reconstructs it, --runs times. Writes budget.json and budget.svg.

With --rods it compares the scenes of a study, which differ in their rods, by the noise alone: the standard deviation across the contour, the
noise that is needed for the one of --sigma, and the largest stress. Writes rods.csv and rods.json.";

const ELASTICA: &str = "\
Find the equilibria of a rod without contacts: cantilevers, columns that buckle, rods between two clamps.

Writes elastica.json (reactions of the clamp, force and moment at the tip, energies, stability), shapes.csv (points of each shape) and
elastica.svg. The equilibrium of the lowest potential energy is branch 0. The search is sampled: it may miss equilibria, but each that it
gives fulfils the equations to 1e-12.";

const STUDY: &str = "\
Sweep a scene with some of its numbers changed, in all combinations, on all cores.

Writes rows.csv: for each scene its parameters, phases, snaps, way with several contacts, error of single-contact points there, share of
the contour that is touched, largest moment, or the reason why there is no sweep. An interrupted run continues when it is
started again.";

const PLAN: &str = "\
Choose the next scans of an object by what a reconstruction knows of it: expected new contour, precision, time and stress.

Objects that agree with the fitted contour are drawn, and straight scans at all distances and angles are swept past each of them, without
friction. Scans are taken one after the other, each time the one that adds most to the length of the touched contour. Together they touch at
least 63 % of what the best scans would. A scan whose clamp runs into one of the drawn objects, or that exceeds --stress, is not taken. Writes
candidates.csv, the most promising first, plan.json and plan.svg.

With --box nothing is known but that the object is in the box: the first scans go through it with the tip of the rod, and the clamp stays outside of it.
Each scan is for the case that those before it touched nothing. Writes plan.json and plan.svg.";

const REACH: &str = "\
Find which parts of the objects of a scene straight scans touch with one contact, with several, or never, on all cores.

Sweeps the rod on straight lines across its direction, at all distances and angles, to both sides, without friction. Rod and objects are
those of the scene; its path only gives the angle. Writes scans.csv (what each scan touches, its largest moment and stress), outline.csv (the
parts of the outlines, and how they are touched), reach.json and reach.svg.";

const LIVE: &str = "\
Read a sensor, and print contact points and phases during the scan.

The scan must begin with a free rod: its first second is the tare and gives the noise. The stage must start with the first
sample. Writes recording.csv (clamp poses, reactions and raw values; `vibrissa reconstruct` reads it), points.jsonl (one object for each
sample) and summary.json (losses, flags, latency), the first two during the scan. Ends when the clamp has arrived, the recording
ends, the sensor is silent for 3 s, or with Ctrl-C.";

const FORCES: &str = "\
Find the forces on a rod from points on it, frame by frame.

Each frame is explained by the elastica with the fewest contacts, none, one or two, each on the side or at the tip. Writes
forces.jsonl and forces.csv (contacts, forces, reactions of the base, standard deviations, chi squared, and a verdict on the frame),
rest.json (the curvature at rest, with --rest), frames.svg (shapes and forces) and forces.svg (force and moment over the frames).";

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a scene with comments, to begin with
    #[command(after_help = guide::INIT)]
    Init {
        /// The new file
        #[arg(default_value = "scene.toml")]
        file: PathBuf,
        #[command(flatten)]
        first: First,
    },
    /// Sweep the rod of a scene along its path: shapes, contacts and reactions of the clamp as tables and a figure
    #[command(after_help = guide::SWEEP)]
    Sweep {
        /// The scene, a TOML file
        scene: PathBuf,
        /// Directory of the results [default: out/<name of the scene>]
        #[arg(long, value_name = "DIR", value_parser = directory)]
        out: Option<PathBuf>,
    },
    /// Find the equilibria of a rod without contacts: under given forces, with its tip loaded, pinned or clamped, and which of them are stable
    #[command(long_about = ELASTICA, after_help = guide::ELASTICA)]
    Elastica {
        /// The rod, its clamp, its loads and its tip, a TOML file
        file: PathBuf,
        /// Directory of the results [default: out/<name of the file>]
        #[arg(long, value_name = "DIR", value_parser = directory)]
        out: Option<PathBuf>,
    },
    /// Write the contours of a scene as points (CSV), and a drawing of them beside it (SVG)
    #[command(after_help = guide::CONTOUR)]
    Contour {
        /// The scene, a TOML file
        scene: PathBuf,
        /// The CSV file, or - for standard output; the drawing has the same name with .svg, none for - [default: out/<name of the
        /// scene>/contour.csv]
        #[arg(long, alias = "out", value_name = "FILE")]
        file: Option<PathBuf>,
        /// Largest distance of a chord between two points from the contour, m [default: 1e-6 of the rod's length]
        #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
        tolerance: Option<f64>,
        /// Only this object, from 0
        #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = index)]
        object: Option<usize>,
    },
    /// List the shapes that objects are made of, with fields and units
    #[command(after_help = guide::SHAPES, arg = no_quiet())]
    Shapes,
    /// Write what a sensor at the clamp would record along a scene (CSV, SI units: t,x0,y0,phi0,f0x,f0y,m0z)
    #[command(after_help = guide::SIMULATE)]
    Simulate(Simulate),
    /// Look at a recording, a stage or tracked points of any layout: what it holds, what must be corrected, and the command that reads it
    #[command(long_about = INSPECT, after_help = guide::INSPECT)]
    Inspect(Inspect),
    /// Reconstruct contact points, phases and the contour from a recording of clamp reactions
    #[command(long_about = RECONSTRUCT, after_help = guide::RECONSTRUCT)]
    Reconstruct(Reconstruct),
    /// Find the forces on a rod from points on it, frame by frame: tracked whiskers, images, or a part of the signal at the base
    #[command(long_about = FORCES, after_help = guide::FORCES)]
    Forces(Forces),
    /// Find stiffness, gains, clamp angle and other errors of rod and sensor from recordings
    #[command(long_about = CALIBRATE, after_help = guide::CALIBRATE)]
    Calibrate(Calibrate),
    /// Forecast the accuracy of a reconstruction, by source of error, before and after self-calibration
    #[command(long_about = BUDGET, after_help = guide::BUDGET)]
    Budget(Expect),
    /// Read a sensor, and print contact points, phases and flags during the scan
    #[command(long_about = LIVE, after_help = guide::LIVE)]
    Live(Live),
    /// Send what a sensor would send along a scene, for tests without a sensor
    #[command(after_help = guide::FAKE_SENSOR)]
    FakeSensor(FakeSensor),
    /// Sweep a scene with some of its numbers changed, in all combinations, on all cores: one row of results for each
    #[command(long_about = STUDY, after_help = guide::STUDY)]
    Study {
        /// The study, a TOML file
        study: PathBuf,
        /// Directory of the results [default: out/<name of the study>]
        #[arg(long, value_name = "DIR", value_parser = directory)]
        out: Option<PathBuf>,
        /// Sweep nothing, and print this scene of the study, by its number in rows.csv, as a scene file
        #[arg(long, value_name = "N", conflicts_with = "out")]
        scene: Option<usize>,
        /// Number of threads [default: one for each core]
        #[arg(long, value_name = "N", visible_alias = "threads", allow_negative_numbers = true, value_parser = number)]
        jobs: Option<usize>,
    },
    /// Find which parts of the objects of a scene straight scans touch with one contact, with several, or never, on all cores
    #[command(long_about = REACH, after_help = guide::REACH)]
    Reach(ReachArguments),
    /// Choose the next scans of an object by what a reconstruction knows of it: expected new contour, precision, time and stress
    #[command(long_about = PLAN, after_help = guide::PLAN)]
    Plan(PlanArguments),
    /// Run the nine scans of Merker et al. (2020) and compare their phases with the paper's
    #[command(after_help = guide::PAPER)]
    Paper {
        /// Directory of the results
        #[arg(long, value_name = "DIR", default_value = "out", value_parser = directory)]
        out: PathBuf,
    },
    /// Print the completions of a shell
    #[command(after_help = guide::COMPLETIONS, arg = no_quiet())]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page of vibrissa, or of one of its commands
    #[command(after_help = guide::MAN, arg = no_quiet())]
    Man {
        /// The command
        command: Option<String>,
    },
}

/// The next scans.
#[derive(Debug, Args)]
pub struct PlanArguments {
    /// Directory of `vibrissa reconstruct`, with the fitted contour (fitted.csv)
    #[arg(required_unless_present = "bounds")]
    pub result: Option<PathBuf>,
    /// In place of a result: a box around an object of which nothing else is known, m. Gives the first scans, through space of which nothing is known
    #[arg(long = "box", value_name = "X0,Y0,X1,Y1", value_parser = rectangle, allow_hyphen_values = true,
        conflicts_with_all = ["result", "paths", "distances", "noise", "rate", "speed", "hypotheses", "seed"])]
    pub bounds: Option<Rectangle>,
    /// The rod, a TOML file with the table [rod] of a scene, or a scene
    #[arg(long, value_name = "FILE")]
    pub rod: PathBuf,
    /// Distances of the clamp's path from the object, m: from:to:count, or several with commas between them [default: 0.2 to 0.8 lengths of
    /// the rod, 5 of them]
    #[arg(long, value_name = "METRES", value_parser = values, allow_hyphen_values = true)]
    pub distances: Option<Values>,
    /// Directions of the rod at its clamp, degrees, in the same form [default: 24 all around]
    #[arg(long, value_name = "DEGREES", value_parser = values, allow_hyphen_values = true)]
    pub angles: Option<Values>,
    /// Further scans to judge, a TOML file with tables [[scan]] (distance, angle, pass) or [[path]] (from, angle, and to, or pivot and turn)
    #[arg(long, value_name = "FILE")]
    pub paths: Option<PathBuf>,
    /// Most scans to choose
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = number, allow_negative_numbers = true)]
    pub scans: usize,
    /// Largest bending stress that the rod bears, Pa, or `any` [default: yield_stress of the rod]
    #[arg(long, value_name = "PA", value_parser = largest_stress, allow_negative_numbers = true)]
    pub stress: Option<LargestStress>,
    /// The noise of the sensor, a TOML file as for `simulate`: predicts standard deviations
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// Samples in a second
    #[arg(long, value_name = "HZ", value_parser = positive, default_value_t = 500.0, allow_negative_numbers = true)]
    pub rate: f64,
    /// Speed of the clamp: a number in m/s, or with a unit as "1 mm/s"
    #[arg(long, value_name = "SPEED", value_parser = speed, default_value = "1e-3", allow_negative_numbers = true)]
    pub speed: f64,
    /// Objects that are drawn: more take longer, and give more accurate expectations
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = number, allow_negative_numbers = true)]
    pub hypotheses: usize,
    /// Seed of the draws: the same one gives the same plan
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = seed)]
    pub seed: u64,
    /// Directory of the results [default: out/plan]
    #[arg(long, value_name = "DIR", default_value = "out/plan", value_parser = directory)]
    pub out: PathBuf,
    /// Number of threads [default: one for each core]
    #[arg(long, value_name = "N", visible_alias = "threads", allow_negative_numbers = true, value_parser = number)]
    pub jobs: Option<usize>,
}

/// Scans to be tried.
#[derive(Debug, Args)]
pub struct ReachArguments {
    /// The scene, a TOML file
    pub scene: PathBuf,
    /// Distances of the clamp's path from the object's nearest point along the rod, m: from:to:count, or several with commas between them
    /// [default: 0.1 to 0.9 lengths of the rod, 33 of them]
    #[arg(long, value_name = "METRES", value_parser = values, allow_hyphen_values = true)]
    pub distances: Option<Values>,
    /// Directions of the rod at its clamp, degrees, in the same form [default: that of the scene]
    #[arg(long, value_name = "DEGREES", value_parser = values, allow_hyphen_values = true)]
    pub angles: Option<Values>,
    /// Directory of the results [default: out/<name of the scene>]
    #[arg(long, value_name = "DIR", value_parser = directory)]
    pub out: Option<PathBuf>,
    /// Number of threads [default: one for each core]
    #[arg(long, value_name = "N", visible_alias = "threads", allow_negative_numbers = true, value_parser = number)]
    pub jobs: Option<usize>,
}

/// Which scene `init` writes.
#[derive(Debug, Args)]
#[group(multiple = false)]
pub struct First {
    /// A whisker that turns about a point behind its base, past a peg and back
    #[arg(long)]
    whisking: bool,
    /// A scene with the commands that simulate the recording of a sensor and reconstruct the object from it
    #[arg(long)]
    recording: bool,
    /// A rod past an object with straight edges
    #[arg(long)]
    polygon: bool,
    /// An average whisker of a rat, by row and column as C2, or of a mouse as mouse:C2, that turns past a peg and back
    #[arg(long, value_name = "WHISKER")]
    whisker: Option<Whisker>,
}

impl First {
    /// The scene that is asked for.
    pub fn scene(self) -> FirstScene {
        match self {
            Self { whisker: Some(whisker), .. } => FirstScene::Whisker(whisker),
            Self { whisking: true, .. } => FirstScene::Whisking,
            Self { recording: true, .. } => FirstScene::Recording,
            Self { polygon: true, .. } => FirstScene::Polygon,
            _ => FirstScene::Ellipse,
        }
    }
}

/// A scan with a sensor.
#[derive(Debug, Args)]
pub struct Live {
    /// Address of the sensor: rdt://HOST[:PORT][?scaling=PORT], serial:PATH:PROFILE[:BAUD] (gsv8, gsv6, bota, optoforce, robotiq)
    /// or file:RECORDING (CSV, TSV, LVM, TDMS, MCAP)
    #[arg(long, value_name = "ADDRESS")]
    pub sensor: SensorAddress,
    /// The rod, a TOML file with the table [rod] of a scene, perhaps with a calibration; or a scene
    #[arg(long, value_name = "FILE")]
    pub rod: PathBuf,
    #[command(flatten)]
    pub moved: Moved,
    /// How the sensor is set up, a TOML file: units and counts, calibration, mounting, accuracy, tare,
    /// columns of a recording, and the size of the systematic errors [errors]
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// Take samples and rod for exact: no systematic errors are estimated, whatever --setup has
    #[arg(long)]
    pub as_is: bool,
    /// Directory of the results
    #[arg(long, value_name = "DIR", default_value = "out/live", value_parser = directory)]
    pub out: PathBuf,
    #[command(flatten)]
    pub written: Written,
}

/// Files to look at.
#[derive(Debug, Args)]
pub struct Inspect {
    /// Recordings (CSV, TSV, LVM, XLSX, TDMS, MCAP), the table of a stage, or tracked points (frame,x,y). A sensor and its stage are put
    /// together by their times
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// The rod, a TOML file with the table [rod] of a scene, or a scene: its stiffness and length give the units
    #[arg(long, value_name = "FILE")]
    pub rod: Option<PathBuf>,
    /// The setup of the sensor, a TOML file as for `live`, if there is one
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// Delay of the clock of the stage's table, as for `reconstruct`: it is added to the times of the stage
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub stage_delay: Option<StageDelay>,
    /// Write the setup file that the command needs, with comments
    #[arg(long, value_name = "FILE", conflicts_with = "setup")]
    pub write_setup: Option<PathBuf>,
    /// Print the report as JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub written: Written,
}

/// Recordings to be reconstructed.
#[derive(Debug, Args)]
pub struct Reconstruct {
    /// The recordings: CSV, TSV or LVM with the columns x0,y0 (m), phi0 (rad), f0x,f0y (N), m0z (N m), perhaps t (s) and the
    /// standard deviations sigma_f0x,sigma_f0y,sigma_m0z; other units in the names, as `f0x [mN]`. With --stage also wrenches and raw
    /// values, in these files, TDMS and MCAP. Several are of one object and one rod
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
    /// The rod, a TOML file with the table [rod] of a scene, perhaps with a calibration; or a scene
    #[arg(long, value_name = "FILE")]
    pub rod: PathBuf,
    /// The scene that the recordings are of, to compare with
    #[arg(long, value_name = "SCENE")]
    pub truth: Option<PathBuf>,
    /// Directory of the results [default: out/<name of the recording>, of several out/merged]
    #[arg(long, value_name = "DIR", value_parser = directory)]
    pub out: Option<PathBuf>,
    /// Of several recordings: move them onto each other along this direction, degrees from x, before their contours are merged
    /// [default: none is moved]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = degrees)]
    pub align: Option<f64>,
    /// Answer samples from their neighbours alone, in a fraction of a second. No contour is fitted to the whole recording, which takes seconds, or a
    /// minute where none explains it; contradictions within the recording are not found
    #[arg(long)]
    pub local: bool,
    #[command(flatten)]
    pub moved: Moved,
    #[command(flatten)]
    pub trust: Trust,
    #[command(flatten)]
    pub written: Written,
}

/// Frames of a rod.
#[derive(Debug, Args)]
pub struct Forces {
    /// Points on the rod, a CSV file with the columns frame,x,y and perhaps sigma: one row a point, in order from the base to the tip. Or measured
    /// numbers at its base, one row a frame: any of x0,y0 (m), phi0 (rad), f0x,f0y (N), m0z (N m), those of a sensor (--setup), base_x,base_y,base_phi, and at the
    /// arc length S in m kappa@S (1/m), x@S, y@S (m), phi@S (rad), each perhaps with sigma_...
    #[arg(value_name = "FRAMES")]
    pub frames: PathBuf,
    /// The rod, a TOML file with the table [rod] of a scene, or a scene. Without bending_stiffness and youngs_modulus forces are in EI/L^2,
    /// and columns of forces and moments are refused
    #[arg(long, value_name = "FILE")]
    pub rod: PathBuf,
    /// Frames of the same rod in which nothing touches it, as FRAMES: its curvature at rest is found from them, in place of that of the rod's file
    #[arg(long, value_name = "FILE")]
    pub rest: Option<PathBuf>,
    /// Length of the rod, m, in place of that of its file
    #[arg(long, value_name = "METRES", value_parser = positive, allow_negative_numbers = true)]
    pub length: Option<f64>,
    /// Measured numbers beside the points, a CSV file with the column frame and columns as FRAMES may have them
    #[arg(long, value_name = "FILE")]
    pub channels: Option<PathBuf>,
    /// How the sensor sits whose components Fx,Fy,Fz (N), Tx,Ty,Tz (N m) are columns of measured numbers: the table [mounting] of a TOML file, as for
    /// `live` [default: in the axes of the frames, at the base]. Without any of these columns it is refused
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// Metres per unit of x and y, as the size of a pixel
    #[arg(long, value_name = "METRES", value_parser = positive, default_value_t = 1.0, allow_negative_numbers = true)]
    pub scale: f64,
    /// y counts down, as in images: it is turned
    #[arg(long)]
    pub image: bool,
    /// Which ends of the rod the points show: the first one is the base, or the last one the tip. With both, how much too short the rod looks
    #[arg(long, value_enum, default_value_t = Visible::Base)]
    pub visible: Visible,
    /// Standard deviation of each coordinate of the points, m [default: found in the film]
    #[arg(long, value_name = "METRES", value_parser = positive, allow_negative_numbers = true)]
    pub sigma: Option<f64>,
    /// Largest coefficient of Coulomb friction at contacts on the side
    #[arg(long, value_name = "MU", value_parser = not_negative, default_value_t = 0.0, allow_negative_numbers = true)]
    pub friction: f64,
    /// Largest number of contacts
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=2), default_value_t = 2, allow_negative_numbers = true)]
    pub contacts: u8,
    /// All frames that have a contact touch one round pole, and no frame has more than one contact. The pole is found from them; or its centre is given, as x and y are in the
    /// table (with a minus sign: --pole=-3,5)
    #[arg(long, value_name = "X,Y", num_args = 0..=1, default_missing_value = "anywhere", value_parser = pole, allow_negative_numbers = true)]
    pub pole: Option<PoleCenter>,
    /// Radius of the pole, in the unit of x and y; 0 for an edge [default: found]
    #[arg(long, value_name = "RADIUS", requires = "pole", value_parser = not_negative, allow_negative_numbers = true)]
    pub pole_radius: Option<f64>,
    /// Standard deviation of each coordinate of the centre that is given, in the unit of x and y [default: a thousandth of the length of the rod]
    #[arg(long, value_name = "SIGMA", requires = "pole", value_parser = positive, allow_negative_numbers = true)]
    pub pole_sigma: Option<f64>,
    /// Largest apparent shortening of a rod of which both ends are seen, %: more is a rod bent out of the plane of the image
    #[arg(long, value_name = "PERCENT", value_parser = positive, default_value_t = 5.0, allow_negative_numbers = true)]
    pub shortening: f64,
    /// Directory of the results [default: out/<name of the frames>]
    #[arg(long, value_name = "DIR", value_parser = directory)]
    pub out: Option<PathBuf>,
}

/// Where a pole is, if that is known.
#[derive(Clone, Copy, Debug)]
pub struct PoleCenter(pub Option<[f64; 2]>);

/// The centre of a pole.
fn pole(text: &str) -> Result<PoleCenter, String> {
    if text == "anywhere" {
        return Ok(PoleCenter(None));
    }
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y] if text.matches(',').count() == 1 && x.is_finite() && y.is_finite() => Ok(PoleCenter(Some([x, y]))),
        _ => Err("expected X,Y: two numbers, or nothing where the pole is to be found".into()),
    }
}

/// Which ends of a rod are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Visible {
    /// The first point is the base
    Base,
    /// The last point is the tip
    Tip,
    /// Both
    Both,
    /// Neither: the place along the rod is determined only where stiffness or curvature at rest vary
    Neither,
}

/// How far a recording and its rod can be trusted.
#[derive(Debug, Args)]
#[command(next_help_heading = "How far recording and rod can be trusted")]
pub struct Trust {
    /// Take samples, rod and poses for exact: nothing is corrected, and standard deviations are of the noise only
    #[arg(long)]
    pub as_is: bool,
    /// A TOML file: the size of the systematic errors, the table [errors] [default: an ordinary laboratory]; for raw values and
    /// wrenches also calibration, mounting, tare and columns of the recording, as for `live`
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// The noise of the sensor, a TOML file as for `simulate` [default: found in the recording]
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// Coulomb friction of rod and object: its coefficient as 0.1, with a standard deviation as 0.1+-0.02, `estimate` to find it from each
    /// pass of the recording, or `none`
    #[arg(long, value_name = "MU", allow_hyphen_values = true, value_parser = friction, default_value = "none")]
    pub friction: Friction,
    /// Most kinks of the reactions to be expected by chance, per scan
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub false_alarms: Option<f64>,
    /// Largest standard deviation of a contact point across the contour, in lengths of the rod; less certain points are left out
    #[arg(long, value_name = "LENGTHS", value_parser = positive, allow_negative_numbers = true)]
    pub largest_sigma: Option<f64>,
}

/// A recording to be simulated.
#[derive(Debug, Args)]
pub struct Simulate {
    /// The scene, a TOML file; its step is not used
    pub scene: PathBuf,
    /// The noise of the sensor, a TOML file [default: a sensor that reads the truth]
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// Samples in a second; there is one every speed / rate of the clamp's way, and each of several legs has a whole number of them
    #[arg(long, value_name = "HZ", default_value_t = 500.0, allow_negative_numbers = true)]
    pub rate: f64,
    /// Speed of the clamp on all legs: a number in m/s, or in rad/s where the clamp only turns, or with a unit as "1 mm/s" or "10 deg/s"
    #[arg(long, value_name = "SPEED", default_value = "1e-3", allow_negative_numbers = true)]
    pub speed: Speed,
    /// Seed of the noise: the same one gives the same recording
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = seed)]
    pub seed: u64,
    /// Write the standard deviations of white and AR(1) noise and the quantum, too: sigma_f0x,sigma_f0y,sigma_m0z
    #[arg(long)]
    pub sigmas: bool,
    /// The CSV file, or - for standard output [default: out/<name of the scene>/recording.csv]
    #[arg(long, alias = "out", value_name = "FILE")]
    pub file: Option<PathBuf>,
}

/// A sensor to be played.
#[derive(Debug, Args)]
pub struct FakeSensor {
    /// The scene, a TOML file; its step is not used
    pub scene: PathBuf,
    /// Protocol of the sensor
    #[arg(long, value_enum)]
    pub protocol: FakeProtocol,
    /// Samples in a second
    #[arg(long, value_name = "HZ", default_value_t = 500.0, allow_negative_numbers = true)]
    pub rate: f64,
    /// Speed of the clamp: a number in m/s, or in rad/s where the clamp only turns, or with a unit as "1 mm/s" or "10 deg/s"
    #[arg(long, value_name = "SPEED", default_value = "1e-3", allow_negative_numbers = true)]
    pub speed: Speed,
    /// How many times faster than real time to play
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, allow_negative_numbers = true)]
    pub faster: f64,
    /// The noise of the sensor, a TOML file [default: a sensor that reads the truth]
    #[arg(long, value_name = "FILE")]
    pub noise: Option<PathBuf>,
    /// Seed of the noise
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = seed)]
    pub seed: u64,
    /// How the sensor is set up, a TOML file, as for `live`
    #[arg(long, value_name = "FILE")]
    pub setup: Option<PathBuf>,
    /// UDP port of the samples, 0 for any that is free
    #[arg(long, value_name = "PORT", default_value_t = 49152)]
    pub port: u16,
    /// TCP port of the scaling, 0 for any that is free
    #[arg(long, value_name = "PORT", default_value_t = 49151)]
    pub scaling_port: u16,
}
