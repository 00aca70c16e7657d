"""Dynamics of robot arms: any Denavit-Hartenberg table or URDF, compiled when it is read."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

Floats = NDArray[np.floating[Any]]
Joints = ArrayLike | Mapping[str, ArrayLike]
Parameters = ArrayLike | Mapping[str, ArrayLike] | None
Form = Literal["reduced", "seven_steps"]
Convention = Literal["standard", "modified"]

class RobotFileError(ValueError):
    """A robot file, a plan or a URDF is wrong."""

    file: str
    line: int | None
    column: int | None

class RobotFileWarning(UserWarning):
    """A robot file or a URDF is valid, but its numbers are probably not those of the arm."""

class EvaluationError(ValueError):
    """A function cannot be computed for this arm or these arguments."""

class BaseParameter(TypedDict):
    name: str
    value: float
    combination: dict[str, float]
    visible: bool

class Change(TypedDict):
    line: int
    column: int
    old: str
    new: str

class Candidate(TypedDict):
    name: str
    mistake: str
    failed: list[str]
    complete: bool
    changes: list[Change]

class Finding(TypedDict):
    link: str
    line: int
    column: int
    failed: list[str]
    equal: int
    candidates: list[Candidate]

class Diagnosis(TypedDict):
    agrees: bool
    error: float
    explanations: list[list[str]]
    nearest: tuple[str, float] | None

class Arm:
    """An arm whose functions are compiled when they are first called.

    Arguments have the shape (n,) for one state or (N, n) for many, a single row standing for all. Arguments with a
    number per joint may be dicts of joint name → number or array (N,).
    """

    @property
    def name(self) -> str: ...
    @property
    def dof(self) -> int: ...
    @property
    def floating(self) -> bool: ...
    @property
    def joints(self) -> list[str]: ...
    @property
    def followers(self) -> dict[str, tuple[dict[str, float], float]]: ...
    @property
    def tips(self) -> list[str]: ...
    @property
    def convention(self) -> Convention: ...
    @property
    def gravity(self) -> list[float]: ...
    @property
    def form(self) -> Form: ...
    @property
    def limits(self) -> Floats: ...
    @property
    def velocity_limits(self) -> Floats: ...
    @property
    def effort_limits(self) -> Floats: ...
    @property
    def yaml(self) -> str: ...
    @property
    def frames(self) -> list[str]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def held(self) -> dict[str, float]: ...
    @property
    def parameters(self) -> list[str]: ...
    def order(self, names: Iterable[str], extra: bool = ...) -> NDArray[np.intp]:
        """The place of each joint of the arm in a list of joint names of another program, an integer array of shape (n,)."""
    # <!-- begin: stubs, of the list of functions; written by: RNE_WRITE_DOCUMENTS=1 cargo test --test documents -->
    def inverse_dynamics(
        self, q: Joints, qd: Joints, qdd: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques for positions `q`, velocities `qd` and accelerations `qdd`, with a free tip."""
    def inverse_dynamics_with_wrench(
        self, q: Joints, qd: Joints, qdd: Joints, wrench: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques when the last link exerts a force and a moment on its environment, at the tip, in tip axes."""
    def inverse_dynamics_with_payload(
        self, q: Joints, qd: Joints, qdd: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques when a payload is fixed to the tip: its mass, centre of mass and inertia, in tip axes."""
    def inverse_dynamics_from_sin_cos(
        self, sin: Joints, cos: Joints, q: Joints, qd: Joints, qdd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques from the sines and cosines of the joint positions; `q` is used for prismatic joints alone."""
    def gravity_torques(
        self, q: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques that hold the arm still against gravity, τ(q, 0, 0)."""
    def bias_torques(
        self, q: Joints, qd: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Coriolis, centrifugal and gravity torques, τ(q, q̇, 0)."""
    def mass_matrix(
        self, q: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The mass matrix M(q), symmetric: column j holds the torques for q̈ = e_j of an arm at rest."""
    def coriolis_matrix(
        self, q: Joints, qd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The Coriolis matrix C(q, q̇) of Christoffel: Ṁ - 2C is skew, and C = ½ ∂(bias torques)/∂q̇."""
    def forward_dynamics(
        self, q: Joints, qd: Joints, tau: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Accelerations for positions `q`, velocities `qd` and torques `tau`, with a free tip."""
    def forward_kinematics(
        self, q: Joints, *,
        frame: str | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The tip in the world, base and tool included."""
    def pose(
        self, q: Joints, *,
        frame: str | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The tip in the world, base and tool included."""
    def link_poses(
        self, q: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The frame of every row of the table in the world."""
    def jacobian(
        self, q: Joints, *,
        frame: str | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The geometric Jacobian of the tip in world axes: three linear rows, then three angular ones."""
    def jacobian_rate_times_velocity(
        self, q: Joints, qd: Joints, *,
        frame: str | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """J̇ q̇: the acceleration of the tip in world axes when q̈ = 0, linear, then angular."""
    def kinetic_energy(
        self, q: Joints, qd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats | float:
        """Kinetic energy, J."""
    def potential_energy(
        self, q: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats | float:
        """Potential energy in gravity, J; zero where a mass is at the origin of frame 0."""
    def centre_of_mass(
        self, q: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The centre of mass of all links in the world, base included."""
    def centre_of_mass_jacobian(
        self, q: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The Jacobian of the centre of mass in world axes: its velocity per joint velocity."""
    def regressor(
        self, q: Joints, qd: Joints, qdd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques per inertial parameter: joint, link, (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz)."""
    def inverse_dynamics_derivatives(
        self, q: Joints, qd: Joints, qdd: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics`; row i is torque i."""
    def joint_wrenches(
        self, q: Joints, qd: Joints, qdd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Force and moment that link i-1 exerts on link i, at joint i, in axes fixed to link i."""
    def momentum_and_rate(
        self, q: Joints, qd: Joints, tau: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """The momentum of the joints, M(q) q̇, and the rate it would have without external torques."""
    def inverse_dynamics_on_moving_base(
        self, q: Joints, qd: Joints, qdd: Joints, *,
        base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques on a base with a given motion, under a given gravity, with a free tip."""
    def actuator_torques(
        self, qd: Joints, qdd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques of rotors behind gears and of friction, beside those of the links."""
    def inverse_mass_matrix(
        self, q: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The inverse of the mass matrix, M(q)⁻¹, symmetric: column j holds the accelerations for τ = e_j."""
    def gravity_torques_with_payload(
        self, q: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques that hold the arm and a payload at its tip still against gravity."""
    def bias_torques_with_payload(
        self, q: Joints, qd: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Coriolis, centrifugal and gravity torques of the arm with a payload at its tip."""
    def mass_matrix_with_payload(
        self, q: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The mass matrix of the arm with a payload at its tip, symmetric."""
    def forward_dynamics_with_payload(
        self, q: Joints, qd: Joints, tau: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Accelerations for positions `q`, velocities `qd` and torques `tau` with a payload at the tip."""
    def inverse_dynamics_derivatives_with_payload(
        self, q: Joints, qd: Joints, qdd: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_payload`; row i is torque i."""
    def momentum_and_rate_with_payload(
        self, q: Joints, qd: Joints, tau: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """The momentum of the joints with a payload at the tip, and its rate without external torques."""
    def wrench_torques(
        self, q: Joints, wrench: ArrayLike, *,
        frame: str | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques Jᵀ w of a force and a moment that the last link exerts at the tip, in tip axes."""
    def inverse_dynamics_with_wrenches(
        self, q: Joints, qd: Joints, qdd: Joints, wrenches: ArrayLike | dict[str, ArrayLike], *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques when the robot exerts a force and a moment at each of its tips, in axes of the tip."""
    def forward_dynamics_with_wrenches(
        self, q: Joints, qd: Joints, tau: Joints, wrenches: ArrayLike | dict[str, ArrayLike], *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Accelerations for positions `q`, velocities `qd`, torques `tau` and a wrench at each tip."""
    def inverse_dynamics_of_floating_base(
        self, q: Joints, qd: Joints, qdd: Joints, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Torques of a robot with a floating base, and the wrench that must act on the base, for a given motion."""
    def floating_mass_matrix(
        self, q: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The mass matrix of a robot with a floating base, symmetric: six rows of the base, then the joints."""
    def floating_bias(
        self, q: Joints, qd: Joints, omega: ArrayLike, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Wrench on a floating base and torques, for zero accelerations: velocity products and tips."""
    def floating_forward_dynamics(
        self, q: Joints, qd: Joints, tau: Joints, omega: ArrayLike, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Accelerations of a floating base and of the joints for torques `tau`."""
    def centroidal_momentum_matrix(
        self, q: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The matrix A of a robot with a floating base: A v is its momentum about its centre of mass."""
    def centroidal_bias(
        self, q: Joints, qd: Joints, omega: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The rate of the momentum about the centre of mass when all accelerations are zero."""
    def floating_regressor(
        self, q: Joints, qd: Joints, qdd: Joints, *,
        base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Wrench on a floating base and torques per inertial parameter of the base and of each link."""
    def floating_kinetic_energy(
        self, q: Joints, qd: Joints, twist: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats | float:
        """Kinetic energy of a robot with a floating base, J."""
    def floating_potential_energy(
        self, q: Joints, pose: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats | float:
        """Potential energy of such a robot in gravity, J; zero where a mass is at the origin of the world."""
    def centroidal_momentum(
        self, q: Joints, qd: Joints, twist: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The momentum of a robot with a floating base, and its angular momentum about the centre of mass."""
    def tip_jacobians(
        self, q: Joints, base_rotation: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The Jacobian of each tip of a robot with a floating base, in world axes: linear rows, then angular."""
    def tip_accelerations(
        self, q: Joints, qd: Joints, omega: ArrayLike, base_rotation: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """J̇ v: accelerations of the tips where base and joints do not accelerate, in world axes, for a floating base."""
    def forward_dynamics_in_contact(
        self, q: Joints, qd: Joints, tau: Joints, omega: ArrayLike, base_rotation: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats]:
        """Accelerations of a robot on a floating base while its contacts hold tips, and the wrenches of these."""
    def floating_inverse_dynamics_derivatives(
        self, q: Joints, qd: Joints, qdd: Joints, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats]:
        """Derivatives of `inverse_dynamics_of_floating_base` by q, by q̇ and by the angular velocity of the base."""
    def closure_step(
        self, q: Joints, passive: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """One Newton step towards closed loops: better positions of the dependent joints, and what is left."""
    def loop_map(
        self, q: Joints, passive: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The matrix G of closed loops: the velocities of the dependent joints are G q̇."""
    def loop_map_rate_times_velocity(
        self, q: Joints, passive: Joints, qd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Accelerations of the dependent joints of closed loops where the others do not accelerate: Ġ q̇."""
    def inverse_dynamics_of_loops(
        self, q: Joints, passive: Joints, qd: Joints, qdd: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques of a robot with closed loops, of the joints that move by themselves."""
    def inverse_dynamics_of_loops_with_wrenches(
        self, q: Joints, passive: Joints, qd: Joints, qdd: Joints, wrenches: ArrayLike | dict[str, ArrayLike], *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques of a robot with closed loops when it exerts a force and a moment at each tip."""
    def mass_matrix_of_loops(
        self, q: Joints, passive: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The mass matrix of a robot with closed loops, of the joints that move by themselves: symmetric."""
    def forward_dynamics_of_loops(
        self, q: Joints, passive: Joints, qd: Joints, tau: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Accelerations of a robot with closed loops for torques `tau` of the joints that move by themselves."""
    def inverse_dynamics_of_floating_loops(
        self, q: Joints, passive: Joints, qd: Joints, qdd: Joints, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Torques of a robot with closed loops and a floating base, and the wrench on the base."""
    def floating_mass_matrix_of_loops(
        self, q: Joints, passive: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The mass matrix of a robot with closed loops and a floating base: six rows, then the joints."""
    def floating_forward_dynamics_of_loops(
        self, q: Joints, passive: Joints, qd: Joints, tau: Joints, omega: ArrayLike, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Accelerations of the base and of the joints of a robot with closed loops and a floating base."""
    def torque_gradient(
        self, q: Joints, qd: Joints, qdd: Joints, multipliers: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats]:
        """The gradient of λᵀτ: of the torques of `inverse_dynamics`, each times its multiplier λ and added up."""
    def forward_dynamics_derivatives(
        self, q: Joints, qd: Joints, tau: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats]:
        """∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂τ of `forward_dynamics`; row i is acceleration i."""
    def inverse_mass_matrix_times_torques(
        self, q: Joints, tau: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """M(q)⁻¹ τ: the accelerations that torques add, in fewer operations than the inverse has."""
    def inverse_dynamics_derivatives_with_wrenches(
        self, q: Joints, qd: Joints, qdd: Joints, wrenches: ArrayLike | dict[str, ArrayLike], *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_wrenches`; row i is torque i."""
    def forward_dynamics_derivatives_with_wrenches(
        self, q: Joints, qd: Joints, tau: Joints, wrenches: ArrayLike | dict[str, ArrayLike], *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats]:
        """∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂τ of `forward_dynamics_with_wrenches`; row i is acceleration i."""
    def forward_dynamics_derivatives_with_payload(
        self, q: Joints, qd: Joints, tau: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats]:
        """∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂τ of `forward_dynamics_with_payload`; row i is acceleration i."""
    def jacobian_rate(
        self, q: Joints, qd: Joints, *,
        frame: str | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The rate J̇ of the geometric Jacobian at velocities `qd`, in world axes."""
    def jacobian_derivatives(
        self, q: Joints, *,
        frame: str | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """∂J/∂q: the derivatives of the geometric Jacobian by the positions, in world axes."""
    def torque_hessian(
        self, q: Joints, qd: Joints, qdd: Joints, multipliers: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """The Hessian of λᵀτ: of the torques of `inverse_dynamics`, each times its multiplier λ and added up."""
    def euler_step(
        self, q: Joints, qd: Joints, tau: Joints, step: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """A step of the semi-implicit Euler method under torques `tau`: positions and velocities after it."""
    def euler_step_derivatives(
        self, q: Joints, qd: Joints, tau: Joints, step: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Derivatives of `euler_step` by q, by q̇ and by τ: the linear model of a step."""
    def floating_euler_step(
        self, q: Joints, qd: Joints, tau: Joints, pose: ArrayLike, twist: ArrayLike, step: ArrayLike, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """A step of the semi-implicit Euler method with a floating base: the state after it."""
    def floating_euler_step_derivatives(
        self, q: Joints, qd: Joints, tau: Joints, pose: ArrayLike, twist: ArrayLike, step: ArrayLike, wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Derivatives of `floating_euler_step` by positions, velocities and τ: the linear model of a step."""
    def coriolis_torques(
        self, q: Joints, qd: Joints, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Coriolis and centrifugal torques, C(q, q̇) q̇: the bias torques without gravity."""
    def floating_inverse_dynamics_with_payload(
        self, q: Joints, qd: Joints, qdd: Joints, payload: ArrayLike, *,
        base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Torques, and the wrench on a floating base, when a payload is fixed to the tip."""
    def floating_mass_matrix_with_payload(
        self, q: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The mass matrix of a robot with a floating base and a payload at its tip: six rows, then the joints."""
    def floating_bias_torques_with_payload(
        self, q: Joints, qd: Joints, omega: ArrayLike, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Force and moment on a floating base and torques where nothing accelerates, with a payload at the tip."""
    def floating_forward_dynamics_with_payload(
        self, q: Joints, qd: Joints, tau: Joints, omega: ArrayLike, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """Accelerations of a floating base and of the joints for torques `tau`, with a payload at the tip."""
    def gravity_torques_of_loops(
        self, q: Joints, passive: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques that hold a robot with closed loops still against gravity, of the joints that move by themselves."""
    def bias_torques_of_loops(
        self, q: Joints, passive: Joints, qd: Joints, *,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Coriolis, centrifugal and gravity torques of a robot with closed loops: its torques at q̈ = 0."""
    def inverse_dynamics_of_loops_with_payload(
        self, q: Joints, passive: Joints, qd: Joints, qdd: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques of a robot with closed loops when a payload is fixed to the tip."""
    def gravity_torques_of_loops_with_payload(
        self, q: Joints, passive: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Torques that hold a robot with closed loops and a payload at its tip still against gravity."""
    def bias_torques_of_loops_with_payload(
        self, q: Joints, passive: Joints, qd: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Coriolis, centrifugal and gravity torques of a robot with closed loops and a payload at its tip."""
    def mass_matrix_of_loops_with_payload(
        self, q: Joints, passive: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The mass matrix of a robot with closed loops and a payload at its tip: symmetric."""
    def forward_dynamics_of_loops_with_payload(
        self, q: Joints, passive: Joints, qd: Joints, tau: Joints, payload: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Accelerations of a robot with closed loops and a payload at its tip for torques `tau`."""
    def floating_gravity_torques(
        self, q: Joints, base_rotation: ArrayLike, *,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """Wrench on a floating base and torques that hold a robot still against gravity."""
    # <!-- end -->
    def runge_kutta_step(
        self, q: Joints, qd: Joints, tau: Joints, step: ArrayLike, *, steps: int = ...,
        payload: ArrayLike | None = ..., parameters: Parameters = ...,
    ) -> tuple[Floats, Floats]:
        """The state after steps of the classical Runge-Kutta method of duration `step` (s) under torques `tau`."""
    def runge_kutta_step_derivatives(
        self, q: Joints, qd: Joints, tau: Joints, step: ArrayLike, *, steps: int = ...,
        payload: ArrayLike | None = ..., parameters: Parameters = ...,
    ) -> tuple[Floats, Floats]:
        """Derivatives of `runge_kutta_step` by q, by q̇ and by τ: the linear model δx' = A δx + B δτ with x = (q, q̇)."""
    def floating_runge_kutta_step(
        self, q: Joints, qd: Joints, tau: Joints, pose: ArrayLike, twist: ArrayLike, step: ArrayLike,
        wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *, steps: int = ..., parameters: Parameters = ...,
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """The state after steps of the classical Runge-Kutta method with a floating base."""
    def floating_runge_kutta_step_derivatives(
        self, q: Joints, qd: Joints, tau: Joints, pose: ArrayLike, twist: ArrayLike, step: ArrayLike,
        wrenches: ArrayLike | dict[str, ArrayLike] | None = ..., *, steps: int = ..., parameters: Parameters = ...,
    ) -> tuple[Floats, Floats]:
        """Derivatives of `floating_runge_kutta_step` by positions, velocities and τ: the linear model of its steps."""
    def friction_torques(self, qd: Joints, *, width: float | None = ...) -> Floats:
        """Friction of the joints at velocities: viscous, and Coulomb's with a smooth change of sign."""
    def friction_derivatives(self, qd: Joints, *, width: float | None = ...) -> Floats:
        """Derivatives of `friction_torques`: of the friction of each joint by its velocity."""
    @property
    def passive_joints(self) -> list[str]:
        """The names of the dependent joints of closed loops, in the order of `passive`."""
    @property
    def closures(self) -> list[tuple[list[float], list[float]]]:
        """Positions at which the closed loops are closed: a list of pairs of `q` and `passive`, found when the file was read."""
    def close(self, q: Joints, guess: Joints, *, parameters: Parameters = ...) -> tuple[Floats, Floats]:
        """Closes the loops of a robot from a guess: five steps of Newton's method."""
    def rollout(
        self, q: Joints, qd: Joints, tau: Joints, step: float, *,
        friction: bool | float | None = ..., limits: bool | str | Sequence[str] | None = ...,
        payload: ArrayLike | None = ..., parameters: Parameters = ..., out: Floats | None = ...,
    ) -> tuple[Floats, Floats]:
        """States of N samples after each of T steps under torques, by semi-implicit Euler."""
    def pose_error(
        self, q: ArrayLike, target: ArrayLike, *, frame: str | None = ..., parameters: Parameters = ...,
    ) -> Floats:
        """How far the tip or a frame is from a target pose, in world axes."""
    def operational_space_inertia(
        self, q: Joints, *,
        frame: str | None = ..., rows: Sequence[int] | None = ..., payload: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The operational-space inertia (J M⁻¹ Jᵀ)⁻¹ at the tip or at a frame, symmetric (Khatib, 1987)."""
    def dynamically_consistent_inverse(
        self, q: Joints, *,
        frame: str | None = ..., rows: Sequence[int] | None = ..., payload: ArrayLike | None = ...,
        parameters: Parameters = ..., out: Floats | None = ...,
    ) -> Floats:
        """The dynamically consistent inverse M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ of the Jacobian at the tip or at a frame (Khatib, 1987)."""
    def inertial_parameters(self) -> Floats: ...
    def floating_inertial_parameters(self) -> Floats: ...
    def base_parameters(self) -> list[BaseParameter]: ...
    def operations(self, function: str = ..., form: Form | None = ...) -> dict[str, int]: ...
    def show(self, function: str = ..., *, joint: int | None = ..., form: Form = ...) -> str: ...
    def code(
        self, language: Literal["c", "rust"] = ..., functions: Sequence[str] = ..., *, form: Form | None = ...,
        precision: Literal["double", "single"] = ..., casadi: bool = ...,
        order: Literal["formulas", "registers"] = ...,
    ) -> str: ...
    def casadi(self, function: str = ...) -> Any:
        """A function as a `casadi.Function`, with its derivatives for optimisers such as IPOPT."""
    def jax(self, *, frame: str | None = ...) -> Any:
        """Functions of this arm for JAX: `jit`, `vmap`, `grad`, `jacfwd` and `jacrev` of them work, on the CPU."""
    def torch(self, *, frame: str | None = ...) -> Any:
        """Functions of this arm for PyTorch, with derivatives in reverse mode, on the CPU."""
    def gpu(self, device: int = ...) -> Any:
        """Functions of this arm on a graphics card of NVIDIA, for arrays of PyTorch, CuPy and JAX that are on it."""
    def diagnose(
        self, q: Sequence[float], qd: Sequence[float], qdd: Sequence[float], tau: Sequence[float], *,
        tolerance: float | None = ...,
    ) -> Diagnosis: ...
    def search(
        self, seconds: float = ..., *, functions: Sequence[str] = ..., seed: int = ...,
        progress: Callable[[float, int], object] | None = ...,
    ) -> Arm: ...
    def report(self) -> str: ...
    def _repr_html_(self) -> str: ...

class _Robots:
    def __getattr__(self, name: str) -> Arm: ...
    def __getitem__(self, name: str) -> Arm: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def __contains__(self, name: object) -> bool: ...

robots: _Robots

def load(
    source: str | PathLike[str],
    *,
    tip: str | Sequence[str] | None = ...,
    base: str | None = ...,
    whole: bool = ...,
    floating: bool | None = ...,
    lock: Mapping[str, float] | None = ...,
    lock_others: bool = ...,
    convention: Convention | None = ...,
    snap: bool = ...,
    keep_unphysical: bool = ...,
    run_time: Sequence[str] = ...,
    settings: Mapping[str, float] | None = ...,
    form: Form = ...,
    rotors: bool | None = ...,
) -> Arm:
    """Return the arm of a robot file (YAML), a URDF, an MJCF file, the text of one, or of a built-in robot."""

def repair(source: str | PathLike[str]) -> list[Finding]:
    """Propose repairs of the links of a robot file, a URDF or an MJCF file that cannot exist, or that are improbable."""

def base_from_imu(
    gyroscope: ArrayLike, gyroscope_rate: ArrayLike, accelerometer: ArrayLike, *,
    rotation: ArrayLike | None = ..., position: ArrayLike = ...,
) -> dict[str, Floats]:
    """The base whose inertial measurement unit reads these values."""
def base_from_pinocchio(
    q: ArrayLike, v: ArrayLike, a: ArrayLike, model: Any = ..., *, gravity: ArrayLike | None = ...,
) -> dict[str, Floats]:
    """The base of a Pinocchio model: what a free flyer moves that carries all other joints."""
def base_from_mujoco(
    qpos: ArrayLike, qvel: ArrayLike, qacc: ArrayLike, model: Any = ..., *, gravity: ArrayLike | None = ...,
) -> dict[str, Floats]:
    """The base of a MuJoCo model: the body with a free joint that carries all other joints."""
def derivatives_to_pinocchio(
    derivatives: Sequence[ArrayLike], mass: ArrayLike, q: ArrayLike, v: ArrayLike, model: Any = ..., *,
    gravity: ArrayLike | None = ...,
) -> tuple[Floats, Floats]:
    """The matrices ∂τ/∂q and ∂τ/∂v of Pinocchio's derivatives of `rnea` with a free flyer."""

def from_mujoco(model: Any, **options: Any) -> Arm:
    """The arm of a compiled MuJoCo model, an `mujoco.MjModel`."""

def from_pinocchio(model: Any, **options: Any) -> Arm:
    """The arm of a Pinocchio model, a `pinocchio.Model`."""

def pose_log(pose: ArrayLike) -> Floats:
    """The logarithm of a pose: the constant twist that leads from the world to it in one unit of time."""
def payload(mass: float, com: ArrayLike = ..., inertia: ArrayLike | None = ...) -> Floats:
    """The argument `payload` of the functions of an `Arm`, shape (10,)."""

Path = str | PathLike[str]
Source = Any
"""A path, a dict of columns, a DataFrame of pandas or Polars, a Table of PyArrow, or a list of these."""
Table = list[dict[str, Any]]

class Log:
    """What a log has, and its motion behind a filter without delay."""

    summary: dict[str, Any]
    @property
    def joints(self) -> list[str]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def time(self) -> Floats: ...
    @property
    def run(self) -> NDArray[np.uint64]: ...
    @property
    def q(self) -> Floats: ...
    @property
    def qd(self) -> Floats: ...
    @property
    def qdd(self) -> Floats: ...
    @property
    def tau(self) -> Floats | None: ...
    def columns(self) -> dict[str, NDArray[Any]]: ...
    def to_pandas(self) -> Any: ...
    def to_polars(self) -> Any: ...

class Verdict:
    """Which joints a model predicts, and what the logs do not determine."""

    lines: list[str]
    errors_on: Literal["fitted", "held_out"]
    limit: float
    predicted: list[str]
    not_predicted: list[str]
    base_parameters: int
    excited_base_parameters: int
    not_excited_base_parameters: list[str]
    frictions: int
    excited_frictions: int
    not_excited_friction: list[str]
    not_excited_offset: list[str]

class Identification:
    """A model that was identified from logs."""

    verdict: Verdict
    joints: Table
    parameters: Table
    friction: Table
    errors: Table
    robot_file: str | None
    arm: Arm | None
    logs: list[str]
    robot: str
    delay: dict[str, Any] | None
    cutoff: float
    held_out: dict[str, Any] | None
    states: int
    duration: float
    notes: list[str]
    def save(self, path: Path) -> None: ...
    def _repr_svg_(self) -> str: ...

class IdentifiedPayload:
    """The rigid body that the last link carries beyond what the robot file has."""

    found: bool
    payload: Floats | None
    mass: dict[str, Any]
    com: list[dict[str, Any]]
    inertia: list[dict[str, Any]]
    joints: Table
    robot_file: str | None
    arm: Arm | None
    delay: float
    cutoff: float
    states: int
    duration: float
    logs: list[str]
    robot: str
    notes: list[str]
    def save(self, path: Path) -> None: ...

class Baseline:
    """What quiet logs say of an arm, saved once and used for every later log."""

    text: str
    def __init__(self, text: str, name: str = ...) -> None: ...
    @classmethod
    def read(cls, path: Path) -> Baseline: ...
    def save(self, path: Path) -> None: ...

class Watch:
    """Result of `rne.watch`: the changes that were found in logs."""

    robot: str
    compared_with: str
    events: Table
    parameters: Table
    joints: Table
    trend: Table | None
    csv: str | None
    left_out: dict[str, str]
    baseline: Baseline | None
    notes: list[str]
    def _repr_svg_(self) -> str: ...

class Excitation:
    """A motion from rest to rest, sampled."""

    time: Floats
    q: Floats
    qd: Floats
    qdd: Floats
    condition: float
    first_condition: float
    evaluations: int
    joints: Table
    parameters: Table
    def columns(self) -> dict[str, NDArray[Any]]: ...
    def to_pandas(self) -> Any: ...
    def to_polars(self) -> Any: ...

def log(
    paths: Source,
    robot: Arm | Path | None = ...,
    *,
    joints: Sequence[str] | None = ...,
    topic: str | None = ...,
    torque_constants: ArrayLike | None = ...,
    angles: Literal["degrees", "radians"] | None = ...,
    cutoff: float | None = ...,
    gap: float = ...,
    derive_velocities: bool = ...,
    recorded: bool = ...,
    time_unit: Literal["s", "ms", "us", "ns"] | None = ...,
    rate: float | None = ...,
    columns: Sequence[str] | None = ...,
    map: Mapping[str, str] | None = ...,
    where: Mapping[str, str] | None = ...,
) -> Log:
    """What a log of an arm has, and its filtered motion."""

def identify(
    robot: Arm | Path,
    paths: Source,
    *,
    hold_out: float | None = ...,
    rotors: bool = ...,
    friction: bool = ...,
    regularization: float = ...,
    joints: Sequence[str] | None = ...,
    topic: str | None = ...,
    torque_constants: ArrayLike | None = ...,
    angles: Literal["degrees", "radians"] | None = ...,
    cutoff: float | None = ...,
    gap: float = ...,
    derive_velocities: bool = ...,
    recorded: bool = ...,
    time_unit: Literal["s", "ms", "us", "ns"] | None = ...,
    rate: float | None = ...,
    columns: Sequence[str] | None = ...,
    map: Mapping[str, str] | None = ...,
    where: Mapping[str, str] | None = ...,
) -> Identification:
    """Identify links and friction of an arm from its logs."""

def identify_payload(
    robot: Arm | Path,
    paths: Source,
    *,
    joints: Sequence[str] | None = ...,
    topic: str | None = ...,
    torque_constants: ArrayLike | None = ...,
    angles: Literal["degrees", "radians"] | None = ...,
    cutoff: float | None = ...,
    gap: float = ...,
    derive_velocities: bool = ...,
    recorded: bool = ...,
    time_unit: Literal["s", "ms", "us", "ns"] | None = ...,
    rate: float | None = ...,
    columns: Sequence[str] | None = ...,
    map: Mapping[str, str] | None = ...,
    where: Mapping[str, str] | None = ...,
) -> IdentifiedPayload:
    """Identify what the last link carries in addition, such as a tool or a load."""

def watch(
    robot: Arm | Path,
    paths: Source,
    quiet: Source | None = ...,
    baseline: Baseline | Path | None = ...,
    *,
    by: Literal["log", "day"] | None = ...,
    gain: float = ...,
    hold: float = ...,
    false_alarms: float = ...,
    joints: Sequence[str] | None = ...,
    topic: str | None = ...,
    torque_constants: ArrayLike | None = ...,
    angles: Literal["degrees", "radians"] | None = ...,
    cutoff: float | None = ...,
    gap: float = ...,
    derive_velocities: bool = ...,
    recorded: bool = ...,
    time_unit: Literal["s", "ms", "us", "ns"] | None = ...,
    rate: float | None = ...,
    columns: Sequence[str] | None = ...,
    map: Mapping[str, str] | None = ...,
    where: Mapping[str, str] | None = ...,
) -> Watch:
    """Find changes of an arm in its logs: friction, payload, contacts."""

def excite(
    robot: Arm | Path,
    *,
    seconds: float = ...,
    periods: int = ...,
    harmonics: int = ...,
    range: ArrayLike | None = ...,
    velocity: ArrayLike | None = ...,
    acceleration: ArrayLike | None = ...,
    friction: bool = ...,
    rotors: bool = ...,
    evaluations: int = ...,
    seed: int = ...,
    rate: float = ...,
) -> Excitation:
    """Find a motion that excites the parameters of an arm; Ctrl-C ends the search and keeps the best."""
