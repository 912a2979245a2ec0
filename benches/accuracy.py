#!/usr/bin/env python3
"""Where a hexapod of struts is, with joint errors and machines of its tolerance at random, against its design's bounds.

    python3 benches/accuracy.py DESIGN.toml [--samples 100000] [--seed 1]

The kinematics is this file's own: poses by Rodrigues' formula, lengths of struts by distances, the pose with given
lengths by Newton's method. Two thirds of the samples are corners: joint errors and tolerances at the ends that
sensitivities at the pose choose for one direction of the platform, or one axis. Prints the worst distance and angle,
each beside the bound. Needs numpy. Nothing is certified here: what is certified must not be exceeded.
"""

import argparse
import re
import tomllib

import numpy as np


def value(x):
    """A number of a design and its half-width."""
    if not isinstance(x, str):
        return float(x), 0.0
    parts = re.split(r"±|\+/-", x)
    number = lambda text: float(eval(text.replace("sqrt", "np.sqrt"), {"np": np}))  # noqa: E731, S307
    return number(parts[0]), number(parts[1]) if len(parts) > 1 else 0.0


def vectors(legs, key):
    both = np.array([[value(x) for x in leg.get(key, [0, 0, 0])] for leg in legs])
    return both[..., 0], both[..., 1]


def rotation(axis_angle):
    """Matrices of rotation vectors, one a row."""
    angle = np.linalg.norm(axis_angle, axis=1)
    k = axis_angle / np.where(angle > 0, angle, 1)[:, None]
    cross = np.zeros((len(k), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -k[:, 2], k[:, 1], -k[:, 0]
    cross -= cross.transpose(0, 2, 1)
    sin, cos = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + sin * cross + (1 - cos) * cross @ cross


def lengths(p, r, a, b):
    """Lengths, unit vectors, and arms of moments."""
    arm = np.einsum("sij,slj->sli", r, b)
    w = p[:, None, :] + arm - a
    rho = np.linalg.norm(w, axis=2)
    return rho, w / rho[..., None], arm


def jacobian(u, arm):
    return np.concatenate([u, np.cross(arm, u)], axis=2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("design")
    parser.add_argument("--samples", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with open(arguments.design, "rb") as file:
        design = tomllib.load(file)
    rng, n = np.random.default_rng(arguments.seed), arguments.samples
    legs, workspace = design["mechanism"]["legs"], design["workspace"]
    asked = design["requirements"]["accuracy"]
    (a0, da), (b0, db) = vectors(legs, "anchor"), vectors(legs, "platform")
    error = value(asked["joint_error"])[0]
    low, high = (np.array([value(x)[0] for x in workspace[key]]) for key in ("min", "max"))
    most = np.radians(value(workspace["orientation"]["angle"])[0])
    corner = rng.random(n) < 0.5
    u = rng.random((n, 3))
    p = low + np.where(corner[:, None], np.round(u), u) * (high - low)
    axis = rng.normal(size=(n, 3))
    angle = np.where(corner, most, most * np.cbrt(rng.random(n)))
    r = rotation(axis / np.linalg.norm(axis, axis=1)[:, None] * angle[:, None])
    commanded, unit, arm = lengths(p, r, np.broadcast_to(a0, (n, 6, 3)), np.broadcast_to(b0, (n, 6, 3)))
    # How each joint moves the platform along a direction, or about an axis, at random.
    along = np.zeros((n, 6))
    which = rng.integers(0, 2, n) * 3
    direction = rng.normal(size=(n, 3))
    for k in range(3):
        along[np.arange(n), which + k] = direction[:, k]
    weight = np.linalg.solve(jacobian(unit, arm).transpose(0, 2, 1), along[..., None])[..., 0]
    at_ends = rng.random(n)[:, None] < 2 / 3
    sign = lambda x: np.where(x < 0, -1.0, 1.0)  # noqa: E731
    pick = lambda best, shape: np.where(  # noqa: E731
        at_ends.reshape((n,) + (1,) * (len(shape) - 1)), best, rng.uniform(-1, 1, shape))
    errors = error * pick(sign(weight), (n, 6))
    # A longer strut, or an anchor moved along it, does the same.
    a = a0 + da * pick(sign(weight[..., None] * unit), (n, 6, 3))
    seen = np.einsum("sji,slj->sli", r, unit)
    b = b0 + db * pick(sign(-weight[..., None] * seen), (n, 6, 3))
    q, s = p.copy(), r.copy()
    for _ in range(12):
        rho, unit, arm = lengths(q, s, a, b)
        step = np.linalg.solve(jacobian(unit, arm), (commanded + errors - rho)[..., None])[..., 0]
        q, s = q + step[:, :3], rotation(step[:, 3:]) @ s
    left = np.abs(commanded + errors - lengths(q, s, a, b)[0]).max()
    off = np.linalg.norm(q - p, axis=1)
    turned = s @ r.transpose(0, 2, 1)
    # Of a small angle the sine, not the cosine.
    sine = np.linalg.norm(np.stack([turned[:, 2, 1] - turned[:, 1, 2], turned[:, 0, 2] - turned[:, 2, 0],
                                    turned[:, 1, 0] - turned[:, 0, 1]], axis=1), axis=1) / 2
    by = np.degrees(np.arcsin(sine))
    print(f"{n} poses, machines and joint errors of {arguments.design}; residual {left:.1e}")
    for name, found, bound in [("distance", off, "max"), ("angle, deg", by, "max_angle")]:
        limit = value(asked[bound])[0]
        print(f"{name:12} worst {found.max():.6g}, bound {limit:g}, beyond it {(found > limit).sum()}")


if __name__ == "__main__":
    main()
