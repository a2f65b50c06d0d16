//! The published numbers: length in mm and coefficient of the parabola in 1/mm, by row and column.

use super::Mean;

/// The whiskers of a row, from the first column on: length (mm) and coefficient (1/mm).
pub(super) struct Row<T: 'static> {
    /// The first column of which there are numbers.
    pub first: u8,
    /// Length and coefficient of each column.
    pub whiskers: &'static [(T, T)],
}

/// The rows A to E of a rat: `param_s_a.csv` of `whisker_param_average_rat` in SeNSE-lab/whiskitphysics, without the whiskers C6, D6 and E6.
pub(super) const RAT: [Row<f64>; 5] = [
    Row { first: 0, whiskers: &[(39.9, 0.00596), (31.0, 0.0118), (25.1, 0.0123), (15.4, 0.0178), (10.7, 0.0222)] },
    Row { first: 0, whiskers: &[(46.8, 0.00681), (40.8, 0.00914), (29.3, 0.0149), (20.7, 0.0166), (11.8, 0.0244)] },
    Row {
        first: 0,
        whiskers: &[(52.8, 0.00694), (45.2, 0.00885), (32.6, 0.0118), (22.9, 0.0136), (13.3, 0.0233), (7.68, 0.0185)],
    },
    Row {
        first: 0,
        whiskers: &[(52.6, 0.00809), (45.9, 0.00859), (35.3, 0.0104), (25.5, 0.013), (17.1, 0.0178), (10.9, 0.0239)],
    },
    Row { first: 1, whiskers: &[(44.1, 0.0101), (34.6, 0.0101), (24.4, 0.0142), (15.5, 0.0224), (9.4, 0.0192)] },
];

const fn mean(value: f64, deviation: f64, count: u8) -> Mean {
    Mean { value, deviation, count }
}

/// The rows A to E of a mouse, both sides of 8 animals: `S_2D` and `Acoef_2D` of `mouse_all.mat` in SeNSE-lab/BreseeEtAl_JEB2023_dataFiles, version 1, where
/// columns count from 1. Without A0, the Greek whisker above the rows, and the whiskers at the front.
pub(super) const MOUSE: [Row<Mean>; 5] = [
    Row {
        first: 1,
        whiskers: &[
            (mean(18.3, 1.5, 13), mean(0.0071, 0.0037, 14)),
            (mean(12.3, 1.2, 12), mean(0.0128, 0.0061, 13)),
            (mean(8.5, 2.1, 12), mean(0.0173, 0.014, 9)),
        ],
    },
    Row {
        first: 0,
        whiskers: &[
            (mean(21.2, 5.0, 13), mean(0.0063, 0.0033, 12)),
            (mean(18.9, 2.5, 12), mean(0.0093, 0.0046, 12)),
            (mean(14.2, 1.7, 11), mean(0.0143, 0.0058, 12)),
            (mean(10.3, 2.8, 13), mean(0.0164, 0.0093, 10)),
        ],
    },
    Row {
        first: 0,
        whiskers: &[
            (mean(19.7, 4.0, 13), mean(0.0057, 0.0029, 12)),
            (mean(19.3, 2.9, 12), mean(0.0075, 0.0042, 12)),
            (mean(15.3, 1.3, 12), mean(0.0094, 0.0045, 11)),
            (mean(12.7, 2.6, 13), mean(0.012, 0.0055, 12)),
            (mean(9.5, 3.0, 13), mean(0.0216, 0.0136, 12)),
        ],
    },
    Row {
        first: 0,
        whiskers: &[
            (mean(20.3, 4.6, 11), mean(0.0111, 0.0027, 10)),
            (mean(19.7, 1.0, 11), mean(0.0088, 0.0036, 12)),
            (mean(14.7, 1.8, 10), mean(0.0118, 0.0055, 9)),
            (mean(11.4, 2.4, 13), mean(0.0142, 0.0077, 13)),
            (mean(8.9, 2.2, 13), mean(0.0153, 0.0096, 12)),
        ],
    },
    Row {
        first: 1,
        whiskers: &[
            (mean(16.7, 2.0, 12), mean(0.0138, 0.0034, 12)),
            (mean(13.7, 2.7, 11), mean(0.0126, 0.0071, 11)),
            (mean(11.5, 3.6, 12), mean(0.0182, 0.0064, 11)),
            (mean(8.9, 2.4, 13), mean(0.0211, 0.0115, 13)),
        ],
    },
];
