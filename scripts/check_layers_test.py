#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plants each kind of violation in a small tree, and expects check_layers to report that one and no other."""

import pathlib
import tempfile
import unittest

import check_layers

SPDX = "// SPDX-License-Identifier: GPL-3.0-or-later\n"


class CheckLayersTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("docs/references.bib", "@phdthesis{Veach1997,\n}\n@article{BlackmanVigna2021,\n}\n", spdx="")
        self.write("core/util/check.h", "#pragma once\n")
        self.write("core/image/film.h", '#include "core/util/check.h"\n')
        self.write("core/geometry/accel.h", '#include <vector>\n#include "core/util/check.h"\n')
        self.write("core/geometry/accel_embree.cpp", "#include <embree3/rtcore.h>\n")
        self.write("media/media.h", '#include "core/image/film.h"\n// Balance heuristic [Veach1997, eq. 9.8].\n')
        self.write("mlt/render.h", '#include "media/media.h"\n// xoshiro (Blackman and Vigna 2021)\n')
        self.write("tests/unit/some_test.cpp", '#include <gtest/gtest.h>\n#include "mlt/render.h"\n')

    def write(self, name, text, spdx=SPDX):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(spdx + text, encoding="utf-8")

    def expect(self, *beginnings):
        found = check_layers.check(self.root)
        self.assertEqual(len(found), len(beginnings), found)
        for line, beginning in zip(found, beginnings):
            self.assertTrue(line.startswith(beginning), f"{line!r} does not begin with {beginning!r}")

    def test_clean_tree(self):
        self.expect()

    def test_include_to_the_right(self):
        self.write("core/util/log.h", '\n#include "mlt/render.h"\n')
        self.expect("core/util/log.h:3: core/util may not include mlt")

    def test_include_of_a_sibling(self):
        self.write("core/image/image.h", '#include "core/geometry/accel.h"\n')
        self.expect("core/image/image.h:2: core/image may not include core/geometry")

    def test_include_of_tests(self):
        self.write("apps/fogbow/main.cpp", '#include "tests/unit/some_test.cpp"\n')
        self.expect("apps/fogbow/main.cpp:2: apps may not include tests")

    def test_scene_io_and_media_are_siblings(self):
        self.write("core/scene_io/load.h", '#include "media/media.h"\n')
        self.expect("core/scene_io/load.h:2: core/scene_io may not include media")

    def test_heavy_header_elsewhere(self):
        self.write("core/geometry/mesh.cpp", "#include <embree4/rtcore.h>\n  #  include <CGAL/Mesh.h>\n")
        self.expect("core/geometry/mesh.cpp:2: <embree4/rtcore.h>", "core/geometry/mesh.cpp:3: <CGAL/Mesh.h>")

    def test_test_libraries_in_the_product(self):
        self.write("media/grid.cpp", "#include <boost/math/special_functions.hpp>\n")
        self.expect("media/grid.cpp:2: <boost/math/special_functions.hpp>")

    def test_second_xml_parser(self):
        self.write("core/scene_io/xml.cpp", "#include <pugixml.hpp>\n")
        self.expect()
        self.write("core/scene_io/yml.cpp", "#include <pugixml.hpp>\n")
        self.expect("core/scene_io/yml.cpp:1: pugixml is included by more than one file")

    def test_relative_include(self):
        self.write("core/image/film.cpp", '#include "film.h"\n')
        self.expect('core/image/film.cpp:2: "film.h" is no file of the project')

    def test_own_header_in_brackets(self):
        self.write("core/image/film.cpp", "#include <core/image/film.h>\n")
        self.expect('core/image/film.cpp:2: "core/image/film.h" is ours')

    def test_stray_file(self):
        self.write("core/extra.cpp", "")
        self.expect("core/extra.cpp:1: lies in no layer")

    def test_missing_licence_line(self):
        self.write("core/util/log.h", "#pragma once\n", spdx="")
        self.expect("core/util/log.h:1: the first line")

    def test_long_mutation(self):
        self.write("mlt/mutations/lens.cpp", "\n" * 199)
        self.expect()
        self.write("mlt/mutations/lens.cpp", "\n" * 200)
        self.expect("mlt/mutations/lens.cpp:201: a mutation has at most 200 lines")

    def test_unknown_key(self):
        self.write("core/path/mis.h", "int x;  // [Veach1995, eq. 1]\n")
        self.expect("core/path/mis.h:2: Veach1995 is not in")

    def test_unknown_citation_in_prose(self):
        self.write("core/path/mis.h", "/// As Veach 1995, or (Duff et al. 2017), or Veach (1997).\n// Šidák 1967\n")
        self.expect("core/path/mis.h:2: Veach 1995 is not in", "core/path/mis.h:2: Duff 2017 is not in",
                    "core/path/mis.h:3: Šidák 1967 is not in")


if __name__ == "__main__":
    unittest.main()
