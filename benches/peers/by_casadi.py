"""CasADi: J, J H J^T, common subexpressions, its own C."""

import os

import casadi
from textbook import ROBOTS, statics

NAME = f"CasADi {casadi.__version__}"
CALL = """static void %(name)s_one(const double *q, double *out) {
    double work[%(work)d + 1];
    const double *arguments[%(arguments)d] = {q};
    double *results[%(results)d] = {out};
    %(name)s(arguments, results, 0, work, 0);
}
"""


def write(folder):
    """The files to compile, each with the flags it needs."""
    functions, calls, ways = [], [], []
    for robot, rows in ROBOTS.items():
        q = casadi.SX.sym("q", len(rows))
        quantities = statics(rows, [q[i] for i in range(len(rows))], casadi.sin, casadi.cos)
        for quantity in ("T", "J", "H", "TJH"):
            entries = casadi.cse(casadi.densify(casadi.vertcat(*quantities[quantity])))
            name = f"{robot}_{quantity}"
            function = casadi.Function(name, [q], [entries])
            assert function.sz_iw() == 0
            functions.append(function)
            sizes = {"work": function.sz_w(), "arguments": function.sz_arg(), "results": function.sz_res()}
            calls.append(CALL % {"name": name, **sizes})
            ways.append(f'{{"{robot}", "{quantity}", "{NAME}", {len(rows)}, {entries.numel()}, .one = {name}_one}}')
            if quantity == "H":
                ways.append(ways[-1].replace('"H"', '"H, batch"').replace(NAME, f"{NAME}, in a loop"))
    generator = casadi.CodeGenerator("casadi_functions.c")
    for function in functions:
        generator.add(function)
    generator.generate(os.path.join(folder, ""))
    (folder / "casadi.c").write_text(
        '#include "casadi_functions.c"\n#include "harness.h"\n' + "".join(calls)
        + "const struct way WAYS[] = {\n    " + ",\n    ".join(ways) + f"\n}};\nconst int WAY_COUNT = {len(ways)};\n"
    )
    return {"casadi.c": []}
