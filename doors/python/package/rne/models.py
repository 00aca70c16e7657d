"""Models of MuJoCo and Pinocchio that are in memory, as arms.

Their arrays are written as an MJCF text with all digits, and `rne.load` reads this text: so there is one import, with
the same messages, names and options.
"""

import re

import numpy as np

from ._rne import RobotFileError, load


def from_mujoco(model, **options):
    """The arm of a compiled MuJoCo model, an `mujoco.MjModel`.

    Positions are those of `qpos`: zero is where a joint's position is zero, not at its `ref`. The order of the joints
    is `arm.joints`. `armature` is the rotor of a joint's motor, and belongs to the arm as in MuJoCo, unless `rotors` is
    False. A joint that follows another one by an equality has its torque at that one, and no place in q. `arm.notes`
    says what the arm has not, such as springs and tendons.

    A body with a free joint that carries all other joints is the floating base, whose motion `rne.base_from_mujoco`
    makes of `qpos`, `qvel`, `qacc` and the model; `floating=False` fixes it.

    model: the compiled model, without joints that turn as balls.
    options: those of `rne.load`; here `whole` is true and `snap` is false by default.

    Raises `RobotFileError` where a robot file cannot describe the model, ValueError at an equality of other elements
    than joints, such as one that closes a loop.
    """
    import mujoco

    names = [model.body(i).name or f"body_{i}" for i in range(model.nbody)]
    bodies = [_Body(*parts) for parts in zip(names, model.body_pos, model.body_quat)]
    for i in range(1, model.nbody):
        body = bodies[i]
        bodies[model.body_parentid[i]].parts.append(body)
        inertia = {"pos": model.body_ipos[i], "quat": model.body_iquat[i], "mass": model.body_mass[i]}
        body.add("inertial", **inertia, diaginertia=model.body_inertia[i])
        body.attributes["gravcomp"] = model.body_gravcomp[i]
        if model.body_mocapid[i] >= 0:
            body.attributes["mocap"] = "true"
    for i in range(model.njnt):
        name, kind, dof = model.joint(i).name or f"joint_{i}", _KINDS[int(model.jnt_type[i])], model.jnt_dofadr[i]
        values = {"armature": model.dof_armature[dof], "damping": _terms(model, "dof_damping", dof)}
        values |= {"frictionloss": model.dof_frictionloss[dof], "stiffness": _terms(model, "jnt_stiffness", i)}
        if kind == "free":
            bodies[model.jnt_bodyid[i]].add("joint", name=name, type=kind, **values)
            continue
        values |= {"pos": model.jnt_pos[i], "axis": model.jnt_axis[i], "ref": model.qpos0[model.jnt_qposadr[i]]}
        if model.jnt_limited[i]:
            values |= {"range": model.jnt_range[i], "limited": "true"}
        if model.jnt_actfrclimited[i]:
            values |= {"actuatorfrcrange": model.jnt_actfrcrange[i], "actuatorfrclimited": "true"}
        bodies[model.jnt_bodyid[i]].add("joint", name=name, type=kind, **values)
    is_between_sites = np.asarray(model.eq_objtype) == int(mujoco.mjtObj.mjOBJ_SITE)
    ends_of_equalities = {*model.eq_obj1id[is_between_sites], *model.eq_obj2id[is_between_sites]}
    sites = [model.site(i).name or f"site_{i}" for i in range(model.nsite)]
    for i in range(model.nsite):
        if model.site(i).name or i in ends_of_equalities:
            bodies[model.site_bodyid[i]].add("site", name=sites[i], pos=model.site_pos[i], quat=model.site_quat[i])

    equalities, kinds = [], mujoco.mjtEq
    words = [(kinds.mjEQ_CONNECT, "connect"), (kinds.mjEQ_WELD, "weld")]
    words = {int(kind): word for kind, word in [*words, (kinds.mjEQ_JOINT, "joint"), (kinds.mjEQ_TENDON, "tendon")]}
    joints = [model.joint(i).name or f"joint_{i}" for i in range(model.njnt)]
    for i in range(model.neq):
        word, data = words.get(int(model.eq_type[i]), "flex"), model.eq_data[i]
        values = {"name": model.eq(i).name} if model.eq(i).name else {}
        if not model.eq_active0[i] or model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_EQUALITY):
            values["active"] = "false"
        ends = [int(end) for end in (model.eq_obj1id[i], model.eq_obj2id[i]) if end >= 0]
        of = {"joint": ("joint", joints), "connect": ("body", names), "weld": ("body", names)}.get(word, (word, None))
        part, known = ("site", sites) if is_between_sites[i] else of
        if known is not None:
            values |= {f"{part}{k + 1}": known[end] for k, end in enumerate(ends)}
        if word == "joint":
            values["polycoef"] = data[:5]
        elif part == "body":
            values |= {"anchor": data[:3]} if word == "connect" else {"anchor": data[:3], "relpose": data[3:10]}
        equalities.append(_tag(word, **values))

    tendons = []
    for i in range(model.ntendon):
        values = {"name": model.tendon(i).name} if model.tendon(i).name else {}
        for part in ("stiffness", "damping", "armature", "frictionloss"):
            values |= {part: _terms(model, f"tendon_{part}", i)} if hasattr(model, f"tendon_{part}") else {}
        is_fixed = int(model.wrap_type[model.tendon_adr[i]]) == int(mujoco.mjtWrap.mjWRAP_JOINT)
        tendons.append(_tag("fixed" if is_fixed else "spatial", **values))

    actuators = []
    on_joints = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
    for i in range(model.nu):
        kind, at = int(model.actuator_trntype[i]), model.actuator_trnid[i, 0]
        if kind in on_joints:
            values = {"joint": joints[at]}
        elif kind == int(mujoco.mjtTrn.mjTRN_TENDON):
            values = {"tendon": model.tendon(at).name or f"tendon {at}"}
        else:
            continue
        values["gear"] = model.actuator_gear[i, :1]
        for part in ("armature", "damping"):  # since MuJoCo 3.4
            values |= {part: _terms(model, f"actuator_{part}", i)} if hasattr(model, f"actuator_{part}") else {}
        if model.actuator_forcelimited[i]:
            values |= {"forcerange": model.actuator_forcerange[i], "forcelimited": "true"}
        is_motor = model.actuator_gaintype[i] == 0 and model.actuator_biastype[i] == 0
        if is_motor and model.actuator_gainprm[i, 0] == 1 and model.actuator_ctrllimited[i]:
            values |= {"ctrlrange": model.actuator_ctrlrange[i], "ctrllimited": "true"}
        actuators.append(_tag("motor" if is_motor else "general", **values))

    name = model.names[: model.names.index(b"\0")].decode() or "mujoco"
    option = {"gravity": _gravity_of_mujoco(model), "density": model.opt.density, "viscosity": model.opt.viscosity}
    sections = {"equality": equalities, "tendon": tendons, "actuator": actuators}
    return _load(name, option, bodies[0], sections, options)


