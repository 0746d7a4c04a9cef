"""Reads record.bin as src/output/RECORD.md describes it: what all other formats are compared with."""
import json

import numpy

TYPES = {"u8": "<u1", "i32": "<i4", "f64": "<f8"}


class Record:
    def __init__(self, folder):
        with open(f"{folder}/record.bin", "rb") as file:
            self.data = file.read()
        size = int.from_bytes(self.data[16:24], "little")
        self.head = json.loads(self.data[24:24 + size])
        self.arrays_begin = 24 + size
        self.frames_begin = self.arrays_begin + self.head["array_bytes"]
        self.frames = (len(self.data) - self.frames_begin) // self.head["frame_bytes"]
        self.bodies = self.head["bodies"]
        self.obstacles = self.head["obstacles"]

    def _array(self, entry, begin):
        rows, columns = entry["shape"]
        values = numpy.frombuffer(self.data, TYPES[entry["type"]], rows * columns, begin + entry["offset"])
        return values.reshape(columns, rows)

    def array(self, name):
        """An array of the model, a row for each column of the record."""
        return self._array(self.head["arrays"][name], self.arrays_begin)

    def frame_array(self, name, frame):
        """An array of a frame, counted from 1."""
        begin = self.frames_begin + (frame - 1) * self.head["frame_bytes"]
        return self._array(self.head["frame_arrays"][name], begin)

    def vertices(self, body, frame):
        """The vertices of a body in a frame [m], n x 3."""
        return self.frame_array("positions", frame)[self.array(f"bodies/{body}/particle_of")[:, 0]]

    def pose(self, obstacle, frame):
        """Rotation and position of an obstacle in a frame, 3 x 4."""
        return self.frame_array("poses", frame).reshape(-1, 3, 4)[obstacle]

    def obstacle_vertices(self, obstacle, frame):
        """The vertices of an obstacle in the world [m], n x 3."""
        motion = self.obstacles[obstacle]["motion"]
        vertices = self.array(f"obstacles/{obstacle}/vertices")
        if motion == "fixed":
            return vertices
        if motion == "deforming":
            number = sum(o["motion"] == "deforming" for o in self.obstacles[:obstacle])
            vertices = self.frame_array(f"deformed/{number}", frame)
        pose = self.pose(obstacle, frame)
        return vertices @ pose[:, :3].T + pose[:, 3]
