# SPDX-License-Identifier: GPL-3.0-or-later
"""floe.py -- the files of DilatedDEM in Python.

    import floe
    loads = floe.read_table("loads.tsv")
    leg = loads.where(part="leg")
    print(max(leg["fx"]), leg.units["fx"])      # N
    for frame in floe.read_frames("ANIMATION_3D.DAT"):
        print(frame.t, len(frame.bodies))

A path may name a file packed by gzip; "-" is standard input; an open binary file is taken as well.  No dependencies.
Where numpy is installed, columns of numbers are arrays of it, else lists; where pandas is, Table.pandas() gives a
DataFrame.  Formats: loads(5) and its kin, g-polys(5), animation(5).
A file that is not what it should be raises floe.Error with file and line.
"""
import gzip
import io
import math
import re
import struct
import subprocess
import sys
import zlib

try:
    import numpy
except ImportError:
    numpy = None

__all__ = ["Error", "Table", "Body", "Ice", "Frame", "read_table", "read_ice", "read_frames", "read_shapes", "solve"]

REPORT_NAME = 19  # width of the name in a line of the report
NOT_TABLES = ("g-polys", "g_struct", "animation", "members", "checkpoint")


class Error(Exception):
    """A file or a run that is not as it should be: one sentence, with file and line where there is one."""


def _open(path):
    if hasattr(path, "read"):
        f = path if hasattr(path, "peek") else io.BufferedReader(path)
    elif path == "-":
        f = sys.stdin.buffer
    else:
        try:
            f = open(path, "rb")
        except OSError as e:
            raise Error(f"{path}: {e.strerror}") from None
    head = f.peek(2)[:2]
    return gzip.open(f) if head == b"\x1f\x8b" else f


def _lines(path, f):
    try:
        for number, line in enumerate(f, 1):
            yield number, line.decode("utf-8", "replace").rstrip("\r\n")
    except (OSError, EOFError, zlib.error) as e:
        raise Error(f"{path}: {e}") from None


class Table:
    """A table of kind `kind`: columns by name, as lists or numpy arrays.

    names, units: of the columns in their order; units is by name ("" where there is none).
    history: lines "PROGRAM VERSION OPTIONS" of the programs that contributed.
    settings: of the lines "#set KEY = VALUE", in which the scene differs from its defaults.
    report: of the lines "#report NAME VALUE"; warnings: its warnings.
    stopped: text of "#stopped" of a run that ended early, else None.
    """

    def __init__(self, kind, version, names, units, columns):
        self.kind, self.version = kind, version
        self.names, self.units, self._columns = names, units, columns
        self.history, self.settings, self.report, self.warnings, self.stopped = [], {}, {}, [], None

    def __len__(self):
        return len(self._columns[0]) if self._columns else 0

    def __contains__(self, name):
        return name in self.names

    def __getitem__(self, name):
        try:
            return self._columns[self.names.index(name)]
        except ValueError:
            raise KeyError(f"{self.kind} has no column {name!r}: {', '.join(self.names)}") from None

    def where(self, **equal):
        """The rows in which the named columns have these values, as a new table."""
        keep = [i for i in range(len(self)) if all(self[k][i] == v for k, v in equal.items())]
        columns = [c[keep] if numpy is not None and isinstance(c, numpy.ndarray) else [c[i] for i in keep]
                   for c in self._columns]
        new = Table(self.kind, self.version, self.names, self.units, columns)
        new.history, new.settings, new.report = self.history, self.settings, self.report
        new.warnings, new.stopped = self.warnings, self.stopped
        return new

    def pandas(self):
        """The table as a pandas.DataFrame."""
        import pandas
        return pandas.DataFrame({n: list(c) for n, c in zip(self.names, self._columns)})


def _column(cells):
    try:
        values = [float(x) for x in cells]
    except ValueError:
        return cells
    return numpy.array(values) if numpy is not None else values


