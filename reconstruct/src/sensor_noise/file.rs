//! A noise model as written in a file: tables of channels, in which `force` stands for both forces.

use super::model::{Ar1, Dropout, NoiseModel};
use rod_core::Reactions;
use serde::de::Error;
use serde::{Deserialize, Deserializer};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Tables {
    #[serde(default)]
    gain: Channels,
    #[serde(default)]
    crosstalk: Matrix,
    #[serde(default)]
    offset: Channels,
    #[serde(default)]
    white: Channels,
    #[serde(default)]
    ar1: Ar1Table,
    #[serde(default)]
    random_walk: Channels,
    #[serde(default)]
    quantum: Channels,
    #[serde(default)]
    dropout: DropoutTable,
}

impl<'de> Deserialize<'de> for NoiseModel {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Tables { gain, crosstalk, offset, white, ar1, random_walk, quantum, dropout } =
            Tables::deserialize(deserializer)?;
        Ok(Self {
            gain: gain.0,
            crosstalk: crosstalk.0,
            offset: offset.0,
            white: white.0,
            ar1: ar1.0,
            random_walk: random_walk.0,
            quantum: quantum.0,
            dropout: Dropout { probability: dropout.probability, mean_length: dropout.mean_length },
        })
    }
}

/// A number for each channel.
#[derive(Default, Deserialize)]
#[serde(try_from = "ChannelFields")]
struct Channels(Reactions);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ChannelFields {
    force: Option<f64>,
    f0x: Option<f64>,
    f0y: Option<f64>,
    m0z: Option<f64>,
}

impl TryFrom<ChannelFields> for Channels {
    type Error = &'static str;

    fn try_from(fields: ChannelFields) -> Result<Self, Self::Error> {
        let ChannelFields { force, f0x, f0y, m0z } = fields;
        if force.is_some() && (f0x.is_some() || f0y.is_some()) {
            return Err("force given beside f0x or f0y, expected either it, for both of them, or those two");
        }
        let channel = |own: Option<f64>| own.or(force).unwrap_or_default();
        Ok(Self(Reactions { f0x: channel(f0x), f0y: channel(f0y), m0z: m0z.unwrap_or_default() }))
    }
}

#[derive(Default, Deserialize)]
#[serde(try_from = "Ar1Fields")]
struct Ar1Table(Ar1);

/// The fields of [`Ar1Table`]; flattened channels would cost the places of their errors.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Ar1Fields {
    force: Option<f64>,
    f0x: Option<f64>,
    f0y: Option<f64>,
    m0z: Option<f64>,
    correlation: f64,
}

impl TryFrom<Ar1Fields> for Ar1Table {
    type Error = &'static str;

    fn try_from(fields: Ar1Fields) -> Result<Self, Self::Error> {
        let Ar1Fields { force, f0x, f0y, m0z, correlation } = fields;
        let sigma = Channels::try_from(ChannelFields { force, f0x, f0y, m0z })?.0;
        Ok(Self(Ar1 { sigma, correlation }))
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct DropoutTable {
    probability: f64,
    mean_length: Option<f64>,
}

/// Three rows of three. Not an array of arrays, of which serde may overlook a fourth number.
#[derive(Default)]
struct Matrix([[f64; 3]; 3]);

impl<'de> Deserialize<'de> for Matrix {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let rows = Vec::<Vec<f64>>::deserialize(deserializer)?;
        let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
        let rows: Result<Vec<[f64; 3]>, _> = rows.into_iter().map(<[f64; 3]>::try_from).collect();
        let matrix = rows.ok().and_then(|rows| rows.try_into().ok());
        matrix.map(Self).ok_or_else(|| {
            D::Error::custom(format!(
                "found rows of {lengths:?} numbers, expected three rows of three: what f0x, f0y, m0z take from f0x, f0y, m0z"
            ))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_a_model() {
        let text = "
            gain = { f0x = 0.01, f0y = -0.02, m0z = 0.03 }
            crosstalk = [[0, 1, 2], [3.5, 4, 5], [6, 7, 8]]
            [offset]
            m0z = -1e-3
            [white]
            force = 2.5e-3
            m0z = 6e-5
            [ar1]
            f0y = 1e-3
            correlation = 0.45
            [random_walk]
            force = 1e-6
            [quantum]
            m0z = 1e-5
            [dropout]
            probability = 0.1
            mean_length = 4
        ";
        let expected = NoiseModel {
            gain: Reactions { f0x: 0.01, f0y: -0.02, m0z: 0.03 },
            crosstalk: [[0.0, 1.0, 2.0], [3.5, 4.0, 5.0], [6.0, 7.0, 8.0]],
            offset: Reactions { m0z: -1e-3, ..Reactions::default() },
            white: Reactions { f0x: 2.5e-3, f0y: 2.5e-3, m0z: 6e-5 },
            ar1: Ar1 { sigma: Reactions { f0y: 1e-3, ..Reactions::default() }, correlation: 0.45 },
            random_walk: Reactions { f0x: 1e-6, f0y: 1e-6, m0z: 0.0 },
            quantum: Reactions { m0z: 1e-5, ..Reactions::default() },
            dropout: Dropout { probability: 0.1, mean_length: Some(4.0) },
        };
        assert_eq!(toml::from_str::<NoiseModel>(text).unwrap(), expected);
        assert_eq!(toml::from_str::<NoiseModel>("").unwrap(), NoiseModel::default());
    }

    #[test]
    fn refuses_what_it_does_not_know() {
        for (text, message) in [
            ("whit = { f0x = 1 }", "unknown field `whit`"),
            ("white = { fx = 1 }", "unknown field `fx`"),
            ("white = { force = 1, f0y = 1 }", "force given beside f0x or f0y"),
            ("ar1 = { force = 1, f0x = 1, correlation = 0 }", "force given beside f0x or f0y"),
            ("ar1 = { force = 1 }", "missing field `correlation`"),
            ("dropout = { mean_length = 1 }", "missing field `probability`"),
            ("crosstalk = [[1, 0, 0], [0, 1, 0]]", "found rows of [3, 3] numbers, expected three rows of three"),
            ("crosstalk = [[1, 0, 0], [0, 1, 0], [0, 0, 1, 0]]", "found rows of [3, 3, 4] numbers"),
            ("white = 3", "invalid type"),
        ] {
            let error = toml::from_str::<NoiseModel>(text).unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
    }
}
