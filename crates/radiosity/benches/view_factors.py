#!/usr/bin/env python3
"""View factors of a box in a box, beside any other program for them that is installed: CPU and wall seconds, memory, the
row sums, and the factors against a reference of our own, computed at a thousandth of the tightest tolerance.

    python3 crates/radiosity/benches/view_factors.py [N ...]       N = 5, 10 by default; 20 and 40 take minutes and gigabytes

Needs NumPy and `cargo build --release`. Looked for are View3D on the PATH (`View3D` or `view3d`) and pyviewfactor's package.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
OURS = HERE.parents[2] / "target/release/fredholm"
PYVIEWFACTOR = """
import sys, numpy as np, pyvista as pv, pyviewfactor as pvf
mesh = pv.read(sys.argv[1]); np.savez(sys.argv[2], F=pvf.compute_viewfactor_matrix(mesh))
"""


def timed(command):
    """CPU seconds, wall seconds and peak megabytes of a command."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) not in (0, 3):
        sys.exit(f"{command[0]} ended with {os.waitstatus_to_exitcode(status)}")
    return usage.ru_utime + usage.ru_stime, time.perf_counter() - start, usage.ru_maxrss / 1024


def ours(mesh, tolerance, out):
    numbers = timed([OURS, "viewfactors", mesh, "--tolerance", str(tolerance), "-o", out])
    with np.load(out) as file:
        return numbers, file["F"], file["error"], file["areas"]


def as_vs3(mesh, out, tolerance):
    """The same mesh as View3D reads it."""
    vertices, faces = [], []
    for line in mesh.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append(rest)
        elif word == "f":
            faces.append(rest)
    lines = ["T box in a box", f"C eps={tolerance:g} out=0", "F 3"]
    lines += [f"V {k} {' '.join(v)}" for k, v in enumerate(vertices, 1)]
    lines += [f"S {k} {' '.join(f)} 0 0 0 0.9 s{k}" for k, f in enumerate(faces, 1)]
    out.write_text("\n".join(lines + ["End of data", ""]))


def view3d(program, mesh, tolerance, folder):
    source, out = folder / "box.vs3", folder / "box.txt"
    as_vs3(mesh, source, tolerance)
    numbers = timed([program, source, out])
    values = np.array(" ".join(out.read_text().splitlines()[1:]).split(), float)
    n = round(np.sqrt(len(values) + 1)) - 1  # n areas, n² factors, n emittances
    return numbers, values[n : n + n * n].reshape(n, n)


def row(program, numbers, factors, reference, known, said=None):
    cpu, wall, memory = numbers
    defect = abs(factors.sum(axis=1) - 1).max()
    l1 = abs(factors - reference).sum() / reference.sum()
    off = 100 * np.mean(abs(factors - reference)[known] > 0.05 * reference[known])
    told = "" if said is None else f"  said {said.sum() / reference.sum():.1e}"
    print(f"  {program:28} {cpu:8.2f} {wall:8.2f} {memory:8.0f} {defect:10.1e} {l1:10.1e} {off:8.2f} %{told}", flush=True)


def main():
    folder = Path(tempfile.mkdtemp())
    for n in map(int, sys.argv[1:] or ["5", "10"]):
        subprocess.run([sys.executable, HERE / "box_in_a_box.py", str(n), folder], check=True)
        mesh = folder / f"box-{n}.obj"
        _, reference, uncertain, areas = ours(mesh, 1e-6, folder / "reference.npz")
        known = reference > 100 * uncertain  # to a hundredth at least
        print(f"{len(areas)} triangles{'CPU s':>21} {'wall s':>8} {'MB':>8} {'row sums':>10} {'L1':>10} {'> 5 % off':>10}")
        for tolerance in (1e-2, 1e-3, 1e-4):
            numbers, factors, said, _ = ours(mesh, tolerance, folder / "ours.npz")
            row(f"fredholm {tolerance:.0e}", numbers, factors, reference, known, said)
        program = shutil.which("View3D") or shutil.which("view3d")
        if program:
            for tolerance in (1e-3, 1e-4):
                numbers, factors = view3d(program, mesh, tolerance, folder)
                row(f"View3D {tolerance:.0e}", numbers, factors, reference, known)
        if find_spec("pyviewfactor"):
            out = folder / "pyviewfactor.npz"
            numbers = timed([sys.executable, "-c", PYVIEWFACTOR, mesh, out])
            row("pyviewfactor", numbers, np.load(out)["F"], reference, known)
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
