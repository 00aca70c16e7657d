"""The torques of MuJoCo, for the tests of the import of MJCF files.

Usage: python mjcf.py FOLDER         writes the torques beside each MJCF file of the folder
       python mjcf.py FOLDER TARGET  saves each URDF and MJCF file of the folder as MJCF, with the torques, in TARGET

`cargo xtask urdf --mjcf FOLDER` calls the second one and then the test that reads the target. MuJoCo reads each URDF
without its meshes. A free joint stands still; where it is the first joint, a second file, NAME.floating.csv, has
the motion of the base, too. Joints that follow others do so: their torques act on the joints that
they follow. Rotors are included.
"""

import pathlib
import re
import sys

import mujoco
import numpy as np

STATES = 3


def read(path):
    """An MJCF file."""
    text = path.read_text()
    if re.search(r"<mesh [^>]*file=", text):  # which are not here, and matter to no inertia
        text = re.sub(r'<geom [^>]*type="mesh"[^>]*/>|<mesh [^>]*/>', "", text)
        return Model(mujoco.MjModel.from_xml_string(text))
    return Model(mujoco.MjModel.from_xml_path(str(path)))


class Model:
    """A model of MuJoCo, whose joints follow others by its equalities."""

    def __init__(self, model):
        self.model, self.data = model, mujoco.MjData(model)
        kinds = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
        moves = [i for i in range(model.njnt) if int(model.jnt_type[i]) in kinds]
        # Each joint's position is that of a leader times a ratio and an offset; `None` has no leader.
        self.follows = {i: (i, 1.0, 0.0) for i in moves}
        for _ in range(model.neq):
            for k in range(model.neq):
                if int(model.eq_type[k]) != int(mujoco.mjtEq.mjEQ_JOINT) or not model.eq_active0[k]:
                    continue
                one, other = int(model.eq_obj1id[k]), int(model.eq_obj2id[k])
                a, b = model.eq_data[k, :2]
                start = model.qpos0[model.jnt_qposadr[one]] + a
                if other < 0:
                    self.follows[one] = (None, 0.0, start)
                else:
                    leader, ratio, offset = self.follows[other]
                    start -= b * model.qpos0[model.jnt_qposadr[other]]
                    self.follows[one] = (leader, ratio * b, start + b * offset)
        self.free = [i for i in moves if self.follows[i][0] == i]
        self.names = [model.joint(i).name for i in self.free]

    def states(self, number=STATES):
        random = np.random.default_rng(7)
        for _ in range(number):
            yield [random.uniform(-size, size, len(self.free)) for size in (1.0, 2.0, 5.0)]

    def put(self, q, qd, qdd):
        """Puts the state of the joints into the data; what floats stands still where the model has it."""
        model, data = self.model, self.data
        data.qpos[:], data.qvel[:], data.qacc[:] = model.qpos0, 0, 0
        place = {joint: k for k, joint in enumerate(self.free)}
        for joint, (leader, ratio, offset) in self.follows.items():
            at, dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
            data.qpos[at] = offset
            if leader is not None:
                k = place[leader]
                data.qpos[at] += ratio * q[k]
                data.qvel[dof], data.qacc[dof] = ratio * qd[k], ratio * qdd[k]
        return data

    def torques_of_data(self):
        """All generalised forces, and those of the joints that follow none, at the state in the data."""
        model, data = self.model, self.data
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        tau = np.zeros(model.nv)
        mujoco.mj_rne(model, data, 1, tau)
        armature = model.dof_armature.copy()
        for k in range(model.nu):
            if int(model.actuator_trntype[k]) == int(mujoco.mjtTrn.mjTRN_JOINT):
                dof = model.jnt_dofadr[model.actuator_trnid[k, 0]]
                armature[dof] += model.actuator_gear[k, 0] ** 2 * model.actuator_armature[k]
        tau += armature * data.qacc
        result = np.zeros(len(self.free))
        for joint, (leader, ratio, _) in self.follows.items():
            if leader is not None:
                result[self.free.index(leader)] += ratio * tau[model.jnt_dofadr[joint]]
        return tau, result

    def torques(self, q, qd, qdd, base=None):
        """Torques; of a base that moves, with ω, ω̇, acceleration and rotation, its force and moment first."""
        data = self.put(q, qd, qdd)
        if base:
            omega, omega_dot, acceleration, turn = base
            mujoco.mju_mat2Quat(data.qpos[3:7], turn.flatten())
            # the velocity of the origin is no matter
            data.qvel[:6] = [0.3, -0.2, 0.1, *omega]
            data.qacc[:6] = [*(turn @ acceleration), *omega_dot]
        tau, result = self.torques_of_data()
        return np.concatenate([base[3].T @ tau[:3], tau[3:6], result]) if base else result


def line(*vectors):
    return ",".join(repr(float(x)) for x in np.concatenate(vectors))


def floating(model):
    """A line per state: q, qd, qdd, then ω, ω̇, acceleration and gravity in axes of the base, force, moment, torques."""
    random = np.random.default_rng(11)
    for state in model.states():
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        turn *= np.linalg.det(turn)
        base = random.normal(size=(3, 3))
        gravity = turn.T @ model.model.opt.gravity
        yield line(*state, *base, gravity, model.torques(*state, base=(*base, turn)))


def golden(path):
    """Writes names, states and torques beside an MJCF file."""
    model = read(path)
    if model.model.njnt and int(model.model.jnt_type[0]) == int(mujoco.mjtJoint.mjJNT_FREE):
        path.with_suffix(".floating.csv").write_text("\n".join([",".join(model.names), *floating(model)]) + "\n")
    lines = [",".join(model.names)]
    for q, qd, qdd in model.states():
        lines.append(line(q, qd, qdd, model.torques(q, qd, qdd)))
    path.with_suffix(".csv").write_text("\n".join(lines) + "\n")
    print(f"{path.name}: {len(model.free)} joints")


def save(path, target):
    """A URDF or an MJCF file as MuJoCo saves it."""
    if path.suffix == ".urdf":
        text = re.sub(r"<(visual|collision)\b(?:[^>]*/>|.*?</\1>)", "", path.read_text(), flags=re.S)
        options = 'fusestatic="false" balanceinertia="true" boundmass="1e-6" boundinertia="1e-9"'
        text = re.sub(r"<mujoco>.*?</mujoco>", "", text, flags=re.S)
        text = re.sub(r"(<robot\b[^>]*>)", rf"\1<mujoco><compiler {options}/></mujoco>", text, count=1)
        model = mujoco.MjModel.from_xml_string(text)
    else:
        model = read(path).model
    result = target / f"{path.stem}.xml"
    mujoco.mj_saveLastXML(str(result), model)
    return result


def main():
    folder = pathlib.Path(sys.argv[1])
    if len(sys.argv) == 2:
        for path in sorted(folder.glob("*.xml")):
            golden(path)
        return
    target = pathlib.Path(sys.argv[2])
    for path in sorted([*folder.glob("*.xml"), *folder.glob("*.urdf")]):
        try:
            golden(save(path, target))
        except ValueError as error:
            print(f"{path.name}: MuJoCo refuses it: {str(error).splitlines()[0]}")


if __name__ == "__main__":
    main()