def from_pinocchio(model, **options):
    """The arm of a Pinocchio model, a `pinocchio.Model`.

    The order of the joints is `arm.joints`. The position of an unbounded joint, of which Pinocchio has cosine and sine,
    is its angle. The frames of the model are `arm.frames`, by their names. `armature`
    belongs to the arm as in Pinocchio, unless `rotors` is False. In a model without it, `rotors=True` counts
    `rotorInertia` times the square of `rotorGearRatio`, which Pinocchio does not count. A joint that follows another
    one has its torque at that one, and no place in q.

    A free-flyer that carries all other joints is the floating base, whose motion `rne.base_from_pinocchio` makes of
    Pinocchio's vectors and the model; `floating=False` fixes it. A function of rne that takes the pose of the base
    takes that in the world, `data.oMi[1]`.

    model: joints that turn about one axis or slide along it, after a free-flyer or not.
    options: those of `rne.load`; here `whole` is true and `snap` is false by default.

    Raises ValueError at a joint of another type, such as a helical or a spherical one.
    """
    bodies = [_Body("universe", np.zeros(3), _IDENTITY)]
    equalities, has_armature = [], bool(np.any(model.armature))
    mimics = dict(zip(getattr(model, "mimicking_joints", []), getattr(model, "mimicked_joints", [])))
    for i in range(1, model.njoints):
        joint, name, placement = model.joints[i], model.names[i], model.jointPlacements[i]
        body = _Body(name, placement.translation, _quaternion(placement.rotation))
        bodies[model.parents[i]].parts.append(body)
        bodies.append(body)
        inertia = model.inertias[i]
        moments = inertia.inertia[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)]
        body.add("inertial", pos=inertia.lever, mass=inertia.mass, fullinertia=moments)
        kind = joint.shortname()
        if kind == "JointModelFreeFlyer" and model.parents[i] == 0:
            body.add("freejoint", name=name)
            continue
        follows = re.search(r"Mimicking joint type: (\w+)", str(joint.extract())) if i in mimics else None
        if follows:
            leader = model.joints[mimics[i]]
            kind = f"{kind} of a {follows[1]}"
            # the position of one is an angle, of the other cosine and sine: Pinocchio mixes them
            if bool(re.search("RUB|Unbounded", kind)) != (leader.nq == 2):
                kind += f" that follows a {leader.shortname()}"
        if not _READ.fullmatch(kind):
            raise ValueError(
                f"the joint {name!r} is a {kind}; rne reads joints that turn about one axis or slide along it, and a "
                "free-flyer on the universe. Fix this joint with `pinocchio.buildReducedModel`, or put such joints in "
                "its place"
            )
        values = {}
        motion = np.asarray(joint.createData().S, dtype=float).reshape(6)
        if i in mimics:
            follower = joint.extract()
            motion = motion / follower.scaling
            polynomial = [follower.offset, follower.scaling]
            equalities.append(_tag("joint", joint1=name, joint2=model.names[mimics[i]], polycoef=polynomial))
        else:
            v, q = joint.idx_v, joint.idx_q
            rotor = model.armature[v] if has_armature else model.rotorInertia[v] * model.rotorGearRatio[v] ** 2
            friction = getattr(model, "upperDryFrictionLimit", None)
            friction = model.friction[v] if friction is None else friction[v]
            values = {"armature": rotor, "damping": model.damping[v], "frictionloss": friction}
            low, high = model.lowerPositionLimit[q], model.upperPositionLimit[q]
            if joint.nq == 1 and np.isfinite([low, high]).all() and low < high:
                values |= {"range": [low, high], "limited": "true"}
            effort = getattr(model, "upperEffortLimit", None)
            effort = model.effortLimit[v] if effort is None else effort[v]
            if 0 < effort < 1e9:
                values |= {"actuatorfrcrange": [-effort, effort], "actuatorfrclimited": "true"}
        slides = bool(motion[:3].any())
        axis = motion[:3] if slides else motion[3:]
        body.add("joint", name=name, type="slide" if slides else "hinge", axis=axis, **values)
    seen = {"universe"}
    for frame in model.frames:
        if frame.name not in seen and frame.type.name != "JOINT":
            seen.add(frame.name)
            place = frame.placement
            turn = _quaternion(place.rotation)
            bodies[frame.parentJoint].add("site", name=frame.name, pos=place.translation, quat=turn)
    options = {"rotors": has_armature, **options}
    option, sections = {"gravity": model.gravity.linear}, {"equality": equalities}
    return _load(model.name or "pinocchio", option, bodies[0], sections, options)


