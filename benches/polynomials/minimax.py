"""The coefficients of robstiff/src/trig: best polynomials for sine and cosine.

On |r| <= pi/4, and beside tables on |r| <= pi/32 (tables.rs) and pi/256 (circle/double.rs), with z = r^2,

    sin r = r + r z S(z),        cos r = 1 - z/2 + z^2 C(z).

and of a whole angle, |x| <= 3.236 (near.rs), with u = x^2 less the rounded 3.236^2 / 2,

    sin x = x S(u),        cos x = C(u).

S and C are chosen so that the largest error of the sine, relative to r, and of
the cosine is as small as it can be. Such a polynomial of n coefficients misses
by equal amounts of alternating sign at n + 1 points (Chebyshev). Remez: solve
for the coefficients and the error at n + 1 trial points, move the points to the
extremes of the error curve, repeat. Rounding the coefficients one by one,
lowest first, and fitting the others again loses nothing of what the shape gives.

Plain Python, exact to 60 digits: python3 minimax.py
"""

import math
import struct
from decimal import Decimal as D, getcontext
from functools import lru_cache

getcontext().prec = 60
PI = D("3.14159265358979323846264338327950288419716939937510582097494459")


def end(part):
    """The largest z; the rounded multiple of pi can be a little off."""
    return (PI / part * D("1.0005")) ** 2


@lru_cache(maxsize=None)
def tail(z, first):
    """The Taylor series of S (first = 3) or C (first = 4), alternating."""
    term = D(1 if first == 4 else -1) / math.factorial(first)
    total, k = D(0), first
    while abs(term) > D("1e-58"):
        total += term
        term *= -z / ((k + 1) * (k + 2))
        k += 2
    return total


def horner(cs, z):
    total = D(0)
    for c in reversed(cs):
        total = total * z + c
    return total


def solve(rows, right):
    """Gaussian elimination with pivots."""
    n = len(rows)
    m = [row + [b] for row, b in zip(rows, right)]
    for i in range(n):
        p = max(range(i, n), key=lambda k: abs(m[k][i]))
        m[i], m[p] = m[p], m[i]
        for k in range(i + 1, n):
            f = m[k][i] / m[i][i]
            m[k] = [x - f * y for x, y in zip(m[k], m[i])]
    x = [D(0)] * n
    for i in reversed(range(n)):
        x[i] = (m[i][n] - sum(m[i][j] * x[j] for j in range(i + 1, n))) / m[i][i]
    return x


class Small:
    """S (first = 3) or C (first = 4) of an angle near 0, in powers of z."""

    def __init__(self, first, last, _):
        self.first, self.last, self.middle = first, last, D(0)

    def value(self, z):
        return tail(z, self.first)

    def weight(self, z):
        return z if self.first == 3 else z**2

    def order(self, n):
        """The order in which coefficients are rounded."""
        return range(n)


class Whole:
    """S (first = 3) or C (first = 4) of a whole angle, in powers of u."""

    def __init__(self, first, last, single):
        self.first, self.last, self.middle = first, last, rounded(last / 2, single)

    def value(self, z):
        return 1 + z * tail(z, 3) if self.first == 3 else 1 - z / 2 + z * z * tail(z, 4)

    def weight(self, z):
        return D(1)

    def order(self, n):
        """Highest first: powers of u without the lowest are all 0 in the middle."""
        return reversed(range(n))


