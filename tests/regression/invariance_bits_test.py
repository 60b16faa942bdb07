# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes that leave every bit of the arithmetic as it was must leave every bit of the picture."""

import json
import unittest

from invariance_support import INTEGRATORS, OVERRIDES, SceneFolder, scenes
from support import PROGRAM, CliTest, exr_metadata, read_exr
from transform_scene import Similarity, brightened, moved, parse, renamed, text_of, with_objects, with_value

COLORS = ("R", "G", "B")
# Powers of two scale without rounding. The program has no lengths of its own, so not a bit of a path may change.
SMALL, LARGE = 2.0**-10, 2.0**10
DIM, BRIGHT = 2.0**-30, 2.0**30


def differing(whole, other, factor):
    """How many values of `other` are not exactly `factor` times those of `whole`."""
    pairs = [(x, y) for name in COLORS for rows in zip(whole[name], other[name], strict=True)
             for x, y in zip(*rows, strict=True)]
    return sum(factor * x != y for x, y in pairs)


class Bits(CliTest):
    def setUp(self):
        self.scenes = SceneFolder()
        self.addCleanup(self.scenes.close)
        super().setUp()

    def run_cli(self, *arguments, program=PROGRAM, **options):
        return super().run_cli(*arguments, program=program, **options)

    def render(self, file, *arguments, integrator="path", seed=1):
        overrides = [word for key, value in OVERRIDES.get(integrator, {}).items()
                     for word in ("--set", f"integrator.{key}={value}")]
        self.expect(0, "render", file, "-o", "picture.exr", "--spp", "16", "--seed", seed, "--integrator",
                    integrator, "-q", *overrides, *arguments)
        return read_exr(self.folder / "picture.exr")

    def check(self, whole, other, factor, what):
        """A picture without light would prove nothing."""
        self.assertTrue(any(value > 0 for row in whole["G"] for value in row), what)
        self.assertEqual(differing(whole, other, factor), 0, what)

    def test_threads_units_radiances_and_names(self):
        variants = {
            "large": (lambda s: brightened(moved(s, Similarity(scale=LARGE)), DIM), DIM),
            "small": (lambda s: renamed(brightened(moved(s, Similarity(scale=SMALL)), BRIGHT)), BRIGHT),
        }
        for name, scene in scenes().items():
            whole_file = self.scenes.write(name, scene)
            files = {variant: self.scenes.write(f"{variant} of another name", change(scene))
                     for variant, (change, _) in variants.items()}
            for integrator in INTEGRATORS:
                with self.subTest(scene=name, integrator=integrator):
                    whole = self.render(whole_file, "-t", "1", integrator=integrator)
                    for threads in ("2", "3"):
                        self.assertEqual(whole, self.render(whole_file, "-t", threads, integrator=integrator), threads)
                    for variant, (_, factor) in variants.items():
                        other = self.render(files[variant], "-t", "1", integrator=integrator)
                        self.check(whole, other, factor, variant)

    def test_another_seed_gives_another_picture(self):
        """Or the test above could not fail."""
        file = self.scenes.write("fog_box", scenes()["fog_box"])
        for integrator in INTEGRATORS:
            self.assertNotEqual(self.render(file, integrator=integrator),
                                self.render(file, integrator=integrator, seed=2))

    def test_renaming_keeps_hash_and_pixels(self):
        scene = scenes()["fog_box"]
        whole = self.render(self.scenes.write("fog_box", scene))
        content_hash = self.hash()
        for name, other in (("b", scene), ("c", renamed(scene))):
            self.check(whole, self.render(self.scenes.write(name, other)), 1, name)
            self.assertEqual(self.hash(), content_hash)
        self.render(self.scenes.write("d", brightened(scene, 2)))
        self.assertNotEqual(self.hash(), content_hash)

    def hash(self):
        return json.loads((self.folder / "picture.json").read_text(encoding="utf-8"))["scene"]["hash"]

    def test_options_do_what_the_file_would(self):
        scene = scenes()["fog_box"]
        file = self.scenes.write("fog_box", scene)
        fewer = self.render(self.scenes.write("fewer", with_value(scene, "default[@name='depth']", 2)))
        self.check(fewer, self.render(file, "-D", "depth=2"), 1, "-D")
        self.check(fewer, self.render(file, "--set", "integrator.max_depth=2"), 1, "--set")
        self.assertNotEqual(fewer, self.render(file))
        smaller = self.render(self.scenes.write("smaller", with_value(scene, "default[@name='res']", 8)))
        self.check(smaller, self.render(file, "-D", "res=8"), 1, "-D of the size")
        self.check(smaller, self.render(file, "--size", "8x8"), 1, "--size")
        text = text_of(scene).replace("</film>", '<integer name="crop_offset_x" value="3"/><integer name="crop_offset_y"'
                                      ' value="4"/><integer name="crop_width" value="6"/>'
                                      '<integer name="crop_height" value="5"/></film>')
        part = self.render(self.scenes.write("part", parse(text)))
        self.check(part, self.render(file, "--crop", "3,4,6,5"), 1, "--crop")
        self.assertEqual(exr_metadata(self.folder / "picture.exr")["dataWindow"], (3, 4, 8, 8))

    def test_the_file_s_integrator(self):
        scene = scenes()["glowing_fog"]
        for asked, used in (("volpath", "path"), ("ptracer", "light"), ("bdpt", "bdpt"), ("pssmlt", "pssmlt"), ("mlt", "mlt")):
            other = parse(text_of(scene))
            other.find("integrator").set("type", asked)
            file = self.scenes.write(asked, other)
            overrides = [word for key, value in OVERRIDES.get(used, {}).items()
                         for word in ("--set", f"integrator.{key}={value}")]
            self.check(self.render(file, integrator=used), self.render(file, *overrides, integrator="file"), 1, asked)
            self.assertEqual(exr_metadata(self.folder / "picture.exr")["integrator"], used)

    def test_two_objects_of_one_id(self):
        double = with_objects(scenes()["fog_box"], '<bsdf type="diffuse" id="grey"/>')
        result = self.expect(3, "render", self.scenes.write("double", double), message="grey")
        self.assertRegex(result.stderr.decode(), r"double\.xml:\d+:\d+")


if __name__ == "__main__":
    unittest.main()
