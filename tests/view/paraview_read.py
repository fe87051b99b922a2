# SPDX-License-Identifier: GPL-3.0-or-later
# paraview_read.py FLOES.vtp STRUCTURE.vtp POINTS.vtp VOLUME -- reads the files of ice-view --vtk back by VTK: arrays, closed
# floes, their volume within 5 % below VOLUME [m3].
import sys
import vtk

def read(path):
    r = vtk.vtkXMLPolyDataReader()
    r.SetFileName(path)
    r.Update()
    return r.GetOutput()

bad = []
def hold(what, ok):
    if not ok: bad.append(what)

floes, structure, points = (read(p) for p in sys.argv[1:4])
cells = {floes.GetCellData().GetArrayName(k) for k in range(floes.GetCellData().GetNumberOfArrays())}
hold("arrays of floes are " + str(sorted(cells)), cells == {"body", "group", "speed", "spin", "thickness", "diameter"})
hold("no normals", floes.GetPointData().GetNormals() is not None)
edges = vtk.vtkFeatureEdges()
edges.SetInputData(floes)
edges.FeatureEdgesOff(), edges.ManifoldEdgesOff()
edges.Update()
hold("%d open edges" % edges.GetOutput().GetNumberOfLines(), edges.GetOutput().GetNumberOfLines() == 0)
mass = vtk.vtkMassProperties()
mass.SetInputData(floes)
volume, exact = mass.GetVolume(), float(sys.argv[4])
hold("volume %g m3, up to %g is expected" % (volume, exact), 0.95 * exact < volume < exact)
hold("the structure has no cell", structure.GetNumberOfPolys() > 0)
rotation = points.GetCellData().GetArray("rotation")
hold("points have no rotation", rotation is not None and rotation.GetNumberOfComponents() == 4)
for line in bad: print("paraview: " + line)
print("VTK %s: %d floes' polygons, %g m3" % (vtk.vtkVersion().GetVTKVersion(), floes.GetNumberOfPolys(), volume))
print("%d passed, %d failed" % (6 - len(bad), len(bad)))
sys.exit(1 if bad else 0)
