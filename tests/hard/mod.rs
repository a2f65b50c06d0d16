//! How near to a cliff the solver works, measured.

pub mod exact;
pub mod made;
pub mod measure;
pub mod table;

#[allow(dead_code, reason = "it is shared, and not all of it is needed here")]
#[path = "../../rod-core/tests/reference/mod.rs"]
pub mod reference;
