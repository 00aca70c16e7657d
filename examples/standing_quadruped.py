"""HyQ stands on four feet: the torques that carry it, and the forces under its feet.

Run it in the folder that has docs/standing_hyq.yaml: python examples/standing_quadruped.py
"""

import numpy as np
import rne

arm = rne.load("docs/standing_hyq.yaml")
level = np.eye(3)  # the axes of the trunk are those of the world

# hips level, knees bent; each leg is hip abduction, hip flexion, knee, rad
q = [0, 0.75, -1.5, 0, -0.75, 1.5, 0, 0.75, -1.5, 0, -0.75, 1.5]
rest = np.zeros(12)

# what carries the robot in the air: the weight, and the torques of the legs that hang
wrench, hanging = arm.inverse_dynamics_of_floating_base(q, rest, rest)
weight = wrench[2]  # N

# the feet share it by the lever rule, so that the centre of mass stays over them
lf, lh, rf, rh = [arm.pose(q, frame=foot)[:3, 3] for foot in arm.tips]
x, y, _ = arm.centre_of_mass(q)
front, left = (x - lh[0]) / (lf[0] - lh[0]), (y - rf[1]) / (lf[1] - rf[1])
share = np.array([front * left, (1 - front) * left, front * (1 - left), (1 - front) * (1 - left)])
jacobians = arm.tip_jacobians(q, level)  # (tips, 6, 6 + joints); row 2 is z
tau = hanging - share * weight @ jacobians[:, 2, 6:]  # N m

base, qdd, wrenches_on_robot = arm.forward_dynamics_in_contact(q, rest, tau, np.zeros(3), level)
print("forces under the feet, N, in world axes:\n", wrenches_on_robot[:, :3].round(1))
print(f"weight {weight:.3f} N, under the feet {wrenches_on_robot[:, 2].sum():.3f} N")
print(f"the fastest joint accelerates with {abs(qdd).max():.0e} rad/s²")
assert np.isclose(wrenches_on_robot[:, 2].sum(), weight) and abs(qdd).max() < 1e-4
