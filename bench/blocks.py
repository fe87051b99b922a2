# SPDX-License-Identifier: GPL-3.0-or-later
# blocks.py -- blocks in YADE, for blocks.sh, which sets BLOCKS, ELASTIC, DT, WINDOWS and STEPS in the
# environment.  Polyhedra without radius, pushed apart by the volume of what they share.
import os
import time
from yade import polyhedra_utils, utils

rock = PolyhedraMat()
rock.density, rock.young, rock.poisson = 917, 1e8, 0.2
rock.frictionAngle = 0 if os.environ["ELASTIC"] == "1" else 0.29
O.materials.append(rock)
with open(os.environ["BLOCKS"]) as rows:
    for row in rows:
        a = list(map(float, row.split()))
        block = polyhedra_utils.polyhedra(rock, v=[tuple(a[k : k + 3]) for k in range(6, 30, 3)])
        s = block.state
        s.vel, s.angVel = Vector3(*a[:3]), Vector3(*a[3:6])
        w = s.ori.conjugate() * s.angVel
        s.angMom = s.ori * Vector3(*(w[k] * s.inertia[k] for k in range(3)))
        O.bodies.append(block)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Polyhedra_Aabb()], verletDist=0.05),
    InteractionLoop(
        [Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
        [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
        [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()],
    ),
    NewtonIntegrator(damping=0, exactAsphericalRot=True),
]
O.dt = float(os.environ["DT"])
steps = int(os.environ["STEPS"])
print("energy", utils.kineticEnergy())
for k in range(int(os.environ["WINDOWS"])):
    start = time.perf_counter()
    O.run(steps, wait=True)
    print("window", (time.perf_counter() - start) / steps)
print("energy", utils.kineticEnergy(), flush=True)
os._exit(0)  # its own end asks for more than there is without a screen
