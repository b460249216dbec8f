"""SymPy: simplified frames, J, J H J^T, common subexpressions, C."""

import sympy
from textbook import ROBOTS, statics

NAME = f"SymPy {sympy.__version__}"
LOOP = ", gcc with a vector libm"
VECTOR = ["H", "trace", "deflection"]


def lines(entries):
    """Assignments to shared names, and the entries."""
    shared, results = sympy.cse(entries, symbols=sympy.numbered_symbols("x"))
    return [f"const real {name} = {sympy.ccode(value)};" for name, value in shared], [sympy.ccode(x) for x in results]


def write(folder):
    """The files to compile, each with the flags it needs."""
    single, ways, loops = [], [], []
    for robot, rows in ROBOTS.items():
        q = sympy.symbols(f"q0:{len(rows)}")
        quantities = statics(rows, q, sympy.sin, sympy.cos, sympy.trigsimp)
        head = f'{{"{robot}", "%s", "{NAME}%s", {len(rows)}, %d, %s}}'
        for quantity, entries in quantities.items():
            shared, results = lines([sympy.sympify(x) for x in entries])
            name = f"{robot}_{quantity}"
            if quantity in VECTOR:
                body = [f"const real q{i} = q[{i}][k];" for i in range(len(rows))] + shared
                body += [f"out[{e}][k] = {x};" for e, x in enumerate(results)]
                loops.append(
                    f"void NAME({name})(const real (*restrict q)[COUNT], real (*restrict out)[COUNT]) {{\n"
                    "    #pragma omp simd\n    for (int k = 0; k < COUNT; k++) {\n        "
                    + "\n        ".join(body) + "\n    }\n}\n"
                )
                ways.append(head % (f"{quantity}, batch", LOOP, len(entries), f".all = {name}_f64"))
                ways.append(head % (f"{quantity}, batch, f32", LOOP, len(entries), f".all_f32 = {name}_f32"))
                for real, bits in [("double", 64), ("float", 32)]:
                    single.append(f"void {name}_f{bits}(const {real} (*)[COUNT], {real} (*)[COUNT]);\n")
            if quantity in ("T", "J", "H", "TJH"):
                body = [f"const real q{i} = q[{i}];" for i in range(len(rows))] + shared
                body += [f"out[{e}] = {x};" for e, x in enumerate(results)]
                single.append(
                    f"static void {name}(const real *restrict q, real *restrict out) {{\n    "
                    + "\n    ".join(body) + "\n}\n"
                )
                ways.append(head % (quantity, "", len(entries), f".one = {name}"))
    top = '#include <tgmath.h>\n#include "harness.h"\n'
    (folder / "sympy.c").write_text(
        top + "typedef double real;\n" + "".join(single)
        + "const struct way WAYS[] = {\n    " + ",\n    ".join(ways) + f"\n}};\nconst int WAY_COUNT = {len(ways)};\n"
    )
    for real, bits in [("double", 64), ("float", 32)]:
        (folder / f"sympy_f{bits}.c").write_text(
            top + f"typedef {real} real;\n#define NAME(name) name##_f{bits}\n" + "".join(loops)
        )
    # Sines and cosines of one angle must not be joined in one call, of which there is no vector version.
    fast = ["-fopenmp-simd", "-ffast-math", "-fdisable-tree-sincos", "-mprefer-vector-width=512"]
    return {"sympy.c": [], "sympy_f64.c": fast, "sympy_f32.c": [*fast, "-fsingle-precision-constant"]}
