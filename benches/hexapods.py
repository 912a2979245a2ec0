#!/usr/bin/env python3
"""Machines that turn their platform: leaves and processor time of bounds near the true extremes.

    python3 benches/hexapods.py table|random ORTHOCERT ORTHOCERT-CHECK

`table`: hexapods of fixed dimensions, with bounds so many percent of the extreme singular values of M. `random`:
twenty hexapods, six planar and six spherical machines drawn at random, with bounds 0.1 % beyond the extremes, to be
certified, and 0.1 % inside, to be refuted; and hexapods over workspaces 10, 1 and 0.1 % narrower than the first that
has a singularity, to be certified, and wider, to be refuted. The extremes are sampled by kinematics of this file's
own (rotations by half-angle tangents, ascents from the best of random poses). The times are processor time of `orthocert verify --threads 1`, with its exact check, and of `orthocert-check` on the
certificate, starts of processes included. Needs numpy.
"""

import json
import resource
import subprocess
import sys
import tempfile
from math import cos, radians, sin, tan
from pathlib import Path

import numpy as np

TIMEOUT = "300"  # seconds of the clock


class Machine:
    """Struts from `a` to `b`; positions in a box; a set of orientations as designs write it."""

    def __init__(self, kind, ell, a, b, box=None, orientation=None, tolerance=None):
        self.kind, self.ell, self.orientation, self.tolerance = kind, ell, orientation, tolerance
        self.a, self.b = np.round(a, 9), np.round(b, 9)
        self.box = np.round(box, 9) if box is not None else None
        self.positions = 0 if box is None else len(self.box[0])

    def design(self, requirements):
        number = (lambda x: f'"{x:.9f} ± {self.tolerance}"') if self.tolerance else (lambda x: f"{x:.9f}")
        vector = lambda v: "[" + ", ".join(map(number, v)) + "]"  # noqa: E731
        legs = "".join(f'[[mechanism.legs]]\ndrive = "strut"\nanchor = {vector(a)}\nplatform = {vector(b)}\n'
                       for a, b in zip(self.a, self.b))
        box = "".join(f"{key} = {[float(x) for x in end]}\n"
                      for key, end in zip(("min", "max"), self.box if self.positions else ()))
        pairs = ", ".join(f"{key} = {value}" for key, value in self.orientation.items())
        return (f'[mechanism]\nkind = "{self.kind}"\ncharacteristic_length = {self.ell}\n{legs}'
                f"[workspace]\n{box}orientation = {{ {pairs} }}\n[requirements]\n{requirements}\n")

    def poses(self, u):
        """Positions and rotations at points of [0, 1]^n."""
        p = np.zeros((len(u), self.positions))
        if self.positions:
            p = self.box[0] + u[:, :self.positions] * (self.box[1] - self.box[0])
        v, o = u[:, self.positions:], self.orientation
        if self.kind == "planar":
            low, high = np.radians(o["angle"])
            angle = low + v[:, 0] * (high - low)
            return p, np.moveaxis(np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]), 2, 0)
        if "roll" in o:
            r = np.eye(3)
            for axis, key in ((2, "yaw"), (1, "pitch"), (0, "roll")):
                low, high = np.tan(np.radians(o[key]) / 2)
                c = np.zeros((len(u), 3))
                c[:, axis] = low + v[:, axis] * (high - low)
                r = r @ cayley(c)
            return p, r
        c = 2 * v - 1
        if "angle" in o:
            c *= tan(radians(o["angle"]) / 2)
            most = tan(radians(o["angle"]) / 2)
            part = np.linalg.norm(c, axis=1)
        else:
            c[:, 2] *= tan(radians(o["torsion"]) / 2)
            most = tan(radians(o["tilt"]) / 2) * np.sqrt(1 + c[:, 2] ** 2)
            c[:, :2] *= most[:, None]
            part = np.hypot(c[:, 0], c[:, 1])
        shrink = np.minimum(1, most / np.maximum(part, 1e-300))
        c[:, :3 if "angle" in o else 2] *= shrink[:, None]
        return p, cayley(c)

    def matrices(self, u):
        p, r = self.poses(u)
        arm = np.einsum("sij,lj->sli", r, self.b)
        leg = (p[:, None, :] if self.positions else 0) + arm - self.a
        unit = leg / np.linalg.norm(leg, axis=2)[..., None]
        if self.kind == "planar":
            moment = (arm[..., 0] * unit[..., 1] - arm[..., 1] * unit[..., 0])[..., None]
        else:
            moment = np.cross(arm, unit)
        return np.concatenate([unit, moment / self.ell], axis=2) if self.positions else moment / self.ell

    def least(self, value, seed, starts=60, steps=1_500):
        """The least value of a function of matrices, by descents."""
        random = np.random.default_rng(seed)
        n = self.positions + (1 if self.kind == "planar" else 3)
        u = np.clip(random.random((20_000, n)) * 1.4 - 0.2, 0, 1)
        known = value(self.matrices(u))
        best = np.argsort(known)[:starts]
        u, known = u[best], known[best]
        size = np.full(starts, 0.2)
        for _ in range(steps):
            step = random.normal(size=u.shape) * (random.random(u.shape) < random.random((starts, 1)))
            after = np.clip(u + size[:, None] * step, 0, 1)
            then = value(self.matrices(after))
            better = then < known
            u[better], known[better] = after[better], then[better]
            size = np.clip(size * np.where(better, 1.5, 0.93), 1e-8, 0.3)
        return known.min()

    def extremes(self, seed):
        """The least and the greatest singular value."""
        return self.least(lambda m: singular(m)[:, -1], seed), -self.least(lambda m: -singular(m)[:, 0], seed)

    def condition(self, seed):
        """The greatest condition number."""
        return -self.least(lambda m: -singular(m)[:, 0] / singular(m)[:, -1], seed)

    def least_determinant(self, seed):
        """The least determinant of M over that in the middle."""
        n = self.positions + (1 if self.kind == "planar" else 3)
        middle = np.linalg.det(self.matrices(np.full((1, n), 0.5)))
        return self.least(lambda m: np.linalg.det(m) / middle, seed, 30, 400)