def base_of_pinocchio(model):
    """Gravity in the axes in which q has the orientation of the base, and where q and v have the base."""
    roots = [joint for joint, parent in enumerate(model.parents) if parent == 0][1:]
    flyers = [joint for joint in roots if model.joints[joint].shortname() == "JointModelFreeFlyer"]
    others = set(range(1, model.njoints)).difference(flyers)
    base = _found(next((flyer for flyer in flyers if others.issubset(model.subtrees[flyer])), None), "free flyer")
    joint = model.joints[base]
    return model.jointPlacements[base].rotation.T @ model.gravity.linear, joint.idx_q, joint.idx_v


def base_of_mujoco(model):
    """Gravity in the world, and where qpos and qvel have the base."""
    root = model.body_rootid[model.jnt_bodyid]
    # 0 is a free joint, 1 a ball
    others = root[model.jnt_type > 1]
    free = np.flatnonzero(model.jnt_type == 0)
    base = _found(next((joint for joint in free if (others == root[joint]).all()), None), "free joint")
    return _gravity_of_mujoco(model), int(model.jnt_qposadr[base]), int(model.jnt_dofadr[base])


def _found(base, kind):
    if base is None:
        raise ValueError(f"no {kind} of the model carries all other joints, so the model has no floating base")
    return base


