#!/usr/bin/env python3
"""Sampled worst values of what a design's machines do, by kinematics of this file's own, against certified bounds.

    python3 benches/sampled.py [--samples 100000] [--seed 1] [--beyond] ORTHOCERT DESIGN.toml...

ORTHOCERT is the program. Of every design: `bounds --relative 0.01`, then poses, machines of the tolerance and joint
errors, at random, on the workspace's border, and from the worst so far at the ends of tolerances that sensitivities
choose. Leg vectors come from the drives' constraints, poses from joint coordinates by Newton's method, accelerations
from second differences along motions, distances of bodies from their segments. Prints, for each quantity, the
worst sampled as a part of what `bounds` certifies, and how many values are beyond it: none may be. With `--beyond`
each quantity becomes a requirement 1 % beyond the worst sampled, which `verify` has to certify, and 1 % inside, which it
has to refute: verdict, leaves and processor time of both. Needs numpy. Nothing is certified here.
"""

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import tomllib
from fractions import Fraction

import numpy as np

STEP = 1e-20  # of derivatives by complex steps


def dot(a, b):
    return (a * b).sum(-1)


def cross(a, b):
    return np.stack([a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1], a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
                     a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]], axis=-1)


def unit(a):
    return a / np.sqrt(dot(a, a))[..., None]


def number(text):
    if not isinstance(text, str):
        return float(text)
    if not re.fullmatch(r"[\d.eE+\-*/() sqrt]+", text):
        raise SystemExit(f"no number: {text}")
    return float(eval(text, {"sqrt": np.sqrt}))  # noqa: S307


def toleranced(x):
    """Middle and half-width of a number of a design."""
    if isinstance(x, dict):
        low, high = number(x["min"]), number(x["max"])
        return (low + high) / 2, (high - low) / 2
    parts = re.split(r"±|\+/-", x) if isinstance(x, str) else [x]
    return number(parts[0]), number(parts[1]) if len(parts) > 1 else 0.0


def rotation(v):
    """Rotations by vectors: about them, by their lengths."""
    angle = np.sqrt(dot(v, v))[..., None, None]
    k = np.zeros(v.shape[:-1] + (3, 3))
    k[..., 0, 1], k[..., 0, 2], k[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    k = k - np.swapaxes(k, -1, -2)
    half = np.sinc(angle / 2 / np.pi)
    return np.eye(3) + np.sinc(angle / np.pi) * k + half * half / 2 * k @ k


def about(axis, angle):
    v = np.zeros(angle.shape + (3,))
    v[..., axis] = angle
    return rotation(v)


def turned_by(r):
    """Angle of rotations, degrees, exact where it is small."""
    skew = np.stack([r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]], -1)
    return np.degrees(np.arctan2(np.sqrt(dot(skew, skew)), np.trace(r, axis1=-2, axis2=-1) - 1))


