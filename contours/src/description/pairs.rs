//! Reading `[x, y]`: of an array of two serde would overlook a third number.

use serde::{Deserialize, Deserializer};

#[derive(Deserialize)]
#[serde(try_from = "Vec<f64>")]
struct Pair([f64; 2]);

impl TryFrom<Vec<f64>> for Pair {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        let found = numbers.len();
        let pair = numbers.try_into().map_err(|_| format!("found a list of {found}, expected two numbers: [x, y]"))?;
        Ok(Self(pair))
    }
}

pub(super) fn one<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    Pair::deserialize(deserializer).map(|pair| pair.0)
}

pub(super) fn list<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<[f64; 2]>>, D::Error> {
    let pairs = Vec::<Pair>::deserialize(deserializer)?;
    Ok(Some(pairs.into_iter().map(|pair| pair.0).collect()))
}
