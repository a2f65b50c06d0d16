//! Units by name.

use Dimension::{
    Angle, BendingStiffness, Curvature, Force, Length, RotationalStiffness, Stiffness, Stress, Temperature, Time,
    Torque,
};
use core::f64::consts::PI;

/// The dimension of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// In SI: N.
    Force,
    /// In SI: N m.
    Torque,
    /// In SI: m.
    Length,
    /// In SI: rad.
    Angle,
    /// In SI: s.
    Time,
    /// Degrees Celsius.
    Temperature,
    /// Stresses and moduli. In SI: Pa.
    Stress,
    /// Curvatures, and coefficients of squares. In SI: 1/m.
    Curvature,
    /// In SI: N m^2.
    BendingStiffness,
    /// Stiffness of a spring. In SI: N/m.
    Stiffness,
    /// Stiffness of a spring against rotation. In SI: N m/rad.
    RotationalStiffness,
}

/// A unit of one of the accepted spellings: `N`, `mN`, `N m`, `N-mm`, `lbf in`, `mm`, `deg`, `ms` and more. Blanks, dots,
/// hyphens, asterisks and crosses between the parts do not matter, capitals do: mN is not MN.
///
/// ```
/// use rod_hw::{Dimension, Unit};
/// let unit = Unit::parse("N-mm", Dimension::Torque)?;
/// assert_eq!((unit.name, unit.factor), ("N mm", 1e-3)); // N m each
/// let wrong = Unit::parse("mN", Dimension::Torque).unwrap_err().to_string();
/// assert!(wrong.starts_with("`mN` is a unit of force, expected one of torque: N m, mN m, N mm"), "{wrong}");
/// # Ok::<(), rod_hw::UnitError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// How it is usually written.
    pub name: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    /// One of it in SI.
    pub factor: f64,
}

/// Why a text is no unit.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UnitError {
    /// No such spelling.
    #[error("`{shown}` is not a known unit, expected one of {expected}: {}", List(*.expected))]
    Unknown {
        /// The text, or its beginning.
        shown: Shown,
        /// The expected value.
        expected: Dimension,
    },
    /// A unit of something else.
    #[error("`{}` is a unit of {}, expected one of {expected}: {}", .found.name, .found.dimension, List(*.expected))]
    Dimension {
        /// The unit it is.
        found: Unit,
        /// The expected value.
        expected: Dimension,
    },
}

