# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals: stop and save, save and go on, and enough is enough."""

import json
import signal
import time
import unittest

from support import CliTest, exr_metadata, read_exr

LONG = "60"


class Interrupt(CliTest):
    def start_render(self, *flags, limit=LONG):
        process = self.start_cli("render", "scene.xml", "--time", limit, *flags)
        process.stderr.readline()  # the first line of progress: the render has begun
        return process

    def wait_for(self, condition):
        for _ in range(1000):
            if condition():
                return
            time.sleep(0.02)
        self.fail("waited in vain")

    def finished(self):
        """What the picture's header says; nothing while there is none."""
        path = self.folder / "run.exr"
        return exr_metadata(path)["finished"] if path.exists() else None

    def test_stop_and_save(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                for path in self.folder.glob("run.*"):
                    path.unlink()
                process = self.start_render()
                process.send_signal(number)
                out, err = process.communicate(timeout=30)
                self.assertEqual(process.returncode, 75, err)
                self.assertIn("interrupted: the picture so far is written", err.decode())
                self.assertIn("wrote run.exr", out.decode())
                self.assertEqual(self.files(), ["run.exr", "run.json", "run.png", "scene.xml"])
                self.assertEqual(read_exr(self.folder / "run.exr")["R"][0][:3], (0, 1, 2))
                self.assertEqual(self.finished(), 0)
                report = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))
                self.assertEqual((report["interrupted"], report["exit_code"]), (True, 75))
                self.assertLess(report["speed"]["seconds"], float(LONG) / 2)

    def test_times_in_all_units(self):
        for text, seconds in (("1d2h", 93600), ("1h30m", 5400), ("1.5m", 90), ("90", 90)):
            process = self.start_render(limit=text)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=30)
            report = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))
            self.assertEqual(report["options"]["seconds"], seconds, text)

    def test_save_and_go_on(self):
        process = self.start_render("--picture-interval", "0")
        for _ in range(2):
            process.send_signal(signal.SIGUSR1)
            self.wait_for(lambda: self.finished() is not None and (self.folder / "run.png").exists())
            self.assertIsNone(process.poll())
            header = exr_metadata(self.folder / "run.exr")
            self.assertEqual((header["finished"], header["b"], header["seed"]), (0, 0.25, "0"))
            self.assertNotIn("run.json", self.files())
            (self.folder / "run.png").unlink()
            (self.folder / "run.exr").unlink()
        time.sleep(0.2)
        self.assertEqual(self.files(), ["scene.xml"], "one request, one picture")

    def test_a_second_signal_ends_at_once(self):
        process = self.start_render("--set", "integrator.outcome=stubborn")
        process.send_signal(signal.SIGINT)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), -signal.SIGINT)
        self.assertEqual(self.files(), ["scene.xml"])

    def test_pictures_at_intervals(self):
        process = self.start_render("--picture-interval", "0.2s")
        self.wait_for(lambda: self.finished() == 0)
        first = (self.folder / "run.exr").stat().st_ino
        self.wait_for(lambda: (self.folder / "run.exr").stat().st_ino != first)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=30), 75)


if __name__ == "__main__":
    unittest.main()
