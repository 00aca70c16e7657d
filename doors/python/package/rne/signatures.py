"""Signatures of the functions of an arm for packages of arrays: what `Arm.jax` and `Arm.torch` share."""

import math


def of_arm(arm, frame):
    """The signatures of the functions of an arm, by the names of its methods; at a frame, of those that have one there."""
    values = arm._parameter_values() if arm.parameters else None
    for method, function, operands, results in arm._functions(frame):
        if frame is None or "frame=" in (getattr(arm, method).__text_signature__ or ""):
            yield Signature(method, function, operands, results, values)


def title(arm, frame):
    return f"{arm.name}{f' at {frame}' if frame else ''}"


class Signature:
    """The names of a function and of its arguments, and the shapes of arguments and results for one state."""

    def __init__(self, method, function, operands, results, values):
        self.name, self.function, self.values = method, function, values
        self.shapes = {name: (4, 4) if name == "pose" else tuple(shape) for name, shape in operands}
        self.results = [((*shape, 4, 4) if is_pose else tuple(shape), is_pose) for shape, is_pose in results]

    def given(self, arguments, keywords):
        """What a call gives for each argument, in their order."""
        names = list(self.shapes)
        given = dict(zip(names, arguments))
        # in words that torch.compile knows
        if len(arguments) > len(names) or any(name in given or name not in names for name in keywords):
            raise TypeError(f"`{self.name}` takes {', '.join(names)}, each once")
        given.update(keywords)
        if self.values is not None:
            given.setdefault("parameters", self.values)
        missing = [name for name in names if name not in given]
        if missing:
            raise TypeError(f"`{self.name}` needs `{missing[0]}`; it takes {', '.join(names)}")
        return [given[name] for name in names]

    def aligned(self, arrays):
        """The arrays with as many leading axes as the one that has most; one of another shape is refused."""
        axes = []
        for (name, shape), array in zip(self.shapes.items(), arrays):
            axes.append(array.ndim - len(shape))
            if axes[-1] < 0 or tuple(array.shape[axes[-1] :]) != shape:
                wanted = ", ".join(["...", *map(str, shape)])
                raise ValueError(f"`{name}` has the shape {tuple(array.shape)}, but it must be ({wanted})")
        return [array.reshape((1,) * (max(axes) - own) + tuple(array.shape)) for own, array in zip(axes, arrays)]

    def entitled(self, call, package):
        """The function of a call, with its name and its help."""
        call.__name__ = call.__qualname__ = self.name
        call.__doc__ = f"`Arm.{self.name}` for {package}; arguments: {', '.join(self.shapes)}."
        return call

    def matrix(self, derivative, result):
        """A derivative as matrices: a row for each element of a result, a column for each element of an argument."""
        shape = self.results[result][0]
        leading = derivative.shape[: derivative.ndim - len(shape) - 1]
        return derivative.reshape((*leading, math.prod(shape), derivative.shape[-1]))
