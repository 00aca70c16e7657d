"""Functions of an arm for PyTorch, computed by the machine, with derivatives: `Arm.torch`."""

import functools
import math
import types

import numpy as np

from .derivatives import DERIVATIVES, refusal
from .names import of_content

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
    name = of_content(arm, frame)
    if name not in _ARMS:
        at = {} if frame is None else {"frame": frame}
        told = arm._functions(frame)
        _ARMS[name] = {method: _Function(arm, at, method, *one) for method, _, *one in told}
    title = f"{arm.name}{f' at {frame}' if frame else ''}"
    calls = {method: _call(name, function) for method, function in _ARMS[name].items()}
    return Functions(title, calls)


class Functions(types.SimpleNamespace):
    """The functions of an arm for PyTorch, as attributes: `inverse_dynamics(q, qd, qdd)` and so on."""

    def __init__(self, title, calls):
        super().__init__(**calls)
        self._title = title

    def __repr__(self):
        return f"<functions of {self._title} for PyTorch>"


class _Function:
    """A function of an arm: the shapes of its arguments and results for one state."""

    def __init__(self, arm, at, method, operands, results):
        self.method, self.name = getattr(arm, method), method
        self.at = at if at and "frame=" in (self.method.__text_signature__ or "") else {}
        self.shapes = {name: (4, 4) if name == "pose" else tuple(shape) for name, shape in operands}
        self.results = [(*shape, 4, 4) if is_pose else tuple(shape) for shape, is_pose in results]
        self.values = arm._parameter_values() if arm.parameters else None

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
        found = self.method(**rows, **self.at)
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
        found = _gradients(ctx.arm, ctx.function, given, wanted, gradients[0])
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


def _gradients(arm, function, given, wanted, gradient):
    """The products of a row of multipliers and the derivatives, by the arguments that are wanted."""
    import torch

    for name in wanted:
        if name not in DERIVATIVES.get(function, {}):
            raise NotImplementedError(refusal(function, name))

    @functools.cache
    def of(name, multipliers=None):
        one, zeros = _ARMS[arm][name], torch.zeros_like(given["q"])
        arguments = [multipliers if part == "multipliers" else given.get(part, zeros) for part in one.shapes]
        results = _operator()(arguments, arm, name)
        return results[0] if len(results) == 1 else results

    found = {}
    for name in wanted:
        if function in _TORQUES:
            product = of("torque_gradient", gradient)[("q", "qd", "qdd").index(name)]
        else:
            derivative = DERIVATIVES[function][name](of, given, torch)
            axes = _ARMS[arm][function].results[0]
            rows = derivative.reshape(*derivative.shape[: derivative.dim() - len(axes) - 1], math.prod(axes), -1)
            weights = gradient.reshape(*gradient.shape[: gradient.dim() - len(axes)], math.prod(axes))
            product = torch.einsum("...ij,...i->...j", rows, weights)
        found[name] = product.sum_to_size(given[name].shape)
    return found


def _call(arm, one):
    """A function as users call it."""
    import torch

    names, operator = list(one.shapes), _operator()

    def call(*arguments, **keywords):
        given = dict(zip(names, arguments))
        if len(arguments) > len(names) or given.keys() & keywords.keys() or keywords.keys() - set(names):
            raise TypeError(f"`{one.name}` takes {', '.join(names)}, each once")
        given.update(keywords)
        if one.values is not None:
            given.setdefault("parameters", one.values)
        missing = [name for name in names if name not in given]
        if missing:
            raise TypeError(f"`{one.name}` needs `{missing[0]}`; it takes {', '.join(names)}")
        tensors = [torch.as_tensor(given[name]) for name in names]
        floats = [tensor.dtype for tensor in tensors if tensor.is_floating_point()]
        kind = functools.reduce(torch.promote_types, floats, torch.float32) if floats else torch.float64
        for index, (name, tensor) in enumerate(zip(names, tensors)):
            shape = one.shapes[name]
            if tensor.device.type != "cpu":
                raise ValueError(f"`{name}` is on {tensor.device}, but rne computes on the CPU: give it `{name}.cpu()`")
            if tensor.is_complex():
                raise TypeError(f"`{name}` is a tensor of {tensor.dtype}, but it must be one of real numbers")
            if tensor.dim() < len(shape) or tensor.shape[tensor.dim() - len(shape) :] != shape:
                wanted = ", ".join(["...", *map(str, shape)])
                raise ValueError(f"`{name}` has the shape {tuple(tensor.shape)}, but it must be ({wanted})")
            tensors[index] = tensor.to(kind)
        most = max(tensor.dim() - len(shape) for tensor, shape in zip(tensors, one.shapes.values()))
        for index, (tensor, shape) in enumerate(zip(tensors, one.shapes.values())):
            tensors[index] = tensor.reshape((1,) * (most + len(shape) - tensor.dim()) + tensor.shape)
        results = operator(tensors, arm, one.name)
        return results[0] if len(results) == 1 else tuple(results)

    call.__name__ = call.__qualname__ = one.name
    call.__doc__ = f"`Arm.{one.name}` for PyTorch; arguments: {', '.join(names)}."
    return call
