"""Writes content/scenes/atrium's files: `python tools/make_atrium.py [FOLDER]`.

atrium.glb, orb.glb, a glowing ball to move about in it, and sky.hdr.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from atrium.glb import GlbWriter
from atrium.layout import places
from atrium.materials import MATERIALS, MaterialWriter
from atrium.mesh import indexed
from atrium.prototypes import PROTOTYPES
from atrium.shapes import revolve
from atrium.sky import sky_hdr

FOLDER = Path(__file__).resolve().parent.parent / "content" / "scenes" / "atrium"


def atrium_glb() -> tuple[bytes, int]:
    """The scene's file and its triangle count, instances counted each."""
    glb = GlbWriter()
    materials = MaterialWriter(glb)
    meshes: dict[str, int] = {}
    triangle_count: dict[str, int] = {}
    for name, make in PROTOTYPES.items():
        primitives = []
        triangle_count[name] = 0
        for material_name, soup in make():
            material = MATERIALS[material_name]
            mesh = indexed(soup, material.crease_degrees, material.metres_per_tile)
            primitives.append({**glb.primitive(mesh), "material": materials.index(material_name)})
            triangle_count[name] += mesh.triangle_count
        meshes[name] = glb.add("meshes", {"name": name, "primitives": primitives})
    copies = dict.fromkeys(meshes, 0)
    total = 0
    for place in places():
        number = copies[place.prototype]
        copies[place.prototype] += 1
        total += triangle_count[place.prototype]
        yaw = float(np.remainder(place.yaw, 2.0 * np.pi))
        glb.node(
            f"{place.prototype}_{number:02d}",
            meshes[place.prototype],
            (place.x, place.y, place.z),
            yaw,
            place.scale,
        )
    for name, count in copies.items():
        print(f"{name:16s} {count:4d} x {triangle_count[name]:5d} = {count * triangle_count[name]}")
    return glb.bytes(["KHR_materials_emissive_strength"]), total


def orb_glb() -> bytes:
    """A ball of radius 0.35 m around the origin, warm, of a radiance of about 6."""
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 17)
    profile = [(0.35 * float(np.cos(a)), 0.35 * float(np.sin(a))) for a in angles]
    glb = GlbWriter()
    material = {
        "name": "orb",
        "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0.0},
        "emissiveFactor": [1.0, 0.72, 0.4],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 6.0}},
    }
    mesh = indexed(revolve(profile, 32), 60.0, 1.0)
    primitive = {**glb.primitive(mesh), "material": glb.add("materials", material)}
    shape = glb.add("meshes", {"name": "orb", "primitives": [primitive]})
    glb.node("orb", shape, (0.0, 0.0, 0.0), 0.0, 1.0)
    return glb.bytes(["KHR_materials_emissive_strength"], "orb")


def main() -> None:
    """Write all files and say how large they are."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    scene, triangle_count = atrium_glb()
    (folder / "atrium.glb").write_bytes(scene)
    (folder / "orb.glb").write_bytes(orb_glb())
    sky = sky_hdr()
    (folder / "sky.hdr").write_bytes(sky)
    print(f"{triangle_count} triangles; atrium.glb {len(scene)} bytes, sky.hdr {len(sky)} bytes")


if __name__ == "__main__":
    main()
