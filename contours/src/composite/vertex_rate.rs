//! How a vertex of a composite moves with a parameter of one of the pieces that meet there.

use super::piece::Piece;
use crate::vector::{cross, minus, plus};
use crate::{Frame, FrameRate};

/// The change of a vertex, the point where the two pieces, continued, cross, per unit of a parameter.
pub(crate) struct VertexRate {
    /// Of the point.
    pub point: [f64; 2],
    /// Of the parameters of the two pieces where they end there.
    pub ends: [f64; 2],
    /// Of the tangent angles of the two pieces there, rad.
    pub alphas: [f64; 2],
}

impl VertexRate {
    /// The vertex between two pieces with these rates there, at the fixed parameters of their ends.
    pub fn new(before: &Piece, after: &Piece, rates: [FrameRate; 2]) -> Self {
        let frames = [before.last(), after.first()];
        let along = frames.map(|Frame { alpha, speed, .. }| {
            let (sin, cos) = alpha.sin_cos();
            [speed * cos, speed * sin]
        });
        let points = rates.map(|rate| [rate.x, rate.y]);
        // r_1 + a r_1' = r_2 + b r_2'
        let (apart, across) = (minus(points[1], points[0]), cross(along[0], along[1]));
        let ends = [cross(apart, along[1]) / across, cross(apart, along[0]) / across];
        let alphas = [0, 1].map(|side| rates[side].alpha + ends[side] * frames[side].turning);
        Self { point: plus(points[0], ends[0], along[0]), ends, alphas }
    }
}
