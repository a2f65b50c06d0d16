//! Explorations of objects that a simulated rig makes, against what scans can reach of them.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rod_contact::{ClampPath, Sweep};
use rod_contours::{Composite, Spline, SplineEnd};
use rod_core::{Pose, Reactions, Rod, Sample};
use rod_plan::{
    Abort, Explorer, ExplorerSettings, Finish, IntervalSet, Purpose, Reach, ReachGrid, Rectangle, ScanReach, reach,
};
use rod_reconstruct::{Budget, FittedObject, NoiseModel, Settings};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

/// Length of the rod, m, and its yield stress, Pa.
const LENGTH: f64 = 0.1;
const YIELD: f64 = 1.5e9;

/// Share of what scans can reach at which enough of it is known.
const ENOUGH: f64 = 0.95;

/// Distance of the clamp from the box in a raster, rod lengths: the tip passes the widest place of an object about 0.4 rod lengths wide, with little stress.
const RASTER: f64 = 0.5;

/// Angles of which the rasters take some: a multiple of the number of scans of each.
const FULL: usize = 120;

fn rod() -> Rod {
    Rod::from_diameter(LENGTH, 5e-4, 206e9).unwrap().with_yield_stress(YIELD).unwrap()
}

fn noise() -> NoiseModel {
    NoiseModel { white: Reactions { f0x: 2.5e-3, f0y: 2.5e-3, m0z: 6e-5 }, ..NoiseModel::default() }
}

/// Kinds of objects.
#[derive(Clone, Copy, Debug)]
enum Kind {
    FreeForm,
    Polygon,
    Notch,
}

/// An object about 0.4 rod lengths wide, by kind and seed.
fn object(kind: Kind, seed: u64) -> Composite {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = |from: f64, to: f64| from + (to - from) * random.random::<f64>();
    let polar = |radius: f64, angle: f64| [radius * LENGTH * angle.cos(), radius * LENGTH * angle.sin()];
    match kind {
        Kind::FreeForm => {
            let (two, three) = (draw(0.0, 0.15), draw(0.0, 0.1));
            let (a, b) = (draw(0.0, TAU), draw(0.0, TAU));
            let points: Vec<[f64; 2]> = (0..24)
                .map(|k| TAU * f64::from(k) / 24.0)
                .map(|angle| {
                    polar(0.2 * (1.0 + two * (2.0 * angle + a).cos() + three * (3.0 * angle + b).cos()), angle)
                })
                .collect();
            Composite::single(Spline::through(&points, SplineEnd::Periodic).unwrap()).unwrap()
        }
        Kind::Polygon => {
            let corners = 4 + (draw(0.0, 3.0) as u32);
            let start = draw(0.0, TAU);
            let points: Vec<[f64; 2]> = (0..corners)
                .map(|k| polar(0.22, start + TAU * (f64::from(k) + draw(-0.2, 0.2)) / f64::from(corners)))
                .collect();
            Composite::polygon(&points).unwrap()
        }
        Kind::Notch => {
            let (width, depth, turn) = (draw(0.06, 0.12), draw(0.05, 0.15), draw(0.0, TAU));
            let corners = [
                [0.2, 0.2],
                [-0.2, 0.2],
                [-0.2, -0.2],
                [-width, -0.2],
                [0.0, -0.2 + depth],
                [width, -0.2],
                [0.2, -0.2],
            ];
            let turned = corners.map(|[x, y]: [f64; 2]| polar(x.hypot(y), turn + y.atan2(x)));
            Composite::polygon(&turned).unwrap()
        }
    }
}

