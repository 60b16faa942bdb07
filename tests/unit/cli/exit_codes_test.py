# SPDX-License-Identifier: GPL-3.0-or-later
"""Every exit code, and that the message says what is wrong."""

import subprocess
import unittest

from support import UNUSED_PROPERTY, CliTest, scene_text


class Usage(CliTest):
    def test_bad_flags_name_themselves(self):
        for flags, message in [
                (["--no-such-flag"], "--no-such-flag"),
                (["--checkpoint", "x"], "--checkpoint"),
                (["--time", "1x"], "--time"),
                (["--time", "0"], "--time"),
                (["--time", "5m3"], "--time"),
                (["--time", "5m1h"], "--time"),
                (["--time", "5m5m"], "--time"),
                (["--time", "1", "--spp", "2"], "excludes"),
                (["--spp", "0"], "--spp"),
                (["--spp", "nan"], "--spp"),
                (["--seed", "-1"], "--seed"),
                (["--seed", "1.5"], "--seed"),
                (["-t", "-1"], "--threads"),
                (["--size", "640"], "--size"),
                (["--size", "0x5"], "--size"),
                (["--crop", "1,2,3"], "--crop"),
                (["--crop", "0,0,0,4"], "--crop"),
                (["-D", "novalue"], "--define"),
                (["-D", "=1"], "--define"),
                (["--set", "max_depth=3"], "--set"),
                (["--set", "integrator.=3"], "--set"),
                (["--exposure", "bright"], "--exposure"),
                (["--replay", "1:2"], "--replay"),
                (["-q", "-v"], "excludes"),
                (["-o", "picture.png"], ".exr"),
                (["-o", "picture"], ".exr"),
                (["--json", "scene.xml"], "another file"),
                (["--json", "run.exr"], "another file"),
                (["--set", "integrator.outcome=usage"], "no such property"),
        ]:
            with self.subTest(flags=flags):
                self.expect(2, "render", "scene.xml", *flags, message=message)
        self.assertEqual(self.files(), ["scene.xml"])

    def test_missing_or_unknown_command(self):
        self.expect(2, message="Usage:")
        self.expect(2, "paint", message="paint")
        self.expect(2, "render", message="SCENE")
        self.expect(2, "compare", "a.exr", message="B is required")
        self.expect(2, "compare", "a.exr", "b.exr", "--tile", "0", message="--tile")

    def test_help_and_version_are_no_failures(self):
        for arguments in (["--help"], ["render", "--help"], ["info", "--help"], ["check", "-h"], ["compare", "-h"],
                          ["fit-phase", "-h"]):
            self.assertIn(b"Usage:", self.expect(0, *arguments).stdout)
        self.assertRegex(self.expect(0, "--version").stdout.decode(), r"^fogbow \d+\.\d+\.\d+\n$")


class Failures(CliTest):
    def test_scene(self):
        self.write("cut.xml", scene_text()[:300])
        for command in ("render", "info", "check"):
            self.expect(3, command, "cut.xml", message="cut.xml:")
        self.assertEqual(self.files(), ["cut.xml", "scene.xml"])

    def test_input_and_output(self):
        self.expect(4, "render", "absent.xml", message="absent.xml")
        self.expect(4, "render", "scene.xml", "-o", "absent/out.exr", message="'absent' does not exist")
        self.expect(4, "render", "scene.xml", "-o", "scene.xml/out.exr", message="scene.xml")
        self.expect(4, "render", "scene.xml", "--json", "absent/out.json", message="'absent' does not exist")
        self.expect(4, "render", "scene.xml", "--json", "/dev/null", message="no regular file")
        (self.folder / "taken.png").mkdir()
        self.expect(4, "render", "scene.xml", "-o", "taken.exr", message="taken.png")
        self.expect(4, "compare", "absent.exr", "scene.xml", message="absent.exr")
        self.assertEqual(self.files(), ["scene.xml", "taken.png"])

    def test_output_is_refused_before_the_scene_is_read(self):
        self.expect(4, "render", "absent.xml", "-o", "absent/out.exr", message="'absent' does not exist")

    def test_full_standard_output(self):
        with open("/dev/full", "wb") as full:
            result = self.run_cli("info", "scene.xml", stdout=full, stderr=subprocess.PIPE)
        self.assertEqual((result.returncode, result.stderr), (4, b"error: standard output cannot be written\n"))

    def test_renderer(self):
        for outcome, code, message in [("no_light", 5, "nothing carries light"), ("numerical", 6, "the film overflows"),
                                       ("bad_alloc", 33, "out of memory")]:
            self.expect(code, "render", "scene.xml", "--set", f"integrator.outcome={outcome}", message=message)
        self.assertEqual(self.files(), ["scene.xml"])

    def test_more_memory_than_there_is(self):
        self.expect(33, "render", "scene.xml", "--set", f"integrator.memory={2**60}", message="1048576.0 TiB")

    def test_groups_that_disagree_leave_a_picture(self):
        self.expect(7, "render", "scene.xml", "--set", "integrator.outcome=disagree", message="disagree")
        self.assertEqual(self.files(), ["run.exr", "run.json", "run.png", "scene.xml"])


class Strict(CliTest):
    def setUp(self):
        super().setUp()
        self.write("odd.xml", scene_text(more=UNUSED_PROPERTY))

    def test_check(self):
        line = 1 + scene_text(more=UNUSED_PROPERTY).split("nonsense")[0].count("\n")
        result = self.expect(0, "check", "odd.xml")
        self.assertRegex(result.stdout.decode(), rf"warning: odd\.xml:{line}:.*nonsense")
        self.assertIn(b"odd.xml: 1 warning\n", result.stdout)
        result = self.expect(3, "check", "odd.xml", "--strict", message="--strict")
        self.assertEqual(result.stdout.decode().count("nonsense"), 1)
        self.assertNotIn(b"warning", self.expect(0, "check", "scene.xml", "--strict").stdout)

    def test_render(self):
        result = self.expect(0, "render", "odd.xml", message="nonsense")
        self.assertEqual(result.stderr.decode().count("nonsense"), 1)
        self.expect(3, "render", "odd.xml", "-o", "strict.exr", "--strict", message="nonsense")
        self.assertNotIn("strict.exr", self.files())


if __name__ == "__main__":
    unittest.main()
