// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The unit cube with one size, surface and volume; without optimisation, unless `-setnumber optimize 1` is given:
//   gmsh -3 -nt 1 -setnumber edge 0.0128 cube.geo -o cube.msh
DefineConstant[ edge = 0.05, optimize = 0 ];
Point(1) = {0, 0, 0};
l[] = Extrude {1, 0, 0} { Point{1}; };
s[] = Extrude {0, 1, 0} { Curve{l[1]}; };
v[] = Extrude {0, 0, 1} { Surface{s[1]}; };
Mesh.MeshSizeMin = edge;
Mesh.MeshSizeMax = edge;
Mesh.Algorithm3D = 10;  // HXT
Mesh.Optimize = optimize;
Mesh.OptimizeNetgen = 0;
Mesh.Binary = 1;
