"""Holds of NAME.vtu and NAME.stl what NAME.json, the exact checker's answer, says of the paving.

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


def closed(faces):
    """Whether every edge runs as often in one direction as in the other."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    corners = int(faces.max()) + 1
    there, back = start * corners + end, end * corners + start
    return (np.sort(there) == np.sort(back)).all()


name = sys.argv[1]
with open(f"{name}.json") as file:
    answer = json.load(file)
box = answer["header"]["claim"]["machine"]["workspace"]["box"]
low, high = (np.array([float(Fraction(x)) for x in box[end]]) for end in ("min", "max"))
volume = float(Fraction(answer["inner_share"])) * np.prod(high - low)

mesh = meshio.read(f"{name}.vtu")
(cells,) = mesh.cells
holds(cells.type == "quad", f"cells are {cells.type}")
points, quads = mesh.points, cells.data
holds(len(np.unique(points, axis=0)) == len(points), "a corner is there twice")
holds(len(np.unique(quads)) == len(points), "a corner is of no face")
holds(closed(quads), "the quadrilaterals are not closed")
found = enclosed(points[np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])])
error = abs(found / volume - 1)
holds(error < 1e-9, f"volume {found} instead of {volume}")
holds((points >= low).all() and (points <= high).all(), "a corner is outside the box")
beyond, depth = (mesh.cell_data[key][0] for key in ("beyond", "depth"))
holds(len(beyond) == len(depth) == len(quads), "a face without data")
holds(set(np.unique(beyond)) <= {0, 1, 2} and depth.max() <= answer["header"]["depth"], "cell data")

solid = stl.Mesh.from_file(f"{name}.stl")
holds(len(solid.vectors) == 2 * len(quads), "triangles and quadrilaterals differ in number")
corners, triangles = np.unique(solid.vectors.reshape(-1, 3), axis=0, return_inverse=True)
holds(len(corners) == len(points), "corners differ in number")
holds(closed(triangles.reshape(-1, 3)), "the triangles are not closed")
for end in (np.min, np.max):
    near = np.allclose(end(points, axis=0), end(corners, axis=0), rtol=1e-6, atol=0)
    holds(near, "bounding boxes differ")
# Single precision: 2^-24 relative for each coordinate.
rough = enclosed(solid.vectors)
holds(abs(rough / volume - 1) < 1e-6, f"volume {rough} instead of {volume} within the triangles")
turned = np.einsum("ij,ij->i", np.cross(solid.v1 - solid.v0, solid.v2 - solid.v0), solid.normals)
holds((turned > 0).all(), "a normal points inwards")
print(f"{name}: {len(quads)} faces, {len(points)} corners, volume {found:.9f}, error {error:.1e}")
