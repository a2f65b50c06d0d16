//! Meanings of column names in several languages and styles.

use crate::sample::{Dimension, Unit};

/// The quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Time.
    Time,
    /// A force.
    Force,
    /// A moment.
    Torque,
    /// A position.
    Position,
    /// An angle.
    Angle,
    /// The number of a frame.
    Frame,
    /// A number of a sample, a status, a temperature: nothing that a scan needs.
    Other,
    /// A raw value.
    Raw,
    /// A standard deviation or bound.
    Spread,
}

impl Quantity {
    /// Its physical dimension.
    pub fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Time => Some(Dimension::Time),
            Self::Force => Some(Dimension::Force),
            Self::Torque => Some(Dimension::Torque),
            Self::Position => Some(Dimension::Length),
            Self::Angle => Some(Dimension::Angle),
            _ => None,
        }
    }
}

/// A name, understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Meaning {
    pub quantity: Quantity,
    /// x, y or z, where the name says it.
    pub axis: Option<usize>,
    /// A unit at the end of the name, as in `pos_x_mm`.
    pub unit: Option<&'static str>,
}

/// Words by what they mean.
const WORDS: [(Quantity, &[&str]); 8] = [
    (
        Quantity::Time,
        &[
            "t",
            "time",
            "zeit",
            "timestamp",
            "zeitstempel",
            "temps",
            "tiempo",
            "tempo",
            "elapsed",
            "clock",
            "uhrzeit",
            "laufzeit",
            "tijd",
            "tid",
            "czas",
            "čas",
            "cas",
            "время",
            "时间",
            "時間",
        ],
    ),
    (
        Quantity::Force,
        &[
            "f", "force", "forces", "kraft", "kräfte", "kraefte", "fuerza", "forza", "effort", "força", "forca",
            "kracht", "siła", "sila", "síla", "сила", "kuvvet", "voima", "erő", "力", "力量", "荷重", "힘",
        ],
    ),
    (
        Quantity::Torque,
        &[
            "m",
            "torque",
            "torques",
            "moment",
            "moments",
            "drehmoment",
            "momento",
            "couple",
            "mom",
            "trq",
            "coppia",
            "par",
            "koppel",
            "момент",
            "力矩",
            "扭矩",
            "モーメント",
            "トルク",
        ],
    ),
    (
        Quantity::Position,
        &[
            "pos",
            "position",
            "stage",
            "weg",
            "verfahrweg",
            "lage",
            "coord",
            "koordinate",
            "posizione",
            "posicion",
            "axis",
            "achse",
            "posición",
            "posição",
            "posicao",
            "pozycja",
            "poloha",
            "positie",
            "положение",
            "位置",
            "位移",
            "変位",
            "displacement",
            "distance",
            "déplacement",
            "deplacement",
            "verschiebung",
            "desplazamiento",
            "spostamento",
            "travel",
        ],
    ),
    (
        Quantity::Angle,
        &[
            "phi",
            "angle",
            "winkel",
            "theta",
            "rot",
            "rotation",
            "yaw",
            "drehung",
            "drehwinkel",
            "neigung",
            "angolo",
            "angulo",
            "orientation",
            "heading",
            "ángulo",
            "ângulo",
            "hoek",
            "vinkel",
            "kąt",
            "угол",
            "úhel",
            "角度",
            "角",
        ],
    ),
    (Quantity::Frame, &["frame", "frames", "image", "bild"]),
    (
        Quantity::Other,
        &[
            "index",
            "sample",
            "nr",
            "no",
            "row",
            "count",
            "counter",
            "seq",
            "sequence",
            "status",
            "temp",
            "temperature",
            "temperatur",
            "quality",
            "flag",
            "flags",
            "note",
            "remark",
            "comment",
            "kommentar",
            "bemerkung",
            "date",
            "datum",
        ],
    ),
    (Quantity::Raw, &["ai", "ch", "channel", "kanal", "sg", "dms", "gauge", "voltage", "spannung", "volt", "raw"]),
];

/// Words beside the quantity that do not change it.
const BESIDE: [&str; 18] = [
    "wrench",
    "sensor",
    "ft",
    "clamp",
    "base",
    "robot",
    "motor",
    "actual",
    "ist",
    "measured",
    "einspannung",
    "linear",
    "data",
    "value",
    "wert",
    "tcp",
    "pose",
    "field",
];

/// The meaning of a name, if its words are known.
pub(super) fn meaning(name: &str) -> Option<Meaning> {
    let (name, unit) = without_unit(name);
    let words = words(name);
    let spread = words.iter().any(|word| matches!(word.as_str(), "sigma" | "std" | "stdev" | "systematic"));
    // a column that is called by a unit of time alone
    if let [only] = &words[..]
        && let Some(found) = ["ms", "us", "sec", "seconds", "sek", "s"].iter().find(|unit| *unit == only)
    {
        let unit = Unit::find(if *found == "sek" { "s" } else { found }).map(|unit| unit.name);
        return Some(Meaning { quantity: Quantity::Time, axis: None, unit });
    }
    let (mut quantity, mut axis) = (None, None);
    for word in &words {
        let (of, along) = understood(word)?;
        // the first word says what it is, as in `stage angle`, unless a later one is more exact
        quantity = match (quantity, of) {
            (Some(Quantity::Position), Some(of)) => Some(of),
            (None, of) => of,
            (known, _) => known,
        };
        axis = axis.or(along);
    }
    let quantity = if spread { Some(Quantity::Spread) } else { quantity };
    match (quantity, axis) {
        (None, Some(axis)) => Some(Meaning { quantity: Quantity::Position, axis: Some(axis), unit }),
        // t with an axis is a torque
        (Some(Quantity::Time), Some(axis)) => Some(Meaning { quantity: Quantity::Torque, axis: Some(axis), unit }),
        (Some(quantity), axis) => Some(Meaning { quantity, axis, unit }),
        (None, None) => None,
    }
}

