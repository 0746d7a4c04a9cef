"""Reads VTK files with VTK and compares them with record.bin. Arguments as those of read_numpy.py."""
import sys
import xml.etree.ElementTree as Tree

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from record import Record

KINDS_OF_SPRINGS = 3


def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def check_body(record, exports, b):
    body = record.bodies[b]
    name = body["name"]
    sets = Tree.parse(f"{exports}/{name}.pvd").getroot().iter("DataSet")
    files = [(float(s.get("timestep")), s.get("file")) for s in sets]
    assert len(files) == record.frames
    particles = record.array(f"bodies/{b}/particle_of")[:, 0]
    for f, (time, file) in enumerate(files, 1):
        assert abs(time - record.frame_array("time", f)[0, 0]) < 1e-9
        mesh = read(f"{exports}/{file}")
        points = vtk_to_numpy(mesh.GetPoints().GetData())
        assert (points == record.vertices(b, f)).all(), f"{file}: points"
        velocity = vtk_to_numpy(mesh.GetPointData().GetArray("velocity"))
        assert (velocity == record.frame_array("velocities", f)[particles]).all(), f"{file}: velocities"
        if f == 1:
            assert mesh.GetNumberOfPolys() == len(record.array(f"bodies/{b}/corner_begin")) - 1
        kind = vtk_to_numpy(mesh.GetCellData().GetArray("kind"))
        tension = vtk_to_numpy(mesh.GetCellData().GetArray("tension"))
        ends = record.array("springs/ends")
        own = (ends >= body["first_particle"]).all(1) & (ends < body["first_particle"] + body["particle_count"]).all(1)
        if (kind < KINDS_OF_SPRINGS).sum() != own.sum():
            continue  # torn, or a lattice
        x, v = record.frame_array("positions", f), record.frame_array("velocities", f)
        between = x[ends[own, 0]] - x[ends[own, 1]]
        length = numpy.linalg.norm(between, axis=1)
        rate = ((v[ends[own, 0]] - v[ends[own, 1]]) * between).sum(1) / length
        wanted = record.array("springs/stiffness")[own, 0] * (length - record.array("springs/rest_lengths")[own, 0])
        wanted = wanted + record.array("springs/damping")[own, 0] * rate
        error = numpy.abs(tension[kind < KINDS_OF_SPRINGS] - wanted).max()
        assert error <= 2.0 ** -20 * max(1.0, numpy.abs(wanted).max()), f"{file}: tension is off by {error} N"


def check(run, exports):
    record = Record(run)
    for b in range(len(record.bodies)):
        check_body(record, exports, b)
    for k, obstacle in enumerate(record.obstacles):
        name = f"obstacles/{obstacle['name']}"
        path = f"{name}.vtp" if obstacle["motion"] == "fixed" else f"{name}/{obstacle['name']}.{record.frames:04}.vtp"
        points = vtk_to_numpy(read(f"{exports}/{path}").GetPoints().GetData())
        assert numpy.abs(points - record.obstacle_vertices(k, record.frames)).max() < 1e-12, path
    print(f"{len(record.bodies)} bodies, {len(record.obstacles)} obstacles, {record.frames} frames: equal")


check(*sys.argv[1:3])
