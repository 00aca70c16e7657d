"""A recursion by torch.compile, and MJX, beside the kernels: torques, mass matrix and accelerations of a Panda.

Usage: python3 benches/gpu/peers.py FOLDER

FOLDER is that of run.py, with panda.urdf (`rne export panda --urdf`) and panda.json beside the kernels: the table of the
arm, a list `joints` with theta, d, a, alpha, offset, m, com and I (about the centre of mass: xx, yy, zz, xy, xz, yz),
and `gravity`. Needs PyTorch, JAX, mujoco and mujoco-mjx, and a card. The recursion is compared with the reference
numbers of the kernels. Prints ns per state.
"""
import json
import math
import os
import sys
import time
import traceback

import numpy as np

HERE = os.path.abspath(sys.argv[1])
N = 1 << 20


def torch_part():
    import torch
    torch.set_float32_matmul_precision("highest")
    model = json.load(open(os.path.join(HERE, "panda.json")))
    dev = "cuda"
    J = model["joints"]
    g = model["gravity"]

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    def add(a, b):
        return tuple(x + y for x, y in zip(a, b))

    def mat(R, v):
        return tuple(sum(R[i][k] * v[k] for k in range(3)) for i in range(3))

    def matT(R, v):
        return tuple(sum(R[k][i] * v[k] for k in range(3)) for i in range(3))

    def inverse_dynamics(q, qd, qdd):
        n = len(J)
        w = wd = (0.0, 0.0, 0.0)
        a = tuple(-x for x in g)
        keep = []
        for i, j in enumerate(J):
            s, c = torch.sin(q[i] + j["offset"]), torch.cos(q[i] + j["offset"])
            sa, ca = math.sin(j["alpha"]), math.cos(j["alpha"])
            R = ((c, -s, 0.0), (s * ca, c * ca, -sa), (s * sa, c * sa, ca))
            p = (j["a"], -sa * j["d"], ca * j["d"])
            a = matT(R, add(a, add(cross(wd, p), cross(w, cross(w, p)))))
            w0 = matT(R, w)
            zq = (0.0, 0.0, qd[i])
            wd = add(matT(R, wd), add(cross(w0, zq), (0.0, 0.0, qdd[i])))
            w = add(w0, zq)
            com, m, I = j["com"], j["m"], j["I"]
            ac = add(a, add(cross(wd, com), cross(w, cross(w, com))))
            F = tuple(m * x for x in ac)
            M = ((I[0], I[3], I[4]), (I[3], I[1], I[5]), (I[4], I[5], I[2]))
            N_ = add(mat(M, wd), cross(w, mat(M, w)))
            keep.append((R, p, F, N_, com))
        f = nn = (0.0, 0.0, 0.0)
        tau = [None] * n
        for i in reversed(range(n)):
            R, p, F, N_, com = keep[i]
            f = add(F, f)
            nn = add(add(N_, cross(com, F)), nn)
            tau[i] = nn[2]
            f0 = mat(R, f)
            nn = add(mat(R, nn), cross(p, f0))
            f = f0
        return torch.stack(tau)

    def rne_numbers(name, count):
        manifest = json.load(open(os.path.join(HERE, "manifest.json")))
        case = next(c for c in manifest["cases"] if c["label"] == name and c["type"] == "f64")
        return case

    case = rne_numbers("panda_inverse_dynamics", 0)
    states = case["states"]
    data = np.fromfile(os.path.join(HERE, "panda_inverse_dynamics.in"), dtype="<f4").astype(np.float64)
    print("input file holds", data.size, "numbers for", states, "states")
    ref = np.fromfile(os.path.join(HERE, "panda_inverse_dynamics.f64"), dtype="<f8")
    width = data.size // states
    rows = data.reshape(states, width) if data.size == states * width else None
    best = None
    for layout in ("rows", "columns"):
        x = rows if layout == "rows" else data.reshape(width, states).T
        q, qd, qdd = (torch.tensor(np.ascontiguousarray(x[:, k * 7:(k + 1) * 7].T), device=dev) for k in range(3))
        tau = inverse_dynamics(q, qd, qdd).cpu().numpy()
        for out in ("rows", "columns"):
            r = ref.reshape(states, 7).T if out == "rows" else ref.reshape(7, states)
            error = float(np.max(np.abs(tau - r)) / np.max(np.abs(r)))
            best = error if best is None else min(best, error)
    print("torch recursion against the reference numbers: largest error %.1e of the largest torque" % best)
    for dtype, name in ((torch.float32, "f32"), (torch.float64, "f64")):
        q, qd, qdd = (torch.rand(7, N, device=dev, dtype=dtype) * 4 - 2 for _ in range(3))
        compiled = torch.compile(inverse_dynamics, fullgraph=True)
        begin = time.time()
        compiled(q, qd, qdd)
        torch.cuda.synchronize()
        compile_s = time.time() - begin
        times = []
        for _ in range(20):
            a, b = torch.cuda.Event(enable_timing=True), torch.cuda.Event(enable_timing=True)
            a.record()
            for _ in range(5):
                compiled(q, qd, qdd)
            b.record()
            torch.cuda.synchronize()
            times.append(a.elapsed_time(b) / 5)
        print("torch.compile inverse dynamics %s: %.4f ns per state (median, %d states), compiled in %.1f s"
              % (name, np.median(times) * 1e6 / N, N, compile_s), flush=True)


