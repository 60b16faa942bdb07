# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the command line share: running the program, a small scene, and pictures without libraries."""

import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

# The program itself, and the same with test_renderer.cpp underneath.
PROGRAM = os.environ["FOGBOW_PROGRAM"]
TEST_PROGRAM = os.environ["FOGBOW_TEST_PROGRAM"]

SCENE = """<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">
  <default name="res" value="16"/>
  <integrator type="volpath"><integer name="max_depth" value="8"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0, 0.25, 2.4" target="0, -0.3, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="$res"/><integer name="height" value="12"/><rfilter type="box"/>
    </film>
  </sensor>
  <bsdf type="twosided" id="grey"><bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></bsdf>
  <shape type="rectangle" id="floor">
    <transform name="to_world"><rotate x="1" angle="-90"/><translate y="-1"/></transform><ref id="grey"/>
  </shape>
  <shape type="rectangle" id="light">
    <transform name="to_world"><scale value="0.4"/><rotate x="1" angle="<!--TURN-->"/><translate y="1"/></transform>
    <ref id="grey"/><!--EMITTER-->
  </shape>
  <!--MORE-->
</scene>
"""
EMITTER = '<emitter type="area"><rgb name="radiance" value="5"/></emitter>'
UNUSED_PROPERTY = '<bsdf type="diffuse" id="spare"><float name="nonsense" value="1"/></bsdf>'


def scene_text(emitter=EMITTER, turn=90, more=""):
    """`turn`: the light's angle; 90 shines on the floor."""
    return SCENE.replace("<!--EMITTER-->", emitter).replace("<!--TURN-->", str(turn)).replace("<!--MORE-->", more)


class CliTest(unittest.TestCase):
    """Runs in a folder of its own, which holds scene.xml; thus pictures are called after that folder's name, `run`."""

    def setUp(self):
        parent = tempfile.mkdtemp(prefix="fogbow-cli-")
        self.addCleanup(shutil.rmtree, parent)
        self.folder = pathlib.Path(parent) / "run"
        self.folder.mkdir()
        self.write("scene.xml", scene_text())

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def run_cli(self, *arguments, program=TEST_PROGRAM, **options):
        return subprocess.run([program, *map(str, arguments)], cwd=self.folder, capture_output="stdout" not in options,
                              timeout=120, check=False, **options)

    def start_cli(self, *arguments, program=TEST_PROGRAM, **options):
        process = subprocess.Popen([program, *map(str, arguments)], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, **options)
        self.addCleanup(self._end, process)
        return process

    @staticmethod
    def _end(process):
        if process.poll() is None:
            process.kill()
        process.communicate()

    def expect(self, code, *arguments, message=None, **options):
        """Runs, checks the exit code, and that standard error holds `message`."""
        result = self.run_cli(*arguments, **options)
        self.assertEqual(result.returncode, code, (arguments, result.stdout, result.stderr))
        if message is not None:
            self.assertIn(message, result.stderr.decode())
        return result

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())


