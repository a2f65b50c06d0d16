//! Raw values to wrenches.

mod accuracy;
#[cfg(feature = "cal")]
mod ati;
mod gauge_matrix;
mod rated_load;
mod scale;
mod sensor_check;
mod tare;
