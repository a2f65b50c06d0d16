//! From samples to labels, contact points and the contour.

pub(crate) mod live;
pub(crate) mod reconstruction;
