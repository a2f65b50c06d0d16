//! Average whiskers of rats and mice, by row and column.

mod table;

use std::ops::RangeInclusive;
use std::str::FromStr;
use table::{MOUSE, RAT, Row};

/// Diameter of a tip, m: the smallest one in the code of WHISKiT Physics (`Whisker.cpp`, a radius of 1.5 um). With twice this diameter the middle of a
/// whisker with a base of 160 um is stiffer by 8 %.
const TIP_DIAMETER: f64 = 3e-6;

/// Diameter of a mouse's base over the length: 67 um at 16 mm, the defaults of the Janelia package Whisker.
const MOUSE_BASE: f64 = 4.2e-3;

/// Largest number of Newton steps to the end of a parabola: from above, on a convex function, they converge for all lengths.
const NEWTON_STEPS: usize = 50;

/// The rows, from the top of the cheek.
const ROWS: [char; 5] = ['A', 'B', 'C', 'D', 'E'];

/// The animals of which there are averages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Animal {
    /// A rat.
    Rat,
    /// A mouse.
    Mouse,
}

impl Animal {
    /// As in `--whisker mouse:C2`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rat => "rat",
            Self::Mouse => "mouse",
        }
    }

    /// The columns of a row that have measured averages, the row counted from 0 (A) to 4 (E).
    fn columns(self, row: usize) -> Option<RangeInclusive<u8>> {
        fn of<T>(row: &Row<T>) -> RangeInclusive<u8> {
            row.first..=row.first + (row.whiskers.len() as u8 - 1)
        }
        match self {
            Self::Rat => RAT.get(row).map(of),
            Self::Mouse => MOUSE.get(row).map(of),
        }
    }
}

/// A mean of measured whiskers.
#[derive(Clone, Copy, Debug)]
struct Mean {
    value: f64,
    /// Standard deviation of single whiskers.
    deviation: f64,
    /// Number of whiskers.
    count: u8,
}

/// An average whisker: a cone of one material, with the shape of a parabola at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Whisker {
    /// The animal.
    pub animal: Animal,
    /// Row and column, as in `C2`.
    pub place: String,
    /// Arc length, m.
    pub length: f64,
    /// Diameter at the base, m.
    pub base_diameter: f64,
    /// Diameter at the tip, m: linear in the arc length in between.
    pub tip_diameter: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Coefficient a of the parabola y = a x^2 at rest, 1/m.
    pub curvature_coefficient: f64,
    /// Where the numbers are from.
    pub sources: WhiskerSources,
}

/// Source and uncertainty of each number of a whisker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WhiskerSources {
    /// Of the length.
    pub length: String,
    /// Of the coefficient of the parabola.
    pub curvature: String,
    /// Of the diameter at the base.
    pub base_diameter: &'static str,
    /// Of the diameter at the tip.
    pub tip_diameter: &'static str,
    /// Of Young's modulus.
    pub youngs_modulus: &'static str,
}

/// Why there is no such whisker.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WhiskerError {
    /// The name is not one of a whisker.
    #[error("expected row and column of a rat's whisker as C2, or of a mouse's as mouse:C2")]
    Name,
    /// The row.
    #[error("expected a row from A to E")]
    Row,
    /// The column.
    #[error(
        "expected {first} to {last}: the whiskers in row {row} of a {animal} of which there are measured averages; 0 is the Greek whisker"
    )]
    Column {
        /// Whose whisker.
        animal: &'static str,
        /// The letter of the row.
        row: char,
        /// The first column.
        first: u8,
        /// The last column.
        last: u8,
    },
}

impl Whisker {
    /// The average whisker of an animal, the row counted from 0 (A) to 4 (E); column 0 is the Greek whisker behind the row.
    ///
    /// ```
    /// use rod_files::{Animal, Whisker};
    /// let whisker = Whisker::average(Animal::Rat, 2, 1)?;
    /// assert!((whisker.length - 0.0452).abs() < 1e-12 && (whisker.base_diameter - 160.5e-6).abs() < 1e-12);
    /// assert_eq!(whisker, "C1".parse()?);
    /// # Ok::<(), rod_files::WhiskerError>(())
    /// ```
    ///
    /// # Errors
    /// [`WhiskerError`] where there are no measured averages.
    pub fn average(animal: Animal, row: usize, column: u8) -> Result<Self, WhiskerError> {
        let (Some(columns), Some(&letter)) = (animal.columns(row), ROWS.get(row)) else {
            return Err(WhiskerError::Row);
        };
        let (first, last) = columns.into_inner();
        let place = format!("{letter}{column}");
        let no_column = WhiskerError::Column { animal: animal.name(), row: letter, first, last };
        let index = usize::from(column.checked_sub(first).ok_or(no_column.clone())?);
        match animal {
            Animal::Rat => RAT[row].whiskers.get(index).map(|&numbers| rat(place, row, column, numbers)),
            Animal::Mouse => MOUSE[row].whiskers.get(index).map(|&numbers| mouse(place, numbers)),
        }
        .ok_or(no_column)
    }

    /// Mean curvature at rest, 1/m: the angle between the ends of the parabola over the length.
    pub fn mean_curvature(&self) -> f64 {
        mean_curvature(self.curvature_coefficient, self.length)
    }
}

