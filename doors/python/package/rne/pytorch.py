"""Functions of an arm for PyTorch, computed by the machine, with derivatives: `Arm.torch`."""

import functools
import math
import types

import numpy as np

from .derivatives import Point, derivatives
from .names import of_content
from .signatures import of_arm, title

#: The arms that operators name; a compiled graph of PyTorch can call them at any time.
_ARMS = {}

#: Torques, whose backward pass is one call of `torque_gradient`.
_TORQUES = ("inverse_dynamics", "bias_torques", "gravity_torques")


def functions(arm, frame):
    """The functions of an arm, of the tip or of a frame."""
    try:
        import torch
    except ImportError as error:
        raise ImportError("`Arm.torch` needs the package torch, 2.4 or later: pip install torch") from error
    if not hasattr(torch.library, "custom_op"):
        raise ImportError(f"`Arm.torch` needs the package torch, 2.4 or later, but {torch.__version__} is installed")
    calls = {method: _call(function) for method, function in _of_arm(arm, frame).items()}
    return Functions(title(arm, frame), calls)


def _of_arm(arm, frame):
    name = of_content(arm, frame)
    if name not in _ARMS:
        # those that have none at a frame are those of the tip, with its derivatives
        tip = {} if frame is None else _of_arm(arm, None)
        _ARMS[name] = {**tip, **{one.name: _Function(arm, name, frame, one) for one in of_arm(arm, frame)}}
    return _ARMS[name]


class Functions(types.SimpleNamespace):
    """The functions of an arm for PyTorch, as attributes: `inverse_dynamics(q, qd, qdd)` and so on."""

    def __init__(self, title, calls):
        super().__init__(**calls)
        self._title = title

    def __repr__(self):
        return f"<functions of {self._title} for PyTorch>"


class _Function:
    """A function of an arm, or of an arm at a frame."""

    def __init__(self, arm, name, frame, signature):
        self.method, self.arm, self.frame, self.signature = getattr(arm, signature.name), name, frame, signature
        self.shapes, self.results = signature.shapes, [shape for shape, _ in signature.results]

    def leading(self, arguments):
        import torch

        axes = [one.shape[: one.dim() - len(shape)] for one, shape in zip(arguments, self.shapes.values())]
        return torch.broadcast_shapes(*axes)

    def computed(self, arguments):
        import torch

        leading, rows = self.leading(arguments), {}
        for (name, shape), one in zip(self.shapes.items(), arguments):
            axes = one.shape[: one.dim() - len(shape)]
            # one row is that of all states
            one = one.detach() if math.prod(axes) == 1 else one.detach().expand(*leading, *shape)
            rows[name] = one.reshape(-1, *shape).numpy()
        if math.prod(leading) == 0:
            return [arguments[0].new_zeros((*leading, *shape)) for shape in self.results]
        found = self.method(**rows, **({} if self.frame is None else {"frame": self.frame}))
        found = found if isinstance(found, tuple) else (found,)
        # parts are views of one array, and results of an operator share no memory
        parts = [np.array(part, copy=True) for part in found] if len(found) > 1 else map(np.asarray, found)
        return [torch.from_numpy(part).reshape((*leading, *shape)) for part, shape in zip(parts, self.results)]


@functools.cache
def _operator():
    """The operator of all functions of all arms; text tells which."""
    import torch

    def computed(arguments, arm, function):
        return _ARMS[arm][function].computed(arguments)

    schema = "(Tensor[] arguments, str arm, str function) -> Tensor[]"
    operator = torch.library.custom_op("rne::compute", computed, mutates_args=(), device_types="cpu", schema=schema)

    @operator.register_fake
    def _(arguments, arm, function):
        one = _ARMS[arm][function]
        leading = one.leading(arguments)
        return [arguments[0].new_empty((*leading, *shape)) for shape in one.results]

    def setup(ctx, inputs, output):
        arguments, ctx.arm, ctx.function = inputs
        ctx.save_for_backward(*arguments)

    def backward(ctx, gradients):
        given = dict(zip(_ARMS[ctx.arm][ctx.function].shapes, ctx.saved_tensors))
        wanted = {name: wants for name, wants in zip(given, ctx.needs_input_grad[0]) if wants}
        found = _gradients(_ARMS[ctx.arm][ctx.function], given, wanted, gradients)
        return [found.get(name) for name in given], None, None

    operator.register_autograd(backward, setup_context=setup)
    if hasattr(operator, "register_vmap"):

        @operator.register_vmap
        def _(info, dimensions, arguments, arm, function):
            pairs = zip(arguments, dimensions[0])
            moved = [one.unsqueeze(0) if axis is None else one.movedim(axis, 0) for one, axis in pairs]
            results = operator(moved, arm, function)
            return results, [0] * len(results)

    return operator


def _gradients(one, given, wanted, gradients):
    """The products of the multipliers of the results and their derivatives, by the arguments that are wanted."""
    import torch

    def compute(name, arguments):
        other = _ARMS[one.arm][name]
        results = _operator()([arguments[argument] for argument in other.shapes], other.arm, name)
        return results[0] if len(results) == 1 else tuple(results)

    point = Point(compute, given, torch, one.frame is None)
    name, found = one.signature.name, {}
    if name in _TORQUES and wanted.keys() <= {"q", "qd", "qdd"}:
        product = point.of_weighted_torques(gradients[0])
        return {argument: product[at].sum_to_size(given[argument].shape)
                for at, argument in enumerate(("q", "qd", "qdd")) if argument in wanted}
    for argument in wanted:
        total = torch.zeros_like(given[argument])
        for index, derivative in enumerate(derivatives(name, argument, point)):
            if derivative is not None and gradients[index] is not None:
                matrix, gradient = one.signature.matrix(derivative, index), gradients[index]
                weights = gradient.reshape((*gradient.shape[: gradient.ndim - len(one.results[index])], matrix.shape[-2]))
                total = total + torch.einsum("...ij,...i->...j", matrix, weights).sum_to_size(total.shape)
        found[argument] = total
    return found


def _call(one):
    """A function as users call it."""
    import torch

    signature, operator = one.signature, _operator()

    def call(*arguments, **keywords):
        tensors = [torch.as_tensor(given) for given in signature.given(arguments, keywords)]
        floats = [tensor.dtype for tensor in tensors if tensor.is_floating_point()]
        kind = functools.reduce(torch.promote_types, floats, torch.float32) if floats else torch.float64
        for name, tensor in zip(signature.shapes, tensors):
            if tensor.device.type != "cpu":
                raise ValueError(f"`{name}` is on {tensor.device}, but rne computes on the CPU: give it `{name}.cpu()`")
            if tensor.is_complex():
                raise TypeError(f"`{name}` is a tensor of {tensor.dtype}, but it must be one of real numbers")
        tensors = [tensor.to(kind) for tensor in signature.aligned(tensors)]
        results = operator(tensors, one.arm, signature.name)
        return results[0] if len(results) == 1 else tuple(results)

    return signature.entitled(call, "PyTorch")
