# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of invariance share: integrators with little to start with, and a folder of scenes."""

import pathlib
import shutil
import tempfile

import invariance_scenes
import transform_scene

INTEGRATORS = ("path", "light", "bdpt", "pssmlt", "mlt")
# Scenes of 256 pixels need no more chains.
OVERRIDES = {"pssmlt": {"luminance_samples": "2048", "chains": "2"}, "mlt": {"luminance_samples": "8192", "chains": "4"}}


class SceneFolder:
    """A temporary folder with the meshes that scenes refer to."""

    def __init__(self):
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="fogbow-invariance-"))
        invariance_scenes.write_meshes(self.path)
        transform_scene.write_primitive_meshes(self.path)

    def close(self):
        shutil.rmtree(self.path)

    def write(self, name, scene):
        file = self.path / f"{name}.xml"
        file.write_text(transform_scene.text_of(scene), encoding="utf-8")
        return str(file)


def scenes():
    """{name: element}."""
    return {name: transform_scene.parse(text) for name, text in invariance_scenes.SCENES.items()}
