# SPDX-License-Identifier: GPL-3.0-or-later
# pack.py -- a cloud of makeCloud at half size, grown by growParticles in YADE, for pack.sh, which sets SIDE, POROSITY,
# STEPS, REST and STATE in the environment.
import os
import time
from yade import pack, utils

side, porosity, steps, rest = (float(os.environ[k]) for k in ("SIDE", "POROSITY", "STEPS", "REST"))
begun = time.process_time()
O.materials.append(FrictMat(young=1e6, poisson=0.3, frictionAngle=0, density=1000))
O.bodies.append(utils.aabbWalls([(0, 0, 0), (side, side, side)], thickness=0))
cloud = pack.SpherePack()
sizes = [1 + k / 20 for k in range(21)]
half = [0.5 * d for d in sizes]
cumm = [k / 20 for k in range(21)]
n = int((1 - porosity) * side ** 3 * 0.716197)
cloud.makeCloud((0, 0, 0), (side, side, side), psdSizes=half, psdCumm=cumm, distributeMass=True, num=n, seed=1)
print("cloud", len(cloud))
cloud.toSimulation()
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                    [Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(damping=0.4),
]
stages = 70
for k in range(stages):
    growParticles(2 ** (1 / stages))
    O.dt = 0.5 * PWaveTimeStep()
    O.run(int(steps / stages), wait=True)
O.run(int(rest), wait=True)
spent = time.process_time() - begun
with open(os.environ["STATE"], "w") as f:
    for b in O.bodies:
        if isinstance(b.shape, Sphere):
            f.write("%.17g %.17g %.17g %.17g\n" % (b.shape.radius, *b.state.pos))
print("seconds", spent, flush=True)
os._exit(0)