def mjx_part():
    import jax, jax.numpy as jnp
    import mujoco
    from mujoco import mjx
    model = mujoco.MjModel.from_xml_path(os.path.join(HERE, "panda.urdf"))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    mx = mjx.put_model(model)
    print("MJX", mujoco.__version__, "jax", jax.__version__, "nv", model.nv, jax.devices())
    n = 1 << 17
    d0 = mjx.make_data(mx)

    def kin(d):
        d = mjx.fwd_position(mx, d)
        return mjx.fwd_velocity(mx, d)

    def inverse(q, qd, qdd):
        d = d0.replace(qpos=q, qvel=qd, qacc=qdd)
        return mjx.inverse(mx, d).qfrc_inverse

    def forward(q, qd, tau):
        d = d0.replace(qpos=q, qvel=qd, qfrc_applied=tau)
        return mjx.forward(mx, d).qacc

    def mass(q):
        from mujoco.mjx._src import smooth
        d = d0.replace(qpos=q)
        d = smooth.com_pos(mx, smooth.kinematics(mx, d))
        d = smooth.crb(mx, d)
        from mujoco.mjx._src import support
        return support.full_m(mx, d)

    key = jax.random.PRNGKey(0)
    q, qd, qdd = (jax.random.uniform(k, (n, model.nq), minval=-2, maxval=2) for k in jax.random.split(key, 3))
    for name, f, args in (("inverse dynamics", inverse, (q, qd, qdd)), ("forward dynamics", forward, (q, qd, qdd)),
                          ("mass matrix", mass, (q,)),):
        try:
            g = jax.jit(jax.vmap(f))
            begin = time.time()
            g(*args).block_until_ready()
            compile_s = time.time() - begin
            times = []
            for _ in range(10):
                begin = time.time()
                g(*args).block_until_ready()
                times.append(time.time() - begin)
            print("MJX %s f32: %.3f ns per state (median, %d states), compiled in %.1f s"
                  % (name, np.median(times) * 1e9 / n, n, compile_s), flush=True)
        except Exception as error:
            print("MJX", name, "failed:", repr(error)[:300], flush=True)
    try:
        jac = jax.jit(jax.vmap(lambda q, qd, qdd: jax.jacfwd(inverse, argnums=(0, 1))(q, qd, qdd)))
        m = 1 << 15
        args = tuple(x[:m] for x in (q, qd, qdd))
        jax.block_until_ready(jac(*args))
        times = []
        for _ in range(10):
            begin = time.time()
            jax.block_until_ready(jac(*args))
            times.append(time.time() - begin)
        print("MJX jacfwd of inverse dynamics f32: %.2f ns per state (%d states)" % (np.median(times) * 1e9 / m, m), flush=True)
    except Exception as error:
        print("MJX jacfwd failed:", repr(error)[:300], flush=True)


for part in (torch_part, mjx_part):
    try:
        part()
    except Exception as error:
        traceback.print_exc()
