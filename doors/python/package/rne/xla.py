"""Functions of an arm for JAX, computed by the machine inside the programs that XLA compiles: `Arm.jax`."""

import functools
import math
import pathlib
import re
import warnings

import numpy as np

from ._rne import xla_handler
from .derivatives import DERIVATIVES, refusal
from .names import of_content

#: The name of the machine in the programs of XLA.
TARGET = "rne"


def functions(arm, frame):
    """The functions of an arm, of the tip or of a frame; the same object for the same arm, so that JAX compiles once."""
    try:
        import jax
        import jax.ffi
    except ImportError as error:
        raise ImportError("`Arm.jax` needs the package jax, 0.5 or later: pip install jax") from error
    _register()
    # a compiled program may outlive this process in JAX's cache
    name = of_content(arm, frame)
    found = _KNOWN.get(name)
    if found is None:
        found = _KNOWN.setdefault(name, Functions(arm, frame, name))
    return found


#: Arms are kept by XLA's programs anyway, as long as the process lives.
_KNOWN = {}


@functools.cache
def _register():
    import jax

    jax.ffi.register_ffi_target(TARGET, xla_handler(*version()), platform="cpu")


def version():
    """The version of XLA's foreign-function interface, as the header says that JAX brings."""
    import jax

    header = pathlib.Path(jax.ffi.include_dir(), "xla/ffi/api/c_api.h").read_text(encoding="utf-8")
    return [int(re.search(rf"#define XLA_FFI_API_{part} (\d+)", header)[1]) for part in ("MAJOR", "MINOR")]


class Functions:
    """The functions of an arm for JAX, as attributes: `inverse_dynamics(q, qd, qdd)` and so on."""

    def __init__(self, arm, frame, name):
        arm._for_xla(name, frame)
        told = arm._functions(frame)
        values = arm._parameter_values() if arm.parameters else None
        self._title = f"{arm.name}{f' at {frame}' if frame else ''}"
        self._all = {}
        for method, function, operands, results in told:
            self._all[method] = _Function(self._all, name, method, function, operands, results, values)
        vars(self).update({function: one.call for function, one in self._all.items()})

    def __repr__(self):
        import jax

        precision = "float32 and float64" if jax.config.jax_enable_x64 else "float32, for jax_enable_x64 is off"
        return f"<functions of {self._title} for JAX: {precision}>"