/// Name, other spellings, what it measures, factor. Blanks stand where a text may have separators.
type Row = (&'static str, &'static [&'static str], Dimension, f64);

const POUND: f64 = 4.448_221_615_260_5;
const GRAVITY: f64 = 9.806_65;
const INCH: f64 = 0.0254;

const UNITS: [Row; 57] = [
    ("N", &["Newton", "newton", "Newtons", "newtons", "Н"], Force, 1.0),
    ("mN", &["мН"], Force, 1e-3),
    ("uN", &["µN", "μN"], Force, 1e-6),
    ("cN", &[], Force, 1e-2),
    ("kN", &[], Force, 1e3),
    ("lbf", &["lb", "lbs", "pound"], Force, POUND),
    ("klbf", &["klb"], Force, 1e3 * POUND),
    ("kgf", &["kg", "kp"], Force, GRAVITY),
    ("gf", &["g"], Force, 1e-3 * GRAVITY),
    ("N m", &["Newton meter", "newton metre", "Newton meters", "Н м"], Torque, 1.0),
    ("mN m", &["мН м"], Torque, 1e-3),
    ("N mm", &["Newton millimeter", "newton millimetre", "Н мм"], Torque, 1e-3),
    ("uN m", &["µN m", "μN m"], Torque, 1e-6),
    ("mN mm", &[], Torque, 1e-6),
    ("N cm", &["Н см"], Torque, 1e-2),
    ("cN m", &[], Torque, 1e-2),
    ("kN m", &[], Torque, 1e3),
    ("lbf in", &["lb in", "in lb", "in lbf"], Torque, POUND * INCH),
    ("lbf ft", &["lb ft", "ft lb", "ft lbf"], Torque, POUND * 12.0 * INCH),
    ("kgf cm", &["kg cm"], Torque, 1e-2 * GRAVITY),
    ("gf cm", &["g cm"], Torque, 1e-5 * GRAVITY),
    ("gf mm", &["g mm"], Torque, 1e-6 * GRAVITY),
    ("m", &["metre", "meter", "metres", "meters", "м"], Length, 1.0),
    ("mm", &["millimetre", "millimeter", "Millimeter", "мм"], Length, 1e-3),
    ("um", &["µm", "μm"], Length, 1e-6),
    ("cm", &["см"], Length, 1e-2),
    ("in", &["inch"], Length, INCH),
    ("ft", &["foot", "feet"], Length, 0.3048),
    ("rad", &["radian", "radians", "рад"], Angle, 1.0),
    ("mrad", &[], Angle, 1e-3),
    ("deg", &["°", "degree", "degrees", "Grad", "град"], Angle, PI / 180.0),
    ("s", &["sec", "second", "seconds", "Sek", "Sekunden", "с"], Time, 1.0),
    ("ms", &["msec", "millisecond", "milliseconds", "мс"], Time, 1e-3),
    ("us", &["µs", "μs", "usec"], Time, 1e-6),
    ("ns", &[], Time, 1e-9),
    ("min", &[], Time, 60.0),
    ("h", &[], Time, 3600.0),
    ("day", &["days"], Time, 86_400.0),
    ("degC", &["°C", "C", "Celsius"], Temperature, 1.0),
    ("Pa", &["N/m2", "N/m^2", "N/m²"], Stress, 1.0),
    ("kPa", &[], Stress, 1e3),
    ("MPa", &["N/mm2", "N/mm^2", "N/mm²"], Stress, 1e6),
    ("GPa", &["kN/mm2", "kN/mm^2", "kN/mm²"], Stress, 1e9),
    ("psi", &[], Stress, POUND / (INCH * INCH)),
    ("1/m", &["m^-1", "/m"], Curvature, 1.0),
    ("1/mm", &["mm^-1", "/mm"], Curvature, 1e3),
    ("1/cm", &["cm^-1", "/cm"], Curvature, 1e2),
    ("N m^2", &["N m2", "N m²"], BendingStiffness, 1.0),
    ("mN m^2", &["mN m2", "mN m²"], BendingStiffness, 1e-3),
    ("uN m^2", &["uN m2", "µN m²", "μN m²", "µN m^2", "μN m^2"], BendingStiffness, 1e-6),
    ("N mm^2", &["N mm2", "N mm²"], BendingStiffness, 1e-6),
    ("N/m", &[], Stiffness, 1.0),
    ("N/mm", &["kN/m"], Stiffness, 1e3),
    ("mN/m", &["uN/mm", "µN/mm", "μN/mm"], Stiffness, 1e-3),
    ("N m/rad", &[], RotationalStiffness, 1.0),
    ("mN m/rad", &["N mm/rad"], RotationalStiffness, 1e-3),
    ("N m/deg", &["N m/°"], RotationalStiffness, 180.0 / PI),
];

impl Unit {
    /// The unit of this spelling, if it measures what is expected.
    ///
    /// # Errors
    /// [`UnitError`], with the spellings that are accepted. There is no unit by default: the empty text is an error, too.
    pub fn parse(text: &str, expected: Dimension) -> Result<Self, UnitError> {
        match Self::find(text) {
            Some(unit) if unit.dimension == expected => Ok(unit),
            Some(found) => Err(UnitError::Dimension { found, expected }),
            None => Err(UnitError::Unknown { shown: Shown::new(text), expected }),
        }
    }

    /// The unit of this spelling, whatever it measures.
    pub fn find(text: &str) -> Option<Self> {
        let is = |name: &str| is_spelling(name, text);
        let row = UNITS.iter().find(|row| is(row.0) || row.1.iter().any(|other| is(other)));
        row.map(|&(name, _, dimension, factor)| Self { name, dimension, factor })
    }
}

/// Whether a text is a spelling but for separators: those of the spelling may be missing or others, and there may be more beside what is no
/// letter, but none within a word: `m m` is not mm.
fn is_spelling(spelling: &str, text: &str) -> bool {
    let mut written = parts(text);
    let matches = parts(spelling).all(|(before, letter, is_apart)| {
        let other = written.next();
        other.is_some_and(|(_, own, own_is_apart)| {
            let within_word = before.is_some_and(char::is_alphanumeric) && letter.is_alphanumeric();
            own == letter && (is_apart || !own_is_apart || !within_word)
        })
    });
    matches && written.next().is_none()
}

/// The characters that are no separators: each with the one before it, and whether a separator stands between the two. The hyphen of an
/// exponent is none.
fn parts(text: &str) -> impl Iterator<Item = (Option<char>, char, bool)> {
    let (mut before, mut is_apart) = (None, false);
    text.chars().filter_map(move |letter| {
        let is_sign = letter == '-' && before == Some('^');
        if !is_sign
            && (letter.is_whitespace() || matches!(letter, '-' | '*' | '.' | '·' | '⋅' | '×' | '∙' | '•' | '・' | '_'))
        {
            is_apart = true;
            return None;
        }
        let part = (before, letter, is_apart);
        (before, is_apart) = (Some(letter), false);
        Some(part)
    })
}

impl core::fmt::Display for Dimension {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Force => "force",
            Torque => "torque",
            Length => "length",
            Angle => "angle",
            Time => "time",
            Temperature => "temperature",
            Stress => "stress",
            Curvature => "curvature",
            BendingStiffness => "bending stiffness",
            Stiffness => "stiffness of a spring",
            RotationalStiffness => "stiffness against rotation",
        })
    }
}

