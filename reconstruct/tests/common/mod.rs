//! What several tests share.
#![allow(dead_code)]

pub mod nine_scans;
pub mod noise;
