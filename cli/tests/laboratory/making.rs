//! A recording from a scene, what is wrong with it, and a seed.

use super::imperfections::{Acts, IMPERFECTIONS, Imperfection};
use super::mistakes::Mistake;
use super::recording::{NOISE, Recording};
use super::truth::{SPEEDS, Site, Truth};
use super::world::World;
use crate::random::dice::Dice;
use std::sync::Arc;

/// How many imperfections are combined.
const COMBINED: usize = 5;

/// What is wrong with a recording.
#[derive(Clone, Copy)]
pub enum Wrong {
    Nothing {
        fast: bool,
    },
    One(&'static Imperfection),
    /// Five imperfections, drawn at random, at levels drawn evenly up to the ordinary one.
    Several,
    Mistake(&'static Mistake),
}

impl Wrong {
    /// All rows of the table.
    pub fn all() -> Vec<Self> {
        let mistakes = super::mistakes::MISTAKES.iter().map(Self::Mistake);
        let one = IMPERFECTIONS.iter().map(Self::One);
        let nothing = [false, true].map(|fast| Self::Nothing { fast });
        nothing.into_iter().chain(one).chain([Self::Several]).chain(mistakes).collect()
    }

    pub fn name(&self) -> String {
        match self {
            Self::Nothing { fast: false } => "nothing".into(),
            Self::Nothing { fast: true } => "nothing, fast".into(),
            Self::One(one) => one.name.into(),
            Self::Several => "combined".into(),
            Self::Mistake(mistake) => format!("mistake {}", mistake.name),
        }
    }

    /// The ordinary level.
    pub fn level(&self) -> &'static str {
        match self {
            Self::Nothing { fast } => ["", "10 mm/s"][usize::from(*fast)],
            Self::One(one) => one.level,
            Self::Several => "five, up to the ordinary level",
            Self::Mistake(_) => "must be refused",
        }
    }

    fn is_fast(&self) -> bool {
        match self {
            Self::Nothing { fast } => *fast,
            Self::One(one) => one.fast,
            Self::Several | Self::Mistake(_) => false,
        }
    }

    /// The imperfections in the order of the table, each with its multiple of the ordinary level.
    fn drawn(&self, level: f64, dice: &mut Dice) -> Vec<(&'static Imperfection, f64)> {
        match self {
            Self::Nothing { .. } | Self::Mistake(_) => Vec::new(),
            Self::One(one) => vec![(one, level)],
            Self::Several => {
                let group = |one: &Imperfection| one.name.split(',').next();
                let mut drawn: Vec<(usize, f64)> = Vec::new();
                while drawn.len() < COMBINED {
                    let next = dice.whole(0, IMPERFECTIONS.len() - 1);
                    if drawn.iter().all(|one| group(&IMPERFECTIONS[one.0]) != group(&IMPERFECTIONS[next])) {
                        drawn.push((next, level * dice.share()));
                    }
                }
                drawn.sort_by_key(|one| one.0);
                drawn.into_iter().map(|(number, level)| (&IMPERFECTIONS[number], level)).collect()
            }
        }
    }
}

/// A recording with the truth that it is of.
pub struct Made {
    pub recording: Recording,
    pub truth: Arc<Truth>,
    /// What is wrong with it, with the levels.
    pub what: String,
    /// Whether the only right answer is status 2.
    pub must_be_refused: bool,
}

/// Makes a recording. The white noise depends on the scene and the seed only; signs and phases depend on the name of the
/// imperfection, too.
pub fn make(site: &Site, wrong: &Wrong, level: f64, seed: u64) -> Made {
    let own = |name: &str| {
        let bytes = site.name.bytes().chain(name.bytes());
        Dice::new(bytes.fold(seed, |hash, byte| hash.wrapping_mul(31).wrapping_add(u64::from(byte))))
    };
    let drawn = wrong.drawn(level, &mut own("combined"));
    let mut world = World::default();
    for (one, level) in &drawn {
        if let Acts::World(change) = one.acts {
            change(&mut world, *level, &mut own(one.name));
        }
    }
    let speed = usize::from(wrong.is_fast());
    let truth = site.truth(speed, &world);
    let mut recording = Recording::ideal(&truth, site.scene.rod.at_clamp(), 1.0 / site.rate, SPEEDS[speed]);
    for (one, level) in &drawn {
        if let Acts::Before(change) = one.acts {
            change(&mut recording, *level, &mut own(one.name));
        }
    }
    let mut noise = own("noise");
    recording.each(|row| std::array::from_fn(|c| row.felt[c] + NOISE[c] * noise.normal()));
    for (one, level) in &drawn {
        if let Acts::After(change) = one.acts {
            change(&mut recording, *level, &mut own(one.name));
        }
    }
    if let Wrong::Mistake(mistake) = wrong {
        (mistake.make)(&mut recording);
    }
    let what: Vec<String> = drawn.iter().map(|(one, level)| format!("{} x {level:.2}", one.name)).collect();
    let must_be_refused = matches!(wrong, Wrong::Mistake(_));
    Made { recording, truth, what: what.join(", "), must_be_refused }
}
