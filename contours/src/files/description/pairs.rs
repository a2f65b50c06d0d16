//! Reading `[x, y]`: of an array of two serde would overlook a third number.

use serde::de::Error;
use serde::{Deserialize, Deserializer};

pub(super) fn one<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    let numbers = Vec::<f64>::deserialize(deserializer)?;
    let found = numbers.len();
    numbers.try_into().map_err(|_| D::Error::custom(format!("found a list of {found}, expected two numbers: [x, y]")))
}

pub(super) fn list<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<[f64; 2]>>, D::Error> {
    let points = Vec::<Vec<f64>>::deserialize(deserializer)?;
    let pair = |(index, numbers): (usize, Vec<f64>)| {
        let (point, found) = (index + 1, numbers.len());
        let fault = |_| D::Error::custom(format!("point {point} is a list of {found}, expected two numbers: [x, y]"));
        numbers.try_into().map_err(fault)
    };
    points.into_iter().enumerate().map(pair).collect::<Result<_, _>>().map(Some)
}