class Set:
    """Poses: a box, of which some coordinates are bound to a ball. `project` puts any vector into it."""

    def __init__(self, low, high, balls=()):
        self.low, self.high, self.balls = np.array(low, float), np.array(high, float), balls

    def project(self, q):
        q = np.clip(q, self.low, self.high)
        for indices, center, radius in self.balls:
            d = q[:, indices] - center
            far = np.sqrt(dot(d, d))
            q[:, indices] = center + d * np.minimum(1, radius / np.maximum(far, 1e-300))[:, None]
        return q

    def draw(self, rng, n):
        """A half anywhere, a half on faces, edges and corners."""
        u = rng.uniform(-1, 1, (n, len(self.low)))
        u[n // 2:] = np.clip(u[n // 2:] * rng.choice([1.0, 2.0, 20.0], (n - n // 2, 1)), -1, 1)
        # A ball's coordinates reach its border in all directions.
        for indices, _, _ in self.balls:
            d = rng.normal(size=(n, len(indices)))
            share = rng.random(n) ** (1 / len(indices))
            share[n // 2:] = np.where(rng.random(n - n // 2) < 0.8, 1, share[n // 2:])
            u[:, indices] = d / np.sqrt(dot(d, d))[:, None] * share[:, None]
        return self.project((self.low + self.high) / 2 + u * (self.high - self.low) / 2)


class Design:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.table = tomllib.load(file, parse_float=str)
        mechanism, self.require = self.table["mechanism"], self.table.get("requirements", {})
        self.kind = mechanism["kind"]
        self.ell = number(mechanism.get("characteristic_length", 1))
        self.radii, self.slots = [], {}
        self.middles = {}
        self.workspace = self.table["workspace"]
        if self.kind == "formulas":
            self.formulas(mechanism)
        else:
            legs = self.cube() if "cube" in self.workspace else mechanism.get("legs") or self.orthoglide(mechanism)
            self.legs(legs)
        self.bodies = mechanism.get("bodies", [])
        self.poses()
        self.k = len(self.radii)

    # What is written

    def slot(self, name, x):
        middle, radius = toleranced(x)
        self.middles[name] = middle
        if radius > 0:
            self.slots[name] = len(self.radii)
            self.radii.append(radius)

    def orthoglide(self, mechanism):
        offset, base = mechanism.get("offset", 0), mechanism.get("base", 0)
        length, legs = mechanism["leg_length"], []
        for i in range(3):
            n = [int(i == j) for j in range(3)]
            at = lambda x, sign: [x if j == i else 0 for j in range(3)]  # noqa: E731
            o, _ = toleranced(offset)
            legs.append({"drive": "slider", "direction": n, "anchor": at(base, 1), "platform": at(-o, 1),
                         "length": length, "mode": "+"})
        return legs

    def cube(self):
        """The paper's Steps 1 to 3."""
        kappa, side = 1 / number(self.require["transmission"]["max"]), number(self.workspace["cube"])
        t = [(1 - kappa) / 2, 1 - kappa if kappa <= 0.5 else (1 / kappa - 1) / 2]
        q = [-t[0] / np.sqrt(1 + 2 * t[0] ** 2), t[1] / np.sqrt(1 + 2 * t[1] ** 2)]
        length = side / (q[1] - q[0])
        low, high = length * q[0], length * q[1]
        self.workspace = {"min": [low] * 3, "max": [high] * 3}
        return self.orthoglide({"leg_length": length, "base": low - length})

    def legs(self, legs):
        self.given, self.n = legs, len(legs)
        for i, leg in enumerate(legs):
            leg.setdefault("platform", [0, 0, 0])
            leg.setdefault("anchor", [0, 0, 0])
            if leg["drive"] == "arm":
                leg.setdefault("axis", [0, 0, 1])
                leg.setdefault("reference", [1, 0, 0])
            for key in ("direction", "anchor", "platform", "axis", "reference"):
                for k, x in enumerate(leg.get(key, [])):
                    self.slot((i, key, k), x)
            for key in ("length", "arm"):
                if key in leg:
                    self.slot((i, key), leg[key])

    def formulas(self, mechanism):
        self.names = mechanism["coordinates"]
        code = lambda text: compile(str(text).replace("^", "**"), "formula", "eval")  # noqa: E731
        for name, x in mechanism.get("parameters", {}).items():
            self.slot(name, x)
        self.parameters = list(mechanism.get("parameters", {}))
        self.definitions = [(name, code(text)) for name, text in mechanism.get("definitions", {}).items()]
        self.joints = [code(j["rho"]) if "rho" in j else [code(x) for x in j["row"]] for j in mechanism["joints"]]
        self.n = len(self.joints)
        self.given = [{} for _ in self.joints]

    def poses(self):
        w, kind = self.workspace, self.kind
        low, high, balls = [], [], []
        if "cylinder" in w:
            c = w["cylinder"]
            center, radius = np.array([number(x) for x in c["center"]]), number(c["radius"])
            low, high = list(center - radius) + [number(c["z"][0])], list(center + radius) + [number(c["z"][1])]
            balls.append(([0, 1], center, radius))
        elif "min" in w:
            low, high = [number(x) for x in w["min"]], [number(x) for x in w["max"]]
        self.m0 = len(low)
        o = w.get("orientation")
        self.orientation = None
        if o and kind == "planar":
            a = [np.radians(number(x)) for x in o["angle"]]
            low, high, self.orientation = low + [a[0]], high + [a[1]], "planar"
        elif o:
            start = len(low)
            if "angle" in o:
                most = np.radians(number(o["angle"]))
                low, high = low + [-most] * 3, high + [most] * 3
                balls.append((list(range(start, start + 3)), np.zeros(3), most))
                self.orientation = "angle"
            elif "tilt" in o:
                tilt, torsion = np.radians(number(o["tilt"])), np.radians(number(o["torsion"]))
                low, high = low + [-tilt, -tilt, -torsion], high + [tilt, tilt, torsion]
                balls.append(([start, start + 1], np.zeros(2), tilt))
                self.orientation = "tilt"
            else:
                for key in ("roll", "pitch", "yaw"):
                    low.append(np.radians(number(o[key][0])))
                    high.append(np.radians(number(o[key][1])))
                self.orientation = "euler"
        self.set = Set(low, high, balls)
        self.m = len(low)
        # Columns of a twist (v, omega) that the motion has.
        self.columns = {"spatial": range(6), "spherical": range(3, 6), "planar": [0, 1, 5] if o else [0, 1],
                        "formulas": range(self.m)}.get(kind, range(3))
        self.columns = list(self.columns)

    # Pose and machine

    def pose(self, q):
        n = len(q)
        p, r = np.zeros((n, 3)), np.broadcast_to(np.eye(3), (n, 3, 3))
        p[:, :self.m0] = q[:, :self.m0]
        o = q[:, self.m0:]
        if self.orientation == "planar":
            r = about(2, o[:, 0])
        elif self.orientation == "angle":
            r = rotation(o)
        elif self.orientation == "tilt":
            tilt = rotation(np.stack([o[:, 0], o[:, 1], 0 * o[:, 0]], -1))
            r = tilt @ about(2, o[:, 2])
        elif self.orientation == "euler":
            r = about(2, o[:, 2]) @ about(1, o[:, 1]) @ about(0, o[:, 0])
        return p, r

    def value(self, name, t):
        middle = self.middles[name]
        at = self.slots.get(name)
        return np.full(len(t), middle) if at is None else middle + self.radii[at] * t[:, at]

    def vector(self, i, key, t):
        v = np.zeros((len(t), 3))
        for k in range(len(self.given[i][key])):
            v[:, k] = self.value((i, key, k), t)
        return v

    def kinematics(self, pose, t):
        if self.kind == "formulas":
            return Formulas(self, pose, t)
        return Legs(self, pose, t)

    def at(self, q, t):
        return self.kinematics(q if self.kind == "formulas" else self.pose(q), t)

    def middle(self, n):
        return np.zeros((n, self.k))


class Legs:
    """Joint coordinates, leg vectors and rows of M of machines of legs."""

    def __init__(self, design, pose, t):
        self.d, (self.p, self.r), n = design, pose, len(t)
        shape = (n, design.n)
        self.rho, self.eta, self.length = np.zeros(shape), np.full(shape, np.nan), np.ones(shape)
        self.leg, self.row = np.zeros(shape + (3,)), np.zeros(shape + (3,))
        self.tip, self.base, self.angle = np.zeros(shape + (3,)), np.zeros(shape + (3,)), np.full(shape, np.nan)
        with np.errstate(invalid="ignore"):
            for i, leg in enumerate(design.given):
                self.one(i, leg, t)
        moment = cross(self.tip - self.p[:, None], self.row)
        self.m = np.concatenate([self.row, moment / design.ell], axis=2)[:, :, design.columns]

    def one(self, i, leg, t):
        d, drive = self.d, leg["drive"]
        b, a = d.vector(i, "platform", t), d.vector(i, "anchor", t)
        tip = self.p + np.einsum("sij,sj->si", self.r, b)
        w = tip - a
        if drive in ("slider", "arm"):
            length, mode = d.value((i, "length"), t), {"+": 1, "-": -1}[leg["mode"]]
        if drive == "slider":
            n = unit(d.vector(i, "direction", t))
            along = dot(n, w)
            # |w - rho n| = L, the leg along the guide's direction or against it.
            rho = along - mode * np.sqrt(length ** 2 - dot(w, w) + along ** 2)
            motion, base = n, a + rho[:, None] * n
        elif drive == "strut":
            rho = np.sqrt(dot(w, w))
            motion, base = unit(w), a
            length = rho
        elif drive == "planar":
            n = unit(d.vector(i, "direction", t))
            rho, length = dot(n, w), 1
            motion, base = n, tip - n
        else:
            k = unit(d.vector(i, "axis", t))
            e = d.vector(i, "reference", t)
            e = unit(e - dot(e, k)[:, None] * k)
            f, arm = cross(k, e), d.value((i, "arm"), t)
            # |w - arm (cos e + sin f)| = L: of two elbows that of the mode.
            x, y = dot(w, e), dot(w, f)
            h = np.sqrt(x ** 2 + y ** 2)
            spread = np.arccos((dot(w, w) + arm ** 2 - length ** 2) / (2 * arm * h))
            best = None
            for side in (1, -1):
                angle = np.arctan2(y, x) + side * spread
                out = np.cos(angle)[:, None] * e + np.sin(angle)[:, None] * f
                tangent = cross(k, out)
                right = np.sign(dot(w - arm[:, None] * out, tangent)) == mode
                if best is None:
                    best = [angle, out, tangent]
                else:
                    best = [np.where(right if z.ndim == 1 else right[:, None], z, y0)
                            for z, y0 in zip([angle, out, tangent], best)]
            angle, out, tangent = best
            rho = np.degrees((angle + np.pi) % (2 * np.pi) - np.pi)
            motion, base = arm[:, None] * tangent, a + arm[:, None] * out
        c = tip - base
        self.row[:, i] = c / dot(c, motion)[:, None]
        self.rho[:, i], self.leg[:, i], self.length[:, i] = rho, c, length
        self.tip[:, i], self.base[:, i] = tip, base
        if drive in ("slider", "arm"):
            self.eta[:, i] = np.abs(dot(c, unit(motion)))
        if drive == "slider":
            self.angle[:, i] = np.degrees(np.arccos(mode * dot(c, n) / length))

    def moved(self, step):
        """The pose after a twist's step, in the columns of M."""
        full = np.zeros((len(step), 6))
        full[:, self.d.columns] = step
        return self.p + full[:, :3], rotation(full[:, 3:] / self.d.ell) @ self.r

    def off(self, other):
        return np.sqrt(dot(self.p - other[0], self.p - other[0])), turned_by(self.r @ np.swapaxes(other[1], 1, 2))


class Formulas:
    def __init__(self, design, q, t):
        self.d, self.q, self.t = design, q, t
        shape = (len(t), design.n)
        self.eta = self.angle = np.full(shape, np.nan)
        rho, self.m = np.full(shape, np.nan), np.zeros(shape + (design.m,))
        with np.errstate(invalid="ignore"):
            plain = self.scope(q.astype(complex))
            for i, joint in enumerate(design.joints):
                if isinstance(joint, list):
                    self.m[:, i] = np.stack([np.real(eval(c, plain)) * np.ones(len(t)) for c in joint], -1)  # noqa: S307
                else:
                    rho[:, i] = np.real(eval(joint, plain))  # noqa: S307
            for k in range(design.m):
                stepped = q.astype(complex)
                stepped[:, k] += 1j * STEP
                scope = self.scope(stepped)
                for i, joint in enumerate(design.joints):
                    if not isinstance(joint, list):
                        self.m[:, i, k] = np.imag(eval(joint, scope)) / STEP  # noqa: S307
        self.rho = rho

    def scope(self, q):
        scope = {"sqrt": np.sqrt, **{name: self.d.value(name, self.t) for name in self.d.parameters}}
        scope |= {name: q[:, k] for k, name in enumerate(self.d.names)}
        for name, code in self.d.definitions:
            scope[name] = eval(code, scope)  # noqa: S307
        return scope

    def moved(self, step):
        return self.q + step


# Values: each a function of poses and machines that answers one number a sample, and whether its least is meant.

def singular(k):
    bad = ~np.isfinite(k.m).all((1, 2))
    s = np.linalg.svd(np.where(bad[:, None, None], 1, k.m), compute_uv=False)
    s[bad] = np.nan
    return s


def curvature(design, q, t):
    """The spectral norm of each joint's second derivative along motions of constant twist."""
    k, m = design.at(q, t), design.m
    scale = np.nanmax(np.abs(k.rho[:100])) if design.kind == "formulas" else design.ell if design.orientation else \
        np.nanmedian(np.sqrt(dot(k.leg, k.leg)))
    h = 1e-4 * scale
    def second(direction):
        there = [design.kinematics(k.moved(np.broadcast_to(sign * h * direction, (len(q), m))), t).rho for sign in (1, -1)]
        return wrapped(design, there[0] - k.rho) / h ** 2 + wrapped(design, there[1] - k.rho) / h ** 2
    eye, hessian = np.eye(m), np.zeros((len(q), design.n, m, m))
    for i in range(m):
        hessian[:, :, i, i] = second(eye[i])
    for i in range(m):
        for j in range(i):
            both = (second(eye[i] + eye[j]) - hessian[:, :, i, i] - hessian[:, :, j, j]) / 2
            hessian[:, :, i, j] = hessian[:, :, j, i] = both
    bad = ~np.isfinite(hessian).all((2, 3))
    norm = np.abs(np.linalg.eigvalsh(np.where(bad[..., None, None], 0, hessian))).max(-1)
    norm[bad] = np.nan
    return norm


def angular(design):
    return np.array([leg.get("drive") == "arm" for leg in design.given])


def wrapped(design, difference):
    return np.where(angular(design), (difference + 180) % 360 - 180, difference)


def segments(a, b, c, d):
    """Distances of segments from a to b and from c to d."""
    def point(p, a, b):
        along = b - a
        s = np.clip(dot(p - a, along) / np.maximum(dot(along, along), 1e-300), 0, 1)
        e = p - a - s[..., None] * along
        return np.sqrt(dot(e, e))
    best = np.minimum(np.minimum(point(a, c, d), point(b, c, d)), np.minimum(point(c, a, b), point(d, a, b)))
    u, v, w = b - a, d - c, a - c
    det = dot(u, u) * dot(v, v) - dot(u, v) ** 2
    with np.errstate(all="ignore"):
        s = (dot(u, v) * dot(v, w) - dot(v, v) * dot(u, w)) / det
        r = (dot(u, u) * dot(v, w) - dot(u, v) * dot(u, w)) / det
    inside = (det > 0) & (s >= 0) & (s <= 1) & (r >= 0) & (r <= 1)
    e = np.where(inside[:, None], w + s[:, None] * u - r[:, None] * v, np.inf)
    return np.where(inside, np.minimum(best, np.sqrt(dot(np.nan_to_num(e, posinf=1e150), np.nan_to_num(e, posinf=1e150)))), best)


def clearance(design, k):
    capsules = []
    for i, leg in enumerate(design.given):
        if "rod" not in leg:
            continue
        rod, along = leg["rod"], unit(k.leg[:, i])
        trim = [number(x) for x in rod.get("trim", [0, 0])]
        ends = k.base[:, i] + trim[0] * along, k.tip[:, i] - trim[1] * along
        sides = [None]
        if "spread" in rod:
            axis = np.array([number(x) for x in rod["axis"]])
            side = number(rod["spread"]) / 2 * axis / np.linalg.norm(axis)
            sides = [side, -side]
        for side in sides:
            capsules.append((ends[0] + (0 if side is None else side), ends[1] + (0 if side is None else side),
                             number(rod["radius"]), ("leg", i), along))
    for body in design.bodies:
        ends = [np.array([number(x) for x in body[key]]) for key in ("from", "to")]
        if body["on"] == "platform":
            ends = [k.p + np.einsum("sij,j->si", k.r, e) for e in ends]
        else:
            ends = [np.broadcast_to(e, k.p.shape) for e in ends]
        capsules.append((*ends, number(body["radius"]), body["on"], None))
    best = np.full(len(k.p), np.inf)
    for i, one in enumerate(capsules):
        for two in capsules[:i]:
            if one[3] == two[3]:
                if one[4] is None:
                    continue
                # Parallel rods of one leg: the distance of their lines.
                across = cross(one[0] - two[0], one[4])
                gap = np.sqrt(dot(across, across))
            else:
                gap = segments(*one[:2], *two[:2])
            best = np.minimum(best, gap - one[2] - two[2])
    return best


def joint_angle(design, k, key):
    most = []
    for i, leg in enumerate(design.given):
        if key in leg:
            axis = np.array([number(x) for x in leg[key]["axis"]])
            axis = np.broadcast_to(axis, k.p.shape) if key == "base_joint" else np.einsum("sij,j->si", k.r, axis)
            most.append(np.degrees(np.arccos(np.clip(dot(unit(k.leg[:, i]), unit(axis)), -1, 1))))
    return np.max(most, axis=0)


def constraint(design, k):
    couples = []
    for i, leg in enumerate(design.given):
        axis = unit(np.array([number(x) for x in leg["base_axis"]]))
        u = unit(k.leg[:, i])
        couples.append(unit(u - dot(u, axis)[:, None] * axis))
    return np.linalg.svd(np.stack(couples, 1), compute_uv=False)[:, -1]


def inverse(k):
    bad = ~np.isfinite(k.m).all((1, 2))
    y = np.linalg.inv(np.where(bad[:, None, None], np.eye(k.m.shape[1]), k.m))
    y[bad] = np.nan
    return y


class Accuracy:
    """Where the platform is, by Newton's method from where it is commanded; errors follow the tolerances."""

    def __init__(self, design, angle):
        self.d, self.angle = design, angle
        self.error = toleranced(design.require["accuracy"]["joint_error"])[0]

    def solve(self, q, t):
        d, n = self.d, self.d.n
        tolerance, errors = t[:, :d.k], t[:, d.k:] * self.error
        first = d.at(q, d.middle(len(q)))
        wanted = first.rho + errors
        pose = q if d.kind == "formulas" else (first.p, first.r)
        in_radians = np.where(angular(d), np.radians(1), 1)
        for _ in range(8):
            k = d.kinematics(pose, tolerance)
            left = wrapped(d, wanted - k.rho) * in_radians
            bad = ~np.isfinite(k.m).all((1, 2))
            step = np.linalg.solve(np.where(bad[:, None, None], np.eye(n), k.m), left[..., None])[..., 0]
            pose = k.moved(step)
        k = d.kinematics(pose, tolerance)
        lost = np.abs(wrapped(d, wanted - k.rho)).max(1)
        self.residual = np.nanmax(lost)
        if d.kind == "formulas":
            off = pose - q
            return np.sqrt(dot(off, off)), 0 * off[:, 0]
        return k.off((first.p, first.r))

    def __call__(self, q, t):
        distance, turned = self.solve(q, t)
        return turned if self.angle else distance

    def corners(self, q, t, rng):
        """Ends of tolerances and joint errors for a direction that grows by itself."""
        d = self.d
        first = d.at(q, d.middle(len(q)))
        in_radians = np.where(angular(d), np.radians(1), 1)
        effect = np.zeros((len(q), d.n, d.k + d.n))
        for j in range(d.k):
            ends = []
            for end in (1, -1):
                s = d.middle(len(q))
                s[:, j] = end
                pose = q if d.kind == "formulas" else (first.p, first.r)
                ends.append(d.kinematics(pose, s).rho)
            effect[:, :, j] = -wrapped(d, ends[0] - ends[1]) / 2 * in_radians
        effect[:, range(d.n), range(d.k, d.k + d.n)] = self.error * in_radians
        g = inverse(first) @ effect
        if d.orientation:
            g = g[:, [c > 2 for c in d.columns] if self.angle else [c <= 2 for c in d.columns]]
        direction = rng.normal(size=g.shape[:2])
        for _ in range(4):
            s = np.where(np.einsum("sij,si->sj", g, direction) < 0, -1.0, 1.0)
            direction = np.einsum("sij,sj->si", g, s)
        return s


def quantities(design, wanted):
    """For each (quantity, end) of `wanted`: a function, and how many numbers beside the pose it takes."""
    out, n = {}, design.n
    given = lambda key, name, other: number(design.require.get(key, {}).get(name, other))  # noqa: E731
    turning = bool(design.orientation) and design.kind != "spherical"
    degrees = np.where(angular(design), np.degrees(1), 1)
    joints = design.require.get("stiffness", {}).get("joint", 1)
    joints = np.array([number(x) for x in joints] if isinstance(joints, list) else [number(joints)] * n)
    for name, end in wanted:
        f = None
        if name == "psi":
            f = lambda k, least=end == "least": 1 / singular(k)[:, 0 if least else -1]  # noqa: E731
        elif name.startswith("rho_"):
            f = lambda k, i=int(name[4:]) - 1: k.rho[:, i]  # noqa: E731
        elif name == "sigma_max/sigma_min":
            f = lambda k: singular(k)[:, 0] / singular(k)[:, -1]  # noqa: E731
        elif name == "|eta_i|/L_i":
            f = lambda k: np.nanmin(k.eta / k.length, axis=1)  # noqa: E731
        elif name.startswith("|det A|"):
            f = lambda k: np.abs(np.linalg.det(unit(k.leg)[:, :, [c for c in design.columns]]))  # noqa: E731
        elif name == "leg angle":
            f = lambda k: np.nanmax(k.angle, axis=1)  # noqa: E731
        elif name == "joint/tool speed":
            f = lambda k: (np.sqrt(dot(k.m, k.m)) * degrees).max(1)  # noqa: E731
        elif name == "stiffness":
            f = lambda k: np.linalg.eigvalsh(np.nan_to_num(  # noqa: E731
                np.einsum("sni,n,snj->sij", k.m, joints, k.m)))[:, 0]
        elif name == "joint force":
            f = lambda k, tool=given("joint_force", "tool", 1): tool * np.sqrt(  # noqa: E731
                (inverse(k) ** 2).sum(1)).max(1)
        elif name == "clearance":
            f = lambda k: clearance(design, k)  # noqa: E731
        elif name in ("base joint", "platform joint"):
            f = lambda k, key=name.replace(" ", "_"): joint_angle(design, k, key)  # noqa: E731
        elif name == "constraint margin":
            f = lambda k: constraint(design, k)  # noqa: E731
        if f:
            out[name, end] = (lambda q, t, f=f: f(design.at(q, t))), design.k, None
        elif name == "joint acceleration":
            a, v = given("joint_acceleration", "acceleration", 0), given("joint_acceleration", "speed", 0)
            def f(q, t, a=a, v=v):
                row = np.sqrt(dot(*[design.at(q, t).m] * 2)) * degrees
                return (row * a + curvature(design, q, t) * v * v).max(1)
            out[name, end] = f, design.k, None
        elif name.startswith("accuracy"):
            how = Accuracy(design, "angle" in name or (bool(design.orientation) and not turning))
            out[name, end] = how, design.k + n, how
    return out


def gradient_signs(f, q, t, sense):
    s = t.copy()
    for j in range(t.shape[1]):
        up, down = t.copy(), t.copy()
        up[:, j], down[:, j] = np.minimum(t[:, j] + 0.5, 1), np.maximum(t[:, j] - 0.5, -1)
        s[:, j] = np.where(sense * (f(q, up) - f(q, down)) < 0, -1, 1)
    return s


def worst(design, name, end, f, size, corners, samples, rng):
    """All sampled values, and the worst with its pose and machine."""
    sense = 1 if end == "greatest" else -1
    values = []
    def run(q, t):
        v = f(q, t)
        values.append(v)
        return np.where(np.isfinite(v), sense * v, -np.inf)
    q = design.set.draw(rng, samples)
    t = rng.uniform(-1, 1, (samples, size))
    ends = rng.random(samples) < 2 / 3
    t[ends] = np.sign(t[ends])
    if corners and size:
        t[ends] = corners.corners(q[ends], t[ends], rng)
    score = run(q, t)
    scale = (design.set.high - design.set.low) / 8
    keep = 60
    for around in range(24):
        best = np.argsort(-score)[:keep]
        q, t, score = q[best], t[best], score[best]
        if size and around % 4 == 0:
            s = corners.corners(q, t, rng) if corners else gradient_signs(f, q, t, sense)
            q2, t2 = q, s
            score2 = run(q2, t2)
            q, t, score = np.concatenate([q, q2]), np.concatenate([t, t2]), np.concatenate([score, score2])
        many = np.repeat(np.arange(len(q)), 10)
        step = rng.normal(size=(len(many), design.m)) * scale
        step *= rng.random(step.shape) < rng.choice([0.3, 1.0], (len(many), 1))
        q2 = design.set.project(q[many] + step)
        t2 = t[many]
        if corners and size:
            t2 = np.where(rng.random(len(many))[:, None] < 0.5, corners.corners(q2, t2, rng), t2)
        score2 = run(q2, t2)
        q, t, score = np.concatenate([q, q2]), np.concatenate([t, t2]), np.concatenate([score, score2])
        scale = scale * 0.75
    best = np.argmax(score)
    return np.concatenate(values), sense * score[best], q[best], t[best]


# A requirement 1 % beyond, and 1 % inside

def toml(x):
    if isinstance(x, bool):
        return "true" if x else "false"
    if isinstance(x, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in x.items()) + " }"
    if isinstance(x, list):
        return "[" + ", ".join(map(toml, x)) + "]"
    return json.dumps(x, ensure_ascii=False) if isinstance(x, str) else str(x)


REQUIREMENT = {
    "psi": "transmission", "sigma_max/sigma_min": "conditioning", "|eta_i|/L_i": "serial_margin",
    "|det A|/(L_1 .. L_n)": "parallel_margin", "leg angle": "leg_angle", "joint/tool speed": "joint_speed",
    "stiffness": "stiffness", "joint acceleration": "joint_acceleration", "joint force": "joint_force",
    "accuracy": "accuracy", "accuracy of the angle": "accuracy", "clearance": "clearance",
    "base joint": "base_joint", "platform joint": "platform_joint", "constraint margin": "constraint_margin",
}


def claim(table, name, end, bound, stroke, other):
    """The design with one requirement, or `None` where it is one of a leg's keys."""
    key, require = REQUIREMENT.get(name, "joint_range"), {}
    own = table.get("requirements", {}).get(key)
    text = repr(float(bound))
    side = "max" if end == "greatest" else "min"
    if key == "joint_range":
        i = int(name[4:]) - 1
        n = len(stroke)
        ranges = [{"min": repr(float(a)), "max": repr(float(b))} for a, b in stroke]
        ranges[i][side] = text
        require = ranges if n > 1 else ranges[0]
    elif key == "joint_speed":
        require = {"tool": 1, "max": text}
    elif name == "accuracy of the angle":
        require = dict(own, max_angle=text, max=other)
    elif name == "accuracy" and "max_angle" in own:
        require = dict(own, max=text, max_angle=other)
    else:
        require = dict(own) if isinstance(own, dict) else {}
        require = {k: v for k, v in require.items() if k not in ("min", "max")}
        if key == "stiffness":
            require.setdefault("joint", 1)
        if key == "joint_force":
            require.setdefault("tool", 1)
        require[side] = text
    design = {"mechanism": dict(table["mechanism"]), "workspace": table["workspace"]}
    if key != "clearance":
        design["mechanism"].pop("bodies", None)
    legs = design["mechanism"].get("legs")
    if legs:
        drop = {"clearance": {"base_joint", "platform_joint"}, "base_joint": {"rod", "platform_joint"},
                "platform_joint": {"rod", "base_joint"}}.get(key, {"rod", "base_joint", "platform_joint"})
        if key != "constraint_margin":
            drop = drop | {"base_axis"}
        legs = [{k: v for k, v in leg.items() if k not in drop} for leg in legs]
        if key in ("base_joint", "platform_joint"):
            for leg in legs:
                if key in leg:
                    leg[key] = dict(leg[key], max=text)
        design["mechanism"]["legs"] = legs
    if key not in ("base_joint", "platform_joint"):
        design["requirements"] = {key: require}
    return "\n".join(f"{k} = {toml(v)}" for k, v in design.items())


def required(design, name, end):
    """The design's own bound, if it has one."""
    own = design.require.get(REQUIREMENT.get(name, "joint_range"))
    if isinstance(own, list):
        own = own[int(name[4:]) - 1] if name.startswith("rho_") else None
    if not isinstance(own, dict):
        return None
    side = "max_angle" if "angle" in name and "accuracy" in name else "max" if end == "greatest" else "min"
    return number(own[side]) if side in own else None


def verify(program, text, folder, limit):
    path = os.path.join(folder, "claim.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "verify", path, "--reprove", "--format", "json", "--timeout", str(limit)],
                          capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    try:
        answer = json.loads(done.stdout)
    except ValueError:
        return done.stderr.strip().split("\n")[0][:120], "-", seconds
    proof = answer.get("proof") or {}
    return answer["verdict"], proof.get("leaves", "-"), seconds


def one_to_one(design, samples, rng):
    """Pairs of poses of the workspace with the same joint coordinates, by Newton's method from poses at random."""
    q, t = design.set.draw(rng, samples), np.sign(rng.uniform(-1, 1, (samples, design.k)))
    start = design.set.draw(rng, samples)
    first = design.at(q, t)
    pose = start if design.kind == "formulas" else design.pose(start)
    in_radians = np.where(angular(design), np.radians(1), 1)
    for _ in range(20):
        k = design.kinematics(pose, t)
        left = wrapped(design, first.rho - k.rho) * in_radians
        bad = ~np.isfinite(k.m).all((1, 2))
        mm = np.where(bad[:, None, None], 0, k.m)
        step = np.einsum("sij,sj->si", np.linalg.pinv(mm), np.nan_to_num(left))
        pose = k.moved(step)
    k = design.kinematics(pose, t)
    found = np.abs(wrapped(design, first.rho - k.rho)).max(1) < 1e-9 * np.nanmax(np.abs(first.rho))
    if design.kind == "formulas":
        apart = np.sqrt(dot(pose - q, pose - q))
        inside = ((pose >= design.set.low) & (pose <= design.set.high)).all(1)
    else:
        apart, by = k.off((first.p, first.r))
        apart = apart + np.radians(by) * design.ell
        x = k.p[:, :design.m0]
        inside = ((x >= design.set.low[:design.m0]) & (x <= design.set.high[:design.m0])).all(1)
        if design.orientation == "angle":
            inside &= turned_by(k.r) <= np.degrees(design.set.high[-1])
    size = np.linalg.norm(design.set.high - design.set.low)
    return found.sum(), (found & inside & (apart > 1e-6 * size)).sum()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("designs", nargs="+")
    parser.add_argument("--samples", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--beyond", action="store_true")
    parser.add_argument("--timeout", type=float, default=3600, help="of each search, seconds by the clock")
    parser.add_argument("--only", default="", help="quantities with this in their names")
    arguments = parser.parse_args()
    if arguments.beyond:
        print("| design | quantity | sampled worst | 1 % beyond | leaves | s | 1 % inside | s |\n|---|---|---|---|---|---|---|---|")
    else:
        print("| design | quantity | certified | sampled worst | part, % | values | beyond |\n|---|---|---|---|---|---|---|")
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for path in arguments.designs:
            failed |= one(arguments, path, folder)
    sys.exit(int(failed))


def one(arguments, path, folder):
    design, rng = Design(path), np.random.default_rng(arguments.seed)
    title = os.path.basename(path)[:-5]
    done = subprocess.run([arguments.program, "bounds", path, "--relative", "0.01", "--format", "json", "--timeout",
                           str(arguments.timeout)], capture_output=True, text=True, check=False)
    rows = json.loads(done.stdout)["bounds"]
    certified = {}
    for row in rows:
        side = "max" if row["end"] == "greatest" else "min"
        certified[row["quantity"], row["end"]] = float(Fraction(row[side])) if side in row else None
    failed, worsts = False, {}
    with open(path, "rb") as file:
        table = tomllib.load(file, parse_float=str)
    for key, (f, size, corners) in quantities(design, certified).items():
        name, end = key
        if arguments.only and arguments.only not in name:
            continue
        samples = arguments.samples
        values, found, q, t = worst(design, name, end, f, size, corners, samples, rng)
        sense = 1 if end == "greatest" else -1
        outer = certified[key]
        worsts[key] = found
        if arguments.beyond:
            continue
        what = f"{title} | {end} {name}"
        if outer is None:
            # What the design requires is certified too.
            bound = required(design, name, end)
            beyond = int((sense * (values - bound) > 1e-9 * abs(bound)).sum()) if bound is not None else ""
            failed |= beyond not in (0, "")
            print(f"| {what} | not enclosed; required {bound} | {found:.6g} | | {len(values)} | {beyond} |", flush=True)
            continue
        beyond = int((sense * (values - outer) > 1e-9 * abs(outer)).sum())
        # Of joint coordinates, whose zero is anywhere, a part of the greatest.
        if name.startswith("rho_"):
            size = max(abs(certified[name, e]) for e in ("least", "greatest"))
            part = 1 - abs(outer - found) / size
        else:
            part = found / outer if sense > 0 else outer / found
        bad = beyond > 0 or part < 0.95
        failed |= bad
        print(f"| {what} | {outer:.6g} | {found:.6g} | {100 * part:.2f} | {len(values)} | {beyond} |"
              f"{' FAILED' if bad else ''}", flush=True)
        if name.startswith("accuracy") and corners:
            print(f"    residual of Newton's method {corners.residual:.1e}", file=sys.stderr)
    if design.require.get("one_to_one"):
        pairs, same = one_to_one(design, arguments.samples, rng)
        failed |= same > 0
        print(f"| {title} | one to one | | | | {pairs} | {same} |{' FAILED' if same else ''}", flush=True)
    if arguments.beyond:
        failed |= beyond_and_inside(arguments, design, table, title, worsts, folder)
    return failed


def beyond_and_inside(arguments, design, table, title, worsts, folder):
    failed = False
    strokes = []
    for i in range(design.n):
        ends = [worsts.get((f"rho_{i + 1}", end)) for end in ("least", "greatest")]
        strokes.append([ends[0] - 0.5 * (ends[1] - ends[0]), ends[1] + 0.5 * (ends[1] - ends[0])] if None not in ends else None)
    for (name, end), found in worsts.items():
        sense = 1 if end == "greatest" else -1
        part = 0.01 * abs(found)
        if name.startswith("rho_"):
            part = 0.01 * (worsts[name, "greatest"] - worsts[name, "least"])
        other = None
        if name.startswith("accuracy") and "max_angle" in table["requirements"]["accuracy"]:
            # The other bound as far from its own worst.
            twin = "accuracy" if "angle" in name else "accuracy of the angle"
            other = repr(float(1.01 * worsts[twin, "greatest"]))
        cells = []
        for away in (sense * part, -sense * part):
            text = claim(table, name, end, found + away, strokes, other)
            cells.append(verify(arguments.program, text, folder, arguments.timeout))
        bad = cells[0][0] != "certified" or cells[1][0] != "refuted"
        failed |= bad
        print(f"| {title} | {end} {name} | {found:.6g} | {cells[0][0]} | {cells[0][1]} | {cells[0][2]:.2f} | {cells[1][0]} | "
              f"{cells[1][2]:.2f} |{' FAILED' if bad else ''}", flush=True)
    return failed


if __name__ == "__main__":
    main()
