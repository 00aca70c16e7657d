"""Derivatives of the functions of an arm, by other functions of the arm: for JAX and PyTorch.

`DERIVATIVES[function][argument]` computes the derivative by that argument: an array with the axes of the result, then one
for the elements of the argument. Of a function with several results it is a tuple, with `None` for zeros. It is called
with the `Point` at which the function is computed. Derivatives are made of functions that have derivatives themselves
where this is possible; then there are second derivatives.
"""

import functools

import numpy as np

#: The signs of a cross product: (a × b)[i] is the sum of CROSS[i, j, k] a[j] b[k].
CROSS = np.array([[[(i - j) * (j - k) * (k - i) / 2 for k in range(3)] for j in range(3)] for i in range(3)])


class Point:
    """The arguments of a call, and other functions of the arm there, each computed once.

    `compute` computes a function, by its name, of arguments, by theirs; `arrays` is the package of the arrays.
    """

    def __init__(self, compute, given, arrays, at_tip):
        self.compute, self.given, self.arrays, self.at_tip = compute, given, arrays, at_tip
        self.known = {}

    @property
    def zeros(self):
        return self.arrays.zeros_like(self.given["q"])

    def of(self, name):
        if name not in self.known:
            found = _QUANTITIES.get(name)
            self.known[name] = found(self) if found else self.with_(name)
        return self.known[name]

    def with_(self, name, **others):
        """A function with other arguments in place of some; rates and accelerations that are not given are zero."""
        return self.compute(name, {"qd": self.zeros, "qdd": self.zeros, **self.given, **others})

    def of_weighted_torques(self, multipliers, **others):
        """The derivatives of λᵀτ by q, q̇ and q̈."""
        return self.with_("torque_gradient", multipliers=multipliers, **others)

    def of_each(self, name, **rows):
        """A function for each row of some arguments: a new axis behind the leading ones."""
        given = {"qd": self.zeros, "qdd": self.zeros, **self.given}
        return self.compute(name, {**{argument: array[..., None, :] for argument, array in given.items()}, **rows})

    def units(self):
        """Unit vectors as rows, with the leading axes of one state for all."""
        q = self.given["q"]
        return self.arrays.eye(q.shape[-1], dtype=q.dtype).reshape((1,) * (q.ndim - 1) + (q.shape[-1],) * 2)

    def einsum(self, text, *operands):
        return self.arrays.einsum(text, *operands)

    def crossed(self, text, *operands):
        """A sum of products with CROSS in front."""
        return self.einsum(text, self.arrays.asarray(CROSS, dtype=self.given["q"].dtype), *operands)


def _turned(array):
    return array.swapaxes(-1, -2)


def _part(function, index):
    return lambda at: at.of(function)[index]


def _of_torques(arguments, more="", mass=""):
    """Of a function that returns torques τ(q, q̇, q̈), some of them zeros."""
    derivatives = "inverse_dynamics_derivatives" + more
    rules = {"q": _part(derivatives, 0), "qd": _part(derivatives, 1), "qdd": lambda at: at.of("mass_matrix" + mass)}
    return {name: rules[name] for name in arguments}


def _of_accelerations(more=""):
    derivatives = "forward_dynamics_derivatives" + more
    return {name: _part(derivatives, index) for index, name in enumerate(("q", "qd", "tau"))}


def _of_mass(more=""):
    """Of a mass matrix: column i is what a unit acceleration adds to the torques at rest."""

    def rule(at):
        derivatives, still = "inverse_dynamics_derivatives" + more, at.zeros
        moved = at.of_each(derivatives, qd=still[..., None, :], qdd=at.units())[0]
        return moved - at.with_(derivatives, qd=still, qdd=still)[0][..., None, :, :]

    return {"q": rule}


def _of_inverse_mass(at):
    inverse = at.of("inverse_mass_matrix")
    return -at.einsum("...ia,...abk,...bj->...ijk", inverse, at.of("∂M/∂q"), inverse)


def _of_product_with_inverse_mass(at):
    product = at.of("inverse_mass_matrix_times_torques")
    return -at.einsum("...ia,...abj,...b->...ij", at.of("inverse_mass_matrix"), at.of("∂M/∂q"), product)


def _of_kinetic_energy(at):
    """½ q̇ᵀ ∂M/∂q q̇, from multipliers q̇: of torques at the acceleration ½ q̇ from rest, less those that hold the arm."""
    qd = at.given["qd"]
    moved = at.of_weighted_torques(qd, qd=at.zeros, qdd=qd / 2)[0]
    return moved - at.of_weighted_torques(qd, qd=at.zeros, qdd=at.zeros)[0]


