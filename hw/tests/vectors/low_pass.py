"""Vectors for tests/low_pass.rs, by SciPy: python3 low_pass.py > low_pass.csv (SciPy 1.17.1).

Lines of a case: `case,order,cutoff,rate`, then `input,output` of each sample.
"""
import math

from scipy.signal import butter, sosfiltfilt

CASES = [(2, 10.0, 500.0, 60), (4, 40.0, 500.0, 50), (6, 3.0, 100.0, 40), (8, 5.0, 16.0, 36), (2, 0.5, 500.0, 24)]

for order, cutoff, rate, count in CASES:
    print(f"case,{order},{cutoff!r},{rate!r}")
    values = [math.sin(0.3 * i) + 0.02 * i + (0.7 if i % 7 == 3 else 0.0) - (1.5 if i > 0.6 * count else 0.0) for i in range(count)]
    sections = butter(order, cutoff, fs=rate, output="sos")
    for value, filtered in zip(values, sosfiltfilt(sections, values)):
        print(f"{value!r},{float(filtered)!r}")
