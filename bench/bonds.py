# SPDX-License-Identifier: GPL-3.0-or-later
# bonds.py -- the free bonded plate of bonds.sh in YADE, CohFrictMat with moments in the incremental shear law of ScGeom6D.
# The environment has PLATE, a g-polys file; DT, STEPS, EVERY (steps between two rows); YOUNG and RATIO (tangential over
# normal stiffness) of its bonds; DENSITY; STATE, the table to write: t, kinetic and elastic energy, projection of the
# velocities on those of the start.
import os
import time
import numpy
from yade import utils

dt, young, ratio, density = (float(os.environ[k]) for k in ("DT", "YOUNG", "RATIO", "DENSITY"))
steps, every = (int(os.environ[k]) for k in ("STEPS", "EVERY"))
place, motion, bonds, radius = [], [], [], 0.0
with open(os.environ["PLATE"]) as f:
    for line in f:
        word = line.split()
        if word[0] == "poly":
            radius = float(word[2])
        elif word[0] == "v":
            place.append([float(x) for x in word[1:4]])
        elif word[0] == "vel":
            motion.append([float(x) for x in word[1:7]])
        elif word[0] == "bond":
            bonds.append((int(word[1]), int(word[2])))
motion = numpy.array(motion)
strong = 1e15
O.materials.append(CohFrictMat(young=young, poisson=ratio, density=density, frictionAngle=0.3, isCohesive=True,
                               normalCohesion=strong, shearCohesion=strong, momentRotationLaw=True, etaRoll=-1, etaTwist=-1))
for x, v in zip(place, motion):
    k = O.bodies.append(utils.sphere(x, radius))
    O.bodies[k].state.vel, O.bodies[k].state.angVel = v[:3], v[3:]
law = Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True)
geometry, box = Ig2_Sphere_Sphere_ScGeom6D(interactionDetectionFactor=1.05), Bo1_Sphere_Aabb(aabbEnlargeFactor=1.05)
O.engines = [ForceResetter(), InsertionSortCollider([box], verletDist=0.05 * radius),
             InteractionLoop([geometry], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionOnNewContacts=True)], [law]),
             NewtonIntegrator(damping=0)]
O.dt = 1e-30
O.step()  # makes the bonds
O.dt = dt
pairs = {tuple(sorted((i.id1, i.id2))) for i in O.interactions}
if pairs != {tuple(sorted(b)) for b in bonds}:
    print("%d bonds in YADE, %d in the plate" % (len(pairs), len(bonds)), flush=True)
    os._exit(1)
area, inertia = numpy.pi * radius ** 2, numpy.pi * radius ** 4 / 4
for i in O.interactions:
    p = i.phys
    p.kn = young * area / (2 * radius)
    p.ks, p.kr, p.ktw = ratio * p.kn, young * inertia / (2 * radius), ratio * young * 2 * inertia / (2 * radius)
mass, turning = O.bodies[0].state.mass, O.bodies[0].state.inertia[0]


def velocities():
    return numpy.array([[*b.state.vel, *b.state.angVel] for b in O.bodies])


spent = 0.0
with open(os.environ["STATE"], "w") as f:
    for k in range(steps // every):
        begun = time.process_time()
        O.run(every - 1, wait=True)
        spent += time.process_time() - begun
        before = velocities()
        begun = time.process_time()
        O.step()
        spent += time.process_time() - begun
        # Velocities are of the middle of a step, forces of its start: their mean belongs to the elastic energy.
        v = 0.5 * (before + velocities())
        kinetic = 0.5 * mass * (v[:, :3] ** 2).sum() + 0.5 * turning * (v[:, 3:] ** 2).sum()
        elastic = law.normElastEnergy() + law.shearElastEnergy() + law.bendingElastEnergy() + law.twistElastEnergy()
        p = (v[:, 2] * motion[:, 2]).sum() / (motion[:, 2] ** 2).sum()
        f.write("%.9g %.9g %.9g %.9g\n" % (((k + 1) * every - 1) * dt, kinetic, elastic, p))
print("seconds", spent, "of", steps // every * every, flush=True)
os._exit(0)
