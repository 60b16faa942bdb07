# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes, each with something of its own that a unit of length, an order or a thread could spoil."""

import math

_FRAME = """<scene version="3.0.0">
  <default name="res" value="16"/>
  <default name="depth" value="6"/>
  <integrator type="volpath"><integer name="max_depth" value="$depth"/></integrator>
  <sensor type="{sensor}">
    <float name="fov" value="48"/><float name="near_clip" value="0.0625"/><float name="far_clip" value="128"/>{lens}
    <transform name="to_world"><lookat origin="0, 0.5, 3" target="0, -0.25, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="$res"/><integer name="height" value="$res"/><rfilter type="box"/></film>
    {sensor_medium}
  </sensor>
  <bsdf type="twosided" id="grey"><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></bsdf>
  <bsdf type="twosided" id="black"><bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></bsdf>
  <medium type="homogeneous" id="fog">
    <rgb name="sigma_t" value="0.4, 0.5, 0.7"/><rgb name="albedo" value="0.9, 0.8, 0.7"/>
    <phase type="hg"><float name="g" value="0.4"/></phase>
  </medium>
  <shape type="rectangle" id="floor">
    <transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/><translate y="-1"/></transform><ref id="grey"/>
  </shape>
  <shape type="rectangle" id="back">
    <transform name="to_world"><scale value="2"/><translate z="-1.5"/></transform><ref id="grey"/>
  </shape>
  {objects}
</scene>
"""

_LAMP = """<shape type="rectangle" id="lamp">
    <transform name="to_world"><rotate x="1" angle="90"/><translate x="0.5" y="1.5" z="0.25"/></transform>
    <ref id="black"/><emitter type="area"><rgb name="radiance" value="3, 2.5, 2"/></emitter>
  </shape>"""
_BALL = """<shape type="sphere" id="ball"><point name="center" x="-0.5" y="-0.5" z="0.25"/><float name="radius" value="0.375"/>
    <ref id="grey"/></shape>"""
_BLOCK = """<shape type="cube" id="block">
    <transform name="to_world"><scale value="0.25"/><rotate y="1" angle="30"/><translate x="0.5" y="-0.7" z="-0.25"/></transform>
    <ref id="grey"/></shape>"""
_FOG_BOX = """<bsdf type="null" id="nothing"/>
  <shape type="cube" id="cloud"><transform name="to_world"><scale x="1.5" y="0.9375" z="1.25"/></transform>
    <ref id="nothing"/><ref name="interior" id="fog"/></shape>"""
_IN_FOG = '<ref id="fog"/>'


def _scene(objects, sensor="perspective", lens="", sensor_medium=""):
    return _FRAME.format(objects=objects, sensor=sensor, lens=lens, sensor_medium=sensor_medium)


def _glass_ball(bsdf, exterior=""):
    return f"""{bsdf}<shape type="sphere" id="ball">
    <point name="center" x="0" y="-0.25" z="0.25"/><float name="radius" value="0.5"/><ref id="glass"/>{exterior}</shape>"""


SCENES = {
    "fog_box": _scene(_LAMP + _BALL + _BLOCK + _FOG_BOX),
    "camera_in_fog": _scene(_LAMP + _BALL + _BLOCK, sensor_medium=_IN_FOG),
    "glass_ball": _scene(_LAMP + _glass_ball(
        '<bsdf type="dielectric" id="glass"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>',
        '<ref name="exterior" id="fog"/>'), sensor_medium=_IN_FOG),
    "smooth_mesh": _scene(_LAMP + """
  <bsdf type="dielectric" id="water"><float name="int_ior" value="1.33"/><float name="ext_ior" value="1"/></bsdf>
  <shape type="obj" id="surface"><string name="filename" value="waves.obj"/>
    <transform name="to_world"><scale x="2" y="1" z="2"/><translate y="-0.5"/></transform><ref id="water"/>
    <ref name="interior" id="fog"/></shape>"""),
    "point_light": _scene('<emitter type="point" id="spark"><point name="position" x="-0.5" y="0.75" z="0.5"/>'
                          '<rgb name="intensity" value="6, 5, 4"/></emitter>' + _BALL + _BLOCK, sensor_medium=_IN_FOG),
    "sky_and_lens": _scene('<emitter type="constant" id="sky"><rgb name="radiance" value="0.75, 0.875, 1"/></emitter>' +
                           _BALL + _BLOCK, sensor="thinlens",
                           lens='<float name="aperture_radius" value="0.0625"/><float name="focus_distance" value="3"/>'),
    "rough_glass": _scene(_LAMP + _glass_ball(
        '<bsdf type="roughdielectric" id="glass"><float name="alpha" value="0.2"/><string name="distribution" value="ggx"/>'
        '<float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>')),
    "glowing_fog": _scene(_BALL + _BLOCK + _FOG_BOX).replace(
        '<phase type="hg">', '<rgb name="emission" value="0.5, 0.25, 0.125"/><phase type="hg">'),
}


def write_meshes(folder, cells=8):
    """A wavy square over [-1, 1]^2 with the normals of its waves."""
    lines, side = [], range(cells + 1)
    grid = [(2 * i / cells - 1, 2 * j / cells - 1) for j in side for i in side]
    for x, z in grid:
        lines.append(f"v {x!r} {0.0625 * math.sin(3 * x) * math.cos(4 * z)!r} {z!r}")
    for x, z in grid:
        dx, dz = 0.1875 * math.cos(3 * x) * math.cos(4 * z), -0.25 * math.sin(3 * x) * math.sin(4 * z)
        n = math.sqrt(1 + dx * dx + dz * dz)
        lines.append(f"vn {-dx / n!r} {1 / n!r} {-dz / n!r}")
    for j in range(cells):
        for i in range(cells):
            a, c = j * (cells + 1) + i + 1, (j + 1) * (cells + 1) + i + 1
            for triangle in ((a, c, a + 1), (a + 1, c, c + 1)):
                lines.append("f " + " ".join(f"{v}//{v}" for v in triangle))
    (folder / "waves.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