/// The box around an object, with a margin on each side that the seed draws, of at most a tenth of a rod length.
fn around(object: &Composite, seed: u64) -> Rectangle {
    let mut random = ChaCha8Rng::seed_from_u64(seed + 1000);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for part in object.parts() {
        for k in 0..=20 {
            let frame = object.own_frame(part.stretch, part.range.at(f64::from(k) / 20.0));
            for (axis, value) in [frame.x, frame.y].into_iter().enumerate() {
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
    }
    let mut margin = || 0.1 * LENGTH * random.random::<f64>();
    Rectangle { low: low.map(|value| value - margin()), high: high.map(|value| value + margin()) }
}

fn settings(object: &Composite, seed: u64) -> ExplorerSettings {
    let settings = ExplorerSettings::new(&rod(), around(object, seed), noise().channels()).unwrap();
    // the rig is exact but for the noise
    let reconstruction = Settings { budget: Some(Budget::NONE), ..Settings::default() };
    let most_scans = std::env::var("MOST").map_or(settings.most_scans, |most| most.parse().unwrap());
    ExplorerSettings { reconstruction, seed, most_scans, ..settings }
}

/// The samples of a scan, as far as the rig may make it.
fn measure(object: &Composite, path: ClampPath, abort: Abort, spacing: f64, seed: u64) -> (Vec<Sample>, f64, bool) {
    let mut sensor = noise().generator(seed).unwrap();
    let outcome = Sweep::new(&rod(), std::slice::from_ref(object), path, spacing).unwrap().run();
    assert!(outcome.stop.is_none(), "{:?}", outcome.stop);
    let (mut samples, mut stress, mut is_aborted) = (Vec::new(), 0.0_f64, false);
    for state in &outcome.states {
        stress = stress.max(state.max_stress.unwrap());
        let reactions = sensor.sample(state.reactions).unwrap();
        samples.push(Sample { t: None, pose: state.pose, reactions, sigma: None });
        if abort.is_beyond(&reactions) {
            is_aborted = true;
            break;
        }
    }
    (samples, stress, is_aborted)
}

/// What came of an exploration.
#[derive(Debug)]
struct Explored {
    finish: Option<Finish>,
    scans: usize,
    /// Way of the clamp along all scans, m; as of a raster, without the ways from one to the next.
    way: f64,
    approaches: usize,
    aborted: usize,
    largest_stress: f64,
    share: Share,
    /// Scans after which the precise share was 0.95, and their way.
    enough: Option<(usize, f64)>,
    /// Touched points through which no object could be drawn.
    left_out: usize,
    /// Predicted over found standard deviation, of the scans along the contour.
    ratios: Vec<f64>,
}

/// Explores until the exploration is finished, or the time is over.
fn explore(object: &Composite, settings: ExplorerSettings, seed: u64, truth: &Truth, most: Duration) -> Explored {
    let begin = Instant::now();
    let (spacing, sigma) = (settings.spacing, settings.sigma);
    let mut explorer = Explorer::new(rod(), settings).unwrap();
    let mut found = Explored {
        finish: None,
        scans: 0,
        way: 0.0,
        approaches: 0,
        aborted: 0,
        largest_stress: 0.0,
        share: Share::default(),
        enough: None,
        left_out: 0,
        ratios: Vec::new(),
    };
    while begin.elapsed() < most
        && let Some(proposal) = explorer.propose().unwrap()
    {
        let (samples, stress, is_aborted) =
            measure(object, proposal.path, proposal.abort, spacing, 100 * seed + found.scans as u64);
        let proposed = begin.elapsed();
        explorer.update(&samples).unwrap();
        found.scans += 1;
        if std::env::var("VERBOSE").is_ok() {
            eprintln!(
                "  {} fit {:.1} s, all so far {:.1} s",
                found.scans,
                (begin.elapsed() - proposed).as_secs_f64(),
                begin.elapsed().as_secs_f64()
            );
        }
        found.way += proposal.path.length();
        found.share = Share::of(explorer.known(), sigma, object, truth);
        if found.share.precise >= ENOUGH {
            found.enough.get_or_insert((found.scans, found.way));
        }
        found.largest_stress = found.largest_stress.max(stress);
        found.aborted += usize::from(is_aborted);
        match &proposal.purpose {
            Purpose::Approach => found.approaches += 1,
            Purpose::Contour { forecast, value } => {
                let mut predicted: Vec<f64> = forecast.sigmas.iter().map(|one| one.sigma).collect();
                let objects = explorer.scans().last().unwrap();
                let mut after: Vec<f64> =
                    objects.iter().flat_map(|one| &one.known).filter_map(|known| known.sigma()).collect();
                if let (Some(predicted), Some(after)) = (median(&mut predicted), median(&mut after)) {
                    found.ratios.push(predicted / after);
                }
                if std::env::var("VERBOSE").is_ok() {
                    let scan = forecast.candidate.scan.unwrap();
                    eprintln!(
                        "  {} angle {:.0} q {:.2} {} value {:.3} gain {:.3} stress {:.0}/{:.0} MPa ratio {:?} aborted {is_aborted} objects {}",
                        found.scans,
                        scan.angle.to_degrees(),
                        scan.distance / LENGTH,
                        scan.pass,
                        value / LENGTH,
                        forecast.gain.unwrap().mean / LENGTH,
                        forecast.largest_stress.unwrap() / 1e6,
                        stress / 1e6,
                        found.ratios.last(),
                        objects.len(),
                    );
                }
            }
        }
    }
    found.finish = explorer.finished();
    found.left_out = explorer.left_out().len();
    found
}

/// How much of what scans can reach is known.
#[derive(Debug, Default)]
struct Share {
    /// Share that was touched, and share that was touched and has the standard deviation that was asked for.
    touched: f64,
    precise: f64,
    /// Median and largest distance of touched points from the object, in rod lengths.
    error: [f64; 2],
}

impl Share {
    fn of(known: &[FittedObject], sigma: f64, object: &Composite, truth: &Truth) -> Self {
        let outline = &truth.reach.outlines[0];
        let (mut touched, mut precise, mut errors) = (IntervalSet::default(), IntervalSet::default(), Vec::new());
        for chain in known {
            let place = |k: usize| {
                let own = chain.known[k].sigma()?;
                let place = outline.nearest(object, chain.points[k][0], chain.points[k][1])?;
                let frame = outline.frame(object, place);
                Some((place, (frame.x - chain.points[k][0]).hypot(frame.y - chain.points[k][1]) / LENGTH, own))
            };
            errors.extend((0..chain.points.len()).filter_map(place).map(|place| place.1));
            let count = chain.points.len();
            for k in 1..=count {
                // the last one closes the contour, if its ends are neighbours
                let (Some(from), Some(to)) = (place(k - 1), place(k % count)) else { continue };
                let way = (to.0 - from.0).rem_euclid(outline.length());
                if way > 0.06 * LENGTH || from.1.max(to.1) > 0.02 {
                    continue;
                }
                for set in if from.2.max(to.2) <= sigma { vec![&mut touched, &mut precise] } else { vec![&mut touched] }
                {
                    set.insert(from.0, (from.0 + way).min(outline.length()));
                    set.insert(0.0, from.0 + way - outline.length());
                }
            }
        }
        let share = |set: &IntervalSet| 1.0 - truth.reachable.without(set).length() / truth.reachable.length();
        let error = [median(&mut errors).unwrap_or(f64::NAN), errors.last().copied().unwrap_or(f64::NAN)];
        Self { touched: share(&touched), precise: share(&precise), error }
    }
}

fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// What scans can reach of an object.
struct Truth {
    reach: Reach,
    /// What those scans touch that do not bend the rod too far.
    reachable: IntervalSet,
}

impl Truth {
    /// The largest share of what can be reached that one pass of the grid touches, and two together.
    fn most_of_two(&self) -> [f64; 2] {
        let within = |scan: &&ScanReach| scan.found.largest_stress.unwrap() <= YIELD;
        let all: Vec<IntervalSet> =
            self.reach.scans.iter().filter(within).map(|scan| scan.found.touched.all(0)).collect();
        let share = |one: &IntervalSet, other: &IntervalSet| {
            let mut both = one.clone();
            both.extend(other);
            both.length() / self.reachable.length()
        };
        let one = all.iter().map(|one| share(one, one)).fold(0.0, f64::max);
        let two = all.iter().enumerate().flat_map(|(k, one)| all[k..].iter().map(move |other| (one, other)));
        [one, two.map(|(one, other)| share(one, other)).fold(0.0, f64::max)]
    }
}

/// All scans of a grid.
fn truth(object: &Composite, angles: usize, distances: &[f64]) -> Truth {
    let grid = ReachGrid {
        distances: distances.iter().map(|share| share * LENGTH).collect(),
        angles: (0..angles).map(|k| TAU * (0.25 + k as f64 / angles as f64)).collect(),
        ..ReachGrid::of(&rod())
    };
    let reach = reach(&rod(), std::slice::from_ref(object), &grid, &|_| true).unwrap();
    let mut reachable = IntervalSet::default();
    let within = reach.scans.iter().filter(|scan| scan.found.largest_stress.unwrap() <= YIELD);
    within.for_each(|scan| reachable.extend(&scan.found.touched.all(0)));
    Truth { reach, reachable }
}

/// A free-form object, of which only its box is known, is touched nearly all around.
#[test]
fn a_free_form_object_is_explored() {
    let object = object(Kind::FreeForm, 1);
    let truth = truth(&object, 12, &[0.3, 0.6]);
    let found = explore(&object, settings(&object, 1), 1, &truth, Duration::MAX);
    assert!(found.share.precise > 0.95 && found.scans <= 8, "{found:?}");
    assert!(found.largest_stress <= YIELD && found.aborted == 0 && found.left_out == 0, "{found:?}");
    assert_eq!(found.finish, Some(Finish::Precise));
}

/// How many scans of an equally spaced raster make the precise share 0.95: passes to the left at equal angles all around, the clamp on lines at one distance from the
/// box. Rasters of 2 to 12 scans are tried, the smallest first; none where 12 are too few, or the time is over. With the way of the clamp, m.
fn raster(
    object: &Composite,
    settings: &ExplorerSettings,
    seed: u64,
    truth: &Truth,
    most: Duration,
) -> Option<(usize, f64)> {
    let (begin, corners) = (Instant::now(), settings.object.corners());
    let mut fits: HashMap<usize, (Vec<FittedObject>, f64)> = HashMap::new();
    for count in [2, 3, 4, 5, 6, 8, 10, 12] {
        let (mut explorer, mut way) = (Explorer::new(rod(), settings.clone()).unwrap(), 0.0);
        for k in 0..count {
            // the same angle in several rasters is one scan
            let place = (FULL / count) * k;
            let (fit, own_way) = fits.entry(place).or_insert_with(|| {
                let angle = TAU * (0.25 + place as f64 / FULL as f64);
                let (sin, cos) = angle.sin_cos();
                let extent = |x: f64, y: f64| {
                    let along = corners.map(|corner| corner[0] * x + corner[1] * y);
                    (
                        along.into_iter().fold(f64::INFINITY, f64::min),
                        along.into_iter().fold(f64::NEG_INFINITY, f64::max),
                    )
                };
                let (near, (right, left)) = (extent(cos, sin).0 - RASTER * LENGTH, extent(-sin, cos));
                let clamp = |left: f64| Pose { x: near * cos - left * sin, y: near * sin + left * cos, phi: angle };
                let path = ClampPath::new(clamp(right - 1.05 * LENGTH), clamp(left + 1.05 * LENGTH)).unwrap();
                let moment = rod().bending_stiffness() * YIELD / rod().bending_stress(1.0).unwrap();
                let abort = Abort { moment, force: f64::INFINITY };
                let (samples, ..) = measure(object, path, abort, settings.spacing, 100 * seed + 50 + place as u64);
                let mut alone = Explorer::new(rod(), settings.clone()).unwrap();
                alone.add(&samples).unwrap();
                (alone.known().to_vec(), path.length())
            });
            way += *own_way;
            explorer.add_known(&[], fit.clone());
            if begin.elapsed() > most {
                return None;
            }
        }
        if Share::of(explorer.known(), settings.sigma, object, truth).precise >= ENOUGH {
            return Some((count, way));
        }
    }
    None
}

/// Objects by kind (`KIND`, 0 to 2) and seed (`FIRST`, `COUNT`), with at most `MOST` scans and `SECONDS` s each; with `RASTER`, a raster of each as well.
#[test]
#[ignore = "minutes; a measurement"]
fn shares_of_objects() {
    let number = |name: &str, otherwise: u64| std::env::var(name).map_or(otherwise, |value| value.parse().unwrap());
    let (first, count, most) = (number("FIRST", 0), number("COUNT", 1), Duration::from_secs(number("SECONDS", 3600)));
    let kinds = [Kind::FreeForm, Kind::Polygon, Kind::Notch];
    let chosen = std::env::var("KIND").ok().map(|kind| kind.parse::<usize>().unwrap());
    for (_, kind) in kinds.into_iter().enumerate().filter(|(k, _)| chosen.is_none_or(|chosen| chosen == *k)) {
        for seed in first..first + count {
            let object = object(kind, seed);
            let truth = truth(&object, 24, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]);
            let (settings, begin) = (settings(&object, seed), Instant::now());
            let found = explore(&object, settings.clone(), seed, &truth, most);
            let seconds = begin.elapsed().as_secs_f64();
            let raster = std::env::var("RASTER").is_ok().then(|| raster(&object, &settings, seed, &truth, most));
            let reachable = truth.reachable.length() / truth.reach.length();
            let [one, two] = truth.most_of_two();
            let Explored { finish, scans, share, enough, .. } = &found;
            let Share { touched, precise, error } = share;
            eprintln!(
                "{kind:?} {seed}: {finish:?}, {scans} scans, touched {touched:.3}, precise {precise:.3} of {reachable:.3}, best pass {one:.3}, best two {two:.3}, error {error:.5?} L, {seconds:.1} s, \
                 enough {enough:?}, raster {raster:?}, {found:.3?}"
            );
        }
    }
}
