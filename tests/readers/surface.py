"""Holds of NAME.vtu and NAME.stl what NAME.json, the exact checker's answer, says of the paving,
and that they have more than LEAST faces: surface.py NAME LEAST

The enclosed volume is that of the divergence theorem: a third of the sum of p . n over the faces.
"""

import json
import sys
from fractions import Fraction

import meshio
import numpy as np
import stl


def holds(condition, what):
    if not condition:
        sys.exit(f"{name}: {what}")


def enclosed(corners):
    """The volume within triangles of corners[triangle, corner, coordinate]."""
    a, b, c = (corners[:, i].astype(np.float64) for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def closed(*kinds):
    """Whether every edge of faces[face, corner], of every kind, runs as often in one direction as in
    the other; and how many edges are shared by two faces, and by four."""
    start = np.concatenate([faces.ravel() for faces in kinds])
    end = np.concatenate([np.roll(faces, -1, axis=1).ravel() for faces in kinds])
    corners = int(start.max()) + 1
    there, back = np.sort(start * corners + end), np.sort(end * corners + start)
    _, times = np.unique(there[there // corners < there % corners], return_counts=True)
    holds((there == back).all(), "the faces are not closed")
    holds(times.max() <= 2, "an edge is shared by more than four faces")
    return (times == 1).sum(), (times == 2).sum()


name = sys.argv[1]
with open(f"{name}.json") as file:
    answer = json.load(file)
box = answer["header"]["claim"]["machine"]["workspace"]["box"]
low, high = (np.array([float(Fraction(x)) for x in box[end]]) for end in ("min", "max"))
volume = float(Fraction(answer["inner_share"])) * np.prod(high - low)

mesh = meshio.read(f"{name}.vtu")
cells = {block.type: block.data for block in mesh.cells}
holds(set(cells) == {"quad", "triangle"}, f"cells are {sorted(cells)}")
points, quads, triangles = mesh.points, cells["quad"], cells["triangle"]
holds(len(np.unique(points, axis=0)) == len(points), "a corner is there twice")
of_faces = np.concatenate([quads.ravel(), triangles.ravel()])
holds(len(np.unique(of_faces)) == len(points), "a corner is of no face")
two, four = closed(quads, triangles)
pieces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]], triangles])
found = enclosed(points[pieces])
error = found / volume - 1
# Of boxes that planes cut, the boxes before the plane are enclosed.
least = -0.03 if name == "cut" else -1e-9
holds(least < error < 1e-9, f"volume {found} instead of {volume}")
holds((points >= low).all() and (points <= high).all(), "a corner is outside the box")
beyond = np.concatenate(mesh.cell_data["beyond"])
holds(len(beyond) == len(quads) + len(triangles), "a face without data")
holds(set(np.unique(beyond)) <= {0, 1, 2}, "cell data")

solid = stl.Mesh.from_file(f"{name}.stl")
holds(len(solid.vectors) == len(pieces), "triangles differ in number")
corners, triangles = np.unique(solid.vectors.reshape(-1, 3), axis=0, return_inverse=True)
holds(len(corners) == len(points), "corners differ in number")
closed(triangles.reshape(-1, 3))
for end in (np.min, np.max):
    near = np.allclose(end(points, axis=0), end(corners, axis=0), rtol=1e-6, atol=0)
    holds(near, "bounding boxes differ")
# Single precision: 2^-24 relative for each coordinate.
rough = enclosed(solid.vectors)
holds(abs(rough / found - 1) < 1e-6, f"volume {rough} instead of {found} within the triangles")
turned = np.einsum("ij,ij->i", np.cross(solid.v1 - solid.v0, solid.v2 - solid.v0), solid.normals)
holds((turned > 0).all(), "a normal points inwards")
holds(len(quads) + len(cells["triangle"]) > int(sys.argv[2]), "too few faces to show anything")
print(
    f"{name}: {len(quads)} quadrilaterals, {len(cells['triangle'])} triangles, {len(points)} corners, "
    f"{two} edges of two faces, {four} of four, volume {found:.9f}, error {error:.1e}"
)
