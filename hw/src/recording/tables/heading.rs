//! Names of columns, and the units in them.

use crate::sample::Unit;

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// The name above the column.
    pub heading: String,
    /// The same without the unit.
    pub name: String,
    /// Its unit as it is written, if it is.
    pub unit: Option<String>,
}

impl Column {
    /// From `Fx`, `Fx [N]`, `Fx (mN)`, `Fx / N` or `Fx in N`.
    pub(super) fn new(heading: &str) -> Self {
        let (name, unit) = match split(heading) {
            Some((name, unit)) => (name.to_owned(), Some(unit.to_owned())),
            None => (heading.to_owned(), None),
        };
        Self { heading: heading.to_owned(), name, unit }
    }

    /// Whether the column is meant by this name, with or without its unit.
    pub(super) fn is(&self, name: &str) -> bool {
        self.heading == name || self.name == name
    }
}

/// Longer texts in parentheses are remarks.
const LONGEST_UNIT: usize = 12;

fn split(heading: &str) -> Option<(&str, &str)> {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = heading.strip_suffix(close).and_then(|rest| rest.rsplit_once(open)) {
            let (name, unit) = (name.trim_end().trim_end_matches('/').trim_end(), unit.trim());
            let is_short = unit.chars().count() <= LONGEST_UNIT || Unit::find(unit).is_some();
            let fits = !name.is_empty() && !unit.is_empty() && is_short;
            return fits.then_some((name, unit));
        }
    }
    [heading.rsplit_once('/'), heading.rsplit_once(" in ")].into_iter().flatten().find_map(|(name, unit)| {
        let (name, unit) = (name.trim(), unit.trim());
        (!name.is_empty() && Unit::find(unit).is_some()).then_some((name, unit))
    })
}

/// The unit that a cell of a row of units names: with or without brackets.
pub(super) fn bare_unit(cell: &str) -> &str {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(inner) = cell.strip_prefix(open).and_then(|cell| cell.strip_suffix(close)) {
            return inner.trim();
        }
    }
    cell
}

/// Whether a cell looks like one of a row of units.
pub(super) fn is_unit(cell: &str) -> bool {
    /// Units of columns that are no quantity of ours, and of those without one.
    const OTHERS: [&str; 13] = ["V", "mV", "uV", "µV", "mV/V", "Volts", "A", "mA", "counts", "-", "bar", "Hz", "%"];
    let bare = bare_unit(cell);
    bare.len() < cell.len() || OTHERS.contains(&bare) || Unit::find(bare).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_in_headings() {
        for (heading, name, unit) in [
            ("Fx", "Fx", None),
            ("Fx [N]", "Fx", Some("N")),
            ("Fx[ mN ]", "Fx", Some("mN")),
            ("Fx (mN)", "Fx", Some("mN")),
            ("Fx / N", "Fx", Some("N")),
            ("Mz / (N mm)", "Mz", Some("N mm")),
            ("Stage X in mm", "Stage X", Some("mm")),
            ("Moment Z in N mm", "Moment Z", Some("N mm")),
            ("Mz [newton millimetre]", "Mz", Some("newton millimetre")),
            ("Angle in degrees", "Angle", Some("degrees")),
            ("Force in the plane", "Force in the plane", None),
            ("phi0 [°]", "phi0", Some("°")),
            ("Dev0/Ai0", "Dev0/Ai0", None),
            ("Force (of the sensor below)", "Force (of the sensor below)", None),
            ("[N]", "[N]", None),
            ("a []", "a []", None),
        ] {
            let column = Column::new(heading);
            assert_eq!((column.name.as_str(), column.unit.as_deref()), (name, unit), "{heading}");
            assert!(column.is(heading) && column.is(name));
        }
        assert!(is_unit("[widgets]") && is_unit("N m") && is_unit("V") && !is_unit("Fx"));
        assert_eq!(bare_unit("(mN)"), "mN");
    }
}
