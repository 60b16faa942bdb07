# SPDX-License-Identifier: GPL-3.0-or-later
"""The files that a render leaves, what the flags do to them, and how they get there."""

import json
import math
import resource
import unittest

from support import CliTest, exr_metadata, read_exr, read_png, scene_text


class Outputs(CliTest):
    def render(self, *flags, code=0):
        self.expect(code, "render", "scene.xml", *flags)
        return json.loads((self.folder / "run.json").read_text(encoding="utf-8"))

    def test_json_has_every_field(self):
        report = self.render("--seed", 2**64 - 1, "--spp", "3.5", "-t", 2, "-D", "res=20", "--set", "integrator.a=b=c")
        self.assertRegex(report["version"], r"^fogbow \d")
        self.assertEqual(report["command"][1:4], ["render", "scene.xml", "--seed"])
        self.assertEqual(report["options"], {"integrator": "auto", "overrides": {"a": "b=c"}, "seconds": None,
                                             "samples_per_pixel": 3.5, "threads": 2, "seed": 2**64 - 1})
        self.assertRegex(report["scene"].pop("hash"), r"^[0-9a-f]{16}$")
        self.assertIsInstance(report["scene"].pop("title"), str)
        self.assertEqual(report["scene"], {"file": "scene.xml", "definitions": {"res": "20"}, "integrator": "volpath",
                                           "width": 20, "height": 12, "crop": [0, 0, 20, 12]})
        self.assertEqual(report["integrator"], "pssmlt")
        self.assertEqual(report["b"], {"value": 0.25, "standard_error": 0.0025})
        self.assertEqual(report["b_k"], [{"k": 2, "value": 0.05, "standard_error": 0.001},
                                         {"k": 3, "value": 0.2, "standard_error": 0.002},
                                         {"k": 4, "value": 1e-6, "standard_error": 1e-7},
                                         {"k": 9, "value": 5e-7, "standard_error": 1e-7}])
        self.assertEqual((report["samples"], report["sample_unit"]), (40_000_000_000, "mutations"))
        self.assertEqual((report["chains"], report["groups"]), (64, 8))
        self.assertEqual(report["mutations"], [
            {"name": "large step", "weight": 0.5, "proposed": 1000, "accepted": 250, "acceptance": 0.25,
             "rejected": {"NonFinite": 3, "Occluded": 500}, "mean_squared_raster_jump": 0.0625, "time_share": 0.75,
             "seconds_per_proposal": 1e-6,
             "kinds": {"S-V": {"proposed": 400, "accepted": 100}, "V-S": {"proposed": 600, "accepted": 150},
                       "never": {"proposed": 0, "accepted": 0}}},
            {"name": "small step", "weight": 1.5, "proposed": 0, "accepted": 0, "acceptance": None, "rejected": {},
             "mean_squared_raster_jump": 0, "time_share": 0, "seconds_per_proposal": 0, "kinds": {}}])
        self.assertEqual(report["b_k_c"], [
            {"configuration": "SMS", "k": 3, "value": 0.19, "standard_error": 0.002},
            {"configuration": "SS", "k": 2, "value": 0.05, "standard_error": 0.001}])
        self.assertEqual(report["diagnostics"], {"r_hat": 1.01})
        self.assertEqual(report["non_finite"], 0)
        speed = report["speed"]
        self.assertEqual((speed["cpu_seconds"], speed["rays"]), (1.5, 123456))
        for name, seconds, count in (("rays_per_second", "seconds", 123456),
                                     ("samples_per_second", "render_seconds", 4e10)):
            self.assertAlmostEqual(speed[name] * speed[seconds] / count, 1)
        self.assertLess(speed["render_seconds"], speed["seconds"])
        self.assertEqual([report["interrupted"], report["groups_disagree"], report["exit_code"]], [False, False, 0])
        self.assertEqual((report["notes"], report["warnings"]), (["the scene asks for volpath"], []))
        self.assertEqual(report["files"], {"exr": "run.exr", "png": "run.png", "json": "run.json"})

    def test_json_stays_json(self):
        report = self.render("--set", "integrator.outcome=non_finite")
        self.assertEqual((report["b"]["standard_error"], report["non_finite"]), (None, 3))
        self.assertIn("3 non-finite contributions refused", report["warnings"])
        self.assertEqual(self.render("--set", "integrator.outcome=latin1")["notes"], ["caf\ufffd"])
        self.assertEqual(self.render("--set", "integrator.outcome=chatty", "--time", "0.2")["warnings"], ["a word on the way"])
        report = self.render("--set", "integrator.outcome=disagree", code=7)
        self.assertEqual((report["groups_disagree"], report["exit_code"]), (True, 7))

    def test_exr(self):
        report = self.render("--seed", 7, "--size", "10x6", "--crop", "2,1,5,4", "--time", "0.2")
        header = exr_metadata(self.folder / "run.exr")
        self.assertEqual(header["dataWindow"], (2, 1, 6, 4))
        self.assertEqual(header["displayWindow"], (0, 0, 9, 5))
        self.assertEqual([report["scene"][name] for name in ("width", "height", "crop")], [10, 6, [2, 1, 5, 4]])
        self.assertEqual(header["channels"], [(name, 2) for name in ("B", "Error.B", "Error.G", "Error.R", "G", "R")])
        self.assertAlmostEqual(header["b"], 0.25)
        self.assertAlmostEqual(header["bStandardError"], 0.0025)
        self.assertEqual(header["samples"], "40000000000")
        self.assertEqual((header["chains"], header["seed"], header["integrator"]), (64, "7", "pssmlt"))
        self.assertEqual((header["sceneHash"], header["fogbowVersion"]), (report["scene"]["hash"], report["version"]))
        self.assertEqual(header["finished"], 1)
        self.assertAlmostEqual(header["renderTimeSeconds"], report["speed"]["seconds"], places=5)
        picture = read_exr(self.folder / "run.exr")
        self.assertEqual(picture["R"], [(0, 1, 2, 3, 4)] * 4)
        self.assertEqual(picture["G"], [(y,) * 5 for y in range(4)])

    def test_world_to_camera(self):
        self.check_world_to_camera()
        # A camera in larger units sees the same world.
        self.write("scene.xml", scene_text().replace("<lookat", '<scale value="5"/><lookat', 1))
        self.check_world_to_camera()

    def check_world_to_camera(self):
        self.render()
        m = exr_metadata(self.folder / "run.exr")["worldToCamera"]

        def to_camera(x, y, z):  # row vectors
            return [x * m[i] + y * m[4 + i] + z * m[8 + i] + m[12 + i] for i in range(3)]

        # Where the scene's lookat puts things: x to the right, y up, z forward, in world units.
        distance = math.hypot(0.55, 2.4)
        for point, expected in [((0, 0.25, 2.4), (0, 0, 0)), ((0, -0.3, 0), (0, 0, distance)),
                                ((1, -0.3, 0), (1, 0, distance)),
                                ((0, -0.3 + 2.4 / distance, -0.55 / distance), (0, 1, distance))]:
            for found, wanted in zip(to_camera(*point), expected):
                self.assertAlmostEqual(found, wanted, places=5)

    def test_png(self):
        self.render("--size", "3x2")
        png = read_png(self.folder / "run.png")
        self.assertEqual(png, [[(0, 0, 188), (255, 0, 188), (255, 0, 188)], [(0, 255, 188), (255, 255, 188), (255, 255, 188)]])
        self.render("--size", "3x2", "--exposure", "-1")
        self.assertEqual(read_png(self.folder / "run.png")[1][1], (188, 188, 137))  # sRGB of 1/2 and 1/4

    def test_names(self):
        self.render()
        self.assertEqual(self.files(), ["run.exr", "run.json", "run.png", "scene.xml"])
        (self.folder / "scene.xml").rename(self.folder / "v1.2.xml")
        (self.folder / "deep").mkdir()
        result = self.expect(0, "render", "v1.2.xml")
        self.assertIn(b"wrote v1.2.exr, v1.2.png, v1.2.json\n", result.stdout)
        self.expect(0, "render", "v1.2.xml", "-o", "deep/a.b.EXR", "--json", "report")
        self.assertEqual(sorted(path.name for path in (self.folder / "deep").iterdir()), ["a.b.EXR", "a.b.png"])
        json.loads((self.folder / "report").read_text(encoding="utf-8"))

    def test_report(self):
        result = self.expect(0, "render", "scene.xml", "--time", "0.2")
        text = result.stdout.decode()
        for part in ("integrator pssmlt, 64 chains in 8 groups\n", "b = 0.2500 ± 0.0025\n", "0.0500 ± 0.0010", " 80.00%\n",
                     "  2 lengths more with 0.0006%\n",
                     "  SMS          0.1900 ± 0.0020            76.00%\n",
                     "large step       1k proposed, 25.00% accepted, 75% of the time, rms jump 0.25; "
                     "refused: NonFinite 0.30%, Occluded 50.00%\n",
                     "    S-V                        400 proposed, 25.00% accepted\n",
                     " mutations/s, ", " rays/s\n", "(1.5 CPU-s)", "wrote run.exr, run.png, run.json\n"):
            self.assertIn(part, text)
        self.assertIn("info: the scene asks for volpath\n", result.stderr.decode())

    def test_replay(self):
        result = self.expect(0, "render", "scene.xml", "--integrator", "pssmlt", "--replay", "1:2:30")
        self.assertEqual(result.stdout, b"pssmlt seed 1 chain 2 step 30\n")
        self.assertEqual(self.files(), ["scene.xml"])

    def test_info(self):
        text = self.expect(0, "info", "scene.xml", "--set", "integrator.memory=3145728").stdout.decode()
        for part in ("16x12, box filter", "asks for: volpath, max_depth 8", "pinhole at 0, 0.25, 2.4", "film: 3.0 MiB",
                     "warnings    none"):
            self.assertIn(part, text)
        self.assertRegex(text, r"hash +[0-9a-f]{16}\n")


