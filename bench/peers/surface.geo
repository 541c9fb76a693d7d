// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volume within the triangles of surface.msh, which are kept as they are; one size inside, or with `-setnumber edge 0` that of the
// triangles around. Without optimisation, unless `-setnumber optimize 1` is given.
//   gmsh -3 -nt 1 -setnumber edge 0.00567 surface.geo -o volume.msh
Merge "surface.msh";
DefineConstant[ edge = 0.05, optimize = 0 ];
Surface Loop(1) = {1};
Volume(1) = {1};
Mesh.MeshSizeFromPoints = 0;
If (edge > 0)
  Mesh.MeshSizeExtendFromBoundary = 0;
  Mesh.MeshSizeMin = edge;
  Mesh.MeshSizeMax = edge;
EndIf
Mesh.Algorithm3D = 10;  // HXT
Mesh.Optimize = optimize;
Mesh.OptimizeNetgen = 0;
Mesh.Binary = 1;
