//! Films of a rod: points on it, frame by frame, and measured numbers at its base, from tables to files of forces.

mod channels;
mod error;
mod options;
mod points;
mod readable;
mod record;
mod result;
mod sensor;
mod summary;
mod table;

pub use channels::channels_of_columns;
pub use error::{AtRestError, FilmError};
pub use options::{Ends, FilmOptions};
pub(crate) use readable::check_frames;
pub use result::FilmForces;
