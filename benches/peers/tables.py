"""What was measured, as Markdown."""

import datetime
import subprocess
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
SINGLE = {"T": "T", "J": "J", "H": "H_x", "TJH": "T, J and H_x"}
BATCH = {"H, batch": "H_x", "trace, batch": "trace", "deflection, batch": "deflection"}
BATCH_F32 = {f"{name}, f32": f"{title}, f32" for name, title in BATCH.items()}
OURS = "robstiff"


def own(way):
    return way.startswith(OURS)


def comparable(way):
    """Ours that does the peers' work: they keep every result."""
    return own(way) and not way.endswith("by block")


def number(x):
    return f"{x:.1f}" if x < 99.95 else f"{x:.0f}"


def bold(cell):
    return cell and f"**{cell}**"


class Times:
    """The least times by way, flags, quantity and robot."""

    def __init__(self, least):
        self.least = least
        self.robots = sorted({robot for *_, robot in least})

    def best(self, quantity, robot, way=lambda way: True, flags=lambda flags: True):
        found = [x for (w, f, q, r), x in self.least.items() if (q, r) == (quantity, robot) and way(w) and flags(f)]
        return min(found, default=None)

    def cell(self, quantity, **which):
        """Both robots."""
        found = [self.best(quantity, robot, **which) for robot in self.robots]
        return "" if None in found else " / ".join(map(number, found))

    def gain(self, quantity, **flags):
        """The best peer's time by ours; nothing where no peer has one."""
        peers = [self.best(quantity, robot, lambda way: not own(way), **flags) for robot in self.robots]
        ours = [self.best(quantity, robot, comparable, **flags) for robot in self.robots]
        if None in peers + ours:
            return ""
        return " / ".join(f"{peer / our:.2f}" for peer, our in zip(peers, ours))

    def ways(self, quantities):
        """In the order of their times."""
        speed = {}
        for (way, _, quantity, _), x in self.least.items():
            if quantity in quantities:
                speed[way] = min(speed.get(way, x), x)
        return sorted(speed, key=speed.get)


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def short(times):
    """Of each the best of its builds."""
    columns = {**SINGLE, "H, batch": "H_x, many poses"}
    names = list(dict.fromkeys(way.split(", ")[0] for way in times.ways(["H"])))
    unflagged = {"flags": lambda flags: flags == "none"}

    def row(name, **flags):
        return [
            times.cell(q, way=lambda way: way.split(", ")[0] == name and not way.endswith("by block"), **flags)
            for q in columns
        ]

    rows = [[name, *row(name)] for name in names]
    rows.append(["**best peer / robstiff**", *(bold(times.gain(q)) for q in columns)])
    rows.append(["robstiff, no flags", *row(OURS, **unflagged)])
    rows.append(["best peer / robstiff, no flags for either", *(times.gain(q, **unflagged) for q in columns)])
    return table([f"ns a pose, {' / '.join(times.robots)}", *columns.values()], rows)


def full(times, columns):
    """Every build."""
    rows = [
        [way, flags, *(times.cell(q, way=lambda w: w == way, flags=lambda f: f == flags) for q in columns)]
        for way in times.ways(columns)
        for flags in dict.fromkeys(flags for w, flags, q, _ in times.least if w == way and q in columns)
    ]
    rows.append(["**best peer / robstiff**", "best", *(bold(times.gain(q)) for q in columns)])
    return table([f"ns a pose, {' / '.join(times.robots)}", "flags", *columns.values()], rows)


def machine():
    def output(*command):
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    cpu = dict(line.split(":", 1) for line in output("lscpu").splitlines() if ":" in line)
    cpu = {key.strip(): value.strip() for key, value in cpu.items()}
    wide = "AVX-512" if "avx512f" in cpu["Flags"] else "AVX2" if "avx2" in cpu["Flags"] else "SSE2"
    compilers = [output("cc", "--version").splitlines()[0].split()[-1], output("rustc", "--version").split()[1]]
    return (
        f"{datetime.date.today()}, {cpu['Model name']} (family {cpu['CPU family']}, model {cpu['Model']}; {wide}), "
        f"one core of {cpu['CPU(s)']}, gcc {compilers[0]}, rustc {compilers[1]}"
    )


def publish(least, agreement, left_out, write):
    """Prints both texts, and puts them in their files if told to."""
    times, missing = Times(least), "".join(f"\n{name} is left out: {why}.\n" for name, why in left_out.items())
    texts = {
        "README.md": f"{machine()}:\n\n{short(times)}{missing}",
        "benches/README.md": (
            f"{machine()}. {agreement}\n{missing}\nOne pose a call, f64:\n\n{full(times, SINGLE)}\n"
            f"Many poses a call, f64:\n\n{full(times, BATCH)}\nand f32:\n\n{full(times, BATCH_F32)}"
        ),
    }
    for file, text in texts.items():
        print(f"== {file}\n\n{text}")
        if write:
            old = (ROOT / file).read_text()
            before, rest = old.split("<!-- peers/run -->\n")
            _, after = rest.split("<!-- end -->\n")
            (ROOT / file).write_text(f"{before}<!-- peers/run -->\n{text}<!-- end -->\n{after}")