def _gravity_of_mujoco(model):
    """The acceleration of gravity, of which a model has none if its flag is off."""
    import mujoco

    return np.array(model.opt.gravity) * (not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_GRAVITY))


# The types of joints of Pinocchio that are read.
_READ = re.compile(
    r"(JointModelMimic of a )?JointModel((R|P|RUB)[XYZ]|(Revolute|Prismatic|RevoluteUnbounded)Unaligned)"
)
# The kinds of joints, in the order of `mujoco.mjtJoint`.
_KINDS = ("free", "ball", "slide", "hinge")
_IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


class _Body:
    """An element `body` that is written."""

    def __init__(self, name, pos, quat):
        self.attributes = {"name": name, "pos": pos, "quat": quat}
        self.parts = []

    def add(self, element, **attributes):
        self.parts.append(_tag(element, **attributes))

    def text(self, element="body"):
        attributes = self.attributes if element == "body" else {}
        lines, open_parts = [_tag(element, **attributes)[:-2] + ">"], [(element, iter(self.parts))]
        while open_parts:
            name, parts = open_parts[-1]
            part = next(parts, None)
            if part is None:
                lines.append(f"</{name}>")
                open_parts.pop()
            elif isinstance(part, str):
                lines.append(part)
            else:
                lines.append(_tag("body", **part.attributes)[:-2] + ">")
                open_parts.append(("body", iter(part.parts)))
        return "\n".join(lines)


def _tag(element, **attributes):
    escape = lambda text: str(text).replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    write = lambda value: escape(value) if isinstance(value, str) else " ".join(repr(float(x)) for x in np.ravel(value))
    return f"<{element}" + "".join(f' {name}="{write(value)}"' for name, value in attributes.items()) + "/>"


def _quaternion(rotation):
    """(w, x, y, z) of a rotation matrix: the largest column of 4 q qᵀ, which loses no digits."""
    r = np.asarray(rotation)
    trace = np.trace(r)
    skew = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    products = np.empty((4, 4))
    products[0, 0], products[0, 1:], products[1:, 0] = 1 + trace, skew, skew
    products[1:, 1:] = r + r.T + (1 - trace) * np.eye(3)
    column = products[:, np.argmax(np.diag(products))]
    return column / np.linalg.norm(column)


def _terms(model, name, index):
    """A coefficient, and those of higher degree, which MuJoCo has since 4.0."""
    higher = getattr(model, f"{name}poly")[index] if hasattr(model, f"{name}poly") else []
    return np.append(getattr(model, name)[index], higher)


def _load(name, option, world, sections, options):
    lines = [
        _tag("mujoco", model=name)[:-2] + ">",
        '<compiler angle="radian" autolimits="false" inertiafromgeom="false"/>',
        _tag("option", **option),
        world.text("worldbody"),
        *[line for section, parts in sections.items() for line in (f"<{section}>", *parts, f"</{section}>")],
        "</mujoco>",
    ]
    try:
        return load("\n".join(lines), **{"whole": True, "snap": False, **options})
    except RobotFileError as error:
        # nobody has seen the text in whose lines the carets stand
        said = [line for line in str(error).splitlines() if not re.match(r"\s*(-->|\d* *\|)", line)]
        raise RobotFileError("\n".join(said)) from None
