# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said while a render goes on: a bar on a terminal, lines elsewhere, nothing if so asked."""

import errno
import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import termios
import unittest

from support import TEST_PROGRAM, UNUSED_PROPERTY, CliTest, scene_text


class Lines(CliTest):
    def test_plain_lines_without_a_terminal(self):
        result = self.expect(0, "render", "scene.xml", "--time", "2.5")
        text = result.stderr.decode()
        self.assertNotIn("\r", text)
        self.assertNotIn("\x1b", text)
        lines = [line for line in text.splitlines() if not line.startswith("info:")]
        self.assertTrue(2 <= len(lines) <= 6, lines)
        self.assertRegex(lines[0], r"^bootstrap +0%")
        for line in lines[1:]:
            self.assertRegex(line, r"^render +\d+%  [\d.]+ s  ETA [\d.]+ s  b 0\.2500 ± 0\.0025  1\.5M mutations/s$")

    def test_independent_samples_are_called_so(self):
        for flags, unit in ((["--integrator", "path"], "samples/s"), (["--integrator", "file"], "samples/s"),
                            (["--integrator", "pssmlt"], "mutations/s")):
            self.expect(0, "render", "scene.xml", *flags, message=unit)

    def test_quiet_prints_nothing(self):
        self.write("scene.xml", scene_text(more=UNUSED_PROPERTY))
        result = self.expect(7, "render", "scene.xml", "-q", "--time", "0.3", "--set", "integrator.outcome=disagree")
        self.assertEqual((result.stdout, result.stderr), (b"", b""))
        report = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))
        self.assertEqual(len(report["warnings"]), 2, "quiet is not forgetful")
        self.expect(6, "render", "scene.xml", "-q", "--set", "integrator.outcome=numerical", message="error: ")


class Terminal(CliTest):
    def on_terminal(self, columns, *flags, term="xterm"):
        """What a terminal of that width gets on standard error."""
        master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("4H", 24, columns, 0, 0))
        process = subprocess.Popen([TEST_PROGRAM, "render", "scene.xml", *flags], cwd=self.folder, stderr=slave,
                                   stdout=subprocess.DEVNULL, env={**os.environ, "TERM": term})
        os.close(slave)
        received = b""
        try:
            while chunk := os.read(master, 65536):
                received += chunk
        except OSError as error:  # how Linux tells that the other end is closed
            if error.errno != errno.EIO:
                raise
        finally:
            os.close(master)
        self.assertEqual(process.wait(timeout=60), 0)
        return received.decode()

    @staticmethod
    def frames(text):
        """The bars as drawn, one after the other."""
        return [frame for frame in re.split(r"\r\x1b\[K|\r\n", text) if "%" in frame]

    def test_bar(self):
        text = self.on_terminal(120, "--time", "1.5")
        frames = self.frames(text)
        self.assertTrue(4 <= len(frames) <= 20, frames)  # at most ten a second
        shares = []
        for frame in frames:
            match = re.match(r"^(bootstrap|render) \[(=*)>?( *)\] +(\d+)%  ", frame)
            self.assertTrue(match, frame)
            length = len(match[0][match[0].index("["):match[0].index("]")]) - 1
            shares.append(int(match[4]))
            self.assertAlmostEqual(len(match[2]) / length, shares[-1] / 100, delta=1.5 / length)
            self.assertLess(len(frame), 120)
        self.assertEqual(shares, sorted(shares))
        self.assertRegex(frames[len(frames) // 2], r"  ETA \d\.\d s  b 0\.2500 ± 0\.0025  1\.5M mutations/s$")
        self.assertRegex(text, r"\r\x1b\[K(info:[^\n]*\n)*$")  # gone at the end

    def test_narrow_terminals_get_no_wrapped_lines(self):
        for columns in (20, 50, 80):
            for frame in self.frames(self.on_terminal(columns, "--time", "0.4")):
                self.assertLess(len(frame), columns)

    def test_messages_stand_above_the_bar(self):
        text = self.on_terminal(100, "--time", "0.6", "--picture-interval", "0.3", "--set", "integrator.outcome=chatty")
        self.assertRegex(text, r"\r\x1b\[Kwarning: a word on the way\r\n(bootstrap|render) \[")

    def test_dumb_terminals_get_lines(self):
        self.assertNotIn("\x1b", self.on_terminal(80, "--time", "0.3", term="dumb"))

    def test_quiet(self):
        self.assertEqual(self.on_terminal(80, "-q", "--time", "0.3"), "")


if __name__ == "__main__":
    unittest.main()
