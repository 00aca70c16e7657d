"""Derivatives of the functions of an arm, by other functions of the arm: for JAX and PyTorch.

`DERIVATIVES[function][argument]` computes the derivative by that argument: an array with the axes of the result, then one
for the elements of the argument. It is called with `of`, which computes another function of the arm at the same
arguments, zeros where that takes rates or accelerations that are not there; with `given`, the arguments by their names;
and with the package of the arrays. A function that returns several arrays has none here.
"""


def _times(matrix, vector):
    return (matrix @ vector[..., None])[..., 0]


def _of_torques(arguments, payload=""):
    """Of a function that returns torques τ(q, q̇, q̈), some of them zeros."""
    derivatives, mass = "inverse_dynamics_derivatives" + payload, "mass_matrix" + payload
    rules = {
        "q": lambda of, given, arrays: of(derivatives)[0],
        "qd": lambda of, given, arrays: of(derivatives)[1],
        "qdd": lambda of, given, arrays: of(mass),
    }
    return {name: rules[name] for name in arguments}


def _of_pose(of, given, arrays):
    """Of a homogeneous matrix: ω × the axes of the frame and the velocity of its origin, for unit velocities of joints."""
    jacobian, rotation = of("jacobian"), of("pose")[..., :3, :3, None]
    omega = [jacobian[..., 3 + row, None, :] for row in range(3)]
    rows = [rotation[..., row, :, :] for row in range(3)]
    following = [(row + 1) % 3 for row in range(3)]
    turned = [omega[i] * rows[3 - i - k] - omega[3 - i - k] * rows[i] for k, i in enumerate(following)]
    moved = arrays.concatenate([arrays.stack(turned, -3), jacobian[..., :3, None, :]], -2)
    return arrays.concatenate([moved, arrays.zeros_like(moved[..., :1, :, :])], -3)


DERIVATIVES = {
    "inverse_dynamics": _of_torques(["q", "qd", "qdd"]),
    "bias_torques": _of_torques(["q", "qd"]),
    "gravity_torques": _of_torques(["q"]),
    "inverse_dynamics_with_payload": _of_torques(["q", "qd", "qdd"], "_with_payload"),
    "bias_torques_with_payload": _of_torques(["q", "qd"], "_with_payload"),
    "gravity_torques_with_payload": _of_torques(["q"], "_with_payload"),
    "forward_dynamics": {
        "q": lambda of, given, arrays: of("forward_dynamics_derivatives")[0],
        "qd": lambda of, given, arrays: of("forward_dynamics_derivatives")[1],
        "tau": lambda of, given, arrays: of("forward_dynamics_derivatives")[2],
    },
    # ½ q̇ᵀ ∂M/∂q q̇ is C(q, q̇)ᵀ q̇ of Christoffel's C
    "kinetic_energy": {
        "q": lambda of, given, arrays: _times(of("coriolis_matrix").swapaxes(-1, -2), given["qd"]),
        "qd": lambda of, given, arrays: _times(of("mass_matrix"), given["qd"]),
    },
    "potential_energy": {"q": lambda of, given, arrays: of("gravity_torques")},
    "centre_of_mass": {"q": lambda of, given, arrays: of("centre_of_mass_jacobian")},
    "pose": {"q": _of_pose},
}


def refusal(function, argument):
    """Why there is no derivative, in one line."""
    if function in ("inverse_dynamics_derivatives", "forward_dynamics_derivatives", "mass_matrix"):
        remedy = "so torques and accelerations have no second ones: take a Gauss-Newton or quasi-Newton method"
    else:
        remedy = f"but these functions have some: {', '.join(DERIVATIVES)}"
    return f"`{function}` has no derivative by `{argument}`, {remedy}"
