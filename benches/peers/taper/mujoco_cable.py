"""MuJoCo: a chain of capsules and hinges, each as stiff as the cone there, run to rest against the parabola.

The parabola is the sphere that osculates it where it is touched: the collision of a sphere with a capsule is in closed form, and all motion
is in one plane. From time to time the sphere moves to the point that is touched now.
"""

import math

import mujoco
import numpy as np

RADIUS = 1e-3
REST = 1e-9  # largest speed of a joint, largest move of the sphere
STEP = 4e-3  # of sqrt(rho A L^4 / EI) at the clamp
LOOK = 50  # steps between moves of the sphere
LIMIT = 20_000
# Times of each joint with its spring: by damping, which the slowest mode takes about critically, and by armature, an inertia that keeps the
# fast modes of many light links from asking for shorter steps. What rests does not depend on either.
DAMPING = 0.13
ARMATURE = 0.05
CONTACT = 'condim="1" solref="0.02 1" solimp="0.9999 0.9999 0.001 0.5 1"'


class Cable:
    """The spring of joint k stands for the half segments on both sides of it; at the clamp there is but one."""

    name = "MuJoCo, capsules and hinges"
    settings = [20, 40, 80, 160, 320]

    def __init__(self):
        self.models = {}

    def model(self, problem, segments):
        key = (problem.tip, segments)
        if key not in self.models:
            self.models[key] = mujoco.MjModel.from_xml_string(chain(problem, segments))
        return self.models[key]

    def solve(self, problem, clamp, start, segments):
        """The angles at rest, where the parabola is touched, and the results."""
        angles, t, *_ = start
        model = self.model(problem, segments)
        x, y, phi = clamp
        model.body_pos[1] = x, 0.0, y
        model.body_quat[1] = math.cos(phi / 2), 0.0, -math.sin(phi / 2), 0.0
        data = mujoco.MjData(model)
        data.qpos[:] = angles
        place(model, problem, t)
        for steps in range(LOOK, LIMIT, LOOK):
            mujoco.mj_step(model, data, LOOK)
            _, at = touched(model, data)
            if at is None:
                continue
            new = foot(problem, at, t)
            moved, t = abs(new - t), new
            place(model, problem, t)
            if max(moved, np.max(np.abs(data.qvel))) < REST:
                break
        else:
            return None
        mujoco.mj_forward(model, data)
        force, at = touched(model, data)
        moment = (at[0] - x) * force[1] - (at[1] - y) * force[0]
        found = np.array([-force[0], -force[1], -moment, *at])
        return data.qpos.copy(), t, found

    def first(self, problem, segments):
        """The angles of links that march along the solution."""
        a, b, at_x, at_y, _ = problem.force(problem.unknowns)
        (x, y, phi), link, held = problem.clamp, 1.0 / segments, problem.length(problem.unknowns)
        angles = []
        for k in range(segments):
            ahead = k * link < held
            angles.append((a * (x - at_x) + b * (y - at_y)) * compliance(problem, k, link) if ahead else 0.0)
            phi += angles[-1]
            x += link * math.cos(phi)
            y += link * math.sin(phi)
        return angles, problem.unknowns[0]

    def results(self, problem, solution):
        return solution[2]


def compliance(problem, k, link):
    """Of joint k: half a segment before it, unless it is the clamp's, and half a segment behind."""
    behind = 0.5 * link / problem.stiffness((k + 0.25) * link)
    return behind if k == 0 else behind + 0.5 * link / problem.stiffness((k - 0.25) * link)


def chain(problem, segments):
    """The model: the rod in the plane of x and z, and the sphere."""
    link = 1.0 / segments
    bodies = ""
    for k in range(segments):
        stiffness = 1.0 / compliance(problem, k, link)
        # the mass of a cone; what rests does not depend on it
        mass = link * math.sqrt(problem.stiffness((k + 0.5) * link))
        bodies += (
            f'<body pos="{link if k else 0.0} 0 0">'
            f'<joint type="hinge" axis="0 -1 0" stiffness="{stiffness}" damping="{DAMPING * stiffness}" armature="{ARMATURE**2 * stiffness}"/>'
            f'<geom type="capsule" size="{RADIUS}" fromto="0 0 0 {link} 0 0" mass="{mass}" '
            f'contype="{int(not problem.tip or k + 1 == segments)}" conaffinity="0" {CONTACT}/>'
        )
    return f"""
<mujoco>
  <compiler angle="radian" autolimits="false"/>
  <option timestep="{STEP}" gravity="0 0 0" integrator="implicitfast" tolerance="1e-14"
      iterations="200"/>
  <worldbody>
    <geom name="object" type="sphere" size="1" pos="1 0 1" contype="0" conaffinity="1" {CONTACT}/>
    <body pos="0 0 0">{bodies}{"</body>" * segments}</body>
  </worldbody>
</mujoco>"""


def place(model, problem, t):
    """The sphere that osculates the parabola at t, less the radius of the capsules."""
    slope = 2.0 * problem.coefficient * t
    x, y, alpha = problem.frame(t)
    radius = (1.0 + slope * slope) ** 1.5 / (2.0 * problem.coefficient)
    # the solid is above
    model.geom_pos[0] = x - radius * math.sin(alpha), 0.0, y + radius * math.cos(alpha)
    model.geom_size[0, 0] = model.geom_rbound[0] = radius - RADIUS


def touched(model, data):
    """Force on the rod, and the point of its axis where it acts; the contacts of neighbouring links act as one."""
    total, point, whole = np.zeros(2), np.zeros(2), 0.0
    wrench = np.zeros(6)
    for number in range(data.ncon):
        contact = data.contact[number]
        mujoco.mj_contactForce(model, data, number, wrench)
        # the normal points from the first geom, which is the sphere, to the second
        normal = np.array([contact.frame[0], contact.frame[2]])
        side = 1.0 if contact.geom[0] == 0 else -1.0
        axis = np.array([contact.pos[0], contact.pos[2]]) + side * normal * (RADIUS + 0.5 * contact.dist)
        total += side * wrench[0] * normal
        point += wrench[0] * axis
        whole += wrench[0]
    return total, point / whole if whole > 0.0 else None


def foot(problem, point, t):
    """The parameter of the parabola's point that is closest to another, by Newton's method from t."""
    u, v = point[0] - problem.vertex[0], point[1] - problem.vertex[1]
    c = problem.coefficient
    for _ in range(20):
        off = t - u + 2.0 * c * t * (c * t * t - v)
        t -= off / (1.0 + 6.0 * c * c * t * t - 2.0 * c * v)
    return t
