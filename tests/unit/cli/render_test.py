# SPDX-License-Identifier: GPL-3.0-or-later
"""The program as it is installed, with the real renderer: that flags reach it and its answers come out."""

import json
import signal
import unittest

from support import PROGRAM, UNUSED_PROPERTY, CliTest, exr_metadata, read_exr, read_png, scene_text

MESH_ELSEWHERE = '<shape type="obj"><string name="filename" value="../elsewhere.obj"/><ref id="grey"/></shape>'


class Render(CliTest):
    def run_cli(self, *arguments, program=PROGRAM, **options):
        return super().run_cli(*arguments, program=program, **options)

    def report(self, name="run.json"):
        return json.loads((self.folder / name).read_text(encoding="utf-8"))

    def test_every_integrator(self):
        brightness = {}
        for name in ("path", "light", "bdpt", "pssmlt", "mlt"):
            self.expect(0, "render", "scene.xml", "--integrator", name, "--spp", "64", "-t", "1")
            report = self.report()
            self.assertEqual(report["integrator"], name)
            self.assertGreater(report["b"]["value"], 0)
            self.assertGreater(report["samples"], 0)
            self.assertGreater(report["speed"]["rays"], 0)
            self.assertEqual(report["non_finite"], 0)
            self.assertEqual(exr_metadata(self.folder / "run.exr")["integrator"], name)
            brightness[name] = (report["b"]["value"], report["b"]["standard_error"])
            green = read_exr(self.folder / "run.exr")["G"]
            self.assertGreater(sum(map(sum, green)), 0)
            self.assertTrue(any(pixel != (0, 0, 0) for row in read_png(self.folder / "run.png") for pixel in row))
        # Five standard errors: that the four are of one picture, not how well they do.
        value, error = brightness["path"]
        for other, other_error in brightness.values():
            self.assertLess(abs(other - value), 5 * (error**2 + other_error**2)**0.5 + 1e-12, brightness)

    def test_default_sampler_and_the_file_s_choice(self):
        result = self.expect(0, "render", "scene.xml", "--spp", "4")
        self.assertEqual(self.report()["integrator"], "mlt")
        self.assertIn("volpath", result.stderr.decode())
        self.expect(0, "render", "scene.xml", "--spp", "4", "--integrator", "file")
        self.assertEqual(self.report()["integrator"], "path")

    def test_explain(self):
        easy = self.expect(0, "explain", "scene.xml", "--samples", "20000").stdout.decode()
        self.assertIn("nothing here is hard", easy)
        ball = ('<shape type="sphere"><point name="center" x="0" y="0.6" z="0"/><float name="radius" value="0.3"/>'
                '<bsdf type="dielectric"/></shape>')
        bulb = '<emitter type="point"><point name="position" x="0" y="0.6" z="0"/></emitter>'
        self.write("bulb.xml", scene_text(emitter="", more=ball + bulb))
        hard = self.expect(0, "explain", "bulb.xml", "--samples", "20000").stdout.decode()
        self.assertNotIn("nothing here is hard", hard)
        self.assertRegex(hard, r"what next-event estimation can make +0\.00%")
        self.assertRegex(hard, r"- 100% of the light are caustics on surfaces:")
        self.assertIn("100% of the light from point or directional lights first meets a specular surface", hard)
        self.write("dark.xml", scene_text(turn=-90))
        self.assertIn("no light reaches the camera", self.expect(0, "explain", "dark.xml").stdout.decode())
        self.write("odd.xml", scene_text(more=UNUSED_PROPERTY))
        self.assertIn("1 warning about the scene", self.expect(0, "explain", "odd.xml").stdout.decode())
        self.expect(3, "explain", "odd.xml", "--strict", message="--strict")
        self.expect(2, "explain", "scene.xml", "--samples", "0", message="--samples")

    def test_a_picture_as_the_sky(self):
        """An OpenEXR picture, and a PNG of the same colours in sRGB, shine alike."""
        constant = '<emitter type="constant"><rgb name="radiance" value="0.5"/></emitter>'
        self.write("grey.xml", scene_text(emitter="", more=constant))
        self.expect(0, "render", "grey.xml", "-o", "grey.exr", "--integrator", "path", "--spp", "64")
        lit = {}
        for picture in ("grey.exr", "grey.png"):
            sky = f'<emitter type="envmap"><string name="filename" value="{picture}"/></emitter>'
            self.write("sky.xml", scene_text(emitter="", more=sky))
            self.expect(0, "render", "sky.xml", "-o", "sky.exr", "--integrator", "path", "--spp", "256")
            lit[picture] = self.report("sky.json")["b"]["value"]
        self.assertGreater(lit["grey.exr"], 0)
        self.assertAlmostEqual(lit["grey.png"] / lit["grey.exr"], 1, delta=0.02)
        self.write("sky.xml", scene_text(emitter="", more=sky.replace("grey", "absent")))
        self.expect(4, "render", "sky.xml", message="absent.png")
        self.write("garbage.png", "no picture")
        self.write("sky.xml", scene_text(emitter="", more=sky.replace("grey", "garbage")))
        self.expect(4, "render", "sky.xml", message="garbage.png")

    def test_errors(self):
        self.expect(2, "render", "scene.xml", "--integrator", "radiosity", message="radiosity")
        self.expect(2, "render", "scene.xml", "--set", "integrator.no_such_property=1", message="no_such_property")
        self.write("unlit.xml", scene_text(emitter=""))
        self.expect(3, "render", "unlit.xml", message="emitter")
        self.write("dark.xml", scene_text(turn=-90))
        self.expect(5, "render", "dark.xml", "--spp", "4", message="light")
        self.write("../elsewhere.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.write("apart.xml", scene_text(more=MESH_ELSEWHERE))
        self.expect(0, "check", "apart.xml")
        self.expect(4, "render", "apart.xml", "--sandbox-paths", message="outside")
        self.expect(2, "render", "scene.xml", "--crop", "10,0,10,4", message="crop")
        self.assertEqual(self.files(), ["apart.xml", "dark.xml", "scene.xml", "unlit.xml"])

    def test_size_crop_and_definitions(self):
        self.expect(0, "render", "scene.xml", "-Dres=20", "--crop", "3,6,8,5", "--spp", "4")
        header = exr_metadata(self.folder / "run.exr")
        self.assertEqual((header["dataWindow"], header["displayWindow"]), ((3, 6, 10, 10), (0, 0, 19, 11)))
        self.expect(0, "render", "scene.xml", "-D", "res=20", "--size", "6x4", "--spp", "4")
        self.assertEqual(exr_metadata(self.folder / "run.exr")["displayWindow"], (0, 0, 5, 3))

    def test_seed_and_number_of_samples(self):
        """A seed is a picture, and another seed another one; as many samples are taken as are asked for."""
        pictures = []
        for integrator in ("path", "mlt"):
            for seed in (1, 1, 2):
                self.expect(0, "render", "scene.xml", "--integrator", integrator, "--spp", "3", "--seed", seed)
                self.assertEqual(self.report()["samples"], 3 * 16 * 12)
                pictures.append(read_exr(self.folder / "run.exr")["G"])
            self.assertEqual(pictures[-3], pictures[-2])
            self.assertNotEqual(pictures[-2], pictures[-1])

    def test_repair_closes_what_encloses(self):
        """A tetrahedron of fog without one side lets the fog out, says check, unless it is to be repaired."""
        self.write("open.obj", "v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\n")
        fog = ('<shape type="obj"><string name="filename" value="open.obj"/><bsdf type="null"/>'
               '<medium type="homogeneous" name="interior"/></shape>')
        self.write("open.xml", scene_text(more=fog))
        self.assertIn("border edges", self.expect(0, "check", "open.xml").stdout.decode())
        self.expect(3, "check", "--strict", "open.xml", message="--strict")
        repaired = self.expect(0, "check", "--strict", "--repair", "open.xml").stdout.decode()
        self.assertNotIn("border edges", repaired)

    def test_properties_reach_the_integrator(self):
        lengths = {}
        for depth in (2, 4):
            self.expect(0, "render", "scene.xml", "--integrator", "bdpt", "--spp", "16", "--set",
                        f"integrator.max_depth={depth}")
            lengths[depth] = {share["k"] for share in self.report()["b_k"] if share["value"] > 0}
        self.assertEqual(max(lengths[2]) + 2, max(lengths[4]), lengths)

    def test_time_is_kept(self):
        self.expect(0, "render", "scene.xml", "--integrator", "path", "--time", "1s", "-t", "2")
        self.assertGreaterEqual(self.report()["speed"]["seconds"], 1)
        self.assertLess(self.report()["speed"]["seconds"], 5)

    def test_interrupt_saves(self):
        process = self.start_cli("render", "scene.xml", "--time", "10m", "-t", "2", program=PROGRAM)
        while b"render" not in process.stderr.readline():
            self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 75)
        self.assertTrue(self.report()["interrupted"])
        self.assertGreater(sum(map(sum, read_exr(self.folder / "run.exr")["G"])), 0)

    def test_replay(self):
        first = self.expect(0, "render", "scene.xml", "--replay", "1:0:5").stdout
        self.assertGreater(len(first), 40)
        self.assertEqual(self.expect(0, "render", "scene.xml", "--replay", "1:0:5").stdout, first)
        self.assertNotEqual(self.expect(0, "render", "scene.xml", "--replay", "1:0:6").stdout, first)
        # Up to its last line where the camera is one of parallel rays, too.
        scene = scene_text().replace("perspective", "orthographic").replace('<float name="fov" value="40"/>', "")
        self.write("parallel.xml", scene)
        parallel = self.expect(0, "render", "parallel.xml", "--replay", "1:0:5").stdout.decode()
        self.assertIn(" parallel sensor at ", parallel)
        self.assertRegex(parallel, r"\nmutation .* log ratio ")

    def test_info(self):
        text = self.expect(0, "info", "scene.xml").stdout.decode()
        for part in ("2 surfaces", "2 quads", "2 twosided", "emitters    1 area", "media       none", "16x12, box"):
            self.assertIn(part, text)
        self.assertRegex(text, r"memory +[\d.]+ [KM]iB to render")

    def test_check(self):
        self.write("odd.xml", scene_text(more=UNUSED_PROPERTY))
        self.expect(0, "check", "scene.xml", "--strict")
        self.expect(3, "check", "odd.xml", "--strict")


if __name__ == "__main__":
    unittest.main()
