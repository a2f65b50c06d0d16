//! A second judge of reported states: objects from the scene's own text, never from the library's contours, and every place
//! where the rod crosses one of them, however thin it is there. Lengths of the rod.

#![allow(dead_code, reason = "each test file uses its own part")]

pub mod boundary;
pub mod crossing;
pub mod curve;
pub mod depth;
pub mod description;
pub mod nearest;
pub mod pieces;
pub mod run;
pub mod side;
pub mod spline;
pub mod state;
pub mod strand;
pub mod vector;
