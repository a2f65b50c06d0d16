//! The guides of the project, page by page. They are compiled for the documentation only.

// Its code needs the package examples/custom-shape, which tests it.
#[cfg(not(doctest))]
#[doc = include_str!("../docs/add-a-shape.md")]
pub mod add_a_shape {}

#[cfg(feature = "hw")]
#[doc = include_str!("../docs/add-a-sensor.md")]
pub mod add_a_sensor {}

#[doc = include_str!("../docs/how-it-works.md")]
pub mod how_it_works {}

#[doc = include_str!("../docs/sweep.md")]
pub mod sweep {}

#[doc = include_str!("../docs/derivatives.md")]
pub mod derivatives {}

#[doc = include_str!("../docs/equilibria.md")]
pub mod equilibria {}

#[doc = include_str!("../docs/elastica.md")]
pub mod elastica {}

#[doc = include_str!("../docs/fits.md")]
pub mod fits {}

#[doc = include_str!("../docs/friction.md")]
pub mod friction {}

#[doc = include_str!("../docs/rods.md")]
pub mod rods {}

#[doc = include_str!("../docs/whiskers.md")]
pub mod whiskers {}

#[doc = include_str!("../docs/scene-files.md")]
pub mod scene_files {}

#[doc = include_str!("../docs/studies.md")]
pub mod studies {}

#[doc = include_str!("../docs/plan.md")]
pub mod plan {}

#[doc = include_str!("../docs/limit-distance.md")]
pub mod limit_distance {}

#[doc = include_str!("../docs/shapes.md")]
pub mod shapes {}

#[doc = include_str!("../docs/output-files.md")]
pub mod output_files {}

#[doc = include_str!("../docs/reconstruction.md")]
pub mod reconstruction {}

#[doc = include_str!("../docs/forces-from-shapes.md")]
pub mod forces_from_shapes {}

#[doc = include_str!("../docs/laboratory.md")]
pub mod laboratory {}

#[cfg(feature = "recordings")]
#[doc = include_str!("../docs/recordings.md")]
pub mod recordings {}

#[doc = include_str!("../docs/sensors.md")]
pub mod sensors {}

#[doc = include_str!("../docs/microcontroller.md")]
pub mod microcontroller {}

#[doc = include_str!("../docs/glossary.md")]
pub mod glossary {}