class _Function:
    """A function: `call` as users call it, `derived` on arrays of one type and as many leading axes."""

    def __init__(self, others, arm, name, function, operands, results, values):
        import jax

        self.others, self.arm, self.name, self.function = others, arm, name, function
        self.results, self.values = results, values
        self.shapes = dict(operands)
        self.derived = jax.custom_jvp(self.computed)
        self.derived.defjvp(self.tangent, symbolic_zeros=True)
        self.call = self._call()

    def _call(self):
        import jax
        import jax.numpy as jnp

        names = list(self.shapes)
        shapes = {**self.shapes, "pose": (4, 4)}

        def call(*arguments, **keywords):
            given = dict(zip(names, arguments))
            if len(arguments) > len(names) or given.keys() & keywords.keys() or keywords.keys() - set(names):
                raise TypeError(f"`{self.name}` takes {', '.join(names)}, each once")
            given.update(keywords)
            if self.values is not None:
                given.setdefault("parameters", self.values)
            missing = [name for name in names if name not in given]
            if missing:
                raise TypeError(f"`{self.name}` needs `{missing[0]}`; it takes {', '.join(names)}")
            if not jax.config.jax_enable_x64 and any(getattr(one, "dtype", None) == np.float64 for one in given.values()):
                warnings.warn(
                    "arrays of float64 are computed in float32, because JAX's option jax_enable_x64 is off; "
                    'jax.config.update("jax_enable_x64", True) turns it on',
                    stacklevel=2,
                )
            arrays = [jnp.asarray(given[name]) for name in names]
            kinds = [array.dtype for array in arrays]
            for name, kind in zip(names, kinds):
                if not (jnp.issubdtype(kind, jnp.floating) or jnp.issubdtype(kind, jnp.integer)):
                    raise TypeError(f"`{name}` is an array of {kind}, but it must be one of real numbers")
            floats = [kind for kind in kinds if jnp.issubdtype(kind, jnp.floating)]
            kind = jnp.result_type(*floats, jnp.float32) if floats else jnp.result_type(float)
            flat = []
            for name, array in zip(names, arrays):
                shape = tuple(shapes[name])
                axes = array.ndim - len(shape)
                if axes < 0 or array.shape[axes:] != shape:
                    wanted = ", ".join(["...", *map(str, shape)])
                    raise ValueError(f"`{name}` has the shape {array.shape}, but it must be ({wanted})")
                if name == "pose":
                    turn = array[..., :3, :3].reshape(*array.shape[:axes], 9)
                    array = jnp.concatenate([turn, array[..., :3, 3]], -1)
                flat.append(array.astype(kind).reshape(*array.shape[:axes], math.prod(self.shapes[name])))
            most = max(array.ndim for array in flat)
            return self.derived(*[array.reshape((1,) * (most - array.ndim) + array.shape) for array in flat])

        call.__name__ = call.__qualname__ = self.name
        call.__doc__ = f"`Arm.{self.name}` for JAX; arguments: {', '.join(names)}."
        return call

    def computed(self, *arrays):
        """The results by one call of the machine."""
        import jax
        import jax.numpy as jnp

        leading = jnp.broadcast_shapes(*(array.shape[:-1] for array in arrays))
        sizes = [math.prod(shape) * (12 if is_pose else 1) for shape, is_pose in self.results]
        result = jax.ShapeDtypeStruct((*leading, sum(sizes)), arrays[0].dtype)
        call = jax.ffi.ffi_call(TARGET, result, vmap_method="expand_dims")
        numbers = call(*arrays, arm=self.arm, function=self.function)
        parts, start = [], 0
        for (shape, is_pose), size in zip(self.results, sizes):
            part = numbers if size == result.shape[-1] else numbers[..., start : start + size]
            start += size
            if is_pose:
                part = part.reshape(*leading, *shape, 12)
                turn = part[..., :9].reshape(*leading, *shape, 3, 3)
                above = jnp.concatenate([turn, part[..., 9:, None]], -1)
                last = jnp.broadcast_to(jnp.array([0, 0, 0, 1], part.dtype), (*leading, *shape, 1, 4))
                parts.append(jnp.concatenate([above, last], -2))
            else:
                parts.append(part.reshape(*leading, *shape))
        return parts[0] if len(parts) == 1 else tuple(parts)

    def tangent(self, primals, tangents):
        """The product of the derivatives and the tangents, which XLA transposes."""
        import jax
        import jax.numpy as jnp

        given = dict(zip(self.shapes, primals))

        @functools.cache
        def of(name):
            other = self.others[name]
            zeros = jnp.zeros_like(given["q"])
            return other.derived(*[given.get(name, zeros) for name in other.shapes])

        results = of(self.name)
        total = None
        for name, tangent in zip(self.shapes, tangents):
            if isinstance(tangent, jax.custom_derivatives.SymbolicZero):
                continue
            rule = DERIVATIVES.get(self.name, {}).get(name)
            if rule is None:
                raise NotImplementedError(refusal(self.name, name))
            derivative = rule(of, given, jnp)
            leading = results.shape[: len(primals[0].shape) - 1]
            shape = results.shape[len(leading) :]
            rows = derivative.reshape(*derivative.shape[: len(leading)], math.prod(shape), -1)
            product = jnp.einsum("...ij,...j->...i", rows, tangent)
            product = jnp.broadcast_to(product, (*leading, math.prod(shape))).reshape(results.shape)
            total = product if total is None else total + product
        return results, jax.tree.map(jnp.zeros_like, results) if total is None else total
