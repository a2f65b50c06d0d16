//! Parts of the chain.

mod constant_speed;
mod rails;
mod table;
mod timekeeper;
