"""Writes the files in hw/tdms/tests/vectors with npTDMS: target/peers/tdms/bin/python hw/tdms/peers/vectors.py

Their values are synthetic, and known to hw/tdms/tests/suite/nptdms.rs.
"""

import pathlib

import numpy as np
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

folder = pathlib.Path(__file__).parents[1] / "tests/vectors"
folder.mkdir(parents=True, exist_ok=True)

start = np.datetime64("2021-02-28T12:00:00.250000")
waveform = {"wf_start_time": start, "wf_start_offset": 0.5, "wf_increment": 2e-3, "unit_string": "mN"}
with TdmsWriter(folder / "waveforms.tdms") as writer:
    for first in (0.0, 100.0):
        channels = [ChannelObject("Measured", name, first + gain * np.arange(3.0), waveform) for name, gain in [("Fx", 1.0), ("Fy", -0.125)]]
        writer.write_segment([RootObject({"operator": "Müller", "run": 7}), GroupObject("Measured"), *channels])

linear = {"NI_Number_Of_Scales": 1, "NI_Scale[0]_Scale_Type": "Linear", "NI_Scale[0]_Linear_Slope": 0.5, "NI_Scale[0]_Linear_Y_Intercept": -1.0}
with TdmsWriter(folder / "kinds.tdms") as writer:
    writer.write_segment(
        [
            ChannelObject("g", "counts", np.array([-32768, 0, 32767], dtype=np.int16), linear),
            ChannelObject("g", "single", np.array([0.1, np.inf], dtype=np.float32)),
            ChannelObject("g", "large", np.array([2**64 - 1], dtype=np.uint64)),
            ChannelObject("g", "label", ["", "größer"]),
            ChannelObject("it's", "when", np.array([start], dtype="datetime64[us]")),
        ]
    )
