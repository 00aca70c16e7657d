"""wrap.py GENERATED: plugin sources around the generated C files in the folder GENERATED.

call_<robot>_<form>.c   one state per call
batch_<robot>_<form>.c  many states per call, LANES at a time
calls.c, batches.c      the tables of the two plugins (native/rnepeer.h)
"""

import re
import sys
from pathlib import Path

FORMS = ["dh", "jf", "base", "pin", "cg"]
NAMES = {"dh": "casadi_dh", "jf": "casadi_jf", "base": "casadi_base", "pin": "pin_casadi", "cg": "pin_cppadcg"}

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
static const struct {{ const char *robot, *form; void *function; }} table[] = {{
{entries}
}};
RP_EXPORT int rp_count(void) {{ return sizeof names / sizeof *names; }}
RP_EXPORT const char *rp_name(int k) {{ return names[k]; }}
RP_EXPORT int rp_kind(int k) {{ return (void)k, {kind}; }}
RP_EXPORT void *rp_func(int k, const char *robot) {{
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (!strcmp(table[i].robot, robot) && !strcmp(table[i].form, forms[k])) return table[i].function;
  return 0;
}}
RP_EXPORT void *rp_open(int k, const char *robot, const char *dir) {{ return (void)k, (void)robot, (void)dir, (void *)0; }}
"""


def table(prefix, functions, kind, suffix=""):
    forms = sorted({form for _, form in functions}, key=FORMS.index)
    return TABLE.format(
        declarations="\n".join(f"extern void {prefix}_{robot}_{form}();" for robot, form in functions),
        forms=", ".join(f'"{form}"' for form in forms),
        names=", ".join(f'"{NAMES[form]}{suffix}"' for form in forms),
        entries="\n".join(f'  {{"{robot}", "{form}", (void *){prefix}_{robot}_{form}}},' for robot, form in functions),
        kind=kind,
    )


def generated(folder, suffix):
    """(robot, form) of every file <robot>_<form><suffix>."""
    pattern = re.compile(rf"(\w+)_({'|'.join(FORMS)}){re.escape(suffix)}")
    return sorted(match.groups() for path in folder.iterdir() if (match := pattern.fullmatch(path.name)))


def main():
    folder = Path(sys.argv[1])
    calls = [(robot, form) for robot, form in generated(folder, ".c") if not robot.startswith(("call_", "batch_"))]
    for robot, form in calls:
        (folder / f"call_{robot}_{form}.c").write_text(CASADI.format(name=f"{robot}_{form}"))
    batches = generated(folder, "_v.h")
    for robot, form in batches:
        (folder / f"batch_{robot}_{form}.c").write_text(BATCH.format(name=f"{robot}_{form}"))
    for robot, form in generated(folder, ""):  # CppADCodeGen's folders
        sources = sorted(path.name for path in (folder / f"{robot}_cg").glob("*forward_zero*.c"))
        joints = int((folder / "../robots" / f"{robot}.txt").read_text().split()[0])
        includes = "\n".join(f'#include "{robot}_cg/{source}"' for source in sources)
        (folder / f"call_{robot}_cg.c").write_text(CPPAD.format(includes=includes, robot=robot, joints=joints))
        calls.append((robot, form))
    (folder / "calls.c").write_text(table("call", calls, "RP_ID"))
    (folder / "batches.c").write_text(table("batch", batches, "RP_ID_BATCH", "_simd"))


if __name__ == "__main__":
    main()
