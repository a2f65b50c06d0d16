"""A rod with its tip on a floor, run to rest by PyElastica: a Cosserat rod, its last node held at the floor's height."""

import math

import elastica as ea
import numpy as np

from floor import PHI0, Y0, divided, results

RADIUS = 0.01  # slender: EA L^2 / EI = 4 / r^2, and steps are shorter by its root than bending wants them
REST = 1e-9  # largest speed of a node
LOOK = 2_000  # steps between looks at the speeds
LIMIT = 400_000
LOWERED = 0.2  # time in which the tip is brought to the floor


class TipOnFloor(ea.ConstraintBase):
    """The last node at height 0, free to slide and to turn; brought there from where the straight rod has it."""

    def __init__(self, _position, height, time, **kwargs):
        super().__init__(**kwargs)
        self.height, self.time = height, time

    def constrain_values(self, system, time):
        system.position_collection[1, -1] = self.height * max(0.0, 1.0 - time / self.time)

    def constrain_rates(self, system, time):
        system.velocity_collection[1, -1] = -self.height / self.time if time < self.time else 0.0


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Damping):
    pass


def run(elements, centred):
    """f0x, f0y, m0z and the contact's x, y at rest; the steps it took."""
    area = math.pi * RADIUS**2
    modulus = 4 / (math.pi * RADIUS**4)  # so that EI = 1
    length, behind = divided(elements, centred)
    direction = np.array([math.cos(PHI0), math.sin(PHI0), 0.0])
    rod = ea.CosseratRod.straight_rod(
        elements,
        np.array([0.0, Y0, 0.0]) - behind * direction,
        direction,
        np.array([0.0, 0.0, 1.0]),
        elements * length,
        RADIUS,
        1 / area,  # density, so that rho A = 1
        youngs_modulus=modulus,
        shear_modulus=modulus / 2,
    )
    # Stability: waves along an element, and the turning of an element against its shear.
    step = min(0.5 * length, 0.7 * RADIUS) / math.sqrt(modulus * area)
    simulator = Simulator()
    simulator.append(rod)
    simulator.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    tip = float(rod.position_collection[1, -1])
    simulator.constrain(rod).using(TipOnFloor, height=tip, time=LOWERED, constrained_position_idx=(-1,))
    # As much as damps the slowest mode critically.
    simulator.dampen(rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=2 * 15.4, time_step=step)
    simulator.finalize()
    stepper, time = ea.PositionVerlet(), 0.0
    for steps in range(1, LIMIT + 1):
        time = stepper.step(simulator, time, step)
        if steps % LOOK == 0 and time > LOWERED and np.max(np.abs(rod.velocity_collection)) < REST:
            break
    else:
        raise RuntimeError("no rest")
    return results(-rod.internal_forces[1, -1], rod.position_collection[0, -1], rod.position_collection[1, -1]), steps
