// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volume within the triangles of surface.msh, whose surface is meshed anew with the same size: curves at angles of 40
// degrees, patches that gmsh can parametrise. The result is close to the surface, not the surface.
//   gmsh -3 -nt 1 -setnumber edge 0.00567 remesh.geo -o volume.msh
Merge "surface.msh";
DefineConstant[ edge = 0.05 ];
ClassifySurfaces{40*Pi/180, 1, 1, Pi};
CreateGeometry;
s() = Surface{:};
Surface Loop(1) = s();
Volume(1) = {1};
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeMin = edge;
Mesh.MeshSizeMax = edge;
Mesh.Algorithm3D = 10;  // HXT
Mesh.Optimize = 0;
Mesh.OptimizeNetgen = 0;
Mesh.Binary = 1;
