//! The ways in which a clamp gives way, one independent of the other.

use nalgebra::Matrix3;
use rod_core::ClampLaw;
use smallvec::SmallVec;

/// Softness over the largest one below which a way is rigid: rounding of the coupled ones.
const RIGID: f64 = 1e-14;

/// A displacement (x, y, phi) of the base, of length 1, and how far it goes by a unit of force along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    pub way: [f64; 3],
    pub softness: f64,
}

impl Spring {
    /// How far along this spring a displacement goes.
    pub fn along(&self, displacement: [f64; 3]) -> f64 {
        self.way.iter().zip(displacement).map(|(way, moved)| way * moved).sum()
    }
}

/// The springs of a clamp, none of a rigid one.
pub(crate) type Springs = SmallVec<[Spring; 3]>;

/// The eigenvectors of its compliance: sum of softness way way'.
pub(crate) fn springs(law: Option<ClampLaw>) -> Springs {
    let Some(ClampLaw { compliance, .. }) = law else { return Springs::new() };
    let eigen = Matrix3::from_fn(|i, j| compliance[i][j]).symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let spring = |i: usize| {
        let way = eigen.eigenvectors.column(i);
        Spring { way: [way[0], way[1], way[2]], softness: eigen.eigenvalues[i] }
    };
    (0..3).map(spring).filter(|spring| spring.softness > RIGID * largest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coupled_springs_come_apart() {
        // a beam of length 0.3 and stiffness 2 as a base: end load and end moment
        let (l, ei) = (0.3_f64, 2.0);
        let [bent, coupled, turned] = [l.powi(3) / 3.0 / ei, l * l / 2.0 / ei, l / ei];
        let compliance = [[0.0; 3], [0.0, bent, coupled], [0.0, coupled, turned]];
        let found = springs(Some(ClampLaw { compliance, torque: None }));
        assert_eq!(found.len(), 2);
        for (i, row) in compliance.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                let sum: f64 = found.iter().map(|spring| spring.softness * spring.way[i] * spring.way[j]).sum();
                assert!((sum - entry).abs() < 1e-15, "{i} {j}: {sum} {entry}");
            }
        }
        assert!((found[0].along(found[0].way) - 1.0).abs() < 1e-15);
        assert!(springs(None).is_empty());
    }
}
