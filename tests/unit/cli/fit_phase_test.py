# SPDX-License-Identifier: GPL-3.0-or-later
"""fit-phase: droplets and tables, and that scenes take what it prints."""

import math
import re
import unittest

from support import PROGRAM, CliTest, scene_text


def henyey_greenstein(g, cosine):
    return (1 - g * g) / (1 + g * g - 2 * g * cosine) ** 1.5


def draine(g, alpha, cosine):
    return henyey_greenstein(g, cosine) * (1 + alpha * cosine**2) / (1 + alpha * (1 + 2 * g * g) / 3)


class FitPhase(CliTest):
    def fit(self, *flags):
        return self.expect(0, "fit-phase", *flags).stdout.decode()

    def table(self, value, comment=""):
        angles = [0.25 * i for i in range(721)]
        lines = [f"{angle} {value(math.cos(math.radians(angle)))!r}{comment}" for angle in angles]
        self.write("table.txt", "# angle, value\n\n" + "\n".join(lines) + "\n")

    def test_table(self):
        # In any unit.
        self.table(lambda c: 7 * (0.75 * henyey_greenstein(0.8, c) + 0.25 * draine(0.4, 5, c)), "  # and so on")
        text = self.fit("--table", "table.txt")
        found = re.search(r"fit +([\d.]+) HG\(g ([\d.]+)\) \+ ([\d.]+) Draine\(g ([\d.]+), alpha ([\d.]+)\)", text)
        for value, expected in zip(map(float, found.groups()), (0.75, 0.8, 0.25, 0.4, 5)):
            self.assertAlmostEqual(value / expected, 1, delta=0.01)
        self.assertRegex(text, r"error +0\.00\d\d rms .* HG\(g 0\.\d+\) alone: 0\.\d+\n")

    def test_droplets(self):
        text = self.fit("--radius", "2", "--spread", "0.3")
        for line in (r"droplets +median radius 2 um, deviation of ln radius 0\.3\n", r"wavelengths +611, 549, 464\n",
                     r"index +1\.33\d+, 1\.33\d+, 1\.3\d+\n", r"extinction +2\.\d+, 2\.\d+, 2\.\d+\n",
                     r"albedo +1, 1, 1\n", r"mean cosine +0\.8\d+, 0\.8\d+, 0\.8\d+\n"):
            self.assertRegex(text, line)
        errors = [float(number) for number in re.search(r"error +(\S+) .* alone: (\S+)\n", text).groups()]
        self.assertLess(errors[0], 0.5 * errors[1])
        # Far smaller than the wavelength: Rayleigh's law is Draine's for g = 0 and alpha = 1.
        text = self.fit("--radius", "0.001", "--spread", "0", "--index", "1.5", "--k", "0.1", "--wavelengths", "500")
        self.assertRegex(text, r"wavelengths +500, 500, 500\n")
        m2, x = (1.5 + 0.1j) ** 2, 2 * math.pi * 0.001 / 0.5
        k = (m2 - 1) / (m2 + 2)
        expected = 8 / 3 * x**4 * abs(k) ** 2 / (4 * x * k.imag)
        self.assertAlmostEqual(float(re.search(r"albedo +(\S+),", text)[1]) / expected, 1, delta=1e-3)
        self.assertLess(float(re.search(r"error +(\S+)", text)[1]), 1e-3)

    def test_every_channel_has_its_wavelength(self):
        """Of droplets far smaller than light, what is scattered goes with 1/λ⁴, what is absorbed with 1/λ."""
        wavelengths = (600, 300, 450)
        text = self.fit("--radius", "0.001", "--spread", "0", "--index", "1.5", "--k", "0.1", "--wavelengths",
                        ",".join(map(str, wavelengths)))
        albedo = [float(number) for number in re.search(r"albedo +(\S+), (\S+), (\S+)\n", text).groups()]
        for wavelength, found in zip(wavelengths, albedo):
            self.assertAlmostEqual(found / albedo[0] * (wavelength / wavelengths[0]) ** 3, 1, delta=2e-3)

    def test_scenes_take_it(self):
        xml = self.fit("--radius", "1", "--xml")
        self.assertTrue(xml.startswith("<phase"))
        medium = f'<medium type="homogeneous" id="fog">{xml}</medium>'
        ball = '<shape type="sphere"><bsdf type="null"/><ref name="interior" id="fog"/></shape>'
        self.write("fog.xml", scene_text(more=medium + ball))
        self.expect(0, "check", "--strict", "fog.xml", program=PROGRAM)

    def test_bad_input(self):
        for flags, message in [
                (["--radius", "0"], "radius of droplets must be positive"),
                (["--radius", "big"], "--radius"),
                (["--radius", "1e9"], "too large"),
                (["--spread", "2"], "must lie in [0, 1]"),
                (["--wavelengths", "1,2"], "--wavelengths"),
                (["--wavelengths", "100"], "between 182 and 1129"),
                (["--index", "0"], "no scattering can be computed"),
                (["--index", "1e9"], "no scattering can be computed"),
                (["--k", "-1"], "no scattering can be computed"),
                (["--table", "x", "--radius", "1"], "excludes"),
        ]:
            with self.subTest(flags=flags):
                self.expect(2, "fit-phase", *flags, message=message)
        self.expect(4, "fit-phase", "--table", "none.txt", message="none.txt: cannot be read")
        for text, message in [
                ("0 1\n90 x\n180 1\n", "table.txt:2:1: expected an angle in degrees and a value, found '90 x'"),
                ("0 1\n90 1 2\n180 1\n", "table.txt:2:1: expected an angle"),
                ("0 1\n90\n180 1\n", "table.txt:2:1: expected an angle"),
                ("10 1\n180 1\n", "table.txt:1:1: the angles must rise from 0 to 180"),
                ("0 1\n90 1\n80 1\n180 1", "table.txt:3:1: the angles must rise"),
                ("0 1\n90 1\n", "the angles must rise from 0 to 180"),
                ("", "the angles must rise from 0 to 180"),
                ("0 1\n90 -1\n180 1\n", "table.txt: the values of a phase function must be finite and not negative"),
                ("0 1\n90 0\n180 0\n", "table.txt: a phase function that is zero at some angle cannot be fitted"),
                ("0 0\n180 0\n", "table.txt: the values of a phase function must not all be zero"),
        ]:
            with self.subTest(text=text):
                self.write("table.txt", text)
                self.expect(3, "fit-phase", "--table", "table.txt", message=message)


if __name__ == "__main__":
    unittest.main()
