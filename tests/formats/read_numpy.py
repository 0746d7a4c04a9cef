"""Reads NPZ, PLY, PC2, MDD and OBJ with NumPy alone and compares them with record.bin. Arguments: the folder of a run that wrote
record.bin, and that of its exports."""
import struct
import sys

import numpy

from record import Record

FLOAT = 2.0 ** -23  # relative rounding of a float, with one bit to spare


def close(found, wanted, what, rounding=FLOAT):
    wanted = numpy.asarray(wanted, float)
    found = numpy.asarray(found, float)
    assert found.shape == wanted.shape, f"{what}: shape {found.shape}, expected {wanted.shape}"
    error = numpy.abs(found - wanted).max(initial=0.0)
    assert error <= rounding * max(1.0, numpy.abs(wanted).max(initial=0.0)), f"{what}: off by {error}"


def read_ply(path):
    """The elements of a binary PLY file: rows of scalars, and lists of faces."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    at = end
    types = {"float": "<f4", "int": "<i4", "uint": "<u4", "uchar": "<u1"}
    elements, order = {}, []
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            order.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            order[-1][2].append(words[1:])
    for name, count, properties in order:
        if all(p[0] != "list" for p in properties):
            row = numpy.dtype([(p[1], types[p[0]]) for p in properties])
            elements[name] = numpy.frombuffer(data, row, count, at)
            at += row.itemsize * count
            continue
        rows = []
        for _ in range(count):
            row = []
            for _, size_type, item_type, _ in properties:
                size = numpy.dtype(types[size_type])
                length = int(numpy.frombuffer(data, size, 1, at)[0])
                at += size.itemsize
                item = numpy.dtype(types[item_type])
                row.append(numpy.frombuffer(data, item, length, at))
                at += item.itemsize * length
            rows.append(row)
        elements[name] = rows
    assert at == len(data), f"{path}: {len(data) - at} bytes are left"
    return elements


def faces_of(record, body):
    begin = record.array(f"bodies/{body}/corner_begin")[:, 0]
    vertex = record.array(f"bodies/{body}/vertex")[:, 0]
    return [vertex[a:b] for a, b in zip(begin[:-1], begin[1:])]


def uv_of_fans(record, body):
    """u, v of the corners of triangles: f x 3 x 2. Nothing if the body has none."""
    corners = record.array(f"bodies/{body}/texcoord")[:, 0]
    if corners.size == 0:
        return None
    uv = numpy.vstack([record.array(f"bodies/{body}/texcoords").reshape(-1, 2), [0.0, 0.0]])[corners]
    begin = record.array(f"bodies/{body}/corner_begin")[:, 0]
    return numpy.array([uv[[a, k, k + 1]] for a, b in zip(begin[:-1], begin[1:]) for k in range(a + 1, b - 1)])


def fans(faces):
    return numpy.array([[f[0], f[k], f[k + 1]] for f in faces for k in range(1, len(f) - 1)], int).reshape(-1, 3)


def read_cache(path, frames, points):
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".pc2"):
        assert data[:12] == b"POINTCACHE2\0"
        version, count, start, rate, samples = struct.unpack("<iiffi", data[12:32])
        assert (version, count, start, rate, samples) == (1, points, 0.0, 1.0, frames), path
        return numpy.frombuffer(data, "<f4", offset=32).reshape(frames, points, 3)
    assert struct.unpack(">ii", data[:8]) == (frames, points), path
    return numpy.frombuffer(data, ">f4", offset=8 + 4 * frames).reshape(frames, points, 3)


def check(run, exports):
    record = Record(run)
    arrays = numpy.load(f"{exports}/animation.npz")
    doubles = numpy.load(f"{exports}/doubles/animation.npz")
    frames = range(1, record.frames + 1)
    close(arrays["time"], [record.frame_array("time", f)[0, 0] for f in frames], "time", 0.0)
    for b, body in enumerate(record.bodies):
        name = body["name"]
        wanted = numpy.array([record.vertices(b, f) for f in frames])
        close(arrays[f"{name}/positions"], wanted, f"{name} in NPZ")
        close(doubles[f"{name}/positions"], wanted, f"{name} in NPZ of doubles", 0.0)
        faces = faces_of(record, b)
        assert (arrays[f"{name}/faces"] == fans(faces)).all()
        uv = uv_of_fans(record, b)
        assert (uv is None) == (f"{name}/uv" not in arrays)
        if uv is not None:
            close(arrays[f"{name}/uv"], uv, f"UVs of {name} in NPZ")
        assert (arrays[f"{name}/edges"] == record.array(f"bodies/{b}/lines")).all()
        for ending in ("pc2", "mdd"):
            close(read_cache(f"{exports}/{name}.{ending}", record.frames, wanted.shape[1]), wanted, f"{name} in {ending}")
        with open(f"{exports}/{name}.obj") as file:
            lines = [line.split()[1:] for line in file if line.startswith("v ")]
        close(numpy.array(lines, float), wanted[0], f"{name}.obj", 0.0)
        particles = record.array(f"bodies/{b}/particle_of")[:, 0]
        for f in (1, record.frames):
            ply = read_ply(f"{exports}/{name}/{name}.{f:04}.ply")
            vertex = ply["vertex"]
            close(numpy.stack([vertex[k] for k in "xyz"], 1), wanted[f - 1], f"{name} in PLY")
            velocities = record.frame_array("velocities", f)[particles]
            close(numpy.stack([vertex["v" + k] for k in "xyz"], 1), velocities, f"velocities of {name} in PLY")
            assert (vertex["contact"] == record.frame_array("states", f)[particles, 0] % 2).all()
            kept = [tuple(row[0]) for row in ply.get("face", [])]
            assert set(kept) <= {tuple(face) for face in faces}, f"{name}: faces in PLY"
            if f == 1:
                assert len(kept) == len(faces)
    for k, obstacle in enumerate(record.obstacles):
        name = obstacle["name"]
        if obstacle["motion"] == "fixed":
            close(arrays[f"obstacles/{name}/vertices"], record.obstacle_vertices(k, 1), name)
            continue
        wanted = numpy.array([record.obstacle_vertices(k, f) for f in frames])
        if obstacle["motion"] == "rigid":
            poses, own = arrays[f"obstacles/{name}/poses"], arrays[f"obstacles/{name}/vertices"]
            close(own @ poses[:, :3, :3].transpose(0, 2, 1) + poses[:, None, :3, 3], wanted, f"{name} in NPZ", 4 * FLOAT)
        else:
            close(arrays[f"obstacles/{name}/positions"], wanted, f"{name} in NPZ")
        for ending in ("pc2", "mdd"):
            close(read_cache(f"{exports}/obstacles/{name}.{ending}", record.frames, wanted.shape[1]), wanted, f"{name} in {ending}")
    print(f"{len(record.bodies)} bodies, {len(record.obstacles)} obstacles, {record.frames} frames: equal")


check(*sys.argv[1:3])