/// Quantity and axis of a word; `None` if it is not known.
fn understood(word: &str) -> Option<(Option<Quantity>, Option<usize>)> {
    let digits = word.trim_end_matches(|c: char| c.is_ascii_digit());
    // numbers after a name, as of the clamp in x0
    let word = if digits.is_empty() { word } else { digits };
    if word.bytes().all(|byte| byte.is_ascii_digit()) || BESIDE.contains(&word) {
        return Some((None, None));
    }
    if matches!(word, "sigma" | "std" | "stdev" | "systematic") {
        return Some((None, None));
    }
    let known = |word: &str| WORDS.iter().find(|line| line.1.contains(&word)).map(|line| line.0);
    let along = |word: &str| ["x", "y", "z"].iter().position(|axis| *axis == word);
    if let Some(axis) = along(word) {
        return Some((None, Some(axis)));
    }
    if let Some(quantity) = known(word) {
        return Some((Some(quantity), None));
    }
    if word == "rz" {
        return Some((Some(Quantity::Angle), Some(2)));
    }
    // fx, forcex, f0x, xpos
    let (head, tail) = word.split_at(word.char_indices().last()?.0);
    if let (Some(quantity), Some(axis)) = (known(head.trim_end_matches('0')), along(tail)) {
        return Some((Some(quantity), Some(axis)));
    }
    let (head, tail) = word.split_at(word.chars().next()?.len_utf8());
    let (quantity, axis) = (known(tail)?, along(head)?);
    Some((Some(quantity), Some(axis)))
}

/// The words of a name in small letters: parted by what is no letter or digit, and before a capital in the middle.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut small = false;
    for letter in name.chars() {
        let parts = !letter.is_alphanumeric() || (letter.is_uppercase() && small);
        if parts {
            words.push(String::new());
        }
        if letter.is_alphanumeric()
            && let Some(word) = words.last_mut()
        {
            word.extend(letter.to_lowercase());
        }
        small = letter.is_lowercase();
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The name without a unit at its end, and that unit: `pos_x` and mm of `pos_x_mm`.
fn without_unit(name: &str) -> (&str, Option<&'static str>) {
    let Some((rest, last)) = name.rsplit_once(|letter: char| !letter.is_alphanumeric()) else { return (name, None) };
    // single letters are axes and quantities, and z and t and m of them the usual ones
    let is_letter = matches!(last, "m" | "t" | "h" | "c" | "C" | "g" | "M" | "T");
    match Unit::find(last).filter(|_| !is_letter && !rest.is_empty()) {
        Some(unit) => (rest, Some(unit.name)),
        None => (name, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_several_languages_and_styles() {
        use Quantity::{Angle, Force, Frame, Other, Position, Raw, Spread, Time, Torque};
        for (name, quantity, axis) in [
            ("Fx", Force, Some(0)),
            ("force_x", Force, Some(0)),
            ("ForceY", Force, Some(1)),
            ("F_x", Force, Some(0)),
            ("Kraft X", Force, Some(0)),
            ("Moment Z", Torque, Some(2)),
            ("Mz", Torque, Some(2)),
            ("Tz", Torque, Some(2)),
            ("f0x", Force, Some(0)),
            ("m0z", Torque, Some(2)),
            ("wrench.torque.z", Torque, Some(2)),
            ("time", Time, None),
            ("Zeit", Time, None),
            ("t", Time, None),
            ("ms", Time, None),
            ("pos_x", Position, Some(0)),
            ("pose.position.x", Position, Some(0)),
            ("pose.yaw", Angle, None),
            ("field.wrench.force.y", Force, Some(1)),
            ("X", Position, Some(0)),
            ("stage_y", Position, Some(1)),
            ("xPos", Position, Some(0)),
            ("angle", Angle, None),
            ("theta", Angle, None),
            ("stage angle", Angle, None),
            ("phi0", Angle, None),
            ("frame", Frame, None),
            ("Status", Other, None),
            ("Ai0", Raw, None),
            ("sigma_f0x", Spread, Some(0)),
            ("Fuerza_X", Force, Some(0)),
            ("sila_y", Force, Some(1)),
            ("力x", Force, Some(0)),
            ("力矩z", Torque, Some(2)),
            ("kraft1", Force, None),
            ("F2", Force, None),
            ("Weg", Position, None),
            ("pos_1", Position, None),
            ("положение x", Position, Some(0)),
            ("Ángulo", Angle, None),
        ] {
            let found = meaning(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((found.quantity, found.axis), (quantity, axis), "{name}");
        }
        assert_eq!(meaning("pos_x_mm").and_then(|found| found.unit), Some("mm"));
        assert_eq!(meaning("Fx_mN").and_then(|found| found.unit), Some("mN"));
        for name in ["pressure", "", "foo x bar", "valve"] {
            assert_eq!(meaning(name), None, "{name}");
        }
    }
}
