//! Bounds that may be infinite, for formats such as JSON that have no infinity: it is written as none.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub(crate) fn finite<S: Serializer>(bound: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    bound.is_finite().then_some(bound).serialize(serializer)
}

pub(crate) fn or_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
}

pub(crate) fn or_minus_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NEG_INFINITY))
}