impl FromStr for Whisker {
    type Err = WhiskerError;

    /// Of a name as `C2`, a rat's, or `mouse:C2`.
    fn from_str(name: &str) -> Result<Self, WhiskerError> {
        let (animal, place) = name.split_once(':').unwrap_or((Animal::Rat.name(), name));
        let animal = [Animal::Rat, Animal::Mouse].into_iter().find(|one| one.name().eq_ignore_ascii_case(animal));
        let (animal, letter) = animal.zip(place.chars().next()).ok_or(WhiskerError::Name)?;
        let column = place[letter.len_utf8()..].parse().map_err(|_| WhiskerError::Name)?;
        let row = ROWS.iter().position(|row| row.eq_ignore_ascii_case(&letter)).ok_or(WhiskerError::Row)?;
        Self::average(animal, row, column)
    }
}

/// Curvature of the circle that turns as far as the parabola y = a x^2 of arc length L, with a in 1/m and L in m.
pub fn mean_curvature(coefficient: f64, length: f64) -> f64 {
    // the slope u at the tip: 4 a L = u sqrt(1 + u^2) + asinh u
    let goal = 4.0 * coefficient.abs() * length;
    let mut slope = 0.5 * goal;
    for _ in 0..NEWTON_STEPS {
        let root = 1.0_f64.hypot(slope);
        slope -= (slope * root + slope.asinh() - goal) / (2.0 * root);
    }
    (slope.atan() / length).copysign(coefficient)
}

fn rat(place: String, row: usize, column: u8, (length, coefficient): (f64, f64)) -> Whisker {
    let base = 0.041 + 0.002 * length + 0.011 * (row + 1) as f64 - 0.0039 * f64::from(column);
    Whisker {
        animal: Animal::Rat,
        place,
        length: 1e-3 * length,
        base_diameter: 1e-3 * base,
        tip_diameter: TIP_DIAMETER,
        youngs_modulus: 3.34e9,
        curvature_coefficient: 1e3 * coefficient,
        sources: WhiskerSources {
            length: "measured average without standard deviation, code of WHISKiT Physics (Zweifel et al. 2021)".into(),
            curvature:
                "measured average without standard deviation, code of WHISKiT Physics (Zweifel et al. 2021); single whiskers differ by \
                 some 30 %, an estimate"
                    .into(),
            base_diameter: "regression with this length, Belli et al. (2017)",
            tip_diameter: "an estimate; others take 3 um to 11 um",
            youngs_modulus: "measured mean, standard deviation 1.48 GPa, Quist et al. (2011)",
        },
    }
}

fn mouse(place: String, (length, coefficient): (Mean, Mean)) -> Whisker {
    Whisker {
        animal: Animal::Mouse,
        place,
        length: 1e-3 * length.value,
        base_diameter: MOUSE_BASE * 1e-3 * length.value,
        tip_diameter: TIP_DIAMETER,
        youngs_modulus: 5e9,
        curvature_coefficient: 1e3 * coefficient.value,
        sources: WhiskerSources {
            length: format!(
                "measured mean of {} whiskers, standard deviation {:.1} mm, Bresee et al. (2023)",
                length.count, length.deviation
            ),
            curvature: format!(
                "measured mean of {} whiskers, standard deviation of the coefficient {:.1} 1/m, Bresee et al. (2023)",
                coefficient.count,
                1e3 * coefficient.deviation
            ),
            base_diameter: "an estimate of +-25 %, 4.2e-3 of the length",
            tip_diameter: "an estimate",
            youngs_modulus: "an estimate, the default of the Janelia package Whisker",
        },
    }
}

impl std::fmt::Display for WhiskerSources {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { length, curvature, base_diameter, tip_diameter, youngs_modulus } = self;
        write!(f, "length: {length}; curvature: {curvature}; base diameter: {base_diameter}; ")?;
        write!(f, "tip diameter: {tip_diameter}; Young's modulus: {youngs_modulus}")
    }
}

#[cfg(test)]
mod tests {
    use super::{Whisker, WhiskerError};

    #[test]
    fn names_of_whiskers() {
        let mouse: Whisker = "mouse:c2".parse().unwrap();
        assert!((mouse.length - 15.3e-3).abs() < 1e-12 && mouse.place == "C2", "{mouse:?}");
        assert!(mouse.sources.length.contains("12 whiskers, standard deviation 1.3 mm"), "{mouse:?}");
        assert!("rat:E5".parse::<Whisker>().is_ok() && "A0".parse::<Whisker>().is_ok());
        for (name, message) in [
            ("", "expected row and column of a rat's whisker as C2, or of a mouse's as mouse:C2"),
            ("cat:C2", "expected row and column"),
            ("C", "expected row and column"),
            ("C-1", "expected row and column"),
            ("é2", "expected a row from A to E"),
            ("C6", "expected 0 to 5: the whiskers in row C of a rat of which there are measured averages"),
            ("mouse:A0", "expected 1 to 3: the whiskers in row A of a mouse"),
        ] {
            let error = name.parse::<Whisker>().unwrap_err();
            assert!(error.to_string().starts_with(message), "{name}: {error}");
        }
        assert_eq!("F1".parse::<Whisker>(), Err(WhiskerError::Row));
    }
}
