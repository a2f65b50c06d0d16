//! Contact points of stretches with several contacts, in random scenes: every answer must hold what its covariance says.

mod dice;
mod judge;
mod run;
mod scene;
mod table;