def singular(matrices):
    return np.linalg.svd(matrices, compute_uv=False)


def cayley(c):
    """Rotations by their half-angle tangents times the axis."""
    cross = np.zeros((len(c), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -c[:, 2], c[:, 1], -c[:, 0]
    cross -= cross.transpose(0, 2, 1)
    square = (c ** 2).sum(axis=1)[:, None, None]
    return ((1 - square) * np.eye(3) + 2 * c[:, :, None] * c[:, None, :] + 2 * cross) / (1 + square)


def circle(radius, degrees):
    return [radius * cos(radians(degrees)), radius * sin(radians(degrees))]


def spent(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return run, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def verified(machine, requirements):
    """Verdict, leaves, and seconds of the proof and of its check."""
    with tempfile.TemporaryDirectory() as folder:
        name, certificate = Path(folder, "machine.toml"), Path(folder, "machine.cert.json")
        name.write_text(machine.design(requirements))
        run, proof = spent([ORTHOCERT, "verify", str(name), "-o", str(certificate), "--reprove", "--threads", "1",
                            "--timeout", TIMEOUT, "--format", "json"])
        if run.returncode not in (0, 1, 3):
            raise SystemExit(run.stderr)
        answer = json.loads(run.stdout)
        verdict = answer["verdict"]
        if run.returncode == 3:
            return verdict, None, proof, None
        checked, check = spent([CHECK, str(certificate)])
        assert checked.returncode == run.returncode, checked.stderr
        return verdict, (answer.get("proof") or {}).get("leaves"), proof, check


def row(name, question, machine, requirements, asked=""):
    verdict, leaves, proof, check = verified(machine, requirements)
    told = [name, question, verdict, "" if leaves is None else f"{leaves:,}", asked, f"{proof:.2f} s",
            "" if check is None else f"{check:.2f} s"]
    print("| " + " | ".join(told) + " |", flush=True)
    return verdict, leaves or 0, proof, check or 0


def head(*names):
    print("\n| " + " | ".join(names) + " |\n|" + "---|" * len(names), flush=True)


def ssm(turn_base, turn_platform):
    """Six legs between circles of radii 1 and 1/2: pairs at so many degrees about 0, 120, 240 and 60, 180, 300."""
    a = [circle(1, third + s * turn_base) + [0] for third in (0, 120, 240) for s in (-1, 1)]
    b = [circle(0.5, third + s * (60 - turn_platform)) + [0] for third in (0, 120, 240) for s in (-1, 1)]
    return a, b


def rubin(tolerance=None):
    a = [[227.6, 653.8], [-227.6, 653.8], [-680, -129.7], [-452.3, -524], [452.3, -524], [680, -129.7]]
    b = [[472.8, 512.2], [-472.8, 512.2], [-680, 153.3], [-207.2, -665.5], [207.2, -665.5], [680, 153.3]]
    box = [[-11.4, -11.4, -13.1], [11.4, 11.4, 13.1]]
    turned = {"roll": [-0.36, 0.36], "pitch": [-0.36, 0.36], "yaw": [-0.1, 0.1]}
    return Machine("spatial", 690, [p + [2233.4] for p in a], [p + [2637] for p in b], box, turned, tolerance)


# Transmission factors are the reciprocals of the singular values of M.
def least(value, part):
    return f"transmission = {{ max = {1 / (value * part):.9f} }}"


def greatest(value, part):
    return f"transmission = {{ min = {1 / (value * part):.9f} }}"


def ratio(value, part):
    return f"conditioning = {{ max = {value * part:.9f} }}"


# Nothing but regularity: of a joint range that says nothing.
REGULAR = "joint_range = { min = 0 }"


def table():
    head("machine", "claim", "verdict", "leaves", "at most", "proof", "check")
    box = [[-0.2, -0.2, 0.8], [0.2, 0.2, 1.2]]
    turned = {"roll": [-15, 15], "pitch": [-15, 15], "yaw": [-15, 15]}
    a, b = ssm(10, 10)
    one = Machine("spatial", 0.5, a, b, box, turned)
    low, high = one.extremes(1)
    name = f"1/0.5, ±0.2, roll, pitch, yaw ±15 ({low:.4f}, {high:.4f})"
    row(name, "regular", one, REGULAR, "1")
    row(name, "least at 90 %", one, least(low, 0.9), "4")
    row(name, "least at 99 %", one, least(low, 0.99), "60")
    row(name, "greatest at 110 %", one, greatest(high, 1.1), "4")
    row(name, "greatest at 101 %", one, greatest(high, 1.01), "160")
    ball = Machine("spatial", 0.5, a, b, box, {"angle": 15})
    low, high = ball.extremes(1)
    name = f"the same, any axis 15 ({low:.4f}, {high:.4f})"
    row(name, "regular", ball, REGULAR)
    row(name, "least at 90 %", ball, least(low, 0.9))
    row(name, "least at 99 %", ball, least(low, 0.99), "200")
    for tilt, torsion in ((20, 20), (20, 40)):
        tilted = Machine("spatial", 0.5, a, b, box, {"tilt": tilt, "torsion": torsion})
        low, high = tilted.extremes(1)
        name = f"the same, tilt {tilt}, torsion {torsion} ({low:.4f}, {high:.4f})"
        row(name, "regular", tilted, REGULAR)
        row(name, "least at 90 %", tilted, least(low, 0.9))
        row(name, "least at 99 %", tilted, least(low, 0.99))
    wide = Machine("spatial", 0.5, a, b, [[-0.3, -0.3, 0.7], [0.3, 0.3, 1.3]], {"angle": 30})
    low, high = wide.extremes(1)
    name = f"1/0.5, ±0.3, any axis 30 ({low:.4f}, {high:.4f})"
    row(name, "regular", wide, REGULAR)
    row(name, "least at 90 %", wide, least(low, 0.9))
    row(name, "least at 99 %", wide, least(low, 0.99))
    low, high = rubin().extremes(1)
    name = f"Rubin camera ({low:.4f}, {high:.4f})"
    row(name, "regular", rubin(), REGULAR)
    row(name, "least at 99 %", rubin(), least(low, 0.99), "4")
    row(name, "greatest at 101 %", rubin(), greatest(high, 1.01), "4")
    row(name, "least at 99.9 %", rubin(), least(low, 0.999))
    made = rubin("0.1")
    row(name + ", ±0.1 mm", "least at 99 %", made, least(low, 0.99), "8")
    row(name + ", ±0.1 mm", "greatest at 101 %", made, greatest(high, 1.01), "8")


def drawn_hexapod(random, reach, turned):
    """Pairs of legs between circles, each point off its place, over a box of `reach` of the height."""
    base, part, height = random.uniform(0.9, 1.1), random.uniform(0.45, 0.7), random.uniform(0.8, 1.3)
    a, b = [], []
    opened, closed = random.uniform(5, 15), random.uniform(5, 15)
    for third in (0, 120, 240):
        for s in (-1, 1):
            off = random.uniform(-2, 2, 2)
            a.append(circle(base, third + s * opened + off[0]) + [0])
            b.append(circle(base * part, third + s * (60 - closed) + off[1]) + [0])
    half = random.uniform(0.5, 1, 3) * reach * height
    box = [[-half[0], -half[1], height - half[2]], [half[0], half[1], height + half[2]]]
    angles = lambda most: [-round(random.uniform(0.5, 1) * most, 3), round(random.uniform(0.5, 1) * most, 3)]  # noqa: E731
    orientation = [
        lambda: {"angle": round(random.uniform(0.5, 1) * turned, 3)},
        lambda: {"tilt": round(random.uniform(0.5, 1) * turned, 3), "torsion": round(random.uniform(0.5, 1) * turned, 3)},
        lambda: {"roll": angles(turned), "pitch": angles(turned), "yaw": angles(turned)},
    ][random.integers(3)]()
    return Machine("spatial", round(base * part, 3), a, b, box, orientation)


def grown(machine, part):
    """The same machine over a box and angles that are so many times as wide."""
    middle, half = machine.box.mean(axis=0), (machine.box[1] - machine.box[0]) / 2 * part
    angles = {key: [round(x * part, 6) for x in v] if isinstance(v, list) else round(v * part, 6)
              for key, v in machine.orientation.items()}
    return Machine(machine.kind, machine.ell, machine.a, machine.b, [middle - half, middle + half], angles)


def first_singular(machine, seed):
    """How many times as wide the first workspace is in which det M has both signs, by ascents."""
    is_regular = lambda part: grown(machine, part).least_determinant(seed) > 0  # noqa: E731
    low, high = 1.0, 2.0
    while is_regular(high):
        low, high = high, 1.3 * high
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (middle, high) if is_regular(middle) else (low, middle)
    return low


def drawn_planar(random):
    a = [circle(random.uniform(0.9, 1.1), 90 + third + random.uniform(-10, 10)) for third in (0, 120, 240)]
    b = [circle(random.uniform(0.2, 0.3), 90 + third - random.uniform(50, 70)) for third in (0, 120, 240)]
    half = random.uniform(0.05, 0.2, 2)
    turned = [-round(random.uniform(5, 20), 3), round(random.uniform(5, 20), 3)]
    return Machine("planar", 0.25, a, b, [list(-half), list(half)], {"angle": turned})


def drawn_spherical(random):
    height = random.uniform(0.9, 1.2)
    a = [circle(random.uniform(0.9, 1.1), third + random.uniform(-8, 8)) + [-height] for third in (0, 120, 240)]
    b = [circle(random.uniform(0.6, 0.8), third + random.uniform(80, 100)) + [0] for third in (0, 120, 240)]
    orientation = [
        {"angle": round(random.uniform(8, 15), 3)},
        {"tilt": round(random.uniform(8, 20), 3), "torsion": round(random.uniform(8, 15), 3)},
        {"roll": [-10, 14], "pitch": [-13, 9], "yaw": [-8, 12]},
    ][random.integers(3)]
    return Machine("spherical", 0.7, a, b, None, orientation)


def drawn():
    random = np.random.default_rng(15)
    machines = [("hexapod", drawn_hexapod(random, 0.12, 12)) for _ in range(20)]
    machines += [("planar", drawn_planar(random)) for _ in range(6)]
    machines += [("spherical", drawn_spherical(random)) for _ in range(6)]
    head("machine", "claim", "verdict", "leaves", "expected", "proof", "check")
    wrong, times = 0, {}
    for count, (kind, machine) in enumerate(machines):
        (low, high), most = machine.extremes(count), machine.condition(count)
        name = f"{kind} {count + 1}: {machine.orientation} ({low:.4f}, {high:.4f}, {most:.4f})"
        for question, requirements, expected in (
            ("least, beyond", least(low, 0.999), "certified"),
            ("greatest, beyond", greatest(high, 1.001), "certified"),
            ("least, inside", least(low, 1.001), "refuted"),
            ("greatest, inside", greatest(high, 0.999), "refuted"),
            ("ratio, beyond", ratio(most, 1.001), "certified"),
            ("ratio, inside", ratio(most, 0.999), "refuted"),
        ):
            found = row(name, question, machine, requirements, expected)
            wrong += found[0] != expected
            times.setdefault((kind, expected), []).append(found)
    for count in range(6):
        machine = drawn_hexapod(random, 0.12, 12)
        part = first_singular(machine, count)
        for off in (0.9, 0.99, 0.999, 1.001, 1.01, 1.1):
            near = grown(machine, part * off)
            expected = "certified" if off < 1 else "refuted"
            found = row(f"grown {count + 1}, {off}: {near.orientation}", "regular", near, REGULAR, expected)
            wrong += found[0] != expected
            times.setdefault(("grown", expected), []).append(found)
    head("machines", "expected", "claims", "leaves, median", "greatest", "proof, median", "greatest", "check, greatest")
    for (kind, expected), all_found in times.items():
        leaves, proof, check = ([found[k] for found in all_found] for k in (1, 2, 3))
        print(f"| {kind} | {expected} | {len(all_found)} | {np.median(leaves):,.0f} | {max(leaves):,} | "
              f"{np.median(proof):.2f} s | {max(proof):.2f} s | {max(check):.2f} s |")
    print(f"\nNot as expected: {wrong}.")


if __name__ == "__main__":
    question, ORTHOCERT, CHECK = sys.argv[1], *(str(Path(path).resolve()) for path in sys.argv[2:4])
    {"table": table, "random": drawn}[question]()
