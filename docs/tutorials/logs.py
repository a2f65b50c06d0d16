"""Writes the two logs of the tutorial sensor.md into the present folder, of a simulated scan past the object of scenes/O1_q40.toml."""

import math

import vibrissa

rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)  # m, m, Pa
bumps = vibrissa.Composite([vibrissa.Parabola((0.0, 0.0), 50.0), vibrissa.Parabola((0.03, 0.0), 50.0)])
path = vibrissa.ClampPath((0.09, -0.04, math.pi / 2), (-0.09, -0.04, math.pi / 2))
noise = {"white": {"force": 2.5e-3, "m0z": 6e-5}}  # standard deviations in N, N m
scan = vibrissa.simulate(vibrissa.Scene(rod, bumps, path, 1e-3), rate=50.0, speed=1e-2, noise=noise, seed=3)

# The sensor's x is along -y of the scene, and it is not quite unloaded at zero.
with open("ati.csv", "w") as file:
    file.write("ATI FT12345\nRate: 50\nTime (s),Fx (N),Fy (N),Fz (N),Tx (N-mm),Ty (N-mm),Tz (N-mm)\n")
    for t, fx, fy, mz in zip(scan["t"], scan["f0x"], scan["f0y"], scan["m0z"]):
        file.write(f"{t:.2f},{fy + 0.041:.4f},{-fx - 0.017:.4f},0.2153,0.31,-1.02,{-1e3 * mz + 0.83:.3f}\n")
# Milliseconds, mm, degrees, decimal commas, a fifth of the rows.
with open("stage.txt", "w") as file:
    file.write("t [ms];Stage X [mm];Stage Y [mm];Angle [deg]\n")
    for t, x, y, phi in zip(scan["t"][::5], scan["x0"][::5], scan["y0"][::5], scan["phi0"][::5]):
        file.write(f"{1e3 * t:.0f};{1e3 * x:.3f};{1e3 * y:.3f};{math.degrees(phi):.2f}\n".replace(".", ","))
