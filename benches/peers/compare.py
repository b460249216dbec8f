"""H_x of the five-axis arm by SymPy and CasADi, as C, against ours.

The same table, the same poses, the upper triangle of H_x. Processes take turns,
and of each function the least time of all turns counts: what else the machine
does makes things slower only.
"""

import math
import subprocess
import sys
from pathlib import Path

import casadi
import sympy

WORK = Path(sys.argv[1])
HERE = Path(__file__).parent
# theta and alpha in quarter turns, d, a, compliance: robots/rv130hsc.yaml
ROWS = [
    (0, 0.865, 0.41, -1, 2.97e-7),
    (-1, 0, 1, 0, 2.97e-7),
    (0, 0, 0.25, -1, 3.12e-7),
    (0, 1.1, 0, 1, 1.92e-7),
    (0, 0, 0.3, 0, 78e-7),
]
EXACT = {0: (0, 1), 1: (1, 0), -1: (-1, 0)}
ROUNDS = 15


def chain(q, sin, cos, matrix, product):
    """Axes and origins of the joints, and the tip, with exact quarter turns."""
    frame, joints = None, []
    for i, (theta, d, a, alpha, _) in enumerate(ROWS):
        (so, co), (sa, ca) = EXACT[theta], EXACT[alpha]
        s, c = sin(q[i]), cos(q[i])
        s, c = s * co + c * so, c * co - s * so
        row = matrix([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])
        joints.append(frame)
        frame = row if frame is None else product(frame, row)
    return joints, frame


def by_sympy():
    """Simplified transforms, J, J H J^T, then common subexpressions."""
    q = sympy.symbols("q0:5")
    joints, tip = chain(q, sympy.sin, sympy.cos, sympy.Matrix, lambda a, b: (a * b).applyfunc(sympy.trigsimp))
    columns = []
    for frame in joints:
        frame = sympy.eye(4) if frame is None else frame
        z, p = frame[:3, 2], frame[:3, 3]
        columns.append(sympy.Matrix.vstack(z.cross(tip[:3, 3] - p), z))
    jacobian = sympy.Matrix.hstack(*columns)
    full = jacobian * sympy.diag(*[row[4] for row in ROWS]) * jacobian.T
    entries = [full[i, j] for i in range(6) for j in range(i, 6)]
    shared, results = sympy.cse(entries, symbols=sympy.numbered_symbols("x"))
    lines = [f"const double {name} = {sympy.ccode(value)};" for name, value in shared]
    lines += [f"out[{k}] = {sympy.ccode(value)};" for k, value in enumerate(results)]
    arguments = ", ".join(f"double q{i}" for i in range(5))
    body = "\n    ".join(lines)
    each = "\n        ".join(
        [f"const double q{i} = q[{i}][k];" for i in range(5)]
        + [line.replace("out[", "out[").replace("] =", "][k] =", 1) if line.startswith("out") else line for line in lines]
    )
    (WORK / "sympy.c").write_text(
        f"#include <math.h>\nvoid sympy_one({arguments}, double *restrict out) {{\n    {body}\n}}\n"
    )
    (WORK / "sympy_many.c").write_text(
        "#include <math.h>\nvoid sympy_many(const double (*restrict q)[1024], double (*restrict out)[1024]) {\n"
        f"    #pragma omp simd\n    for (int k = 0; k < 1024; k++) {{\n        {each}\n    }}\n}}\n"
    )


def by_casadi():
    q = casadi.SX.sym("q", 5)

    def matrix(rows):
        return casadi.vertcat(*[casadi.horzcat(*row) for row in rows])

    joints, tip = chain([q[i] for i in range(5)], casadi.sin, casadi.cos, matrix, casadi.mtimes)
    columns = []
    for frame in joints:
        frame = casadi.SX.eye(4) if frame is None else frame
        z, p = frame[:3, 2], frame[:3, 3]
        columns.append(casadi.vertcat(casadi.cross(z, tip[:3, 3] - p), z))
    jacobian = casadi.horzcat(*columns)
    full = jacobian @ casadi.diag(casadi.SX([row[4] for row in ROWS])) @ jacobian.T
    entries = casadi.cse(casadi.vertcat(*[full[i, j] for i in range(6) for j in range(i, 6)]))
    function = casadi.Function("casadi_one", [q], [entries])
    function.generate("casadi.c")
    (WORK / "casadi.c").write_text(Path("casadi.c").read_text())
    Path("casadi.c").unlink()


def build():
    by_sympy()
    by_casadi()
    cc = ["cc", "-O3", "-march=native", "-fopenmp-simd", "-c"]
    for name, more in [("sympy", []), ("casadi", []), ("sympy_many", ["-ffast-math", "-fdisable-tree-sincos"])]:
        subprocess.run([*cc, *more, WORK / f"{name}.c", "-o", WORK / f"{name}.o"], check=True)
    objects = [WORK / f"{name}.o" for name in ("sympy", "casadi", "sympy_many")]
    subprocess.run(
        ["cc", "-O3", "-march=native", HERE / "harness.c", *objects, "-lmvec", "-lm", "-o", WORK / "harness"], check=True
    )


def lines(program, what):
    text = subprocess.run([program, what], check=True, capture_output=True, text=True).stdout
    return [line.split("\t") for line in text.splitlines()]


def check(programs):
    """Every entry of every program against the first, relative to the largest of its kind."""
    values = {}
    for label, program in programs.items():
        for name, value in lines(program, "check"):
            values.setdefault(f"{label}: {name}", []).append(float(value))
    first = next(iter(values.values()))
    kinds = [(i < 3) + (j < 3) for i in range(6) for j in range(i, 6)]
    size = [max(abs(x) for x, kind in zip(first, kinds * 64) if kind == k) for k in range(3)]
    for name, own in values.items():
        assert len(own) == len(first) == 64 * 21, name
        off = max(abs(x - y) / size[kind] for x, y, kind in zip(own, first, kinds * 64))
        assert off < 1e-12, f"{name} is off by {off:.1e}"
    print(f"{len(values)} ways agree to 1e-12 at 64 poses")


def main():
    build()
    programs = {"C": WORK / "harness"}
    for level in ("default", "x86-64-v3", "native"):
        programs[f"robstiff, {level}"] = next((WORK / level).glob("release/peer"))
    check(programs)
    least = {}
    for _ in range(ROUNDS):
        for label, program in programs.items():
            for name, nanoseconds in lines(program, "time"):
                key = f"{label}: {name}"
                least[key] = min(least.get(key, math.inf), float(nanoseconds))
    print(subprocess.run(["lscpu"], capture_output=True, text=True).stdout.split("Model name:")[1].split("\n")[0].strip())
    casadi_time = least["C: CasADi"]
    print(f"{'H_x of five axes':<40} {'ns':>7} {'CasADi / this':>14}")
    for name, nanoseconds in sorted(least.items(), key=lambda item: -item[1]):
        print(f"{name:<40} {nanoseconds:7.1f} {casadi_time / nanoseconds:14.2f}")


main()