def _exr_attributes(data):
    """{name: (type, bytes)} and the offset behind the header."""
    magic, version = struct.unpack_from("<II", data)
    assert magic == 20000630 and version & 0xFF == 2, "no OpenEXR file"
    attributes, at = {}, 8
    while data[at]:
        name, at = _exr_string(data, at)
        kind, at = _exr_string(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def _exr_string(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _exr_channels(value):
    """[(name, pixel type)]."""
    channels, at = [], 0
    while value[at]:
        name, at = _exr_string(value, at)
        channels.append((name, struct.unpack_from("<i", value, at)[0]))
        at += 16
    return channels


def exr_metadata(path):
    """The header's attributes as Python values, by name."""
    formats = {"float": "<f", "int": "<i", "m44f": "<16f", "box2i": "<4i"}
    values = {}
    for name, (kind, value) in _exr_attributes(pathlib.Path(path).read_bytes())[0].items():
        if kind in formats:
            numbers = struct.unpack(formats[kind], value)
            values[name] = numbers if len(numbers) > 1 else numbers[0]
        elif kind == "string":
            values[name] = value.decode()
        elif kind == "chlist":
            values[name] = _exr_channels(value)
        elif kind == "compression":
            values[name] = value[0]
    return values


def _unzip_block(block, size):
    """Undoes OpenEXR's ZIP: deflate, differences, and halves interleaved."""
    if len(block) == size:
        return block
    raw = bytearray(zlib.decompress(block))
    for i in range(1, len(raw)):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 0xFF
    half = (len(raw) + 1) // 2
    result = bytearray(len(raw))
    result[0::2] = raw[:half]
    result[1::2] = raw[half:]
    return bytes(result)


def read_exr(path):
    """{channel: rows of floats} of a float32 scan-line file that is stored plainly or zipped."""
    data = pathlib.Path(path).read_bytes()
    attributes, at = _exr_attributes(data)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    lines = {0: 1, 3: 16}[attributes["compression"][1][0]]
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = _exr_channels(attributes["channels"][1])
    assert all(kind == 2 for _, kind in channels), "not float32"
    picture = {name: [None] * height for name, _ in channels}
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, y1 + 1 - y)
        block = _unzip_block(data[offset + 8:offset + 8 + size], rows * width * 4 * len(channels))
        for row in range(rows):
            for i, (name, _) in enumerate(channels):
                start = (row * len(channels) + i) * width * 4
                picture[name][y - y0 + row] = struct.unpack_from(f"<{width}f", block, start)
    return picture


def write_exr(path, picture):
    """A plain float32 file from {channel: rows of floats}."""
    names = sorted(picture)
    height, width = len(picture[names[0]]), len(picture[names[0]][0])
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2)
    for name, kind, value in [("channels", "chlist", channels), ("compression", "compression", b"\0"),
                              ("dataWindow", "box2i", window), ("displayWindow", "box2i", window),
                              ("lineOrder", "lineOrder", b"\0"), ("pixelAspectRatio", "float", struct.pack("<f", 1)),
                              ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
                              ("screenWindowWidth", "float", struct.pack("<f", 1))]:
        header += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    header += b"\0"
    line_size = width * 4 * len(names)
    first = len(header) + 8 * height
    body = b"".join(struct.pack("<ii", y, line_size) + b"".join(struct.pack(f"<{width}f", *picture[name][y])
                                                                 for name in names) for y in range(height))
    offsets = struct.pack(f"<{height}Q", *(first + y * (line_size + 8) for y in range(height)))
    pathlib.Path(path).write_bytes(header + offsets + body)


def read_png(path):
    """Rows of (r, g, b) of an 8-bit RGB file."""
    data = pathlib.Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG file"
    at, packed, size = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        content = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">IIBBBBB", content)
        packed += content if kind == b"IDAT" else b""
        at += 12 + length
    width, height, depth, color, *_ = size
    assert (depth, color) == (8, 2), "not 8-bit RGB"
    return [_pixels(row) for row in _unfilter(zlib.decompress(packed), 3 * width, height)]


def _pixels(row):
    return [tuple(row[i:i + 3]) for i in range(0, len(row), 3)]


def _unfilter(raw, stride, height):
    above, rows = bytearray(stride), []
    for y in range(height):
        kind, *line = raw[y * (stride + 1):(y + 1) * (stride + 1)]
        for i in range(stride):
            left, corner = (line[i - 3], above[i - 3]) if i >= 3 else (0, 0)
            line[i] = (line[i] + _predict(kind, left, above[i], corner)) & 0xFF
        rows.append(bytes(line))
        above = line
    return rows


def _predict(kind, left, above, corner):
    guess = left + above - corner
    paeth = min((left, above, corner), key=lambda value: abs(guess - value))
    return (0, left, above, (left + above) // 2, paeth)[kind]