def _of_pose(at):
    """Of a homogeneous matrix: ω × the axes of the frame and the velocity of its origin, for unit velocities of joints."""
    jacobian, rotation = at.of("jacobian"), at.of("pose")[..., :3, :3]
    turned = at.crossed("abc,...bj,...cd->...adj", jacobian[..., 3:, :], rotation)
    moved = at.arrays.concatenate([turned, jacobian[..., :3, None, :]], -2)
    return at.arrays.concatenate([moved, at.arrays.zeros_like(moved[..., :1, :, :])], -3)


def _of_jacobian(at):
    """By a function of the tip. At a frame, ∂Jᵢ/∂qⱼ + ∂Jⱼ/∂qᵢ is in J̇ q̇, and ∂ωᵢ/∂qⱼ - ∂ωⱼ/∂qᵢ is ωⱼ × ωᵢ."""
    if at.at_tip:
        return at.of("jacobian_derivatives")
    units, omega = at.units(), at.of("jacobian")[..., 3:, :]
    n = units.shape[-1]
    pairs = (units[..., :, None, :] + units[..., None, :, :]).reshape((*units.shape[:-2], n * n, n))
    rates = at.of_each("jacobian_rate_times_velocity", qd=pairs)
    rates = rates.reshape((*rates.shape[:-2], n, n, 6)).swapaxes(-1, -3)
    alone = at.einsum("...ii->...i", rates) / 4
    symmetric = (rates - alone[..., :, None] - alone[..., None, :]) / 2
    turned = at.crossed("abc,...bj,...ci->...aij", omega, omega) / 2
    return symmetric + at.arrays.concatenate([at.arrays.zeros_like(turned), turned], -3)


def _wrench(at):
    """Force and moment in world axes, (..., 2, 3), and the rows of the Jacobian by which they act, (..., 2, 3, n)."""
    rotation, wrench, jacobian = at.of("pose")[..., :3, :3], at.given["wrench"], at.of("jacobian")
    turned = at.einsum("...pc,...ac->...ap", rotation, wrench.reshape((*wrench.shape[:-1], 2, 3)))
    return turned, jacobian.reshape((*jacobian.shape[:-2], 2, 3, jacobian.shape[-1]))


def _of_wrench_by_q(at):
    """Of Jᵀ w, where w turns with the axes of the tip."""
    wrench, rows = _wrench(at)
    derivatives = at.of("∂J/∂q")
    derivatives = derivatives.reshape((*derivatives.shape[:-3], *rows.shape[-3:], rows.shape[-1]))
    moved = at.einsum("...apij,...ap->...ij", derivatives, wrench)
    return moved + at.crossed("pbd,...api,...bj,...ad->...ij", rows, rows[..., 1, :, :], wrench)


def _of_wrench(at):
    by_parts = at.einsum("...api,...pc->...iac", _wrench(at)[1], at.of("pose")[..., :3, :3])
    return by_parts.reshape((*by_parts.shape[:-2], 6))


def _of_torque_derivatives():
    rules = {
        "q": lambda by: (by[0], _turned(by[1])),
        "qd": lambda by: (by[1], by[2]),
        "qdd": lambda by: (by[3], None),
    }
    return {name: lambda at, rule=rule: rule(at.of("∂²τ")) for name, rule in rules.items()}


def _of_torque_gradient():
    rules = {
        "q": lambda by: (by[0], _turned(by[1]), _turned(by[3])),
        "qd": lambda by: (by[1], by[2], None),
        "qdd": lambda by: (by[3], None, None),
    }
    rules = {name: lambda at, rule=rule: rule(at.of("torque_hessian")) for name, rule in rules.items()}
    first = "inverse_dynamics_derivatives"
    multipliers = lambda at: (*map(_turned, at.of(first)), at.of("mass_matrix"))  # noqa: E731
    return {**rules, "multipliers": multipliers}


