"""Functions of an arm for CasADi, compiled by a compiler of C: `Arm.casadi`."""

import hashlib
import os
import pathlib
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile

#: Options of the compiler: a library that shows CasADi's functions alone.
_OPTIONS = ["-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-fvisibility=hidden", "-shared"]


def external(arm, function):
    """`function` of an arm as a `casadi.Function`."""
    try:
        import casadi
    except ImportError as error:
        raise ImportError("`Arm.casadi` needs the package casadi, 3.6 or later: pip install casadi") from error
    code = arm.code("c", [function], casadi=True, order="registers")
    library = str(_library(arm.name, code))
    # By default CasADi derives a large problem direction by direction, and calls `fwd1_` for each. For many directions
    # it calls the Jacobian once, but not for up to two multipliers: the Jacobian has no derivatives, and `adj1_` has.
    of = casadi.external(function, library)
    return casadi.external(function, library, {"jac_penalty": max(2 / of.nnz_out(), 4.2 / of.nnz_in())})


def _library(name, code):
    """The compiled code: a file of the cache, whose name tells the code and the compiler."""
    compiler = _compiler()
    version = subprocess.run([*compiler, "--version"], capture_output=True, check=False).stdout
    key = hashlib.sha256(code.encode())
    for part in (shlex.join(compiler + _OPTIONS).encode(), version, platform.platform().encode()):
        key.update(b"\0" + part)
    folder = _cache()
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    library = folder / f"{name}-{key.hexdigest()[:32]}.so"
    if library.exists():
        return library
    with tempfile.TemporaryDirectory(dir=folder) as place:
        source, built = pathlib.Path(place, "arm.c"), pathlib.Path(place, "arm.so")
        source.write_text(code, encoding="utf-8")
        command = [*compiler, *_OPTIONS, str(source), "-o", str(built)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"`{shlex.join(command)}` failed: {done.stderr.strip()}")
        try:
            os.link(built, library)
        except FileExistsError:
            pass  # another process has made the same library meanwhile
        except OSError:
            os.replace(built, library)  # a file system without links
    return library


def _compiler():
    """The compiler of C as words of a command: `$CC`, or the first one that is installed."""
    asked = shlex.split(os.environ.get("CC", ""))
    for words in [asked] if asked else [["cc"], ["gcc"], ["clang"]]:
        if shutil.which(words[0]):
            return words
    missing = f"`{asked[0]}`, which the variable CC names" if asked else "cc, gcc or clang"
    raise RuntimeError(
        f"`Arm.casadi` needs a compiler of C, and there is no {missing} on PATH. Install one, or name one by the "
        "variable CC. On another computer, `rne emit FILE --lang c --casadi -o arm.c` writes the code"
    )


def _cache():
    """The folder of compiled code."""
    given = os.environ.get("RNE_CACHE")
    if given:
        return pathlib.Path(given)
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or pathlib.Path.home() / "AppData/Local"
    elif sys.platform == "darwin":
        base = pathlib.Path.home() / "Library/Caches"
    else:
        base = os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache"
    return pathlib.Path(base) / "rne" / "casadi"
