//! The columns of a recording, found by their names.

use super::row::plain;
use csv::ByteRecord;

/// What a recording must have, for messages.
pub(super) const EXPECTED: &str = "x0, y0 (m), phi0 (rad), f0x, f0y (N), m0z (N m) in any order, perhaps t (s), and perhaps all of sigma_f0x, sigma_f0y (N), sigma_m0z (N m)";

/// All names that mean something, with their units: pose, reactions, standard deviations, time.
pub(super) const NAMES: [(&str, &str); 10] = [
    ("x0", "m"),
    ("y0", "m"),
    ("phi0", "rad"),
    ("f0x", "N"),
    ("f0y", "N"),
    ("m0z", "N m"),
    ("sigma_f0x", "N"),
    ("sigma_f0y", "N"),
    ("sigma_m0z", "N m"),
    ("t", "s"),
];
/// Where standard deviations and the time are among them.
pub(super) const SIGMA: usize = 6;
pub(super) const TIME: usize = 9;

/// Where each column is.
#[derive(Debug)]
pub(super) struct Columns {
    /// By the order of [`NAMES`].
    places: [Option<usize>; 10],
    /// How many columns there are.
    pub width: usize,
    /// Names of those that mean nothing.
    pub ignored: Vec<String>,
}

/// What is wrong with a line of names.
#[derive(Debug)]
pub(super) enum Wrong {
    Missing { missing: Vec<String>, found: Vec<String>, hint: String },
    Twice(&'static str),
}

impl Columns {
    pub fn find(header: &ByteRecord) -> Result<Self, Wrong> {
        let found: Vec<String> = header.iter().map(|name| String::from_utf8_lossy(plain(name)).into_owned()).collect();
        let mut places = [None; 10];
        for (place, (name, _)) in places.iter_mut().zip(NAMES) {
            let mut at = found.iter().enumerate().filter(|(_, found)| *found == name).map(|(at, _)| at);
            *place = at.next();
            if at.next().is_some() {
                return Err(Wrong::Twice(name));
            }
        }
        let sigmas = places[SIGMA..TIME].iter().any(Option::is_some);
        let needed = if sigmas { TIME } else { SIGMA };
        let missing: Vec<usize> = (0..needed).filter(|&i| places[i].is_none()).collect();
        if !missing.is_empty() {
            let hint = hint(&missing, &found);
            let missing = missing.into_iter().map(|i| NAMES[i].0.to_owned()).collect();
            return Err(Wrong::Missing { missing, found, hint });
        }
        let known = |name: &String| NAMES.iter().any(|(known, _)| known == name);
        Ok(Self { places, width: found.len(), ignored: found.into_iter().filter(|name| !known(name)).collect() })
    }

    /// Columns that are there out of a range of [`NAMES`]: number in that list and in the row.
    pub fn present(&self) -> impl Iterator<Item = (usize, usize)> {
        self.places.iter().enumerate().filter_map(|(i, place)| Some((i, (*place)?)))
    }

    pub fn has(&self, i: usize) -> bool {
        self.places[i].is_some()
    }
}

/// What may have been meant by the names that were found.
fn hint(missing: &[usize], found: &[String]) -> String {
    if let [only] = found {
        for (separator, name) in [(';', "semicolons"), ('\t', "tabs")] {
            if only.contains(separator) {
                return format!("; the names are separated by {name}, expected commas");
            }
        }
    }
    if found.iter().all(|name| name.parse::<f64>().is_ok()) {
        return "; the first line holds numbers, expected the names of the columns".to_owned();
    }
    let mut hint = String::new();
    for &i in missing {
        let (name, unit) = NAMES[i];
        let alike = found.iter().find_map(|found| {
            let lower = found.to_lowercase();
            let rest = lower.strip_prefix(name)?;
            (!rest.starts_with(char::is_alphanumeric)).then_some((found, rest.is_empty()))
        });
        match alike {
            Some((found, true)) => hint += &format!("; `{found}` is {name} but for its letters' case"),
            Some((found, false)) => hint += &format!("; is `{found}` {name}? Give it in {unit} and name it {name}"),
            None => {}
        }
    }
    hint
}
