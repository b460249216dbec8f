"""The robots, and what every peer computes of them, as the textbooks write it."""

# Rows of theta [quarter turns], d [m], a [m], alpha [quarter turns], compliance [rad/Nm].
ROBOTS = {
    # robots/rv130hsc.yaml
    "R5": [
        (0, 0.865, 0.41, -1, 2.97e-7),
        (-1, 0, 1, 0, 2.97e-7),
        (0, 0, 0.25, -1, 3.12e-7),
        (0, 1.1, 0, 1, 1.92e-7),
        (0, 0, 0.3, 0, 78e-7),
    ],
    # benches/robots/six-axis.yaml
    "R6": [
        (0, 0.75, 0.35, -1, 2.6e-7),
        (0, 0, 1.25, 0, 1.5e-7),
        (-1, 0, 0.055, -1, 2.6e-7),
        (0, 1.1, 0, 1, 18e-7),
        (0, 0, 0, -1, 15e-7),
        (0, 0.23, 0, 0, 21e-7),
    ],
}
WRENCH = (300, -500, 700, 40, -60, 80)  # N, Nm
# Sines and cosines of quarter turns.
EXACT = {0: (0, 1), 1: (1, 0), -1: (-1, 0)}
TRIANGLE = [(i, j) for i in range(6) for j in range(i, 6)]


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def statics(rows, q, sin, cos, simplify=lambda x: x):
    """Flat lists, by quantity: T and J by columns (translation first), the upper
    triangle of H_x by rows, all three one after the other, the trace of the
    translational block of H_x, and the deflection under WRENCH.

    Over any numbers or symbols; `simplify` is applied to the entries of frames.
    """
    frames = [[[int(i == j) for j in range(4)] for i in range(4)]]
    for (theta, d, a, alpha, _), angle in zip(rows, q):
        (so, co), (sa, ca) = EXACT[theta], EXACT[alpha]
        s, c = sin(angle), cos(angle)
        s, c = s * co + c * so, c * co - s * so
        link = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        frames.append([[simplify(x) for x in row] for row in product(frames[-1], link)])
    *joints, tip = frames
    columns = []
    for frame in joints:
        axis, arm = [row[2] for row in frame[:3]], [t[3] - f[3] for t, f in zip(tip[:3], frame[:3])]
        columns.append(cross(axis, arm) + axis)
    soft = [row[4] for row in rows]

    def entry(i, j):
        return sum(h * column[i] * column[j] for h, column in zip(soft, columns))

    twists = [h * sum(x * f for x, f in zip(column, WRENCH)) for h, column in zip(soft, columns)]
    quantities = {
        "T": [x for column in zip(*tip) for x in column],
        "J": [x for column in columns for x in column],
        "H": [entry(i, j) for i, j in TRIANGLE],
        "trace": [sum(entry(i, i) for i in range(3))],
        "deflection": [sum(column[i] * twist for column, twist in zip(columns, twists)) for i in range(6)],
    }
    quantities["TJH"] = quantities["T"] + quantities["J"] + quantities["H"]
    return quantities


def units(quantity, joints):
    """What can be compared with what: a number an entry, the same for the same unit."""
    kinds = {
        "T": [int(k >= 12) for k in range(16)],
        "J": [2 + int(k % 6 < 3) for k in range(6 * joints)],
        "H": [4 + (i < 3) + (j < 3) for i, j in TRIANGLE],
        "trace": [7],
        "deflection": [8 + int(k < 3) for k in range(6)],
    }
    return kinds["T"] + kinds["J"] + kinds["H"] if quantity == "TJH" else kinds[quantity]
