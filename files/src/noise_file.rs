//! Noise models from TOML files.

use crate::SceneError;
use crate::toml_file::{self, Fault, Quantities, place_of};
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};
use vibrissa::hw::Dimension;
use vibrissa::reconstruct::{NoiseError, NoiseModel};

/// The noise model in a TOML file, SI units: any of the tables `gain`, `offset`, `white`, `ar1`, `random_walk`,
/// `quantum`, `dropout` and the matrix `crosstalk`, as [`NoiseModel`] has them.
///
/// # Errors
/// [`SceneError`]: the file cannot be read, or is no noise model.
pub fn read_noise(file: &Path) -> Result<NoiseModel, SceneError> {
    parse(file, &toml_file::text("the noise model", file)?)
}

fn parse(file: &Path, text: &str) -> Result<NoiseModel, SceneError> {
    toml_file::parse_quantities(file, text, quantities, |table| {
        let tree = table.get_ref().clone();
        let model = NoiseModel::deserialize(Deserializer::from(table))?;
        model.check().map_err(|error| fault(&tree, &error))?;
        Ok(model)
    })
}

/// Tables whose fields are forces and moments.
const IN_UNITS: [&str; 5] = ["offset", "white", "ar1", "random_walk", "quantum"];

fn quantities(table: &Spanned<DeTable<'_>>) -> Result<Quantities, Fault> {
    let mut quantities = Quantities::default();
    let tables = IN_UNITS.iter().filter_map(|name| table.get_ref().get(*name)?.get_ref().as_table());
    for (name, value) in tables.flatten() {
        let dimension = match name.get_ref().as_ref() {
            "force" | "f0x" | "f0y" => Dimension::Force,
            "m0z" => Dimension::Torque,
            _ => continue,
        };
        if let DeValue::String(text) = value.get_ref() {
            quantities.read(name.get_ref(), text, value.span(), dimension).transpose()?;
        }
    }
    Ok(quantities)
}

/// Blames the field, or the one that stands for it.
fn fault(tree: &DeTable<'_>, error: &NoiseError) -> Fault {
    match error {
        NoiseError::Value { field, value, expected } => {
            let (table, name) = field.split_once('.').unwrap_or((field, field));
            let both = format!("{table}.force");
            let span = [field, both.as_str(), table].into_iter().find_map(|path| place_of(tree, path));
            Fault::new(span.unwrap_or(0..0), format!("{name} is {value}, expected {expected}"))
        }
        // Errors of other kinds concern the model as a whole.
        _ => Fault::new(0..0, error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_and_moments_may_have_units() {
        let read = |text: &str| parse("noise.toml".as_ref(), text);
        let units = read("white = { force = \"2.5 mN\", m0z = \"60 uN m\" }\nquantum.m0z = \"1e-3 N mm\"").unwrap();
        assert_eq!(units, read("white = { force = 2.5e-3, m0z = 6e-5 }\nquantum.m0z = 1e-6").unwrap());
        let error = read("white.force = \"2 mm\"").unwrap_err().to_string();
        let expected =
            "noise.toml:1:15: white.force: force is \"2 mm\": `mm` is a unit of length, expected one of force: N, mN";
        assert!(error.starts_with(expected), "{error}");
    }

    #[test]
    fn mistakes_have_their_places() {
        for (text, message) in [
            ("[white]\nforce = -1", "noise.toml:2:9: white.force: f0x is -1, expected a finite number that is not"),
            ("[white]\nm0z = nan", "noise.toml:2:7: white.m0z: m0z is NaN, expected"),
            ("[ar1]\nforce = 1\ncorrelation = 1", "noise.toml:3:15: ar1.correlation: correlation is 1, expected"),
            ("[ar1]\nforce = 1", "noise.toml:1:1: ar1: missing field `correlation`"),
            (
                "crosstalk = [[0, 0, 0], [0, inf, 0], [0, 0, 0]]",
                "noise.toml:1:29: crosstalk[2][2]: crosstalk[2][2] is inf",
            ),
            (
                "crosstalk = [[0, 0], [0, 0]]",
                "noise.toml:1:13: crosstalk: found rows of [2, 2] numbers, expected three",
            ),
            ("\n[white]\nforce = 1\nf0x = 1", "noise.toml:2:1: white: force given beside f0x or f0y, expected either"),
            ("white.f0z = 1", "noise.toml:1:7: white.f0z: unknown field `f0z`, expected one of `force`, `f0x`"),
            ("[withe]", "noise.toml:1:2: withe: unknown field `withe`, expected one of `gain`"),
            ("white.force = \"low\"", "noise.toml:1:15: white.force: the value is the text \"low\", expected a number"),
            ("[dropout]\nprobability = 2", "noise.toml:2:15: dropout.probability: probability is 2, expected"),
            ("white = ", "noise.toml:1:9: "),
        ] {
            let error = parse("noise.toml".as_ref(), text).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
        let error = read_noise("nowhere.toml".as_ref()).unwrap_err().to_string();
        assert!(error.starts_with("cannot read the noise model nowhere.toml: "), "{error}");
    }
}