impl Dimension {
    /// The names of its units, for messages: `m, mm, um, ...`.
    pub fn units(self) -> impl core::fmt::Display {
        List(self)
    }
}

/// The units of a dimension, for messages.
struct List(Dimension);

impl core::fmt::Display for List {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        for (i, row) in UNITS.iter().filter(|row| row.2 == self.0).enumerate() {
            f.write_str(if i == 0 { "" } else { ", " })?;
            f.write_str(row.0)?;
        }
        Ok(())
    }
}

/// The beginning of a text, for messages.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Shown {
    bytes: [u8; Self::MOST],
    count: u8,
}

impl Shown {
    /// Small, since errors are handed up by value.
    const MOST: usize = 31;

    fn new(text: &str) -> Self {
        let mut shown = Self { bytes: [0; Self::MOST], count: 0 };
        let ends = text.char_indices().map(|(at, character)| at + character.len_utf8());
        let count = ends.take_while(|end| *end <= Self::MOST).last().unwrap_or(0);
        if let (Some(place), Some(bytes)) = (shown.bytes.get_mut(..count), text.as_bytes().get(..count)) {
            place.copy_from_slice(bytes);
            shown.count = count as u8;
        }
        shown
    }
}

impl core::fmt::Display for Shown {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let bytes = self.bytes.get(..usize::from(self.count)).unwrap_or_default();
        f.write_str(core::str::from_utf8(bytes).unwrap_or_default())
    }
}

impl core::fmt::Debug for Shown {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "`{self}`")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings() {
        for (text, name) in [
            ("N·m", "N m"),
            ("Nm", "N m"),
            ("N-m", "N m"),
            ("Nmm", "N mm"),
            ("mN m", "mN m"),
            ("mNm", "mN m"),
            (" lb-in ", "lbf in"),
            ("µs", "us"),
            ("°", "deg"),
            ("N/mm^2", "MPa"),
            ("N m^2", "N m^2"),
            ("Nm/rad", "N m/rad"),
            ("N m / rad", "N m/rad"),
            ("1 / mm", "1/mm"),
            ("mm^-1", "1/mm"),
            ("mm^ -1", "1/mm"),
            ("N mm ^ 2", "N mm^2"),
            ("µN·m", "uN m"),
            ("N×mm", "N mm"),
            ("Н·мм", "N mm"),
            ("мм", "mm"),
            ("gf mm", "gf mm"),
        ] {
            assert_eq!(Unit::find(text).map(|unit| unit.name), Some(name), "{text}");
        }
        for text in ["", "MN", "nm", "NM", "counts", "V", "mm^1", "m m", "N m m", "m N", "de g", "1/m m", "G Pa"] {
            assert_eq!(Unit::find(text), None, "{text}");
        }
        let error = Unit::parse("counts", Force).unwrap_err().to_string();
        assert_eq!(error, "`counts` is not a known unit, expected one of force: N, mN, uN, cN, kN, lbf, klbf, kgf, gf");
    }

    #[test]
    fn long_texts_are_cut_between_characters() {
        let message = |text: &str| Unit::parse(text, Force).unwrap_err().to_string();
        assert!(message("µµµµµµµµµµµµµµµµµ").starts_with("`µµµµµµµµµµµµµµµ` is not a known unit"));
        assert!(message("").starts_with("`` is not a known unit"));
        assert!(size_of::<UnitError>() <= 64, "{}", size_of::<UnitError>());
    }

    #[test]
    fn no_two_units_share_a_spelling() {
        for row in UNITS {
            for text in row.1.iter().chain([&row.0]) {
                assert_eq!(Unit::find(text).unwrap().name, row.0, "{text}");
            }
        }
    }
}
