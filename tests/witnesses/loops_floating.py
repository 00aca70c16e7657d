"""The oracles of loops.py where nothing holds the base of a robot with closed loops.

The first moves the base as a rigid body at 60 digits: its frame 0 stands at the frame of the world at the state, and has
there the angular velocity and the accelerations of the state, and a linear velocity, which must not count. The virtual
work of all points for displacements of the base and of the independent joints is the wrench on the base and the
torques. The second is Pinocchio with a free flyer, at another place of the world; its accelerations are those of the
system of KKT of the base, all joints and the multipliers of the loops.

All numbers of the base are in axes of frame 0: forces, moments about its origin; accelerations of it less gravity.
"""

import mpmath as mp
import numpy as np
import pinocchio as pin

from loops_peer import Pinocchio
from loops_robot import STEP, rotation, second_moments, shift

VELOCITY = ["0.7", "-1.1", "0.4"]  # of the origin of frame 0
PLACE = pin.SE3(pin.rpy.rpyToMatrix(0.7, -0.4, 2.1), np.array([0.3, -0.8, 1.2]))  # of frame 0 in Pinocchio's world


def motion_of_base(random):
    """A random motion of the base, with gravity in any direction."""
    draw = lambda size: [round(float(x), 3) for x in random.uniform(-size, size, 3)]
    down = random.normal(size=3)
    gravity = [round(float(x), 4) for x in 9.81 * down / np.linalg.norm(down)]
    return {"omega": draw(2), "omega_dot": draw(4), "acceleration": draw(5), "gravity": gravity}


def moved(along, about):
    """The base after a displacement and a rotation vector."""
    angle = mp.sqrt(about @ about)
    cross = np.array([[0, -about[2], about[1]], [about[2], 0, -about[0]], [-about[1], about[0], 0]])
    out = shift(along)
    if angle != 0:
        turn = cross * (mp.sin(angle) / angle) + cross @ cross * ((1 - mp.cos(angle)) / angle**2)
        out[:3, :3] = out[:3, :3] + turn
    return out


def wrench_of(move, pose, force, moment):
    """The work of a wrench that acts at a frame, for a small displacement of this frame."""
    spin = move[:3, :3] @ pose[:3, :3].T
    return move[:3, 3] @ force + np.array([spin[2, 1], spin[0, 2], spin[1, 0]]) @ moment


def floating_values(robot, q, state):
    """The values at one state, from differences of closed poses. The base is the last body."""
    y, slopes, joints = [q[row] for row in robot.free], robot.slopes(q, robot.passive), range(len(robot.free))
    moments = [*robot.moments, second_moments(*robot.base)]
    vector = lambda numbers: np.array([mp.mpf(x) for x in numbers])
    omega, omega_dot, linear, gravity = (vector(state["base"][key]) for key in
                                         ("omega", "omega_dot", "acceleration", "gravity"))
    qd, qdd, wrench, velocity = (vector(numbers) for numbers in (state["qd"], state["qdd"], state["wrench"], VELOCITY))
    at = lambda base, positions: [base @ pose for pose in robot.close(positions, q, slopes)[1]]
    here, nowhere = at(shift([0, 0, 0]), y), vector([0, 0, 0])

    def displaced(direction, by):
        unit = vector([by if row == direction else 0 for row in range(6 + len(y))])
        return at(moved(unit[:3], unit[3:6]), [x + by for x, by in zip(y, unit[6:])])

    def accelerated(acceleration, turning, bending):
        ends = []
        for time in (STEP, -STEP):
            base = moved(velocity * time + acceleration * time**2 / 2, omega * time + turning * time**2 / 2)
            ends.append(at(base, list(y + qd * time + bending * time**2 / 2)))
        return [(ahead - 2 * x + behind) / STEP**2 for ahead, x, behind in zip(ends[0], here, ends[1])]

    moves = [[(a - b) / (2 * STEP) for a, b in zip(displaced(k, STEP), displaced(k, -STEP))]
             for k in range(6 + len(y))]
    product = lambda a, moment, b: ((a @ moment)[:3] * b[:3]).sum()
    work = lambda accelerations, gravity: np.array([
        sum(product(a, moment, move) - gravity @ move[:3] @ moment[:, 3]
            for a, moment, move in zip(accelerations, moments, of_all)) for of_all in moves])
    mass = np.array([[sum(map(product, one, moments, other)) for other in moves] for one in moves])
    bias = work(accelerated(nowhere, nowhere, qdd * 0), nowhere)
    forces = work(accelerated(linear, omega_dot, qdd), gravity)
    accelerations = np.concatenate([linear - gravity, omega_dot, qdd])
    assert max(abs(forces - bias - mass @ accelerations)) < 1e-18 * max(abs(forces))
    link, frame = robot.tip
    pose = here[link] @ frame
    turn = pose[:3, :3]
    carried = np.array([wrench_of(of_all[link] @ frame, pose, turn @ wrench[:3], turn @ wrench[3:]) for of_all in moves])
    applied = np.concatenate([vector([0] * 6), vector(state["tau"])])
    solved = lambda rest: list(mp.lu_solve(mp.matrix(mass.tolist()), mp.matrix(list(rest))))
    return {
        "inverse_dynamics_of_floating_loops": forces,
        "inverse_dynamics_of_floating_loops_with_wrench": forces + carried,
        "floating_mass_matrix_of_loops": mass.ravel(),
        "floating_forward_dynamics_of_loops": solved(applied - bias),
        "floating_forward_dynamics_of_loops_with_wrench": solved(applied - bias - carried),
    }


