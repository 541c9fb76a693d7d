# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that must be refused: name -> (content, the line that the message must name, or None where it has none)."""
import struct

POINTS = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n"
SIDES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
POLY = POINTS + "4 0\n" + "".join("1\n3 %d %d %d\n" % s for s in SIDES) + "0\n0\n"
SMESH = POINTS + "4 0\n" + "".join("3 %d %d %d\n" % s for s in SIDES) + "0\n0\n"
OFF = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + "".join("3 %d %d %d\n" % s for s in SIDES)
FACET = "facet normal 0 0 0\nouter loop\n%svertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
STL = "solid s\n" + FACET % "" + "endsolid s\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + "".join("f %d %d %d\n" % tuple(i + 1 for i in s) for s in SIDES)
PSLG = "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"

PLY = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
       "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n") + "".join(
           "3 %d %d %d\n" % s for s in SIDES)
BINARY_PLY = PLY[:PLY.index("0 0 0")].replace("ascii", "binary_little_endian").encode()
MEDIT = ("MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTriangles\n4\n" +
         "".join("%d %d %d 0\n" % tuple(i + 1 for i in s) for s in SIDES) + "End\n")
MSH = ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n4\n" +
       "".join("%d 2 2 0 1 %d %d %d\n" % (n, *(i + 1 for i in s)) for n, s in enumerate(SIDES)) + "$EndElements\n")
BINARY_MSH = b"$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n$Nodes\n"

BAD_INPUTS = {
    "empty.poly": ("", None),
    "empty.smesh": ("", None),
    "empty.node": ("", None),
    "empty.off": ("", None),
    "empty.stl": ("", None),
    "empty.obj": ("", None),
    "blank.poly": ("# nothing\n\n", None),
    "truncated.poly": (POLY[:60], None),
    "truncated.smesh": (SMESH[:60], None),
    "truncated.node": (POINTS[:30], None),
    "truncated.off": (OFF[:40], None),
    "truncated.stl": (STL[:60], None),
    "truncated2d.poly": (PSLG[:36], None),
    "billion.poly": (POLY.replace("4 3 0 0", "1000000000 3 0 0"), 1),
    "billion_facets.poly": (POLY.replace("\n4 0\n", "\n1000000000 0\n"), 6),
    "billion.smesh": (SMESH.replace("4 3 0 0", "1000000000 3 0 0"), 1),
    "billion_corners.smesh": (SMESH.replace("\n3 0 2 1", "\n1000000000 0 2 1"), 7),
    "billion.node": (POINTS.replace("4 3 0 0", "1000000000 3 0 0"), 1),
    "billion.off": (OFF.replace("4 4 0", "1000000000 4 0"), 2),
    "billion_facets.off": (OFF.replace("4 4 0", "4 1000000000 0"), 2),
    "billion.stl": (b"\0" * 80 + struct.pack("<I", 10**9) + b"\0" * 50, None),
    "nan.poly": (POLY.replace("\n1 1 0 0", "\n1 nan 0 0"), 3),
    "nan.smesh": (SMESH.replace("\n1 1 0 0", "\n1 nan 0 0"), 3),
    "infinite.node": (POINTS.replace("\n1 1 0 0", "\n1 inf 0 0"), 3),
    "huge.node": (POINTS.replace("\n1 1 0 0", "\n1 1e999 0 0"), 3),
    "nan.off": (OFF.replace("\n1 0 0", "\n1 nan 0"), 4),
    "nan.obj": (OBJ.replace("v 1 0 0", "v nan 0 0"), 2),
    "index.obj": (OBJ.replace("f 1 3 2", "f 1 3 5"), 5),
    "word.obj": (OBJ.replace("v 0 1 0", "v 0 one 0"), 3),
    "nan.stl": (STL.replace("vertex 1 0 0", "vertex nan 0 0"), 5),
    "nan2d.poly": (PSLG.replace("\n2 1 0", "\n2 nan 0"), 3),
    "index.poly": (POLY.replace("3 0 2 1", "3 0 2 4"), 8),
    "index.smesh": (SMESH.replace("\n3 0 2 1", "\n3 0 2 4"), 7),
    "negative_index.smesh": (SMESH.replace("\n3 0 2 1", "\n3 0 2 -1"), 7),
    "index.off": (OFF.replace("\n3 0 2 1", "\n3 0 2 4"), 7),
    "index2d.poly": (PSLG.replace("\n2 2 3", "\n2 2 4"), 7),
    "word.poly": (POLY.replace("\n2 0 1 0", "\n2 0 one 0"), 4),
    "word.off": (OFF.replace("\n0 1 0", "\n0 one 0"), 5),
    "word.stl": (STL.replace("vertex 0 1 0", "vertex 0 1"), None),
    "not_off.off": ("PLY\n4 4 0\n", 1),
    "negative.node": (POINTS.replace("4 3 0 0", "-4 3 0 0"), 1),
    "dimension.node": (POINTS.replace("4 3 0 0", "4 5 0 0"), 1),
    "empty.ply": ("", None),
    "empty.mesh": ("", None),
    "empty.msh": ("", None),
    "truncated.ply": (PLY[:-9], None),
    "truncated.mesh": (MEDIT[:-9], None),
    "truncated.msh": (MSH[:-9], None),
    "truncated_binary.ply": (BINARY_PLY + bytes(99), None),
    "behind.ply": (PLY + "0\n", 18),
    "billion.ply": (PLY.replace("vertex 4", "vertex 1000000000"), 3),
    "billion_binary.ply": (BINARY_PLY.replace(b"face 4", b"face 1000000000") + bytes(100), None),
    "billion.mesh": (MEDIT.replace("Vertices\n4", "Vertices\n1000000000"), 4),
    "billion.msh": (MSH.replace("$Nodes\n4", "$Nodes\n1000000000"), 5),
    "billion_binary.msh": (BINARY_MSH + struct.pack("<4Q", 10**9, 10**9, 1, 10**9) + bytes(100), None),
    "nan.ply": (PLY.replace("1 0 0\n", "nan 0 0\n", 1), 11),
    "nan.mesh": (MEDIT.replace("1 0 0 0\n", "nan 0 0 0\n", 1), 6),
    "nan.msh": (MSH.replace("2 1 0 0\n", "2 nan 0 0\n", 1), 7),
    "index.ply": (PLY.replace("3 0 2 1", "3 0 2 4"), 14),
    "index.mesh": (MEDIT.replace("1 3 2 0", "1 3 5 0"), 11),
    "index.msh": (MSH.replace("0 2 2 0 1 1 3 2", "0 2 2 0 1 1 3 5"), 13),
    "curved.msh": (MSH.replace("0 2 2 0 1 1 3 2", "0 21 2 0 1 1 3 2 1 3 2 1 3 2 1"), 13),
    "version.msh": (MSH.replace("2.2 0 8", "4.0 0 8"), 2),
    "binary.poly": (bytes(range(256)) * 4, None),
}
