"""wrap.py GENERATED: plugin sources around the generated C files in the folder GENERATED.

call_<robot>_<form>.c   one state per call
batch_<robot>_<form>.c  many states per call, LANES at a time
calls.c, batches.c      the tables of the two plugins (native/rnepeer.h)
"""

import re
import sys
from pathlib import Path

# The forms, the names of the rows, their kinds, and the quantities of matrices.
FORMS = {
    "dh": ("casadi_dh", "RP_ID"),
    "jf": ("casadi_jf", "RP_ID"),
    "base": ("casadi_base", "RP_ID"),
    "pin": ("pin_casadi", "RP_ID"),
    "cg": ("pin_cppadcg", "RP_ID"),
    "m": ("casadi_mass_matrix", "RP_OTHER", "RP_MASS_MATRIX"),
    "fd": ("casadi_forward_dynamics", "RP_FD"),
    "pinm": ("pin_casadi_crba", "RP_OTHER", "RP_MASS_MATRIX"),
    "pinfd": ("pin_casadi_aba", "RP_FD"),
    "pind": ("pin_casadi_deriv", "RP_OTHER", "RP_DTAU_DQ", "RP_DTAU_DQD"),
}

# The pointers are never null: so CasADi's tests for it can go, as in a hand-made build.
CASADI = """#define CASADI_SYMBOL_EXPORT static
#include "{name}.c"
void call_{name}(void *ctx, const double *q, const double *qd, const double *qdd, double *out) {{
  const double *arg[3] = {{q, qd, qdd}};
  double *res[1] = {{out}};
  (void)ctx;
  if (!q || !qd || !qdd || !out) __builtin_unreachable();
  id(arg, res, 0, 0, 0);
}}
"""

# Matrices stay where they are: for the driver's check `call_<name>_results` tells where.
MATRICES = """#define CASADI_SYMBOL_EXPORT static
#include "rnepeer.h"
#include "{name}.c"
static double matrices[{count}][{joints} * {joints}];
void call_{name}(void *ctx, const double *q, const double *qd, const double *qdd, double *out) {{
  const double *arg[3] = {{q, qd, qdd}};
  double *res[] = {{{results}}};
  (void)ctx;
  if (!q || !qd || !qdd || !out) __builtin_unreachable();
  id(arg, res, 0, 0, 0);
  out[0] = matrices[0][0];
}}
const double *call_{name}_results(int what) {{ return {choice}0; }}
"""

BATCH = """#include "vector.h"
#define LOAD(x, j) (*(const vec *)((x) + (size_t)(j) * count + k))
#define STORE(x, j, value) (*(vec *)((x) + (size_t)(j) * count + k) = (vec){{0}} + (value))
static inline void lanes(const double *x0, const double *x1, const double *x2, double *out, size_t count, size_t k) {{
#include "{name}_v.h"
}}
void batch_{name}(void *ctx, const double *q, const double *qd, const double *qdd, double *out, size_t count) {{
  (void)ctx;
  for (size_t k = 0; k < count; k += LANES) lanes(q, qd, qdd, out, count, k);
}}
"""

CPPAD = """{includes}
#include <string.h>
void call_{robot}_cg(void *ctx, const double *q, const double *qd, const double *qdd, double *out) {{
  enum {{ N = {joints} }};
  double x[3 * N];
  double const *in[1] = {{x}};
  double *res[1] = {{out}};
  struct LangCAtomicFun atomic;
  (void)ctx;
  memcpy(x, q, N * sizeof *x), memcpy(x + N, qd, N * sizeof *x), memcpy(x + 2 * N, qdd, N * sizeof *x);
  memset(&atomic, 0, sizeof atomic);
  {robot}_forward_zero(in, res, atomic);
}}
"""