class Atomic(CliTest):
    def limited(self, size, *flags):
        """Renders where no file may grow beyond `size` bytes; Python ignores SIGXFSZ, and so then does its child."""
        return self.run_cli("render", "scene.xml", *flags, restore_signals=False,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))

    def test_a_full_disk_leaves_what_was_there(self):
        for name in ("run.exr", "run.png", "run.json"):
            self.write(name, "old")
        result = self.limited(100, "--size", "100x100")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("run.exr", result.stderr.decode())
        self.assertEqual((self.folder / "run.exr").read_text(), "old")
        self.assertEqual(self.files(), ["run.exr", "run.json", "run.png", "scene.xml"])

    def test_a_report_that_does_not_fit(self):
        self.write("run.json", "old")
        result = self.limited(1500, "--size", "2x2")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("run.json", result.stderr.decode())
        self.assertEqual((self.folder / "run.json").read_text(), "old")
        self.assertEqual(self.files(), ["run.exr", "run.json", "run.png", "scene.xml"])

    def test_a_picture_on_the_way_that_does_not_fit_is_no_end(self):
        result = self.limited(100, "--size", "100x100", "--time", "0.5", "--picture-interval", "0.2s")
        self.assertEqual(result.returncode, 4)
        self.assertIn("the picture so far was not saved", result.stderr.decode())

    def test_files_are_replaced_never_rewritten(self):
        for name in ("run.exr", "run.png", "run.json"):
            self.write(name, "old")
        with open(self.folder / "run.exr", "rb") as picture, open(self.folder / "run.json", "rb") as report:
            self.expect(0, "render", "scene.xml")
            self.assertEqual((picture.read(), report.read()), (b"old", b"old"))
        self.assertGreater((self.folder / "run.exr").stat().st_size, 300)
        self.assertEqual(self.files(), ["run.exr", "run.json", "run.png", "scene.xml"])


if __name__ == "__main__":
    unittest.main()
