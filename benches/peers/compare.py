"""Others' T, J and H_x of two arms against ours, single poses and batches.

All must agree with the textbook first. Then processes take turns, and of each
function the least time of all turns counts: what else the machine does makes
things slower only.
"""

import math
import subprocess
import sys
from pathlib import Path

import tables
from build import build
from textbook import ROBOTS, statics, units

POSES = 64
ROUNDS = 15


def lines(program, what):
    """Robot, quantity, way and numbers."""
    text = subprocess.run([program, what], check=True, capture_output=True, text=True).stdout
    for line in text.splitlines():
        robot, quantity, way, *numbers = line.split("\t")
        yield robot, quantity, way, [float(x) for x in numbers]


def reference():
    """What the textbook says of the first poses, by robot and quantity."""
    values = {}
    for robot, rows in ROBOTS.items():
        for k in range(POSES):
            q = [2.0 * math.sin(1.7 * k + 2.3 * i) for i in range(len(rows))]
            for quantity, entries in statics(rows, q, math.sin, math.cos).items():
                values.setdefault((robot, quantity), []).extend(entries)
    return values


def check(programs):
    """Every entry of every way, relative to the largest of its unit; what to say of it."""
    expected = reference()
    worst, ways = {"f64": 0.0, "f32": 0.0}, 0
    for (_, flags), program in programs.items():
        for robot, quantity, way, own in lines(program, "check"):
            kind, precision = quantity.split(",")[0], "f32" if quantity.endswith("f32") else "f64"
            right = expected[robot, kind]
            unit = units(kind, len(ROBOTS[robot])) * POSES
            largest = {u: max(abs(x) for x, v in zip(right, unit) if u == v) for u in set(unit)}
            assert len(own) == len(right) == len(unit), (way, quantity)
            # Not `max`, which would pass over a NaN.
            offs = [abs(x - y) / largest[u] for x, y, u in zip(own, right, unit)]
            limit = 1e-12 if precision == "f64" else 1e-5
            if not all(off < limit for off in offs):
                sys.exit(f"{way} ({flags}): {quantity} of {robot} is off by {max(offs):.1e}")
            worst[precision] = max(worst[precision], *offs)
            ways += 1
    return (
        f"All {ways} functions agree with the textbook's formulas at {POSES} poses: in f64 to {worst['f64']:.0e} of "
        f"the largest entry of the same unit (1e-12 is asked for), in f32 to {worst['f32']:.0e}."
    )


def main():
    work = Path(sys.argv[1])
    programs, left_out = build(work)
    agreement = check(programs)
    print(agreement, file=sys.stderr)
    least = {}
    for _ in range(ROUNDS):
        for (_, flags), program in programs.items():
            for robot, quantity, way, (nanoseconds,) in lines(program, "time"):
                key = (way, flags, quantity, robot)
                least[key] = min(least.get(key, math.inf), nanoseconds)
    tables.publish(least, agreement, left_out, "--write" in sys.argv[2:])


main()
