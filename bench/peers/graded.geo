// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The unit cube, graded: sizes from edge at a corner to 21.5 edge at the opposite one.
//   gmsh -3 -nt 1 -setnumber edge 0.00131 graded.geo -o graded.msh
DefineConstant[ edge = 0.05 ];
Point(1) = {0, 0, 0};
l[] = Extrude {1, 0, 0} { Point{1}; };
s[] = Extrude {0, 1, 0} { Curve{l[1]}; };
v[] = Extrude {0, 0, 1} { Surface{s[1]}; };
Field[1] = MathEval;
Field[1].F = Sprintf("%g*(1+20.5*sqrt((x*x+y*y+z*z)/3))", edge);
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Algorithm3D = 10;  // HXT
Mesh.Optimize = 0;
Mesh.OptimizeNetgen = 0;
Mesh.Binary = 1;