def _acceleration_hessians(at):
    """Second derivatives of accelerations by (q, q̇, τ).

    With the multipliers M⁻¹ eₖ, those of acceleration k are less those of the torques, in which q̈ moves by its first
    derivatives.
    """
    join, (dq, dqd, dtau) = at.arrays.concatenate, at.of("forward_dynamics_derivatives")
    qdd = at.of("forward_dynamics")[..., None, :]
    qq, qv, vv, qa = at.of_each("torque_hessian", qdd=qdd, multipliers=dtau)
    none = at.arrays.zeros_like(vv)
    rows = [[qq, qv, qa], [_turned(qv), vv, none], [_turned(qa), none, none]]
    hessians = join([join(row, -1) for row in rows], -2)
    none = at.arrays.zeros_like(dq)
    same = none + at.units()
    moved = join([join(row, -1) for row in ([same, none, none], [none, same, none], [dq, dqd, dtau])], -2)
    return -at.einsum("...ai,...kab,...bj->...kij", moved, hessians, moved)


def _of_acceleration_derivatives():
    def rule(at, column):
        n = at.zeros.shape[-1]
        part = lambda index: slice(index * n, (index + 1) * n)  # noqa: E731
        return tuple(at.of("∂²q̈")[..., part(row), part(column)] for row in range(3))

    return {name: functools.partial(rule, column=column) for column, name in enumerate(("q", "qd", "tau"))}


#: What several derivatives need, computed once at a point.
_QUANTITIES = {
    "∂²τ": lambda at: at.of_each("torque_hessian", multipliers=at.units()),
    "∂²q̈": _acceleration_hessians,
    "∂M/∂q": _of_mass()["q"],
    "∂J/∂q": _of_jacobian,
}

DERIVATIVES = {
    "inverse_dynamics": _of_torques(["q", "qd", "qdd"]),
    "bias_torques": _of_torques(["q", "qd"]),
    "gravity_torques": _of_torques(["q"]),
    "inverse_dynamics_with_payload": _of_torques(["q", "qd", "qdd"], "_with_payload", "_with_payload"),
    "bias_torques_with_payload": _of_torques(["q", "qd"], "_with_payload"),
    "gravity_torques_with_payload": _of_torques(["q"], "_with_payload"),
    "inverse_dynamics_with_wrenches": _of_torques(["q", "qd", "qdd"], "_with_wrenches"),
    "inverse_dynamics_with_wrench": {
        **_of_torques(["qd", "qdd"]),
        "q": lambda at: at.of("inverse_dynamics_derivatives")[0] + _of_wrench_by_q(at),
        "wrench": _of_wrench,
    },
    "wrench_torques": {"q": _of_wrench_by_q, "wrench": _of_wrench},
    "inverse_dynamics_derivatives": _of_torque_derivatives(),
    "torque_gradient": _of_torque_gradient(),
    "forward_dynamics": _of_accelerations(),
    "forward_dynamics_with_payload": _of_accelerations("_with_payload"),
    "forward_dynamics_with_wrenches": _of_accelerations("_with_wrenches"),
    "forward_dynamics_derivatives": _of_acceleration_derivatives(),
    "mass_matrix": _of_mass(),
    "mass_matrix_with_payload": _of_mass("_with_payload"),
    "inverse_mass_matrix": {"q": _of_inverse_mass},
    "inverse_mass_matrix_times_torques": {
        "q": _of_product_with_inverse_mass,
        "tau": lambda at: at.of("inverse_mass_matrix"),
    },
    "kinetic_energy": {
        "q": _of_kinetic_energy,
        "qd": lambda at: at.einsum("...ij,...j->...i", at.of("mass_matrix"), at.given["qd"]),
    },
    "potential_energy": {"q": lambda at: at.of("gravity_torques")},
    "centre_of_mass": {"q": lambda at: at.of("centre_of_mass_jacobian")},
    "pose": {"q": _of_pose},
    "jacobian": {"q": _of_jacobian},
}


def derivatives(function, argument, at):
    """The derivatives of the results by an argument, one for each; `None` is zero."""
    rule = DERIVATIVES.get(function, {}).get(argument)
    if rule is None:
        raise NotImplementedError(refusal(function, argument))
    found = rule(at)
    return found if isinstance(found, tuple) else (found,)


def refusal(function, argument):
    """Why there is no derivative, in one line."""
    if function in DERIVATIVES:
        remedy = f"but by {', '.join(DERIVATIVES[function])}"
    elif "derivatives" in function or "jacobian" in function:
        remedy = "so what it derives has no second derivatives: take a Gauss-Newton or quasi-Newton method"
    else:
        remedy = f"but these functions have some: {', '.join(DERIVATIVES)}"
    return f"`{function}` has no derivative by `{argument}`, {remedy}"
