"""An ankle that two rods drive: the torques of its two motors, and how they map to pitch and roll of the foot.

Run it in the folder that has benches/trees/loops/g1_ankle.yaml: python examples/ankle.py
"""

import numpy as np
import rne

arm = rne.load("benches/trees/loops/g1_ankle.yaml")
q, qd, qdd = np.array([0.15, -0.1]), np.array([1.2, -0.8]), np.array([3.0, 5.0])  # of the motors

# the positions of the dependent joints, from a guess; the residual says whether the loops are closed
passive, residual = arm.close(q, np.zeros(len(arm.passive_joints)))
pitch, roll = arm.passive_joints.index("pitch"), arm.passive_joints.index("roll")
print(f"pitch {passive[pitch]:.4f} rad, roll {passive[roll]:.4f} rad; {abs(residual).max():.0e} m are left")

tau = arm.inverse_dynamics_of_loops(q, passive, qd, qdd)  # N m
loop_map = arm.loop_map(q, passive)  # rates of the dependent joints per rate of a motor
print("motors:", tau.round(3), "N m")
print("10 N m about pitch ask", (10 * loop_map[pitch]).round(2), "N m of the motors")
assert abs(residual).max() < 1e-12
assert np.allclose(arm.forward_dynamics_of_loops(q, passive, qd, tau), qdd)
