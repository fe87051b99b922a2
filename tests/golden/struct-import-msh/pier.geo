SetFactory("OpenCASCADE");
Box(1) = {-2,-2,-6, 4,4,1};
Cylinder(2) = {0,0,-5, 0,0,6, 0.75};
BooleanFragments{ Volume{1}; Volume{2}; Delete; }{}
Physical Volume("foot") = {1};
Physical Volume("the leg") = {2};
Physical Volume("all") = {1,2};
Mesh.MeshSizeMin=1.5;
Mesh.MeshSizeMax=2.5;
