"""The Python package against the program, on machines with known answers."""

import subprocess
import sys
import tempfile
import threading
import unittest
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np

import orthocert as oc

DESIGNS = Path(__file__).resolve().parent.parent / "designs"

PRINTER = dict(
    title="A printer",
    mechanism=oc.linear_delta(radius="174.75", arm=333),
    workspace={"cylinder": {"center": [0, 0], "radius": 80, "z": [0, 200]}},
    requirements={"transmission": {"min": "0.52", "max": "1.4"}, "joint_range": {"min": 200, "max": 520}},
)


class Designs(unittest.TestCase):
    def test_numbers_stay_as_they_are_written(self):
        design = oc.Design.of(
            mechanism={"kind": "orthoglide", "leg_length": oc.plus_minus("310.25", Decimal("0.02"))},
            workspace={"min": [-73, Fraction(-147, 2), np.int64(-73)], "max": np.array([126, 126, 126])},
            requirements={"transmission": {"min": Fraction(1, 2), "max": 2.5}},
        )
        for text in (
            'leg_length = "310.25 ± 0.02"',
            'min = [-73, "-147/2", -73]',
            "max = [126, 126, 126]",
            'min = "1/2"',
            "max = 2.5",
        ):
            self.assertIn(text, design.toml)

    def test_a_float_that_is_not_its_decimal_is_refused(self):
        for x in (0.1, np.float64(0.3), float("nan"), True, None, 1j):
            with self.assertRaises((TypeError, ValueError, oc.DesignError)):
                oc.verify(dict(PRINTER, workspace={"min": [x, 0, 0], "max": [1, 1, 1]}))

    def test_what_the_program_refuses_is_told_in_its_own_sentence(self):
        with self.assertRaises(oc.DesignError) as refused:
            oc.verify(dict(PRINTER, requirements={"transmision": {"max": 2}}))
        self.assertIn("transmision", str(refused.exception))
        self.assertIn("design.toml:", str(refused.exception))
        with self.assertRaisesRegex(oc.DesignError, "did you mean requirements"):
            oc.verify(dict(PRINTER, requirement={}))
        with self.assertRaisesRegex(oc.DesignError, "the key is missing"):
            oc.verify({})
        with self.assertRaises(OSError):
            oc.verify("no such file.toml")


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.printer = oc.verify(PRINTER)

    def test_a_design_is_certified_and_its_certificate_is_accepted(self):
        self.assertTrue(self.printer)
        self.assertEqual(self.printer.verdict, "certified")
        self.assertIn("greatest psi", [r.requirement for r in self.printer.requirements])
        self.assertIn("CERTIFIED", self.printer._repr_html_())
        self.assertIn("<svg", self.printer._repr_html_())
        checked = oc.check(self.printer, design=PRINTER)
        self.assertTrue(checked and "It is proved" in checked.statement)

    def test_a_certificate_of_another_design_or_with_another_digit_is_rejected(self):
        other = dict(PRINTER, workspace={"cylinder": {"center": [0, 0], "radius": 79, "z": [0, 200]}})
        self.assertFalse(oc.check(self.printer, design=other).accepted)
        edited = self.printer.certificate.replace(b'"1.4"', b'"1.3"', 1)
        self.assertNotEqual(edited, self.printer.certificate)
        checked = oc.check(edited)
        self.assertFalse(checked.accepted)
        self.assertTrue(checked.reason)
        self.assertIn("REJECTED", checked._repr_html_())

    def test_a_refutation_has_its_point(self):
        found = oc.verify(DESIGNS / "orthoglide-310.toml")
        self.assertEqual((found.verdict, bool(found)), ("refuted", False))
        self.assertEqual(found.counterexample.point, (Fraction(634, 5),) * 3)
        self.assertEqual(found.counterexample.violated, "greatest psi <= 2")
        checked = oc.check(found)
        self.assertTrue(checked.accepted and not checked)

    def test_an_undecided_design_has_no_certificate(self):
        found = oc.verify(DESIGNS / "delta-parallel-margin.toml", max_boxes=1)
        self.assertEqual((found.verdict, found.certificate), ("undecided", None))
        with self.assertRaises(ValueError):
            found.save("never")
        with self.assertRaises(ValueError):
            oc.check(found)

    def test_bounds_enclose_what_is_known_in_closed_form(self):
        # The Orthoglide on [0, 1/2]^3 with L = 1: psi is least at (1/2, 1/2, 1/2), 1/(1 + 2m), m = 1/sqrt(2).
        found = oc.bounds(
            {
                "mechanism": {"kind": "orthoglide", "leg_length": 1},
                "workspace": {"min": [0] * 3, "max": ["1/2"] * 3},
                "requirements": {"transmission": {"max": 100}},
            },
            relative="1e-3",
        )
        least = found.of("psi", "least")
        self.assertTrue(float(least.min) <= 1 / (1 + 2**0.5) <= float(least.max))
        self.assertLess(least.max - least.min, Fraction(2, 1000) * least.max)
        self.assertEqual(found.to_numpy().shape, (len(found), 2))
        with self.assertRaises(KeyError):
            found.of("psi", "middle")

    def test_what_is_told_of_a_bound_holds(self):
        third = Fraction(1, 3)
        bounds = oc.Bounds((oc.Bound("psi", "least", third, third, None),), {})
        self.assertIn("<td>0.3333333</td><td>0.3333334</td>", bounds._repr_html_())
        values = tuple(oc.Value("psi", "transmission", end, third, third) for end in ("least", "greatest"))
        told = oc.Summary("certified", None, None, values, {})._repr_html_()
        self.assertIn("<td>0.3333333</td><td>0.3333334</td>", told)
        self.assertIn("<td>0.3333334</td><td>0.3333333</td>", told)
        side = oc.Side("upper", Fraction(1907, 20), third, None, None)
        self.assertIn("<td>95.35</td><td>1/3</td>", oc.Limit("radius", "80", (side,), {})._repr_html_())

    def test_the_unit_and_the_title_of_tables_are_those_of_the_design(self):
        found = oc.verify(dict(PRINTER, unit="mm", title="Printer"))
        self.assertEqual((found.title, found.answer["length_unit"]), ("Printer", "mm"))

    def test_a_limit_has_both_sides(self):
        found = oc.limit(PRINTER, "workspace.cylinder.radius", gap="1e-2")
        upper = found.upper
        self.assertTrue(80 <= upper.certified < upper.refuted < Fraction(101, 100) * upper.certified)
        self.assertIn("rho", upper.limited_by.violated)
        self.assertIsNone(found.lower.refuted)
        self.assertIn("radius", found.lower.reason)
        up = oc.limit(PRINTER, "workspace.cylinder.radius", gap="1e-2", direction="up")
        self.assertEqual([side.side for side in up.sides], ["upper"])

    def test_tolerances_sizes_and_cubes_have_a_certified_and_a_refuted_end(self):
        found = oc.tolerance(DESIGNS / "orthoglide-tolerance.toml", on=["leg_length"])
        (row,) = found
        self.assertEqual((row.on, row.leg, row.measure), (("leg_length",), None, "length"))
        self.assertTrue(0 < row.certified < row.refuted <= Fraction(111, 100) * row.certified)
        self.assertEqual(row.limited_by.violated, "greatest psi <= 2")
        self.assertIn("leg_length, length", found._repr_html_())
        by_leg = oc.tolerance(DESIGNS / "orthoglide-tolerance.toml", on=["leg_length"], by_leg=True)
        self.assertEqual(sorted(row.leg for row in by_leg if row.leg), [1, 2, 3])
        # The paper's cube of 200 mm: legs of 310 mm are published.
        smallest = oc.size(DESIGNS / "orthoglide-310.toml", 200)
        self.assertTrue(310 < smallest.refuted < smallest.certified < 311)
        self.assertIn("psi", smallest.limited_by.violated)
        cube = oc.largest_cube(DESIGNS / "orthoglide-310.toml", gap="1e-2")
        self.assertTrue(199 < Fraction(cube.certified) < Fraction(cube.refuted) < 201)
        self.assertIn(cube.certified, cube._repr_html_())

    def test_a_summary_has_speeds(self):
        found = oc.summary(PRINTER, speed=1000)
        self.assertEqual(found.verdict, "certified")
        self.assertTrue(any(v.quantity == "joint_speed" for v in found.values))

    def test_some_coordinates_are_paved_for_all_values_of_the_others(self):
        for name, coordinates, whole in (
            ("planar-3-rpr", ["y", "x"], 100.0**2),
            ("planar-3-rpr", ["angle"], 40.0),
            ("hexapod-linuxcnc", ["z"], 8.0),
        ):
            paving = oc.pave(DESIGNS / "kernel" / f"{name}.toml", coordinates=coordinates, volume_gap="1/2")
            self.assertEqual(paving.answer["coordinates"], coordinates)
            boxes = paving.boxes()
            volume = {kind: np.prod(cells[..., 1] - cells[..., 0], axis=1).sum() for kind, cells in boxes.items()}
            self.assertAlmostEqual(sum(volume.values()), whole, places=9)
            self.assertAlmostEqual(volume["inner"], whole * float(paving.inner_share), places=9)
            self.assertEqual(paving.inner_volume is None, coordinates == ["angle"])
            self.assertTrue(oc.check(paving).accepted)
            self.assertIn("inner", paving._repr_html_())

    def test_boxes_that_planes_cut_are_seen_on_both_sides(self):
        paving = oc.pave(
            {
                "mechanism": {"kind": "orthoglide", "leg_length": 1},
                "workspace": {"min": ["-7/10"] * 3, "max": ["7/10", "7/10", "701/1000"]},
                "requirements": {"transmission": {"min": "1/2", "max": 2}},
            },
            volume_gap="1/10",
        )
        volume = {kind: np.prod(c[..., 1] - c[..., 0], axis=1).sum() for kind, c in paving.boxes().items()}
        whole = 1.4 * 1.4 * 1.401
        self.assertAlmostEqual(sum(volume.values()), whole, places=9)
        inner, outer = volume["inner"] / whole, volume["outer"] / whole
        self.assertTrue(0.9 * paving.inner_share < inner < paving.inner_share, (inner, paving.inner_share))
        self.assertTrue(0.9 * paving.outer_share < outer < paving.outer_share, (outer, paving.outer_share))

    def test_the_boxes_of_a_paving_have_its_shares(self):
        paving = oc.pave(
            {
                "mechanism": {"kind": "orthoglide", "leg_length": 1},
                "workspace": {"min": ["-7/10"] * 3, "max": ["7/10"] * 3},
                "requirements": {"transmission": {"min": "1/2", "max": 2}},
            },
            volume_gap="1/2",
        )
        boxes = paving.boxes()
        volume = {kind: np.prod(cells[..., 1] - cells[..., 0], axis=1) for kind, cells in boxes.items()}
        # Cells that a plane of symmetry cuts count with their kept part alone.
        kept = sum(v.sum() for v in volume.values())
        self.assertAlmostEqual(kept, 1.4**3, places=9)
        self.assertGreater(len(boxes["inner"]), 10)
        self.assertGreater(len(boxes["outer"]), 10)
        self.assertTrue(0 < paving.inner_share < 1)
        self.assertTrue(oc.check(paving).accepted)
        # A point of an inner cell meets the requirements, one of an outer cell does not.
        for kind, verdict in (("inner", "certified"), ("outer", "refuted")):
            cell = max(boxes[kind], key=lambda c: np.prod(c[:, 1] - c[:, 0]))
            middle = [str(Fraction(x)) for x in cell.mean(axis=1)]
            found = oc.verify(
                {
                    "mechanism": {"kind": "orthoglide", "leg_length": 1},
                    "workspace": {"min": middle, "max": middle},
                    "requirements": {"transmission": {"min": "1/2", "max": 2}},
                }
            )
            self.assertEqual(found.verdict, verdict, kind)

    def test_a_report_is_one_page(self):
        page = oc.report(self.printer, title="Signed & sealed")
        self.assertIn("Signed &amp; sealed", page.html)
        self.assertIn("orthocert_verify", page.html)
        self.assertTrue(page._repr_html_().startswith("<iframe sandbox="))

    def test_progress_is_told_and_a_command_is_cancelled(self):
        told = []
        stop = threading.Event()

        def progress(seconds):
            told.append(seconds)
            stop.set()

        with self.assertRaises(oc.Unfinished):
            oc.bounds(DESIGNS / "rotary-delta-linuxcnc.toml", relative="1e-9", progress=progress, cancel=stop)
        self.assertTrue(told and told == sorted(told))

    def test_figures_are_drawn(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("Agg")
        for found in (self.printer, oc.limit(PRINTER, "workspace.cylinder.radius", gap="1e-1")):
            self.assertTrue(found.plot().has_data())
        paving = oc.pave(DESIGNS / "orthoglide-312.toml", volume_gap="1/2")
        self.assertTrue(paving.plot(across=2).collections)


class Package(unittest.TestCase):
    def test_the_program_is_the_package_s_own(self):
        self.assertRegex(oc.version(), r"^\d+\.\d+\.\d+$")
        with tempfile.TemporaryDirectory() as folder:
            code = "import orthocert; print(orthocert.verify.__doc__)"
            out = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=True)
        self.assertIn("Proves or refutes", out.stdout)


if __name__ == "__main__":
    unittest.main()
