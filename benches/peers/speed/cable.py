"""A rod with its tip on a floor, run to rest by MuJoCo: its cable of capsules and ball joints, bent by the elasticity plugin."""

import math

import mujoco
import numpy as np

from floor import PHI0, Y0, divided, results

RADIUS = 1e-3
REST = 1e-10  # largest speed of a joint
STEP, COARSE = 2e-3, 20  # of sqrt(rho A L^4 / EI), up to so many elements; with more of them it must be shorter
LOOK = 50  # steps between looks at the speeds
LIMIT = 12_000
# As stiff as a contact stays without jitter: with a tenth of this time, or a longer step, the rod does not come to rest.
CONTACT = 'condim="1" solref="0.02 1" solimp="0.9999 0.9999 0.001 0.5 1"'


def prepare(elements, centred):
    bend = 4 / (math.pi * RADIUS**4)  # so that EI = 1
    density = 1 / (math.pi * RADIUS**2)  # so that rho A = 1
    length, behind = divided(elements, centred)
    at = (-behind * math.cos(PHI0), 0.0, Y0 - behind * math.sin(PHI0))
    # Damping of the joints is implicit: with as much of it as damps the slowest mode critically, large steps are stable
    # though the plugin's bending moments are explicit.
    damping = 2 / 15.4 / length
    step = STEP * min(1.0, COARSE / elements)
    spec = mujoco.MjSpec.from_string(f"""
<mujoco>
  <extension><plugin plugin="mujoco.elasticity.cable"/></extension>
  <compiler angle="radian"/>
  <option timestep="{step}" gravity="0 0 0" integrator="implicitfast" jacobian="dense"
      tolerance="1e-14" iterations="200"/>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 .1" pos="0 0 {-RADIUS}" contype="1" conaffinity="2" {CONTACT}/>
    <body pos="{at[0]} {at[1]} {at[2]}" euler="0 {-PHI0} 0">
      <composite prefix="rod" type="cable" curve="s" count="{elements + 1} 1 1" size="{elements * length}" initial="none">
        <plugin plugin="mujoco.elasticity.cable">
          <config key="twist" value="{bend}"/><config key="bend" value="{bend}"/><config key="vmax" value="0"/>
        </plugin>
        <joint kind="main" damping="{damping}"/>
        <geom type="capsule" size="{RADIUS}" density="{density}" contype="0" conaffinity="0" {CONTACT}/>
      </composite>
    </body>
  </worldbody>
</mujoco>""")
    spec.geoms[-1].contype, spec.geoms[-1].conaffinity = 2, 1  # the last capsule alone touches
    return spec.compile()


def run(model):
    """f0x, f0y, m0z and the contact's x, y at rest; the steps it took."""
    data = mujoco.MjData(model)
    # From an arc whose end is as high as the clamp: no depth of contact to be thrown out of.
    half = PHI0 / model.njnt
    data.qpos[:] = np.tile((math.cos(half), 0.0, math.sin(half), 0.0), model.njnt)
    for steps in range(1, LIMIT + 1):
        mujoco.mj_step(model, data)
        if steps % LOOK == 0 and data.ncon and np.max(np.abs(data.qvel)) < REST:
            break
    else:
        raise RuntimeError("no rest")
    mujoco.mj_forward(model, data)
    force = np.zeros(6)
    mujoco.mj_contactForce(model, data, 0, force)
    contact = data.contact[0]
    # The middle of the capsule's end is on the floor's line, but for the depth of the contact.
    return results(force[0], contact.pos[0], contact.dist), steps