def remez(shape, fixed):
    """The best coefficients, of which those that are not None are fixed."""
    def error(z, cs):
        return shape.weight(z) * (shape.value(z) - horner(cs, z - shape.middle))
    free = [k for k, c in enumerate(fixed) if c is None]
    known = [c or D(0) for c in fixed]
    n, last = len(free), shape.last
    points = [last * (1 - D(math.cos(math.pi * (i + 0.5) / (n + 1)))) / 2 for i in range(n + 1)]
    for _ in range(8):
        rows, right = [], []
        for i, z in enumerate(points):
            u = z - shape.middle
            rows.append([u**k for k in free] + [(-1) ** i / shape.weight(z)])
            right.append(shape.value(z) - horner(known, u))
        cs = list(known)
        for k, c in zip(free, solve(rows, right)):
            cs[k] = c
        grid = [last * D(i) / 1500 for i in range(1, 1501)]
        values = [error(z, cs) for z in grid]
        extremes, run = [], [0]
        for i in range(1, 1500):
            if (values[i] > 0) == (values[run[-1]] > 0):
                run.append(i)
            else:
                extremes.append(max(run, key=lambda k: abs(values[k])))
                run = [i]
        extremes.append(max(run, key=lambda k: abs(values[k])))
        if len(extremes) < n + 1:
            break
        points = [grid[i] for i in extremes[-(n + 1):]]
    return cs, max(abs(v) for v in values)


def sine(x):
    """By Taylor's series."""
    return x + x**3 * tail(x * x, 3)


def rounded(x, single):
    x = float(x)
    return D(struct.unpack("f", struct.pack("f", x))[0] if single else x)


def fit(shape, n, single):
    cs = [None] * n
    for k in shape.order(n):
        best, _ = remez(shape, cs)
        cs[k] = rounded(best[k], single)
    worst = max(
        abs(shape.weight(z) * (shape.value(z) - horner(cs, z - shape.middle)))
        for z in (shape.last * D(i) / 1500 for i in range(1, 1501))
    )
    return cs, worst


def parts(bits, whole=PI / 2):
    """pi/2 as a sum of numbers with so many bits each."""
    rest, out = whole, []
    for b in bits:
        e = math.frexp(float(rest))[1]
        unit = D(2) ** (e - b)
        part = (rest / unit).to_integral_value() * unit
        out.append(part)
        rest -= part
    return out, rest


if __name__ == "__main__":
    # Of all limits from 3.23 to 3.26 that where what is rounded does least harm, and cos 0 is 1.
    near = D("3.236") ** 2
    for name, single, shape, last, counts in (
        ("f64", False, Small, end(4), (6, 6)),
        ("f64, near", False, Whole, near, (11, 11)),
        ("f64, tables", False, Small, end(32), (3, 3)),
        ("f64, circle", False, Small, end(256), (2,)),
        ("f32", True, Small, end(4), (4, 3)),
        ("f32", True, Small, end(4), (3, 3)),
        ("f32, near", True, Whole, near, (8, 8)),
    ):
        for first, n in zip((3, 4), counts):
            cs, worst = fit(shape(first, last, single), n, single)
            print(name, "sin" if first == 3 else "cos", n, f"largest error {float(worst):.2e} = 2^{math.log2(worst):.1f}")
            for c in cs:
                print("   ", repr(float(c)))
    for name, bits in (("f64", (33, 33, 53)), ("f64 fused", (53, 53, 53)), ("f32", (11, 11, 11, 24)), ("f32 fused", (24, 24, 24))):
        ps, rest = parts(bits)
        print("pi/2", name, [repr(float(p)) for p in ps], f"rest {float(rest):.1e}")
    print("2/pi", repr(float(2 / PI)))
    print("pi/128", [repr(float(p)) for p in parts((53, 53), PI / 128)[0]], "128/pi", repr(float(128 / PI)))
    print("pi/512, f32", [repr(float(p)) for p in parts((24, 24), PI / 512)[0]], "512/pi", repr(float(rounded(512 / PI, True))))
    print("sines of multiples of pi/128", [repr(float(sine(PI * k / 128))) for k in range(65)])
    print("pi/16", [repr(float(p)) for p in parts((53, 53), PI / 16)[0]], "16/pi", repr(float(16 / PI)))
    print("sines of multiples of pi/16", [repr(float(sine(PI * k / 16))) for k in range(16)])
