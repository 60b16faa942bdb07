#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the .vol files of the closed forms, next to this script.

smoke.vol is sigma_t of 10x10x10 voxels and three channels: zero in one part, in some channels alone in others.
smoke-emission.vol is what it emits as a black body of radiance 1 with the albedo (0.75, 0.5, 0), bricks-emission.vol with the albedo of
bricks-albedo.vol (then both filters are to be "nearest": a product of trilinear fields is none).
"""
import math
import pathlib
import struct

N = 10


def sigma_t(x, y, z, c):
    if x + y < 5 or z > 7 or (c == 1 and y > 6) or (c == 2 and x > 6):
        return 0.0
    return (4, 3, 5)[c] * (1 + math.sin(1.3 * x + 0.9 * y) * math.cos(1.1 * z))


def albedo(x, y, z, c):
    return 0.5 + 0.5 * math.sin(0.7 * x + c) * math.cos(0.5 * y - 0.8 * z)


def write(name, field):
    values = [field(x, y, z, c) for z in range(N) for y in range(N) for x in range(N) for c in range(3)]
    header = b"VOL\x03" + struct.pack("<5i6f", 1, N, N, N, 3, 0, 0, 0, 1, 1, 1)
    (pathlib.Path(__file__).parent / name).write_bytes(header + struct.pack(f"<{len(values)}f", *values))


write("smoke.vol", sigma_t)
write("smoke-emission.vol", lambda x, y, z, c: sigma_t(x, y, z, c) * (0.25, 0.5, 1)[c])
write("bricks-albedo.vol", albedo)
write("bricks-emission.vol", lambda x, y, z, c: sigma_t(x, y, z, c) * (1 - albedo(x, y, z, c)))
