"""The second oracle of loops.py: Pinocchio's dynamics of the tree in double precision, and rates of the loop equations.

Inverse dynamics is that of the tree, by the rates of all joints for those of the independent ones. Forward dynamics is
the system of KKT: all joints and the multipliers of the loops at once, so it does not use that map.
"""

import numpy as np
import pinocchio as pin


class Pinocchio:
    """The tree in Pinocchio; the loops are equations between its frames."""

    def __init__(self, robot, floats=False):
        self.robot, self.model, rows = robot, pin.Model(), {-1: 0}
        inertia = lambda mass, centre, tensor: pin.Inertia(float(mass), centre.astype(float), tensor.astype(float))
        if floats:
            rows[-1] = self.model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
            self.model.appendBodyToJoint(rows[-1], inertia(*robot.base), pin.SE3.Identity())
        place = lambda pose: pin.SE3(pose[:3, :3].astype(float), pose[:3, 3].astype(float))
        ends = {-1: pin.SE3.Identity()}

        def add(row):  # depth first, as Pinocchio wants it
            parent = robot.parents[row]
            kind = pin.JointModelPZ() if robot.slides[row] else pin.JointModelRZ()
            rows[row] = self.model.addJoint(rows[parent], kind, ends[parent] * place(robot.before[row]),
                                            robot.joints[row])
            ends[row] = pin.SE3.Identity() if robot.after[row] is None else place(robot.after[row])
            self.model.appendBodyToJoint(rows[row], inertia(*robot.links[row]), ends[row])
            for child, above in enumerate(robot.parents):
                if above == row:
                    add(child)

        for row, parent in enumerate(robot.parents):
            if parent == -1:
                add(row)
        frame = lambda name, end: self.model.addFrame(
            pin.Frame(name, rows[end[0]], ends[end[0]] * place(end[1]), pin.FrameType.OP_FRAME))
        self.cuts = [(cut, [frame(f"{k}{side}", end) for side, end in enumerate(ends_of)])
                     for k, (cut, ends_of) in enumerate(robot.cuts)]
        self.tip = frame("tip", robot.tip)
        self.model.gravity.linear = robot.gravity.astype(float)
        self.data = self.model.createData()
        base = list(range(6)) if floats else []
        self.order = base + [self.model.joints[rows[row]].idx_v for row in range(len(robot.joints))]

    def equations(self, q, v):
        """K and k of K q'' = k, from products of vectors that stay zero."""
        axes, zero = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED, np.zeros(self.model.nv)
        pin.computeJointJacobians(self.model, self.data, q)
        pin.forwardKinematics(self.model, self.data, q, v, zero)
        pin.updateFramePlacements(self.model, self.data)
        rows, rest = [], []
        for cut, frames in self.cuts:
            jacobians = [pin.getFrameJacobian(self.model, self.data, f, axes) for f in frames]
            drifts = [pin.getFrameClassicalAcceleration(self.model, self.data, f, axes) for f in frames]
            spins = [pin.getFrameVelocity(self.model, self.data, f, axes).angular for f in frames]
            rows += list(jacobians[1][:3] - jacobians[0][:3])
            rest += list(drifts[0].linear - drifts[1].linear)
            if cut == "weld":
                rows += list(jacobians[1][3:] - jacobians[0][3:])
                rest += list(drifts[0].angular - drifts[1].angular)
            for first, second in {"revolute": [(0, 2), (1, 2)], "universal": [(0, 1)]}.get(cut, []):
                x, z = (self.data.oMf[f].rotation[:, column] for f, column in zip(frames, (first, second)))
                (xd, zd) = np.cross(spins[0], x), np.cross(spins[1], z)
                bend = lambda side, axis, rate: np.cross(drifts[side].angular, axis) + np.cross(spins[side], rate)
                rows.append(np.cross(z, x) @ (jacobians[1][3:] - jacobians[0][3:]))
                rest.append(-(bend(0, x, xd) @ z + 2 * xd @ zd + x @ bend(1, z, zd)))
        return np.array(rows)[:, self.order], np.array(rest)

    def compare(self, q, state, expected):
        """The largest differences, relative to the largest number, and the singular values of the dependent joints."""
        robot, size = self.robot, len(q)
        rates, accelerations = np.zeros(size), np.zeros(size)
        rates[robot.free], rates[robot.passive] = state["qd"], expected["passive_rates"]
        accelerations[robot.free] = state["qdd"]
        q, v = self._spread(q), self._spread(rates)
        keys, rest = self.equations(q, v)
        values = np.linalg.svd(keys[:, robot.passive], compute_uv=False)
        rank = int((values > 1e-7 * values[0]).sum())
        assert rank == len(robot.passive), "the dependent joints do not follow"
        inverted = np.linalg.pinv(keys[:, robot.passive], rcond=1e-7)
        loop_map = -inverted @ keys[:, robot.free]
        drift = inverted @ rest
        follow = np.eye(size)[:, robot.free]
        follow[robot.passive] = loop_map
        accelerations[robot.passive] = drift + loop_map @ state["qdd"]
        torques = follow.T @ pin.rnea(self.model, self.data, q, v, self._spread(accelerations))[self.order]
        tip = pin.computeFrameJacobian(self.model, self.data, q, self.tip, pin.ReferenceFrame.LOCAL)[:, self.order]
        tree = pin.crba(self.model, self.data, q)
        tree = (np.triu(tree) + np.triu(tree, 1).T)[np.ix_(self.order, self.order)]
        zeros = np.zeros(size)
        gravity = follow.T @ pin.rnea(self.model, self.data, q, zeros, zeros)[self.order]
        nle = pin.nonLinearEffects(self.model, self.data, q, v)[self.order]
        mass, added = follow.T @ tree @ follow, np.zeros(size)
        added[robot.passive] = drift
        # Forward dynamics of the whole system: multipliers of redundant equations are not unique, accelerations are.
        pushed = np.zeros(size)
        pushed[robot.free] = state["tau"]
        system = np.block([[tree, keys.T], [keys, np.zeros((len(keys), len(keys)))]])
        solved = np.linalg.lstsq(system, np.concatenate([pushed - nle, rest]), rcond=1e-13)[0][:size]
        found = {
            "loop_map": loop_map, "passive_rates": loop_map @ state["qd"], "passive_accelerations_bias": drift,
            "passive_accelerations": accelerations[robot.passive], "inverse_dynamics": torques,
            "inverse_dynamics_with_wrench": torques + follow.T @ tip.T @ state["wrench"],
            "gravity_torques": gravity, "bias_torques": follow.T @ (nle + tree @ added), "mass_matrix": mass,
            "forward_dynamics": solved[robot.free],
        }
        largest = max(np.abs(expected["inverse_dynamics"]).max(), 1e-300)
        faster = np.abs(state["qdd"]).max()  # of numbers that may vanish
        scales = {"gravity_torques": largest, "bias_torques": largest, "passive_accelerations_bias": faster,
                  "passive_accelerations": faster}
        errors = {key: np.abs(np.ravel(found[key]) - expected[key]).max()
                  / max(np.abs(expected[key]).max(), scales.get(key, 1e-12)) for key in expected}
        return errors, values[0] / values[rank - 1], np.linalg.cond(mass)

    def _spread(self, values):
        out = np.zeros(self.model.nv)
        out[self.order] = [float(x) for x in values]
        return out