def read_table(path):
    """Reads a table of any kind: loads, energy, state, bonds, panels, stats, ..."""
    kind, version, head, rows, by, settings, report = None, 0, None, [], [], {}, {}
    warnings, stopped = [], None
    for number, line in _lines(path, _open(path)):
        if line.startswith("#"):
            m = re.match(r"#(\S+) ?(.*)", line)
            if not m:
                continue
            word, rest = m.groups()
            if kind is None:
                if not rest.split(" ")[0].isdigit():
                    raise Error(f"{path}:{number}: this is no table, its first line is not \"#KIND VERSION\"")
                kind, version = word, int(rest.split(" ")[0])
                if kind in NOT_TABLES:
                    raise Error(f"{path}: {kind} is no table")
            elif word == "by":
                by.append(rest)
            elif word == "set" and "=" in rest:
                key, value = rest.split("=", 1)
                settings[key.strip()] = value.strip()
            elif word == "report":
                if rest.startswith("warning: "):
                    warnings.append(rest[9:])
                else:
                    report[rest[:REPORT_NAME].strip()] = rest[REPORT_NAME:].strip()
            elif word == "stopped":
                stopped = rest
            continue
        if kind is None:
            raise Error(f"{path}:{number}: this is no table, its first line is not \"#KIND VERSION\"")
        cells = line.split("\t")
        if head is None:
            head = cells
        elif len(cells) != len(head):
            raise Error(f"{path}:{number}: {len(cells)} columns, the head has {len(head)}")
        else:
            rows.append(cells)
    if head is None:
        raise Error(f"{path}: no line of column names")
    names, units = [], {}
    for name in head:
        m = re.match(r"(.*)\[(.*)\]$", name)
        names.append(m.group(1) if m else name)
        units[names[-1]] = m.group(2) if m else ""
    columns = [_column(list(c)) for c in zip(*rows)] if rows else [[] for _ in names]
    t = Table(kind, version, names, units, columns)
    t.history, t.settings, t.report, t.warnings, t.stopped = by, settings, report, warnings, stopped
    return t


class Body:
    """A floe: id, dilation radius [m], vertices [m], faces (vertex numbers from 0), material, group, velocity
    (vx, vy, vz [m/s], wx, wy, wz [rad/s])."""

    def __init__(self, id, radius):
        self.id, self.radius = id, radius
        self.vertices, self.faces, self.material, self.group, self.velocity = [], [], None, None, (0.0,) * 6


class Ice:
    """Bodies, and bonds as (id1, id2, area [m2], length [m], x, y, z [m])."""

    def __init__(self):
        self.bodies, self.bonds, self.history = [], [], []


def read_ice(path):
    """Reads ice of the kind g-polys."""
    ice, first = Ice(), True
    for number, line in _lines(path, _open(path)):
        if first:
            if not re.match(r"#g-polys [0-9]+$", line):
                raise Error(f"{path}:{number}: no ice, the first line is not \"#g-polys VERSION\"")
            first = False
        if line.startswith("#by "):
            ice.history.append(line[4:])
        words = re.split(r"(?:^|\s)#", line, maxsplit=1)[0].split()
        if not words:
            continue
        try:
            _ice_row(ice, words)
        except (ValueError, IndexError):
            raise Error(f"{path}:{number}: not a record of g-polys: {line[:60]}") from None
    if first:
        raise Error(f"{path}: the file is empty")
    return ice


def _ice_row(ice, words):
    word, rest = words[0], words[1:]
    if word == "poly":
        b = Body(int(rest[0]), float(rest[1]))
        for pair in rest[4:]:
            key, value = pair.split("=", 1)
            if key in ("material", "group"):
                setattr(b, key, value)
        ice.bodies.append(b)
    elif word == "v":
        x, y, z = (float(a) for a in rest)
        ice.bodies[-1].vertices.append((x, y, z))
    elif word == "f":
        corners = [int(a) for a in rest]
        if len(corners) != corners[0] + 1:
            raise ValueError
        ice.bodies[-1].faces.append(tuple(corners[1:]))
    elif word == "vel":
        ice.bodies[-1].velocity = tuple(float(a) for a in rest)
        if len(ice.bodies[-1].velocity) != 6:
            raise ValueError
    elif word in ("bond", "joint"):
        ice.bonds.append((int(rest[0]), int(rest[1])) + tuple(float(a) for a in rest[2:7]))
    else:
        raise ValueError


