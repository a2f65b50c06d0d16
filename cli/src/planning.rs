//! The commands about which scans to make: `reach` and `plan`.

use crate::arguments::{PlanArguments, ReachArguments};
use crate::error::Error;
use crate::progress::Progress;
use crate::{read_scene, say, signals};
use rod_files::{
    Approaches, Interrupt, PlanRequest, Planned, Staged, read_calibrated_rod, read_known_contours, read_noise,
    read_scans,
};
use std::path::Path;
use std::process::ExitCode;
use vibrissa::plan::Candidate;
use vibrissa_cli::{write_approaches, write_plan, write_reach};

/// What may be done with a scene that has friction.
const FRICTION: &str = "take it away: `reach` computes contacts without friction";

pub fn reach(arguments: ReachArguments) -> Result<ExitCode, Error> {
    let ReachArguments { scene, distances, angles, out, jobs } = arguments;
    run_on(jobs);
    signals::end();
    let scene = read_scene(&scene)?;
    scene.check_no_friction(FRICTION)?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let interrupt = Interrupt::default();
    let staged = Staged::new(&out)?.keeping(scene.files.clone());
    let progress = Progress::of(&interrupt);
    let angles = angles.map(|angles| angles.0.into_iter().map(f64::to_radians).collect());
    let found = scene.reach(distances.map(|distances| distances.0), angles, &interrupt)?;
    drop(progress);
    write_reach(&found, &staged)?;
    published(staged, &found.report(), &out)
}

/// Computes on so many threads.
fn run_on(jobs: Option<usize>) {
    if let Some(jobs) = jobs {
        // fails only where the threads are there already
        let _ = rayon::ThreadPoolBuilder::new().num_threads(jobs).build_global();
    }
}

pub fn plan(arguments: PlanArguments) -> Result<ExitCode, Error> {
    let PlanArguments {
        result,
        bounds,
        rod,
        paths,
        distances,
        angles,
        scans,
        stress,
        noise,
        rate,
        speed,
        hypotheses,
        seed,
        out,
        jobs,
    } = arguments;
    run_on(jobs);
    signals::end();
    let calibrated = read_calibrated_rod(&rod)?;
    let angles = angles.map(|angles| angles.0.into_iter().map(f64::to_radians).collect());
    let largest_stress = stress.unwrap_or_default();
    if let Some(bounds) = bounds {
        let found = Approaches::new(&calibrated.rod, bounds, angles, scans, largest_stress)?;
        let staged = Staged::new(&out)?.keeping(vec![rod]);
        write_approaches(&found, &staged)?;
        return published(staged, &found.report(), &out);
    }
    // without a box there is one: the arguments say so
    let result = result.unwrap_or_default();
    let known = read_known_contours(&result)?;
    let own = paths.as_ref().map(|file| read_scans(file, calibrated.rod.length())).transpose()?.unwrap_or_default();
    let inputs = [rod, result.join("fitted.csv")].into_iter().chain(noise.clone()).chain(paths).collect();
    let request = PlanRequest {
        distances: distances.map(|distances| distances.0),
        angles,
        scans: own.scans,
        paths: own.paths.iter().map(|path| Candidate { scan: None, path: path.path() }).collect(),
        noise: noise.map(|file| read_noise(&file)).transpose()?,
        rate,
        speed,
        count: scans,
        largest_stress,
        hypotheses,
        seed,
    };
    let interrupt = Interrupt::default();
    let staged = Staged::new(&out)?.keeping(inputs);
    let progress = Progress::of(&interrupt);
    let name = result.file_name().unwrap_or(result.as_os_str()).to_string_lossy().into_owned();
    let found = Planned::new(&name, &calibrated.rod, known, &request, &interrupt)?;
    drop(progress);
    write_plan(&found, &staged)?;
    published(staged, &found.report(), &out)
}

/// Shows the files, and says what is in them.
fn published(staged: Staged, report: &str, out: &Path) -> Result<ExitCode, Error> {
    staged.publish()?;
    say(report);
    say(&format!("written to {}\n", out.display()));
    Ok(ExitCode::SUCCESS)
}
