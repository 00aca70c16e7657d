#!/usr/bin/env python3
"""Runs kernels of `rne emit --lang ptx` on a graphics card of NVIDIA: their numbers against the processor's, then times.

It needs the driver (libcuda.so.1) and Python's standard library alone. The folder beside it is written by
`cargo run -p rne-emit --example gpu_folder -- FOLDER`. The variable RNE_LIBCUDA names another library of the driver: with
that of `cargo build -p fake-driver`, which runs kernels on the processor, the checks run on any machine and times mean
nothing.
"""

import ctypes
import json
import os
import sys
import time
from array import array

HERE = os.path.dirname(os.path.abspath(__file__))
BEGIN = time.monotonic()
SECONDS = float(os.environ.get("RNE_GPU_SECONDS", "135"))
RESULT = {"checks": [], "times": [], "limits": {}}
GUARD = 64  # numbers behind the results that no kernel may write


def say(*words):
    print(*words, flush=True)


def left():
    return SECONDS - (time.monotonic() - BEGIN)


class Failed(Exception):
    pass


class Driver:
    """The few calls of the driver that are needed."""

    def __init__(self):
        self.lib = ctypes.CDLL(os.environ.get("RNE_LIBCUDA", "libcuda.so.1"))
        self.call("cuInit", 0)
        self.device = ctypes.c_int()
        self.call("cuDeviceGet", ctypes.byref(self.device), 0)
        context = ctypes.c_void_p()
        self.call("cuDevicePrimaryCtxRetain", ctypes.byref(context), self.device)
        self.call("cuCtxSetCurrent", context)
        name = ctypes.create_string_buffer(256)
        self.call("cuDeviceGetName", name, 256, self.device)
        version = ctypes.c_int()
        self.call("cuDriverGetVersion", ctypes.byref(version))
        self.name, self.version = name.value.decode(), version.value
        self.attributes = {
            "multiprocessors": self.attribute(16),
            "clock_kHz": self.attribute(13),
            "memory_clock_kHz": self.attribute(36),
            "capability": [self.attribute(75), self.attribute(76)],
        }
        self.events = [ctypes.c_void_p(), ctypes.c_void_p()]
        for event in self.events:
            self.call("cuEventCreate", ctypes.byref(event), 0)

    def call(self, function, *arguments):
        status = getattr(self.lib, function)(*arguments)
        if status != 0:
            text = ctypes.c_char_p()
            self.lib.cuGetErrorString(status, ctypes.byref(text))
            raise Failed(f"{function}: {status} {(text.value or b'').decode()}")

    def attribute(self, which):
        value = ctypes.c_int()
        self.call("cuDeviceGetAttribute", ctypes.byref(value), which, self.device)
        return value.value

    def memory(self):
        free, total = ctypes.c_size_t(), ctypes.c_size_t()
        self.call("cuMemGetInfo_v2", ctypes.byref(free), ctypes.byref(total))
        return free.value

    def allocate(self, count):
        address = ctypes.c_uint64()
        self.call("cuMemAlloc_v2", ctypes.byref(address), ctypes.c_size_t(max(count, 16)))
        return address.value

    def free(self, addresses):
        for address in addresses:
            self.call("cuMemFree_v2", ctypes.c_uint64(address))

    def upload(self, address, numbers):
        data = numbers.tobytes()
        self.call("cuMemcpyHtoD_v2", ctypes.c_uint64(address), data, ctypes.c_size_t(len(data)))

    def download(self, address, code, count):
        numbers = array(code, bytes(count * array(code).itemsize))
        place, _ = numbers.buffer_info()
        self.call("cuMemcpyDtoH_v2", ctypes.c_void_p(place), ctypes.c_uint64(address),
                  ctypes.c_size_t(count * numbers.itemsize))
        return numbers

    def fill(self, address, numbers, count):
        """Repeats numbers in memory until it has `count` of them."""
        size = numbers.itemsize
        have = min(len(numbers), count)
        self.upload(address, numbers[:have])
        while have < count:
            more = min(have, count - have)
            self.call("cuMemcpyDtoD_v2", ctypes.c_uint64(address + have * size), ctypes.c_uint64(address),
                      ctypes.c_size_t(more * size))
            have += more

    def module(self, text):
        data = text.encode() if isinstance(text, str) else text
        log, errors = ctypes.create_string_buffer(8192), ctypes.create_string_buffer(8192)
        # info log, its size, error log, its size
        options = [3, 4, 5, 6]
        values = [ctypes.cast(log, ctypes.c_void_p), 8192, ctypes.cast(errors, ctypes.c_void_p), 8192]
        numbers = (ctypes.c_int * len(options))(*options)
        pointers = (ctypes.c_void_p * len(options))(*values)
        module = ctypes.c_void_p()
        begin = time.monotonic()
        try:
            self.call("cuModuleLoadDataEx", ctypes.byref(module), data + b"\0", len(options), numbers, pointers)
        except Failed as error:
            raise Failed(f"{error}\n{errors.value.decode(errors='replace')}") from None
        return module, time.monotonic() - begin

    def function(self, module, name):
        function = ctypes.c_void_p()
        self.call("cuModuleGetFunction", ctypes.byref(function), module, name.encode())
        return function

    def properties(self, function):
        found = {}
        for name, which in (("registers", 4), ("local_bytes", 3), ("most_threads", 0)):
            value = ctypes.c_int()
            self.call("cuFuncGetAttribute", ctypes.byref(value), which, function)
            found[name] = value.value
        return found

    def launch(self, function, blocks, width, arguments):
        pointers = (ctypes.c_void_p * len(arguments))(*[ctypes.cast(ctypes.byref(a), ctypes.c_void_p) for a in arguments])
        self.call("cuLaunchKernel", function, blocks, 1, 1, width, 1, 1, 0, None, pointers, None)

    def synchronize(self):
        self.call("cuCtxSynchronize")

    def seconds(self, function, blocks, width, arguments):
        """The median time of a launch, and the shortest, by events around many of them."""
        self.launch(function, blocks, width, arguments)
        self.synchronize()
        times, launches = [], 1
        for _ in range(7):
            self.call("cuEventRecord", self.events[0], None)
            for _ in range(launches):
                self.launch(function, blocks, width, arguments)
            self.call("cuEventRecord", self.events[1], None)
            self.call("cuEventSynchronize", self.events[1])
            milliseconds = ctypes.c_float()
            self.call("cuEventElapsedTime", ctypes.byref(milliseconds), self.events[0], self.events[1])
            times.append(milliseconds.value / 1e3 / launches)
            launches = max(1, min(200, int(0.012 / max(times[-1], 1e-7))))
        times = sorted(times[2:])
        return times[len(times) // 2], times[0]


def u64(number):
    return ctypes.c_uint64(number)


def u32(number):
    return ctypes.c_uint32(number)


COPY = """
.version 7.0
.target sm_70
.address_size 64
.visible .entry copy(.param .u64 from, .param .u64 to, .param .u32 count)
{
    .reg .u32 %i, %b, %w, %n, %x<4>;
    .reg .u64 %f, %t;
    .reg .pred %p;
    mov.u32 %b, %ctaid.x;
    mov.u32 %w, %ntid.x;
    mov.u32 %i, %tid.x;
    mad.lo.u32 %i, %b, %w, %i;
    ld.param.u32 %n, [count];
    setp.ge.u32 %p, %i, %n;
    @%p ret;
    ld.param.u64 %f, [from];
    ld.param.u64 %t, [to];
    cvta.to.global.u64 %f, %f;
    cvta.to.global.u64 %t, %t;
    mad.wide.u32 %f, %i, 16, %f;
    mad.wide.u32 %t, %i, 16, %t;
    ld.global.nc.v4.u32 {%x0, %x1, %x2, %x3}, [%f];
    st.global.v4.u32 [%t], {%x0, %x1, %x2, %x3};
    ret;
}
"""


def chains(real):
    """A kernel of 8 independent chains of 512 fused multiply-adds per thread."""
    factor, small = (("0d3FEFF00000000000", "0d3E10000000000000") if real == "f64" else ("0f3F7F0000", "0f30800000"))
    lines = [f"    cvt.rn.{real}.u32 %x{k}, %i;" for k in range(8)]
    lines += [f"    fma.rn.{real} %x{k}, %x{k}, {factor}, %y;" for _ in range(16) for k in range(8)]
    loop = "\n".join(lines[8:])
    start = "\n".join(lines[:8])
    total = "\n".join(f"    add.rn.{real} %x0, %x0, %x{k};" for k in range(1, 8))
    bytes_of = 8 if real == "f64" else 4
    return f"""
.version 7.0
.target sm_70
.address_size 64
.visible .entry chains(.param .u64 to, .param .u32 count)
{{
    .reg .u32 %i, %b, %w, %k;
    .reg .{real} %x<8>, %y;
    .reg .u64 %t;
    .reg .pred %p;
    mov.u32 %b, %ctaid.x;
    mov.u32 %w, %ntid.x;
    mov.u32 %i, %tid.x;
    mad.lo.u32 %i, %b, %w, %i;
    mov.{real} %y, {small};
{start}
    mov.u32 %k, 0;
again:
{loop}
    add.u32 %k, %k, 1;
    setp.lt.u32 %p, %k, 32;
    @%p bra again;
{total}
    ld.param.u64 %t, [to];
    cvta.to.global.u64 %t, %t;
    mad.wide.u32 %t, %i, {bytes_of}, %t;
    st.global.{real} [%t], %x0;
    ret;
}}
"""


def code_of(case):
    return "d" if case["type"] == "f64" else "f"


def read(name, code):
    numbers = array(code)
    with open(os.path.join(HERE, name), "rb") as file:
        numbers.frombytes(file.read())
    return numbers


def inputs_of(case, states):
    """The columns of each array for the first states, in the type of the case."""
    code = code_of(case)
    numbers = read(case["label"] + ".in", "f")
    arrays, at = [], 0
    for _, elements in case["arrays"]:
        columns = []
        for _ in range(elements):
            columns.append(array(code, numbers[at:at + states]))
            at += case["states"]
        arrays.append(columns)
    return arrays


def laid_out(columns, states, code, arrangement):
    numbers = array(code, bytes(len(columns) * states * array(code).itemsize))
    for element, column in enumerate(columns):
        if arrangement == "columns":
            numbers[element * states:(element + 1) * states] = column
        else:
            numbers[element::len(columns)] = column
    return numbers


def arguments_of(addresses, states, case=None):
    """The parameters of a kernel; the results of a rollout are two arrays, one behind the other."""
    rollout = (case or {}).get("rollout")
    if not rollout:
        return [u64(address) for address in addresses] + [u32(states)]
    is_double = case["type"] == "f64"
    half = case["outputs"] // 2 * states * (8 if is_double else 4)
    step = (ctypes.c_double if is_double else ctypes.c_float)(rollout["step"])
    return [u64(address) for address in [*addresses, addresses[-1] + half]] + [
        step, u32(rollout["steps"]), u32(rollout["every"]), u32(states)]


def check(driver, case, function, arrangement, states):
    """Runs the first states; compares with the processor."""
    code, outputs = code_of(case), case["outputs"]
    size = array(code).itemsize
    addresses = []
    try:
        for columns in inputs_of(case, states):
            addresses.append(driver.allocate(len(columns) * states * size))
            if columns:
                driver.upload(addresses[-1], laid_out(columns, states, code, arrangement))
        count = outputs * states
        addresses.append(driver.allocate((count + GUARD) * size))
        driver.upload(addresses[-1], array("B", b"\xa5" * ((count + GUARD) * size)))
        # one block more than there are states for
        driver.launch(function, states // 64 + 2, 64, arguments_of(addresses, states, case))
        driver.synchronize()
        found = driver.download(addresses[-1], code, count + GUARD)
    finally:
        driver.free(addresses)
    guard = found[count:].tobytes()
    is_guarded = guard == b"\xa5" * len(guard)
    found = found[:count]
    if arrangement == "rows":
        parts = 2 if case.get("rollout") else 1
        elements, size_of_part = outputs // parts, count // parts
        found = array(code, [x for part in range(parts) for element in range(elements)
                             for x in found[part * size_of_part + element:(part + 1) * size_of_part:elements]])
    whole = case["states"]
    same, double = read(f"{case['label']}.{case['type']}", code), read(case["label"] + ".f64", "d")
    first = lambda numbers: [numbers[e * whole:e * whole + states] for e in range(outputs)]
    same, double = first(same), first(double)
    expected = array(code)
    for column in same:
        expected.extend(column)
    differing = 0
    if found.tobytes() != expected.tobytes():
        a, b = found.tobytes(), expected.tobytes()
        differing = sum(a[k:k + size] != b[k:k + size] for k in range(0, len(a), size))
    scales = [max(abs(column[state]) for column in double) or 1.0 for state in range(states)]
    worst, squares = 0.0, 0.0
    for element in range(outputs):
        column, mine = double[element], found[element * states:(element + 1) * states]
        for state in range(states):
            error = abs(mine[state] - column[state]) / scales[state]
            worst = error if not error <= worst else worst
            squares += error * error
    return {
        "label": case["label"] + case.get("variant", ""), "type": case["type"], "arrangement": arrangement, "states": states,
        "numbers": count, "differing_bits": differing, "largest_error": worst,
        "rms_error": (squares / count) ** 0.5, "is_guarded": is_guarded,
    }


def measure(driver, case, function, arrangement, states, widths=(128,)):
    code, outputs = code_of(case), case["outputs"]
    size = array(code).itemsize
    elements = sum(len(columns) for columns in inputs_of(case, 1))
    bytes_in, bytes_out = case["used"] * states * size, outputs * states * size
    if (elements + outputs) * states * size > 0.8 * driver.memory():
        raise Failed("too little memory for so many states")
    known = case["states"]
    addresses = []
    try:
        for columns in inputs_of(case, known):
            addresses.append(driver.allocate(len(columns) * states * size))
            if arrangement == "columns":
                for element, column in enumerate(columns):
                    driver.fill(addresses[-1] + element * states * size, column, states)
            elif columns:
                driver.fill(addresses[-1], laid_out(columns, known, code, "rows"), states * len(columns))
        addresses.append(driver.allocate(bytes_out))
        best = None
        for width in widths:
            median, least = driver.seconds(
                function, (states + width - 1) // width, width, arguments_of(addresses, states, case))
            if best is None or median < best[0]:
                best = (median, least, width)
    finally:
        driver.free(addresses)
    median, least, width = best
    return {
        "label": case["label"] + case.get("variant", ""), "type": case["type"], "arrangement": arrangement, "states": states, "width": width,
        "seconds": median, "shortest": least, "states_per_second": states / median, "ns_per_state": 1e9 * median / states,
        "GB_per_second": (bytes_in + bytes_out) / median / 1e9, "bytes_per_state": (case["used"] + outputs) * size,
        "Gflop_per_second": case["operations"] * states / median / 1e9,
    }


def limits(driver):
    """What this card does at best: a copy, chains of fused multiply-adds."""
    module, _ = driver.module(COPY)
    function = driver.function(module, "copy")
    for power in (26, 28, 30, 32):
        bytes_each = 2 ** power // 2
        if 2 * bytes_each > 0.8 * driver.memory():
            break
        addresses = [driver.allocate(bytes_each) for _ in range(2)]
        count = bytes_each // 16
        median, _ = driver.seconds(function, (count + 255) // 256, 256, arguments_of(addresses, count))
        driver.free(addresses)
        RESULT["limits"][f"copy_{2 * bytes_each}_bytes_GB_per_second"] = 2 * bytes_each / median / 1e9
        say(f"copy, {2 * bytes_each / 2**20:.0f} MiB read and written: {2 * bytes_each / median / 1e9:.0f} GB/s")
    for real, size in (("f32", 4), ("f64", 8)):
        module, _ = driver.module(chains(real))
        function = driver.function(module, "chains")
        threads = driver.attributes["multiprocessors"] * 2048 * 4
        address = driver.allocate(threads * size)
        median, _ = driver.seconds(function, threads // 256, 256, arguments_of([address], 0))
        driver.free([address])
        rate = threads * 8 * 512 / median
        RESULT["limits"][f"fma_{real}_per_second"] = rate
        say(f"chains of fused multiply-adds, {real}: {rate / 1e12:.2f} T/s ({2 * rate / 1e12:.1f} TFLOP/s)")


def attempt(what, work):
    try:
        return work()
    except Exception as error:  # one kernel that fails is no reason to stop
        say(f"FAILED {what}: {error}")
        RESULT.setdefault("failed", []).append(f"{what}: {error}")
        return None


def copy_near(count):
    """The measured copy whose size is nearest."""
    found = [(abs(int(name.split("_")[1]) - count), rate) for name, rate in RESULT["limits"].items()
             if name.startswith("copy_")]
    return min(found)[1] if found else float("nan")


def load(driver, case):
    with open(os.path.join(HERE, case["ptx"]), encoding="ascii") as file:
        return driver.module(file.read())


def one_case(driver, case, sizes, counts):
    module, seconds = load(driver, case)
    for arrangement in ("columns", "rows"):
        function = driver.function(module, f"{case['kernel']}_{arrangement}")
        properties = driver.properties(function)
        for states in counts:
            result = attempt(f"{case['label']} {case['type']} {arrangement} {states}",
                             lambda: check(driver, case, function, arrangement, states))
            if result is None:
                continue
            result.update(properties, translation_seconds=seconds)
            RESULT["checks"].append(result)
            is_last = states == counts[-1]
            if is_last or result["differing_bits"] or not result["is_guarded"]:
                say(f"check {result['label']:<44} {case['type']} {arrangement:<7} n={states:<5}"
                    f" bits differ {result['differing_bits']}/{result['numbers']}"
                    f" largest error {result['largest_error']:.1e} {'' if result['is_guarded'] else 'WROTE BEYOND'}"
                    f" regs {properties['registers']} local {properties['local_bytes']} B, translated {seconds:.2f} s")
        for power in sizes if arrangement == "columns" else sizes[-1:]:
            result = attempt(f"{case['label']} {case['type']} {arrangement} 2^{power}",
                             lambda: measure(driver, case, function, arrangement, 2 ** power,
                                             (64, 128, 256) if arrangement == "columns" else (64,)))
            if result is None:
                continue
            result.update(properties)
            copy = copy_near(result["bytes_per_state"] * 2 ** power)
            fma = RESULT["limits"].get(f"fma_{case['type']}_per_second", float("nan"))
            result["part_of_copy"] = result["GB_per_second"] / copy
            result["part_of_fma"] = case["instructions"] * result["states_per_second"] / fma
            RESULT["times"].append(result)
            say(f"time  {result['label']:<44} {case['type']} {arrangement:<7} 2^{power} block {result['width']:<3}"
                f" {result['states_per_second'] / 1e9:8.3f} G states/s {result['ns_per_state'] * 1e3:9.2f} ps/state"
                f" {result['GB_per_second']:6.0f} GB/s = {result['part_of_copy']:.0%} of copy,"
                f" {result['part_of_fma']:.0%} of fma peak")
    driver.call("cuModuleUnload", module)


def main():
    try:
        with open(os.path.join(HERE, "manifest.json"), encoding="utf-8") as file:
            manifest = json.load(file)
    except FileNotFoundError:
        sys.exit("there is no manifest.json beside this program: `cargo run -p rne-emit --example gpu_folder -- FOLDER` "
                 "writes a folder with the kernels, their manifest and a copy of this program; run that copy")
    cases = manifest["cases"]
    driver = Driver()
    RESULT.update(device=driver.name, driver=driver.version, attributes=driver.attributes, unit=manifest["unit"])
    say(f"{driver.name}, driver {driver.version}, {driver.attributes}")
    is_fake = driver.name.startswith("no card")
    if not is_fake:
        attempt("limits", lambda: limits(driver))
    sizes = lambda *powers: (5,) if is_fake else powers
    torques = [case for case in cases if case["label"] == "panda_inverse_dynamics"]
    rollouts = [case for case in cases if case.get("rollout")]
    first = torques + rollouts
    close = [case for case in cases if case not in first and case["robot"] in ("panda", "g1_floating", "g1")]
    others = [case for case in cases if case not in first and case not in close]
    for case in torques:
        attempt(case["label"], lambda: one_case(driver, case, sizes(20, 22, 24), (1, 31, 64, case["states"])))
    for case in rollouts:
        attempt(case["label"], lambda: one_case(driver, case, sizes(17, 20), (1, 31, 64, case["states"])))
    for case in close:
        if left() < 40:
            say(f"skipped for want of time: {case['label']} {case['type']}")
            continue
        attempt(case["label"], lambda: one_case(driver, case, sizes(20, 22), (1, 31, 64, case["states"])))
    for case in others:
        if left() < 3:
            say(f"skipped for want of time: {case['label']} {case['type']}")
            continue
        attempt(case["label"], lambda: one_case(driver, case, sizes(22) if left() > 25 else (), (31, 64, case["states"])))
    checks = RESULT["checks"]
    RESULT["seconds"] = time.monotonic() - BEGIN
    differing = sum(result["differing_bits"] for result in checks)
    numbers = sum(result["numbers"] for result in checks)
    say(f"checked {numbers} numbers of {len(checks)} runs: {differing} differ in a bit from the processor's;"
        f" {sum(not result['is_guarded'] for result in checks)} runs wrote beyond their results;"
        f" {len(RESULT.get('failed', []))} failed; {RESULT['seconds']:.0f} s")
    for real in ("f64", "f32"):
        of = [result["largest_error"] for result in checks if result["type"] == real]
        say(f"largest error {real}, relative to the largest result of the state: {max(of, default=0):.2e}")
    text = json.dumps(RESULT)
    if os.environ.get("OUT"):
        with open(os.path.join(os.environ["OUT"], "gpu.json"), "w", encoding="utf-8") as file:
            file.write(text)
    say("JSON " + text)
    return 0 if differing == 0 and not RESULT.get("failed") else 1


if __name__ == "__main__":
    sys.exit(main())
