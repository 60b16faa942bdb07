#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the rules that the compiler does not: layers, heavy headers, licence lines, citations, sizes.

usage: check_layers.py [ROOT]; prints one line a violation, and exits with 1 if there is any.
"""

import pathlib
import re
import sys
import unicodedata

# A file may include its own layer and those of the tiers above it in this list.
TIERS = [
    ["core/util"],
    ["core/math"],
    ["core/image", "core/geometry"],
    ["core/scene"],
    ["media", "core/scene_io"],
    ["core/path"],
    ["core/estimators"],
    ["mlt"],
    ["include", "apps", "python"],
]
TIER_OF = {layer: tier for tier, layers in enumerate(TIERS) for layer in layers}
ANYTHING = "tests"  # may include every layer, and is included by none

# Headers that cost seconds to compile or change how code is compiled: (header, files that may include it).
CONFINED = [
    (r"embree\d*/", r"core/geometry/accel_embree\.cpp|tests/benchmarks/embree_clock\.cpp"),
    (r"CGAL/", r"core/geometry/mesh_(check|repair)_cgal\.cpp"),
    (r"OpenImageIO/", r"core/image/image_io_oiio\.cpp"),
    (r"pugixml", r"core/scene_io/[a-z0-9_]+\.cpp"),
    (r"ceres/|Eigen/", r"media/phase_fit_ceres\.cpp|mlt/manifold/.*|tests/.*"),
    (r"openvdb/", r"tests/.*"),
    (r"nanovdb/", r"core/scene_io/volume_nanovdb\.cpp|tests/.*"),
    (r"blosc", r"core/scene_io/unpack\.cpp"),
    (r"CLI/", r"apps/.*"),
    (r"nlohmann/", r"apps/.*|tests/.*"),
    (r"spdlog/|fmt/", r"core/util/log\.cpp"),
    (r"tbb/|oneapi/", r"core/util/parallel\.cpp"),
    (r"Random123/", r"core/util/rng\.cpp|tests/.*"),
    (r"boost/|gtest/|gmock/|benchmark/", r"tests/.*"),
]
# Of these, no more than one file in the whole project.
ONCE = [r"pugixml"]

MUTATION_LINES = 200
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
COMMENT = re.compile(r"//(.*)")
KEY = re.compile(r"\[([A-Z][A-Za-z]+(?:19|20)\d\d[a-z]?)\b")
# "Blackman and Vigna 2021", "Duff et al. (2017)": the first author's name and the year.
NAME = r"[A-ZÀ-Ž][\w’'-]*[a-zà-ž]"
PROSE = re.compile(rf"({NAME})(?:(?:,|,? and) {NAME})*(?: et al\.)?,? \(?((?:19|20)\d\d)\b")
BIB_KEY = re.compile(r"^@\w+\{\s*([^,\s]+)", re.MULTILINE)


def layer_of(path):
    """The layer of a path relative to the root, or None."""
    parts = pathlib.PurePosixPath(path).parts
    for depth in (2, 1):
        layer = "/".join(parts[:depth])
        if len(parts) > depth and (layer in TIER_OF or layer == ANYTHING):
            return layer
    return None


def may_include(layer, other):
    if layer == other or layer == ANYTHING:
        return True
    return other != ANYTHING and TIER_OF[other] < TIER_OF[layer]


def source_files(root):
    tops = sorted({layer.split("/")[0] for layer in TIER_OF} | {ANYTHING})
    for top in tops:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield path


def check_include(root, name, layer, bracket, target):
    """The violation of one include line, or None."""
    other = layer_of(target)
    if other is not None and (root / target).is_file():
        if bracket == "<":
            return f'"{target}" is ours: include it with quotes'
        if not may_include(layer, other):
            return f"{layer} may not include {other} ({target})"
        return None
    if bracket == '"':
        return f'"{target}" is no file of the project, named from its root'
    for header, allowed in CONFINED:
        if re.match(header, target) and not re.fullmatch(allowed, name):
            return f"<{target}> is confined to {allowed}"
    return None


def citations(comment):
    """(surname or whole key, year or None) of each citation in a comment."""
    for match in KEY.finditer(comment):
        yield match[1], None
    for match in PROSE.finditer(comment):
        yield match[1], match[2]


def is_known(key, year, bib):
    if year is None:
        return key in bib
    name = unicodedata.normalize("NFD", key).encode("ascii", "ignore").decode().lower()
    return any(name in entry.lower() and year in entry for entry in bib)


def check_file(root, path, bib):
    """Violations of one file as (line number, message), and the targets it includes."""
    name = path.relative_to(root).as_posix()
    layer = layer_of(name)
    lines = path.read_text(encoding="utf-8").splitlines()
    violations, included = [], []
    if layer is None:
        violations.append((1, "lies in no layer"))
        return violations, included
    if not lines or lines[0] != "// SPDX-License-Identifier: GPL-3.0-or-later":
        violations.append((1, "the first line is to be the SPDX licence line"))
    if name.startswith("mlt/mutations/") and len(lines) > MUTATION_LINES:
        violations.append((len(lines), f"a mutation has at most {MUTATION_LINES} lines"))
    for number, line in enumerate(lines, 1):
        include = INCLUDE.match(line)
        if include:
            included.append(include[2])
            message = check_include(root, name, layer, include[1], include[2])
            if message:
                violations.append((number, message))
        comment = COMMENT.search(line)
        for key, year in citations(comment[1]) if comment else []:
            if not is_known(key, year, bib):
                cited = key if year is None else f"{key} {year}"
                violations.append((number, f"{cited} is not in docs/references.bib"))
    return violations, included


def check(root):
    """All violations below `root`, as lines."""
    root = pathlib.Path(root)
    bib_file = root / "docs/references.bib"
    bib = set(BIB_KEY.findall(bib_file.read_text(encoding="utf-8"))) if bib_file.is_file() else set()
    found = []
    users = {header: [] for header in ONCE}
    for path in source_files(root):
        name = path.relative_to(root).as_posix()
        violations, included = check_file(root, path, bib)
        found += [f"{name}:{number}: {message}" for number, message in violations]
        for header in ONCE:
            if any(re.match(header, target) for target in included):
                users[header].append(name)
    for header, names in users.items():
        if len(names) > 1:
            found.append(f"{names[1]}:1: {header} is included by more than one file: {', '.join(names)}")
    return found


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    violations = check(root)
    for line in violations:
        print(line)
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