class Frame:
    """The floes at time t [s]: bodies has (x, y, z [m], qw, qx, qy, qz) by number; moved the same of the parts of the
    structure that have moved; structure the displacement of the whole."""

    def __init__(self, t):
        self.t, self.bodies, self.moved, self.structure = t, {}, {}, (0.0, 0.0, 0.0)


def read_shapes(path):
    """Shapes at the head of an animation file, by number: bodies whose vertices are relative to their centre."""
    shapes, f = {}, _open(path)
    _read_head(path, f, shapes)
    return shapes


def _shape_line(shapes, words):
    if words[0] == "shape":
        shapes["last"] = shapes[int(words[1])] = Body(int(words[1]), float(words[2]))
    elif words[0] == "part":
        shapes["last"] = None
    elif words[0] == "v" and shapes.get("last"):
        shapes["last"].vertices.append(tuple(float(a) for a in words[1:4]))
    elif words[0] == "f" and shapes.get("last"):
        shapes["last"].faces.append(tuple(int(a) for a in words[2:]))


def _read_head(path, f, shapes):
    """Reads up to the first frame.  Returns (that line, number) of text, ("packed", bounds) of packed frames."""
    number = 0
    for number, line in _lines(path, f):
        if number == 1 and not re.match(r"#animation [12]$", line):
            raise Error(f"{path}:1: no frames, the first line is not \"#animation VERSION\"")
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0] == "packed":
            shapes.pop("last", None)
            return "packed", [float(a) for a in words[1:3]]
        if words[0] == "frame":
            shapes.pop("last", None)
            return words, number
        try:
            _shape_line(shapes, words)
        except (ValueError, IndexError):
            raise Error(f"{path}:{number}: not a record of a shape: {line[:60]}") from None
    shapes.pop("last", None)
    if number == 0:
        raise Error(f"{path}: the file is empty")
    return None, number


def read_frames(path):
    """Frames of an animation file one by one, of either form; a last one that is cut off is left out."""
    f = _open(path)
    what, more = _read_head(path, f, {})
    if what == "packed":
        yield from _packed_frames(path, f, more)
    elif what is not None:
        yield from _text_frames(path, f, what, more)


def _text_frames(path, f, words, before):
    frame = Frame(float(words[1]))
    for number, line in _lines(path, f):
        words = line.split()
        try:
            if not words:
                continue
            if words[0] == "frame":
                yield frame
                frame = Frame(float(words[1]))
            elif words[0] in ("body", "moved"):
                pose = tuple(float(a) for a in words[2:9])
                if len(pose) != 7:
                    raise ValueError
                (frame.bodies if words[0] == "body" else frame.moved)[int(words[1])] = pose
            elif words[0] == "structure":
                frame.structure = tuple(float(a) for a in words[1:4])
        except (ValueError, IndexError):
            raise Error(f"{path}:{before + number}: not a record of a frame: {line[:60]}") from None
    yield frame


def _zigzag(planes, n):
    """Whole numbers from four planes of bytes, by zigzag."""
    out = [0] * n
    for i in range(n):
        u = planes[i] | planes[n + i] << 8 | planes[2 * n + i] << 16 | planes[3 * n + i] << 24
        out[i] = u >> 1 ^ -(u & 1)
    return out


def _wrap(x):
    return (x + 2**31) % 2**32 - 2**31


