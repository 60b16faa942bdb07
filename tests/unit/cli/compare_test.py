# SPDX-License-Identifier: GPL-3.0-or-later
"""compare against numbers worked out by hand here."""

import json
import math
import unittest

from support import CliTest, exr_metadata, read_exr, write_exr

WEIGHTS = {"R": 0.212671, "G": 0.715160, "B": 0.072169}


def constant(width, height, **channels):
    return {name.replace("_", "."): [[value] * width for _ in range(height)] for name, value in channels.items()}


class Compare(CliTest):
    def compare(self, a, b, *flags):
        write_exr(self.folder / "a.exr", a)
        write_exr(self.folder / "b.exr", b)
        result = self.expect(0, "compare", "a.exr", "b.exr", "--json", "c.json", *flags)
        return json.loads((self.folder / "c.json").read_text(encoding="utf-8")), result.stdout.decode()

    def test_numbers(self):
        a = constant(8, 4, R=3, G=1, B=0.5)
        b = constant(8, 4, R=2, G=1, B=1)
        luminance = sum(WEIGHTS[name] * b[name][0][0] for name in WEIGHTS)
        floor = 0.01 * luminance**2
        report, text = self.compare(a, b)
        self.assertEqual(report["pixels"], 32)
        self.assertAlmostEqual(report["mse"], (1 + 0.25) / 3)
        self.assertAlmostEqual(report["rel_mse"], (1 / (4 + floor) + 0.25 / (1 + floor)) / 3)
        self.assertEqual(report["mean_ratio"], [1.5, 1, 0.5])
        ratio = sum(WEIGHTS[name] * a[name][0][0] for name in WEIGHTS) / luminance
        self.assertAlmostEqual(report["luminance_ratio"], ratio)
        self.assertFalse(report["has_errors"])
        for line in (r"pixels +32\n", r"MSE +0\.416667\n", r"relMSE +0\.\d+\n", r"mean A / mean B +1\.5, 1, 0\.5\n",
                     rf"luminance ratio +{ratio:.6g}\n"):
            self.assertRegex(text, line)

    def test_tiles_and_exclusion(self):
        a = constant(8, 8, R=1, G=1, B=1)
        b = constant(8, 8, R=1, G=1, B=1)
        a["G"][5][6] = 17.0
        report, text = self.compare(a, b, "--tile", "4")
        self.assertEqual([tile["area"] for tile in report["tiles"]],
                         [[0, 0, 4, 4], [4, 0, 4, 4], [0, 4, 4, 4], [4, 4, 4, 4]])
        for tile, expected in zip(report["tiles"], (1, 1, 1, 1 + WEIGHTS["G"])):
            self.assertAlmostEqual(tile["a"], expected)
        self.assertRegex(text, r"worst tiles.*\n +4,4,4,4: ")
        report, _ = self.compare(a, b, "--exclude", "6,5,1,1", "--exclude", "0,0,8,1")
        self.assertEqual((report["pixels"], report["mse"]), (64 - 9, 0))
        report, _ = self.compare(a, b, "--exclude", "5,6,1,1")
        self.assertAlmostEqual(report["mse"], 256 / (3 * 63))

    def test_standard_errors(self):
        a = constant(4, 4, R=1.5, G=1.5, B=1.5, Error_R=0.3, Error_G=0.3, Error_B=0.3)
        b = constant(4, 4, R=1, G=1, B=1)
        report, text = self.compare(a, b)
        self.assertTrue(report["has_errors"])
        self.assertAlmostEqual(report["tiles"][0]["z"], 0.5 / (0.3 / 4), places=4)
        self.assertIn("largest 6.67", text)
        write_exr(self.folder / "e.exr", constant(4, 4, R=0.4, G=0.4, B=0.4))
        report, _ = self.compare(a, b, "--error-b", "e.exr")
        self.assertAlmostEqual(report["tiles"][0]["z"], 0.5 / (math.hypot(0.3, 0.4) / 4), places=4)
        report, _ = self.compare(a, b, "--error-a", "e.exr")
        self.assertAlmostEqual(report["tiles"][0]["z"], 0.5 / (0.4 / 4), places=4)

    def test_difference(self):
        a = constant(5, 3, R=1, G=2, B=3)
        b = constant(5, 3, R=3, G=2, B=1)
        b["R"][2][4] = 8.0
        self.compare(a, b, "--diff", "d.exr")
        difference = read_exr(self.folder / "d.exr")
        self.assertEqual(difference["R"], [(-2,) * 5, (-2,) * 5, (-2, -2, -2, -2, -7)])
        self.assertEqual((difference["G"][0], difference["B"][0]), ((0,) * 5, (2,) * 5))
        self.assertEqual(exr_metadata(self.folder / "d.exr")["dataWindow"], (0, 0, 4, 2))
        self.expect(2, "compare", "a.exr", "b.exr", "--diff", "d.png", message=".exr")
        self.expect(4, "compare", "a.exr", "b.exr", "--diff", "absent/d.exr", message="does not exist")

    def test_failures(self):
        write_exr(self.folder / "a.exr", constant(4, 4, R=1, G=1, B=1))
        write_exr(self.folder / "b.exr", constant(4, 3, R=1, G=1, B=1))
        write_exr(self.folder / "grey.exr", constant(4, 4, Y=1))
        write_exr(self.folder / "nan.exr", constant(4, 4, R=1, G=math.nan, B=1))
        self.expect(4, "compare", "a.exr", "b.exr", message="4x3")
        self.expect(4, "compare", "a.exr", "grey.exr", message="R, G, B")
        self.expect(4, "compare", "a.exr", "a.exr", "--exclude", "0,0,4,4", message="no pixels")
        self.expect(6, "compare", "a.exr", "nan.exr", message="not finite")
        (self.folder / "cut.exr").write_bytes((self.folder / "a.exr").read_bytes()[:200])
        self.expect(4, "compare", "a.exr", "cut.exr", message="cut.exr")


if __name__ == "__main__":
    unittest.main()
