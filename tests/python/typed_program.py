"""Read by mypy, not run: a program that uses the types of the stubs."""
import numpy

import sprung

scene: sprung.Scene = sprung.load({"duration": 1}, overrides={"step": 0.001})
simulator = scene.simulator()
simulator.step(3)
height: float = float(simulator.bodies["cloth"].particles[:, 1].min())
simulator.add_force(lambda x, v, t: -0.1 * v, body="cloth")
simulator.pins["hand"].move_to([0, 1, 0])
simulator.obstacles["ball"].pose = numpy.eye(4)
sprung.Batch([simulator, simulator.copy()]).step(10)
table = sprung.sweep({"duration": 1}, "swept", vary={"step": [0.001, 0.002]}, sample={"gravity": "uniform(0,1)"}, count=2)
mean: float = float(table["largest_stretch"].mean()) + float(sprung.sweep_results("swept")["seconds"].max())
try:
    simulator.frame()
except sprung.StepError as error:
    print(error.step, error.particle, height, mean)