class _Decoder:
    """State from frame to frame: numbers of bodies, and the whole numbers of the last two frames with bodies."""

    def __init__(self, bounds):
        self.step, self.turn = 2.0 * bounds[0], bounds[1] / 4.0
        self.ids, self.m = [], []
        self.old, self.older, self.m_changed = None, None, []

    def frame(self, data):
        t, n, order, flags = struct.unpack_from("<dIBB", data)
        body, at, frame = zlib.decompress(data[16:]), 0, Frame(t)
        if flags & 1:
            self.ids, last = [], 0
            for d in _zigzag(body, n):
                last += d + 1
                self.ids.append(last)
            at, self.old, self.older, self.m = 4 * n, None, None, [0] * n
            self.m_changed = [False] * n
        if not flags & 4:
            if n != len(self.ids):
                raise ValueError("bodies are not those of the key")
            at = self._bodies(frame, body, at, n, order)
        if flags & 8:
            frame.structure = struct.unpack_from("<3d", body, at)
            at += 24
        if flags & 16:
            (parts,) = struct.unpack_from("<I", body, at)
            for k in range(parts):
                (number,) = struct.unpack_from("<I", body, at + 4 + 60 * k)
                frame.moved[number] = struct.unpack_from("<7d", body, at + 8 + 60 * k)
        return frame

    def _bodies(self, frame, body, at, n, order):
        rows = [_zigzag(body[at + 4 * n * k:at + 4 * n * (k + 1)], n) for k in range(6)]
        left = [a ^ b for a, b in zip(body[at + 24 * n:at + 25 * n], self.m)]
        changed = [a != b for a, b in zip(left, self.m)]
        for k in range(6):
            for i in range(n):
                o = order
                if k > 2:
                    o = 0 if changed[i] else min(o, 1) if self.m_changed[i] else o
                if o == 1:
                    rows[k][i] = _wrap(rows[k][i] + self.old[k][i])
                elif o == 2:
                    rows[k][i] = _wrap(rows[k][i] + 2 * self.old[k][i] - self.older[k][i])
        self.older, self.old, self.m, self.m_changed = self.old, rows, left, changed
        for i, number in enumerate(self.ids):
            q = [rows[k][i] * self.turn for k in (3, 4, 5)]
            q.insert(left[i], math.sqrt(max(0.0, 1.0 - sum(a * a for a in q))))
            frame.bodies[number] = tuple(rows[k][i] * self.step for k in range(3)) + tuple(q)
        return at + 25 * n


def _packed_frames(path, f, bounds):
    decoder = _Decoder(bounds)
    while True:
        head = f.read(16)
        if len(head) < 16:
            return
        kind, stored, _, crc = struct.unpack("<4sIII", head)
        data = f.read(stored)
        if len(data) < stored:
            return
        if zlib.crc32(data) != crc:
            raise Error(f"{path}: a block of packed frames is damaged")
        if kind == b"FRAM":
            try:
                yield decoder.frame(data)
            except (ValueError, struct.error, zlib.error, TypeError, IndexError) as e:
                raise Error(f"{path}: a packed frame is damaged: {e}") from None


def solve(scene, program="dem-solve", options=(), **keys):
    """Runs dem-solve on a scene and returns its table of loads.  Keys as section__key=value:

        floe.solve("ice.scene", run__duration="20 s", contact__law="core")
    """
    args = [program, "-q", *options]
    for key, value in keys.items():
        args += ["--set", f"{key.replace('__', '.', 1)}={value}"]
    done = subprocess.run([*args, scene], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode not in (0, 1):
        raise Error(done.stderr.decode("utf-8", "replace").strip() or f"{program} ended with status {done.returncode}")
    return read_table(io.BytesIO(done.stdout))


if __name__ == "__main__":
    for name in sys.argv[1:]:
        try:
            table = read_table(name)
            print(f"{name}: {table.kind} {table.version}, {len(table)} rows: {' '.join(table.names)}")
        except Error as error:
            sys.exit(f"floe.py: {error}")
