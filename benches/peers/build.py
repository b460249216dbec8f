"""Builds every peer once for each set of compiler flags."""

import importlib
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from textbook import ROBOTS

HERE = Path(__file__).parent
# What the processor may be taken to have: for C and C++, and for Rust.
FLAGS = {
    "none": ([], ""),
    "x86-64-v3": (["-march=x86-64-v3"], "-C target-cpu=x86-64-v3"),
    "native": (["-march=native"], "-C target-cpu=native"),
}
CMEEL = Path(sys.prefix, "lib", f"python3.{sys.version_info.minor}", "site-packages", "cmeel.prefix", "include")
KDL = Path("/usr/include/kdl/chain.hpp")


class Missing(Exception):
    """Why a peer cannot take part."""


def run(*command, **how):
    """Quietly, unless it fails."""
    result = subprocess.run(command, capture_output=True, text=True, **how)
    if result.returncode:
        print(result.stderr, file=sys.stderr)
        raise Missing(f"`{command[0]}` failed")


def generated(name):
    """Prepares a peer that writes C, and compiles it."""

    def prepare(work):
        try:
            files = importlib.import_module(name).write(work)
        except ImportError as error:
            raise Missing(f"pip did not install it; {error}") from error
        return lambda flags: compiled(work, name, flags, ["cc"], {work / file: own for file, own in files.items()})

    return prepare


def library(name, there, hint, arguments, libraries=()):
    """Prepares a peer that is a C++ library, and compiles what calls it."""

    def prepare(work):
        if not there.exists():
            raise Missing(hint)
        command = ["c++", "-std=c++17", "-w", "-DNDEBUG", *arguments]
        return lambda flags: compiled(work, name, flags, command, {HERE / f"{name}.cpp": []}, libraries)

    return prepare


def compiled(work, name, flags, compiler, files, libraries=()):
    program = work / f"{name}-{flags}"
    inputs = [*files, *HERE.glob("*.h*"), HERE / "harness.c", work / "robots.h", HERE / "build.py"]
    if program.exists() and all(file.stat().st_mtime < program.stat().st_mtime for file in inputs):
        return program
    common = ["-O3", *FLAGS[flags][0], f"-I{HERE}", f"-I{work}"]
    objects = []
    for file, own in {**files, HERE / "harness.c": []}.items():
        objects.append(work / f"{file.stem}-{name}-{flags}.o")
        command = ["cc"] if file.suffix == ".c" else compiler
        run(*command, *common, *own, "-c", file, "-o", objects[-1])
    vector = ["-lmvec"] if name == "by_sympy" else []
    run(*compiler, *objects, *libraries, *vector, "-lm", "-o", program)
    return program


def crate(folder, program):
    """Prepares a peer in Rust."""

    def build(work, flags):
        target = work / f"{program}-{flags}"
        command = ["cargo", "build", "--locked", "--quiet", "--release", "--bin", program, "--target-dir", target]
        run(*command, cwd=folder, env={**os.environ, "RUSTFLAGS": FLAGS[flags][1]})
        return target / "release" / program

    return lambda work: lambda flags: build(work, flags)


PEERS = {
    "SymPy": generated("by_sympy"),
    "CasADi": generated("by_casadi"),
    # What its CMake files define; its templates are compiled here, its library is not used.
    "Pinocchio": library(
        "pinocchio", CMEEL / "pinocchio", "pip did not install it",
        ["-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
         "-isystem", CMEEL, "-isystem", CMEEL / "eigen3"],
    ),
    # Debian's library takes 16 bytes for the alignment of what both sides allocate.
    "Orocos KDL": library(
        "kdl", KDL, "apt-get install liborocos-kdl-dev",
        ["-DEIGEN_MAX_ALIGN_BYTES=16", "-isystem", "/usr/include/eigen3"], ["-lorocos-kdl"],
    ),
    "crate k": crate(HERE / "k", "peer-k"),
}


def build(work):
    """Programs by what they are built for, and why peers are left out."""
    header, text = work / "robots.h", ""
    for robot, rows in ROBOTS.items():
        numbers = str(rows).translate(str.maketrans("()[]", "{}{}"))
        text += f"static const double {robot}[{len(rows)}][5] = {numbers};\n"
    if not header.exists() or header.read_text() != text:
        header.write_text(text)
    programs, left_out = {}, {}
    ours = crate(HERE.parent, "peer")(work)
    for flags in FLAGS:
        programs["robstiff", flags] = ours(flags)
    for name, prepare in PEERS.items():
        try:
            peer = prepare(work)
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                built = dict(zip(FLAGS, pool.map(peer, FLAGS)))
            programs.update({(name, flags): program for flags, program in built.items()})
        except (Missing, OSError) as why:
            left_out[name] = str(why)
    return programs, left_out
