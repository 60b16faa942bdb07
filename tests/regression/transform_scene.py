# SPDX-License-Identifier: GPL-3.0-or-later
"""Mitsuba scenes written anew in ways that leave the picture as it is, or change it by a known factor."""

import copy
import math
import random
import xml.etree.ElementTree as ET


def parse(text):
    return ET.fromstring(text)


def text_of(scene):
    ET.indent(scene)
    return ET.tostring(scene, encoding="unicode")


class Similarity:
    """p -> scale · R p + translation, with R a turn by `angle` degrees about `axis`."""

    def __init__(self, scale=1.0, axis=(0.0, 0.0, 1.0), angle=0.0, translation=(0.0, 0.0, 0.0)):
        self.scale, self.axis, self.angle, self.translation = scale, axis, angle, translation

    def direction(self, v):
        """Rodrigues' formula; v itself where there is no turn, so that powers of two scale without rounding."""
        if self.angle == 0:
            return tuple(v)
        norm = math.sqrt(sum(a * a for a in self.axis))
        n = [a / norm for a in self.axis]
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        along = sum(a * b for a, b in zip(n, v)) * (1 - c)
        across = (n[1] * v[2] - n[2] * v[1], n[2] * v[0] - n[0] * v[2], n[0] * v[1] - n[1] * v[0])
        return tuple(c * v[i] + s * across[i] + along * n[i] for i in range(3))

    def point(self, p):
        return tuple(self.scale * x + t for x, t in zip(self.direction(p), self.translation))

    def append_to(self, transform):
        if self.scale != 1:
            ET.SubElement(transform, "scale", value=repr(self.scale))
        if self.angle != 0:
            ET.SubElement(transform, "rotate", **dict(zip("xyz", map(repr, self.axis))), angle=repr(self.angle))
        if any(self.translation):
            ET.SubElement(transform, "translate", **dict(zip("xyz", map(repr, self.translation))))


def numbers(text):
    return [float(part) for part in text.replace(",", " ").split()]


def _multiply(element, factor):
    element.set("value", ", ".join(repr(factor * x) for x in numbers(element.get("value"))))


def _named(parent, name):
    return next((child for child in parent if child.get("name") == name), None)


def _multiply_named(parent, name, factor):
    child = _named(parent, name)
    if child is not None:
        _multiply(child, factor)


def _move_point(element, similarity):
    p = similarity.point([float(element.get(axis, "0")) for axis in "xyz"])
    for axis, value in zip("xyz", p):
        element.set(axis, repr(value))


def _move_sensor(sensor, similarity):
    """The camera turns and moves, but is not scaled: only its distances are."""
    for name in ("near_clip", "far_clip", "aperture_radius", "focus_distance"):
        _multiply_named(sensor, name, similarity.scale)
    lookat = sensor.find("transform/lookat")
    for name, move in (("origin", similarity.point), ("target", similarity.point), ("up", similarity.direction)):
        lookat.set(name, ", ".join(map(repr, move(numbers(lookat.get(name))))))


def _move_shape(shape, similarity):
    center = _named(shape, "center")
    if shape.get("type") == "sphere" and center is not None:
        _move_point(center, similarity)
        _multiply_named(shape, "radius", similarity.scale)
        return
    transform = shape.find("transform")
    if transform is None:
        transform = ET.SubElement(shape, "transform", name="to_world")
    similarity.append_to(transform)


def moved(scene, similarity):
    """The same scene elsewhere and in another unit of length: its picture is the same."""
    scene = copy.deepcopy(scene)
    for sensor in scene.findall("sensor"):
        _move_sensor(sensor, similarity)
    for shape in scene.findall("shape"):
        _move_shape(shape, similarity)
    for medium in scene.iter("medium"):
        for name in ("sigma_t", "emission"):
            _multiply_named(medium, name, 1 / similarity.scale)
    for emitter in scene.iter("emitter"):
        if emitter.get("type") == "point":
            _move_point(_named(emitter, "position"), similarity)
            _multiply_named(emitter, "intensity", similarity.scale**2)
    return scene


def brightened(scene, factor):
    scene = copy.deepcopy(scene)
    for emitter in scene.iter("emitter"):
        for name in ("radiance", "intensity"):
            _multiply_named(emitter, name, factor)
    for medium in scene.iter("medium"):
        _multiply_named(medium, "emission", factor)
    return scene


def renamed(scene):
    """Other ids, in another alphabetical order."""
    scene = copy.deepcopy(scene)
    ids = [element.get("id") for element in scene.iter() if element.get("id") and element.tag != "ref"]
    names = {name: f"other-{len(ids) - i}-{name[::-1]}" for i, name in enumerate(ids)}
    for element in scene.iter():
        if element.get("id"):
            element.set("id", names[element.get("id")])
    return scene


def shuffled(scene, seed=1):
    """Shapes and free emitters in another order, among the places where they stood."""
    scene = copy.deepcopy(scene)
    places = [i for i, child in enumerate(scene) if child.tag in ("shape", "emitter")]
    order = list(places)
    rng = random.Random(seed)
    while order == places and len(places) > 1:
        rng.shuffle(order)
    children = list(scene)
    for place, source in zip(places, order):
        scene[place] = children[source]
    return scene


def with_objects(scene, text):
    """And the objects in `text`."""
    scene = copy.deepcopy(scene)
    scene.extend(ET.fromstring(f"<scene>{text}</scene>"))
    return scene


def with_value(scene, path, value):
    """`value` set as the value of all elements at the XPath."""
    scene = copy.deepcopy(scene)
    elements = scene.findall(path)
    if not elements:
        raise ValueError(f"the scene has no {path}")
    for element in elements:
        element.set("value", str(value))
    return scene


def without(scene, paths):
    """Removes top-level elements, and references, found by XPath."""
    scene = copy.deepcopy(scene)
    for path in paths:
        found = scene.findall(path)
        if not found:
            raise ValueError(f"the scene has no {path}")
        for element in found:
            parent = next(p for p in scene.iter() if element in list(p))
            parent.remove(element)
    return scene


_CUBE = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
_CUBE_FACES = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
_OBJ = {
    "rectangle": ([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(1, 2, 3, 4)]),
    "cube": (_CUBE, _CUBE_FACES),
}


def write_primitive_meshes(folder):
    for name, (vertices, faces) in _OBJ.items():
        lines = ["v " + " ".join(map(str, v)) for v in vertices]
        lines += [f"f {a} {b} {c}\nf {a} {c} {d}" for a, b, c, d in faces]
        (folder / f"{name}.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")


def as_meshes(scene):
    """Rectangles and cubes as the files of `write_primitive_meshes`."""
    scene = copy.deepcopy(scene)
    for shape in scene.findall("shape"):
        if shape.get("type") in _OBJ:
            ET.SubElement(shape, "string", name="filename", value=f"{shape.get('type')}.obj")
            ET.SubElement(shape, "boolean", name="face_normals", value="true")
            shape.set("type", "obj")
    return scene


def flipped(scene):
    """Shapes that look alike from both sides turned inside out: those without light or medium."""
    scene = copy.deepcopy(scene)
    two_sided = {bsdf.get("id") for bsdf in scene.findall("bsdf") if bsdf.get("type") == "twosided"}
    count = 0
    for shape in scene.findall("shape"):
        refs = [ref.get("id") for ref in shape.findall("ref") if ref.get("name") is None]
        if shape.find("emitter") is None and refs and set(refs) <= two_sided:
            ET.SubElement(shape, "boolean", name="flip_normals", value="true")
            count += 1
    if count == 0:
        raise ValueError("the scene has nothing to flip")
    return scene
