//! The filters of OnRobot's sensors, before OptoForce's, over Ethernet and USB.

/// Corner frequency of the low-pass filter in a sensor or converter of OnRobot's; its number is the maker's code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum OnRobotFilter {
    /// No filter.
    None,
    /// 500 Hz.
    Hz500,
    /// 150 Hz.
    Hz150,
    /// 50 Hz.
    Hz50,
    /// 15 Hz, after power-on.
    Hz15,
    /// 5 Hz.
    Hz5,
    /// 1.5 Hz.
    Hz1_5,
}

impl OnRobotFilter {
    /// In the order of their numbers.
    pub(crate) const ALL: [Self; 7] =
        [Self::None, Self::Hz500, Self::Hz150, Self::Hz50, Self::Hz15, Self::Hz5, Self::Hz1_5];
}
