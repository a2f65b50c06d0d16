//! The shape of a rod at rest, from frames in which nothing touches it.