TABLE = """#include <string.h>
#include "rnepeer.h"
{declarations}
static const char *const forms[] = {{{forms}}};
static const char *const names[] = {{{names}}};
static const int kinds[] = {{{kinds}}};
static const struct {{ const char *robot, *form; void *function; const double *(*results)(int); }} table[] = {{
{entries}
}};
RP_EXPORT int rp_count(void) {{ return sizeof names / sizeof *names; }}
RP_EXPORT const char *rp_name(int k) {{ return names[k]; }}
RP_EXPORT int rp_kind(int k) {{ return kinds[k]; }}
RP_EXPORT void *rp_func(int k, const char *robot) {{
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (!strcmp(table[i].robot, robot) && !strcmp(table[i].form, forms[k])) return table[i].function;
  return 0;
}}
RP_EXPORT void *rp_open(int k, const char *robot, const char *dir) {{
  (void)dir;
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (!strcmp(table[i].robot, robot) && !strcmp(table[i].form, forms[k])) return (void *)(table + i);
  return 0;
}}
RP_EXPORT const double *rp_result(int k, void *ctx, const double *out, int what) {{
  const double *(*results)(int) = ((const __typeof__(*table) *)ctx)->results;
  (void)k, (void)out;
  return results ? results(what) : 0;
}}
"""


def table(prefix, functions, suffix=""):
    forms = [form for form in FORMS if any(form == f for _, f in functions)]
    has_matrices = [prefix == "call" and len(FORMS[form]) > 2 for _, form in functions]
    results = [f"call_{robot}_{form}_results" if has else "0" for (robot, form), has in zip(functions, has_matrices)]
    return TABLE.format(
        declarations="\n".join(
            [f"extern void {prefix}_{robot}_{form}();" for robot, form in functions]
            + [f"extern const double *{function}(int);" for function in results if function != "0"]
        ),
        forms=", ".join(f'"{form}"' for form in forms),
        names=", ".join(f'"{FORMS[form][0]}{suffix}"' for form in forms),
        kinds=", ".join("RP_ID_BATCH" if prefix == "batch" else FORMS[form][1] for form in forms),
        entries="\n".join(
            f'  {{"{robot}", "{form}", (void *){prefix}_{robot}_{form}, {result}}},'
            for (robot, form), result in zip(functions, results)
        ),
    )


def joints_of(folder, robot):
    return int((folder / "../robots" / f"{robot}.txt").read_text().split()[0])


def generated(folder, suffix):
    """(robot, form) of every file <robot>_<form><suffix>."""
    pattern = re.compile(rf"(\w+)_({'|'.join(FORMS)}){re.escape(suffix)}")
    return sorted(match.groups() for path in folder.iterdir() if (match := pattern.fullmatch(path.name)))


def main():
    folder = Path(sys.argv[1])
    calls = [(robot, form) for robot, form in generated(folder, ".c") if not robot.startswith(("call_", "batch_"))]
    for robot, form in calls:
        quantities = FORMS[form][2:]
        text = MATRICES if quantities else CASADI
        (folder / f"call_{robot}_{form}.c").write_text(
            text.format(
                name=f"{robot}_{form}",
                count=len(quantities),
                joints=joints_of(folder, robot),
                results=", ".join(f"matrices[{i}]" for i in range(len(quantities))),
                choice="".join(f"what == {what} ? matrices[{i}] : " for i, what in enumerate(quantities)),
            )
        )
    batches = generated(folder, "_v.h")
    for robot, form in batches:
        (folder / f"batch_{robot}_{form}.c").write_text(BATCH.format(name=f"{robot}_{form}"))
    for robot, form in generated(folder, ""):  # CppADCodeGen's folders
        sources = sorted(path.name for path in (folder / f"{robot}_cg").glob("*forward_zero*.c"))
        includes = "\n".join(f'#include "{robot}_cg/{source}"' for source in sources)
        (folder / f"call_{robot}_cg.c").write_text(CPPAD.format(includes=includes, robot=robot, joints=joints_of(folder, robot)))
        calls.append((robot, form))
    (folder / "calls.c").write_text(table("call", calls))
    (folder / "batches.c").write_text(table("batch", batches, "_simd"))


if __name__ == "__main__":
    main()
