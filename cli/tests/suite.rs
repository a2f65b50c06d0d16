//! The tests of the command: one program, because each of its own links the whole library again.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod common;
mod random;
mod sharp;
#[path = "../examples/noise_study/study/mod.rs"]
#[allow(dead_code, unused_imports, reason = "the example needs more of it")]
mod study;
mod witness;
#[allow(dead_code, reason = "a part of it is used here")]
#[path = "../../hw/tdms/tests/suite/writer.rs"]
mod writer;

mod angle_warnings;
mod budget;
mod calibrate;
mod contour;
mod defects;
mod documents;
mod edges;
mod elastica;
mod files;
mod first_steps;
mod forces;
mod friction;
mod friction_reconstructed;
mod inspect;
mod inspect_clocks;
mod interrupt;
mod laboratory;
mod legs;
mod live;
mod live_recordings;
mod many_contacts;
mod noise_study;
mod options;
mod outputs;
mod paper;
mod plan;
mod random_scenes;
mod reach;
mod reconstruct;
mod reconstruct_objects;
mod recording_messages;
mod regression;
mod restarts;
mod rods;
mod scene_messages;
mod sensor_faults;
mod several_recordings;
mod sharp_scenes;
mod simulate;
mod starts;
mod studies;
mod transitions;
mod units;
