//! Rods that are not uniform and straight, against independent solutions.

mod clamps;
mod diameters;
mod differences;
mod judge;
mod own;
mod rules;
mod scans;
mod sections;
mod si;
mod smooth;
