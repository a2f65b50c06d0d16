//! The tests of plans: one program, because each of its own links the whole library again.

mod explore;
mod plan;
mod reach;
