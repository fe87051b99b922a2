#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh_batch.py [options] FOLDER... -- import every mesh of a folder and compare it with sums of another reader.

A row for each file goes to standard output, tab-separated: the exit status and the volume, area and number of open
edges that struct-import reports, the same from this script, and what differs.  The script reads STL, OBJ, OFF, ANSYS
archives and g_struct files itself; other formats are read by meshio (Debian: python3-meshio) where this Python has it,
and are otherwise imported without a comparison.  Volumes are compared where the surface is closed.  share/doc/mesh-batch.md tells how to read
the table.  Status 1 if a file differs, crashes the program or runs out of time."""
import argparse
import contextlib
import io
import math
import os
import struct
import subprocess
import sys
import tempfile

try:
    import meshio
except ImportError:
    meshio = None

ENDS = {".stl", ".obj", ".off", ".ply", ".inp", ".cdb", ".dat", ".bdf", ".nas", ".msh", ".vtk", ".vtu", ".vtp"}
# Faces of solids by their corners, and shells, as meshio calls the cells; orders above one follow the corners.
SOLID = {
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
}
SHELL = {"triangle": 3, "quad": 4}


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def read_stl(path):
    data = open(path, "rb").read()
    n = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else -1
    points, faces = [], []
    if n >= 0 and len(data) == 84 + 50 * n:
        for k in range(n):
            x = struct.unpack_from("<12f", data, 84 + 50 * k)[3:]
            points += [x[0:3], x[3:6], x[6:9]]
    else:
        for line in data.decode("latin-1").splitlines():
            w = line.split()
            if len(w) == 4 and w[0].lower() == "vertex":
                points.append(tuple(float(c) for c in w[1:]))
    faces = [(k, k + 1, k + 2) for k in range(0, len(points) - 2, 3)]
    return points, faces


def read_obj(path):
    points, faces = [], []
    for line in open(path, encoding="latin-1").read().replace("\\\n", " ").splitlines():
        w = line.split("#")[0].split()
        if w and w[0] == "v":
            points.append(tuple(float(c) for c in w[1:4]))
        elif w and w[0] == "f":
            at = [int(c.split("/")[0]) for c in w[1:]]
            faces.append(tuple(k - 1 if k > 0 else len(points) + k for k in at))
    return points, faces


def read_off(path):
    text = [line.split("#")[0].split() for line in open(path, encoding="latin-1")]
    text = [row for row in text if row]
    if not text[0][0][0].isdigit():
        if not text[0][0].endswith("OFF") or "4" in text[0][0] or "n" in text[0][0]:
            raise ValueError("kind " + text[0][0])
        text[0] = text[0][1:]
    counts = []
    while len(counts) < 2:
        counts += [int(c) for c in text.pop(0)]
    points = [tuple(float(c) for c in text.pop(0)[:3]) for _ in range(counts[0])]
    faces = []
    for _ in range(counts[1]):
        row = text.pop(0)
        while len(row) < 1 + int(row[0]):
            row = row + text.pop(0)
        faces.append(tuple(int(c) for c in row[1 : 1 + int(row[0])]))
    return points, [f for f in faces if len(f) > 2]


def read_gstruct(path):
    points, faces, base = [], [], 0
    for line in open(path, encoding="latin-1"):
        w = line.split("#")[0].split()
        if w and w[0] == "part":
            base = len(points)
        elif w and w[0] == "v":
            points.append(tuple(float(c) for c in w[1:4]))
        elif w and w[0] == "t":
            faces.append(tuple(base + int(c) for c in w[1:4]))
        elif w and w[0] == "cone":
            raise ValueError("has cones")
    return points, faces


# Corners of the ANSYS types whose shape does not depend on their nodes; others are bricks or quadrilaterals.
ANSYS_TET = {87, 92, 98, 123, 127, 148, 168, 187, 227, 232, 237, 285, 291}
ANSYS_SHELL = {28, 41, 43, 63, 93, 131, 132, 157, 181, 281}


def ansys_cells(number, node):
    """Cells, as meshio calls them, of an ANSYS element: collapsed bricks repeat corners."""
    if number in ANSYS_SHELL:
        loop = list(dict.fromkeys(node[:4]))
        return [("triangle" if len(loop) == 3 else "quad", loop)]
    if number in ANSYS_TET:
        return [("tetra", node[:4])]
    a, b = list(dict.fromkeys(node[:4])), list(dict.fromkeys(node[4:8]))
    if len(b) == 1:
        return [("tetra" if len(a) == 3 else "pyramid", a + b)]
    return [("wedge", a + b)] if len(a) == 3 else [("hexahedron", node[:8])]


def read_cdb(path):
    index, points, types, cells = {}, [], {}, []
    lines = iter(open(path, encoding="latin-1").read().splitlines())

    def fields(line, width):
        return [line[k : k + width].strip() for k in range(0, len(line.rstrip()), width)]

    for line in lines:
        w = [c.strip() for c in line.upper().split(",")]
        if w[0] == "ET":
            digits = "".join(c for c in w[2] if c.isdigit())
            types[int(w[1])] = int(digits)
        elif w[0] == "NBLOCK":
            form = next(lines).strip().lower()
            n, width = int(form[1 : form.index("i")]), int(form[form.index("i") + 1 : form.index(",")])
            wide = int(form.split("e")[1].split(".")[0])
            for row in lines:
                if row.startswith("N,") or row.strip() == "-1":
                    break
                x = [float(c) if c else 0.0 for c in fields(row[n * width :], wide)][:3]
                index[int(row[:width])] = len(points)
                points.append(tuple(x + [0.0] * (3 - len(x))))
        elif w[0] == "EBLOCK" and len(w) > 2 and w[2] == "SOLID":
            form = next(lines).strip().lower()
            width = int(form[form.index("i") + 1 : form.index(")")])
            for row in lines:
                head = [int(c or 0) for c in fields(row, width)]
                if head[0] == -1:
                    break
                node, want = head[11:], head[8]
                while len(node) < want:
                    node += [int(c or 0) for c in fields(next(lines), width)]
                cells.append((types.get(head[1], 0), node[:want]))
    out = []
    for number, node in cells:
        for kind, corner in ansys_cells(number, node):
            out.append((kind, [index[k] for k in corner]))
    return points, skin_of(out, points)


def read_bulk_as(end):
    """meshio goes by the end of the name."""

    def read(path):
        with tempfile.NamedTemporaryFile("w", suffix=end) as f:
            f.write(open(path, encoding="latin-1").read())
            f.flush()
            return read_bulk(f.name)

    return read


def read_bulk(path):
    """A deck that starts without BEGIN BULK, which meshio needs."""
    try:
        return read_meshio(path)
    except (Exception, SystemExit) as e:
        if "BEGIN BULK" not in str(e):
            raise
    with tempfile.NamedTemporaryFile("w", suffix=".bdf") as f:
        f.write("BEGIN BULK\n" + open(path, encoding="latin-1").read() + "\nENDDATA\n")
        f.flush()
        return read_meshio(f.name)


def read_meshio(path):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        mesh = meshio.read(path)
    points = [tuple(float(c) for c in list(p) + [0.0] * (3 - len(p))) for p in mesh.points]
    return points, skin_of(
        [(block.type.rstrip("0123456789"), [int(k) for k in cell]) for block in mesh.cells for cell in block.data],
        points)


def skin_of(cells, points):
    """Shells, and the faces of solids that no other solid has."""
    faces, once = [], {}
    for kind, cell in cells:
        if kind in SHELL:
            faces.append(tuple(cell[: SHELL[kind]]))
        for f in SOLID.get(kind, ()):
            loop = []
            for k in f:
                if cell[k] not in loop:
                    loop.append(cell[k])
            if len(loop) > 2:
                once.setdefault(tuple(sorted(loop)), []).append((tuple(loop), cell))
    skin = set()
    for (loop, cell), *others in once.values():
        if others:
            continue
        middle = [sum(points[k][i] for k in cell) / len(cell) for i in range(3)]
        normal = cross(sub(points[loop[1]], points[loop[0]]), sub(points[loop[2]], points[loop[0]]))
        skin.add(tuple(sorted(loop)))
        faces.append(loop if dot(normal, sub(points[loop[0]], middle)) >= 0 else tuple(reversed(loop)))
    kept, seen = [], set()
    for f in reversed(faces):  # shells stand first: those on faces of solids add nothing
        key = tuple(sorted(f))
        if key not in seen and (key not in once or key in skin):
            seen.add(key)
            kept.append(f)
    return kept if once else faces


def sums(points, faces):
    """Volume (None where edges do not balance), area, open edges, after equal points are made one."""
    index, at = {}, []
    for p in points:
        at.append(index.setdefault(p, len(index)))
    edges, volume, area = {}, 0.0, 0.0
    o = points[faces[0][0]]
    for f in faces:
        c = [at[k] for k in f]
        c = [k for i, k in enumerate(c) if k != c[i - 1]]
        if len(c) < 3 or len(set(c)) < len(c):
            continue
        for i, k in enumerate(c):
            a, b = c[i - 1], k
            key = (min(a, b), max(a, b))
            n = edges.get(key, (0, 0))
            edges[key] = (n[0] + 1, n[1] + (1 if a < b else -1))
        for i in range(1, len(f) - 1):
            x, y, z = (sub(points[f[j]], o) for j in (0, i, i + 1))
            n = cross(sub(y, x), sub(z, x))
            area += 0.5 * math.sqrt(dot(n, n))
            volume += dot(x, n) / 6.0
    opened = sum(1 for n, _ in edges.values() if n == 1)
    balanced = all(d == 0 for _, d in edges.values())
    return abs(volume) if balanced else None, area, opened


def run_import(program, options, path, seconds):
    with tempfile.TemporaryDirectory() as folder:
        command = [program] + options + ["-o", os.path.join(folder, "out"), path]
        try:
            p = subprocess.run(command, capture_output=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return "time", None, None, None, "more than %g s" % seconds
    lines = p.stderr.decode("latin-1").splitlines()
    volume = area = opened = None
    for k, line in enumerate(lines):
        w = line.split()
        if line.startswith("nothing was mended: every surface came closed"):
            opened = 0
        if not w or w[0] != "part":
            continue
        rows = []
        for row in lines[k + 1 :]:
            if not row.strip() or row.startswith("struct-import:"):
                break
            rows.append(row.split())
        if "volume[m3]" in w and "triangles" in w and rows:
            volume = None if rows[-1][3] == "-" else float(rows[-1][3])
            area = float(rows[-1][4])
        if "open" in w and rows:
            opened = int(rows[-1][w.index("open")])
    told = [line.split(": ", 2)[-1] for line in lines if "warning" in line]
    if p.returncode != 0 and lines:
        told = [lines[-1].split(": ", 1)[-1]]
    return p.returncode, volume, area, opened, "; ".join(told)


def near(a, b, tolerance):
    return abs(a - b) <= tolerance * max(abs(a), abs(b), 1e-300)


def compare(path, args):
    status, volume, area, opened, told = run_import(args.program, args.option, path, args.seconds)
    end = os.path.splitext(path)[1].lower()
    reader = {".stl": read_stl, ".obj": read_obj, ".off": read_off, ".cdb": read_cdb}.get(
        end, (read_bulk if end in (".bdf", ".nas") else read_meshio) if meshio else None)
    own, why = None, "no other reader"
    if end == ".dat":  # of whom?
        head = open(path, encoding="latin-1").readline(4096)
        if head.startswith("#g_struct"):
            reader = read_gstruct
        elif head.startswith("#"):
            reader, why = None, "no mesh"
        elif meshio:
            reader = read_bulk_as(".bdf")
    if reader:
        try:
            points, faces = reader(path)
            own = sums(points, faces) if faces else None
            why = "" if faces else "no faces"
        except (Exception, SystemExit) as e:  # meshio ends the program on some files
            why = "other reader: " + (str(e).splitlines() or [type(e).__name__])[0][:60]
    differs = []
    if status not in (0, 1, 3):
        differs.append("status")
    if own and status == 3:
        differs.append("refused")
    if own and area is not None:
        if own[0] is not None and (volume is None or not near(own[0], abs(volume), args.tolerance)):
            differs.append("volume")
        if not near(own[1], area, args.tolerance):
            differs.append("area")
        if own[2] != opened:
            differs.append("open")
    return status, volume, area, opened, own, differs, why or told


def text(x):
    return "-" if x is None else "%.9g" % x if isinstance(x, float) else str(x)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="+")
    parser.add_argument("--program", default="build/bin/struct-import")
    parser.add_argument("--option", action="append", default=[], help="passed on, as --option=--repair")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="of volume and area (1e-6)")
    parser.add_argument("--seconds", type=float, default=60.0, help="per file (60)")
    parser.add_argument("--all", action="store_true", help="files of any name")
    args = parser.parse_args()
    files = []
    for folder in args.folder:
        for here, _, names in sorted(os.walk(folder)):
            files += [os.path.join(here, n) for n in sorted(names)
                      if args.all or os.path.splitext(n)[1].lower() in ENDS]
    print("file\tstatus\tvolume\tarea\topen\town_volume\town_area\town_open\tdiffers\tremark")
    count, compared, different = 0, 0, 0
    for path in files:
        status, volume, area, opened, own, differs, remark = compare(path, args)
        count, compared, different = count + 1, compared + bool(own), different + bool(differs)
        row = [path, status, volume, area, opened] + (list(own) if own else [None] * 3)
        print("\t".join(text(x) for x in row + [",".join(differs) or None, remark or None]), flush=True)
    print("%d files, %d compared, %d differ" % (count, compared, different), file=sys.stderr)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