class FloatingPinocchio(Pinocchio):
    """The tree on a free flyer. The first six velocities and forces are in axes of the base."""

    def __init__(self, robot):
        super().__init__(robot, floats=True)

    def compare(self, q, state, expected):
        """The largest differences, relative to the largest number of their kind."""
        robot, size, base = self.robot, 6 + len(q), {key: np.array(x) for key, x in state["base"].items()}
        velocity = np.array(VELOCITY, dtype=float)
        self.model.gravity.linear = PLACE.rotation @ base["gravity"]
        rates, accelerations = np.zeros(size), np.zeros(size)
        free, passive = ([6 + row for row in rows] for rows in (robot.free, robot.passive))
        sway = np.cross(base["omega"], velocity)  # spatial accelerations are less by this
        rates[:6] = [*velocity, *base["omega"]]
        rates[free], rates[passive] = state["qd"], expected["passive_rates"]
        accelerations[:6] = [*(base["acceleration"] - sway), *base["omega_dot"]]
        accelerations[free] = state["qdd"]
        v, at = self._spread(rates), np.zeros(self.model.nq)
        at[:7] = [*PLACE.translation, *pin.Quaternion(PLACE.rotation).coeffs()]
        at[1 + np.array(self.order[6:])] = [float(x) for x in q]
        keys, rest = self.equations(at, v)
        inverted = np.linalg.pinv(keys[:, passive], rcond=1e-7)
        kept = [*range(6), *free]
        follow = np.eye(size)[:, kept]
        follow[passive] = -inverted @ keys[:, kept]
        accelerations[passive] = inverted @ (rest - keys[:, kept] @ accelerations[kept])
        forces = follow.T @ pin.rnea(self.model, self.data, at, v, self._spread(accelerations))[self.order]
        tip = pin.computeFrameJacobian(self.model, self.data, at, self.tip, pin.ReferenceFrame.LOCAL)[:, self.order]
        tree = pin.crba(self.model, self.data, at)
        tree = (np.triu(tree) + np.triu(tree, 1).T)[np.ix_(self.order, self.order)]
        nle = pin.nonLinearEffects(self.model, self.data, at, v)[self.order]
        system = np.block([[tree, keys.T], [keys, np.zeros((len(keys), len(keys)))]])

        def solved(pushed):
            pushed = pushed - nle
            pushed[free] += state["tau"]
            out = np.linalg.lstsq(system, np.concatenate([pushed, rest]), rcond=1e-13)[0][kept]
            out[:3] += sway - base["gravity"]
            return out

        wrench = tip.T @ state["wrench"]
        found = {
            "inverse_dynamics_of_floating_loops": forces,
            "inverse_dynamics_of_floating_loops_with_wrench": forces + follow.T @ wrench,
            "floating_mass_matrix_of_loops": follow.T @ tree @ follow,
            "floating_forward_dynamics_of_loops": solved(np.zeros(size)),
            "floating_forward_dynamics_of_loops_with_wrench": solved(-wrench),
        }
        return {key: np.abs(np.ravel(numbers) - expected[key]).max() / np.abs(expected[key]).max()
                for key, numbers in found.items()}
