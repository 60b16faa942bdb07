# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that look alike must look alike in the statistics of their pictures; FOGBOW_LONG asks for more samples.

Pairs are written down here and compared by invariance_judge, all in one process and at one level."""

import json
import os
import subprocess
import sys

from invariance_support import INTEGRATORS, OVERRIDES, SceneFolder, scenes
from transform_scene import (Similarity, as_meshes, flipped, moved, parse, shuffled, text_of, with_objects, with_value,
                             without)

LONG = "FOGBOW_LONG" in os.environ
# Biases that are found with probability 0.99, relative to the mean of the picture and of a tile.
MEAN_BIAS, TILE_BIAS = (0.04, 0.2) if LONG else (0.25, 0.75)
# Where hardly a path changes but by rounding, equal seeds leave little to average over.
SPP, REPLICATES, FEW = (64, 40, 20) if LONG else (8, 16, 4)
# More samples where pictures are noisier: for the same power.
NOISY_INTEGRATORS = {"light": 3, "mlt": 4}
NOISY_SCENES = {"smooth_mesh": 3, "sky_and_lens": 3, "point_light": 3, "rough_glass": 4}

# Next to a camera in fog a light path's contribution has no variance: what is left of its picture is its bits.
CAMERA_IN_FOG = ("camera_in_fog", "glass_ball", "point_light")

TURN = Similarity(axis=(1.0, 2.0, 3.0), angle=77.0, translation=(0.3, -1.7, 2.9))
UNITS = {"thousandfold": Similarity(scale=1000.0),
         "thousandth": Similarity(scale=1e-3, translation=(3e-3, 1.7e-3, -2e-3))}
FAR_OFF = Similarity(translation=(1e4, -1e4, 5e3))

NO_LIGHT = """<emitter type="point"><point name="position" x="0" y="0.5" z="0"/><rgb name="intensity" value="0"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0"/></emitter>
<shape type="sphere"><point name="center" x="0.1" y="-0.1" z="-2.5"/><float name="radius" value="0.1"/>
  <emitter type="area"><rgb name="radiance" value="0"/></emitter></shape>"""
TWO_LIGHTS = """<emitter type="point"><point name="position" x="0.5" y="1" z="0.5"/><rgb name="intensity" value="1, 0.5, 2"/>
</emitter><shape type="sphere"><point name="center" x="0.9" y="-0.75" z="0.75"/><float name="radius" value="0.1875"/>
  <ref id="black"/><emitter type="area"><rgb name="radiance" value="2, 4, 1"/></emitter></shape>"""
ANOTHER_BLACK = """<shape type="sphere"><point name="center" x="0.1" y="-0.1" z="-2.5"/><float name="radius" value="0.1"/>
  <ref id="black"/></shape>"""
EMPTY_CUBE = """<shape type="cube"><transform name="to_world"><scale value="0.45"/><translate x="-0.5" y="-0.45" z="0.25"/>
  </transform><bsdf type="null"/></shape>"""
# A thousandth across and a hundred scene radii away.
SPECK = """<shape type="obj"><string name="filename" value="rectangle.obj"/><transform name="to_world"><scale value="0.001"/>
  <translate x="200" y="150" z="100"/></transform><ref id="grey"/></shape>"""


def overrides_of(integrator, twin):
    """Chains that share their time as the light is shared know means best. Few starts will do where both sides have the same."""
    overrides = OVERRIDES.get(integrator, {})
    if integrator == "mlt" and not twin:
        overrides = overrides | {"luminance_samples": "16384"}
    return overrides | {"two_stage": "false"} if overrides else {}


class Manifest:
    def __init__(self, folder):
        self.folder, self.pairs, self.written, self.turn = folder, [], {}, 0

    def side(self, scene, integrator, more=1, twin=False, **options):
        more *= NOISY_INTEGRATORS.get(integrator, 1)
        text = text_of(scene)
        if text not in self.written:
            self.written[text] = self.folder.write(f"scene{len(self.written)}", scene)
        return {"scene": self.written[text], "integrator": integrator, "spp": SPP * more,
                "overrides": overrides_of(integrator, twin and not LONG), **options}

    def add(self, name, a, b, replicates=REPLICATES, window=None):
        pair = {"name": name, "a": a, "b": b, "replicates": replicates}
        if window is not None:
            pair["window"] = window
        self.pairs.append(pair)

    def in_turn(self, integrators):
        """All in the long suite. Else every other one, so that each change is seen by some, and each integrator sees most."""
        self.turn += 1
        return integrators if LONG else integrators[self.turn % 2::2]

    def compare(self, name, scene, other, integrators=INTEGRATORS, replicates=FEW, more=1):
        for integrator in self.in_turn(integrators):
            twin = replicates == FEW
            self.add(f"{name}, {integrator}", self.side(scene, integrator, more, twin),
                     self.side(other, integrator, more, twin), replicates)

    def agree(self, name, scene, integrators=INTEGRATORS, more=1):
        """The integrators among each other."""
        first = self.side(scene, integrators[0], more)
        for integrator in integrators[1:]:
            self.add(f"{name}, {integrators[0]} and {integrator}", first, self.side(scene, integrator, more))

    def write(self):
        file = self.folder.path / "manifest.json"
        file.write_text(json.dumps({"pairs": self.pairs, "mean_bias": MEAN_BIAS, "tile_bias": TILE_BIAS}),
                        encoding="utf-8")
        return str(file)


def add_similarities(manifest, base):
    for name, scene in base.items():
        more = NOISY_SCENES.get(name, 1)
        for what, similarity in UNITS.items():
            manifest.compare(f"{name} {what}", scene, moved(scene, similarity))
        manifest.compare(f"{name} far off", scene, moved(scene, FAR_OFF), INTEGRATORS if LONG else ("path", "bdpt"),
                         2 * FEW)
        manifest.compare(f"{name} shuffled", scene, shuffled(scene))
        manifest.compare(f"{name} turned", scene, moved(scene, TURN),
                         [i for i in INTEGRATORS if i != "light" or name not in CAMERA_IN_FOG], REPLICATES, more)


def add_neutral_changes(manifest, base):
    """What a scene may gain or be rewritten as without being seen."""
    box, fog, sky = base["fog_box"], base["camera_in_fog"], base["sky_and_lens"]
    three = with_objects(box, TWO_LIGHTS)
    manifest.compare("lights in another order", three, shuffled(three), replicates=REPLICATES)
    manifest.compare("lights without light", with_objects(box, ANOTHER_BLACK), with_objects(box, NO_LIGHT))
    black_mirror = text_of(box).replace(
        '<bsdf type="diffuse">\n      <rgb name="reflectance" value="0" />\n    </bsdf>',
        '<bsdf type="conductor"><string name="material" value="none"/><rgb name="specular_reflectance" value="0"/></bsdf>')
    assert "conductor" in black_mirror
    manifest.compare("black lamp as a black mirror", box, parse(black_mirror), replicates=REPLICATES)
    manifest.compare("speck far away", box, with_objects(box, SPECK), replicates=REPLICATES)
    # Of rays from an infinite emitter only one in 10^4 meets the rest.
    manifest.compare("speck far away under the sky", sky, with_objects(sky, SPECK), ("path", "bdpt", "pssmlt", "mlt"),
                     REPLICATES, 2)
    manifest.compare("meshes for primitives", box, as_meshes(box), replicates=REPLICATES)
    manifest.compare("turned inside out", box, flipped(box), replicates=REPLICATES)
    manifest.compare("nothing around nothing", box, with_objects(box, EMPTY_CUBE))
    manifest.compare("nothing around nothing in fog", fog, with_objects(fog, EMPTY_CUBE), ("path", "bdpt", "pssmlt", "mlt"))


def add_extremes_of_media(manifest, base):
    box = base["fog_box"]
    sigma_t, albedo = "medium/rgb[@name='sigma_t']", "medium/rgb[@name='albedo']"
    manifest.compare("empty medium", without(box, ["shape[@id='cloud']"]), with_value(box, sigma_t, 0),
                     replicates=REPLICATES)
    black, white = with_value(box, albedo, 0), with_value(box, albedo, 1)
    manifest.compare("fog that only absorbs has no phase function", black,
                     with_value(black, "medium/phase/float[@name='g']", -0.9))
    manifest.agree("fog that only absorbs", black)
    manifest.agree("fog that only scatters", white)


def add_extremes_of_depth_and_film(manifest, base):
    box, glow = base["fog_box"], base["glowing_fog"]
    for name, scene, depth in (("glowing fog", glow, 1), ("fog box", box, 2), ("glowing fog", glow, 3)):
        manifest.agree(f"{name} of depth {depth}", with_value(scene, "default[@name='depth']", depth))
    fov = "sensor/float[@name='fov']"
    manifest.agree("field of view of 150 degrees", with_value(base["camera_in_fog"], fov, 150),
                   ("path", "bdpt", "pssmlt", "mlt"), 8)
    manifest.agree("field of view of 0.01 degrees", with_value(glow, fov, 0.01), ("path", "bdpt", "pssmlt", "mlt"))
    for integrator in INTEGRATORS:
        # Chains are slower where they see but a part of the picture.
        more, most = {"light": (2, 2), "pssmlt": (4, 12), "mlt": (8, 32)}.get(integrator, (1, 1))
        window, pixel = [5, 6, 9, 7], [1, 2, 1, 1]
        whole, few = manifest.side(glow, integrator, more), manifest.side(glow, integrator, 32 * most, size=[3, 3])
        one = manifest.side(glow, integrator, 256, size=[1, 1])
        part = manifest.side(glow, integrator, 4 * more, crop=window)
        point = manifest.side(glow, integrator, 256 * most, size=[3, 3], crop=pixel)
        manifest.add(f"one pixel for all, {integrator}", whole, one)
        manifest.add(f"crop, {integrator}", whole, part, window=window)
        manifest.add(f"crop of one pixel, {integrator}", few, point, window=pixel)


def main():
    folder = SceneFolder()
    try:
        manifest = Manifest(folder)
        base = scenes()
        add_similarities(manifest, base)
        add_neutral_changes(manifest, base)
        add_extremes_of_media(manifest, base)
        add_extremes_of_depth_and_film(manifest, base)
        return subprocess.run([os.environ["FOGBOW_JUDGE"], manifest.write()], check=False).returncode
    finally:
        folder.close()


if __name__ == "__main__":
    sys.exit(main())
