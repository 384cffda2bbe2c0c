"""CPU cost of materials: microseconds a frame that one more of them adds to the G-buffer.

    PYTHONPATH=app python tools/material_cost.py [--frames 300]

A row of cubes is drawn with one material, with as many of one definition, and with as many
definitions; the rounds take turns, and the medians count. The camera looks away, so that the driver
gets every call, with nothing to draw: what is left is the CPU's part.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np

from elemental.core import transforms
from elemental.gpu.device import Device
from elemental.passes.camera_view import pack_view
from elemental.passes.gbuffer import draw_gbuffer
from elemental.passes.scene_gpu import GpuScene
from elemental.scene.cameras import framing_camera
from elemental.scene.definitions import MaterialDefinition, builtin, read_definition
from elemental.scene.load import load_scene
from elemental.scene.model import Instance, Material, Scene

COUNT = 16
SIZE = (16, 16)
TEXT = """/*
[parameters]
amount = { type = "float", default = 0.5 }
*/
void material(inout Surface s, MaterialInput m, Parameters p) { s.albedo *= p.amount; }
"""


def row(definitions: list[MaterialDefinition], distinct: bool) -> Scene:
    """COUNT balls in a row; `distinct`: a material each, their definitions taken in turn."""
    ball = load_scene("material_ball", default_lights=False).meshes[0]
    materials = [
        Material(str(k), definition=definitions[k % len(definitions)])
        for k in range(COUNT if distinct else 1)
    ]
    made = Scene("row", Path("row"), materials=materials)
    for k in range(COUNT):
        mesh = type(ball)(**{**vars(ball), "material": k % len(materials)})
        made.meshes.append(mesh)
        place = transforms.compose(np.array([k, 0, 0]), np.array([0, 0, 0, 1]), np.ones(3))
        made.instances.append(Instance(str(k), k, place))
    return made


class Frames:
    """Draws one of the rows."""

    def __init__(self, device: Device, scene: Scene) -> None:
        self._device, self._scene = device, GpuScene(device, scene)
        camera = framing_camera(*scene.bounds(), 1.0)
        camera.world_from_view[:3, :3] *= np.array([-1.0, 1.0, -1.0], np.float32)  # looks away
        self._view = pack_view(camera, SIZE, scene.bounds())
        self.passes = 0

    def microseconds(self) -> float:
        """Of CPU for one frame."""
        self._device.finish()
        began = time.perf_counter()
        self._scene.update(None)
        g = self._device.begin_frame()
        g.keep(draw_gbuffer(g, self._view, self._scene, SIZE).a)
        g.execute()
        spent = 1e6 * (time.perf_counter() - began)
        self._device.finish()
        self.passes = len(self._device.timings)
        return spent


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=300)
    frames = parser.parse_args().frames
    device = Device.headless()
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / f"m{k}.glsl" for k in range(COUNT)]
        for file in files:
            file.write_text(TEXT)
        own = [read_definition(file) for file in files]
        rows = {
            "one material": Frames(device, row([builtin("standard")], distinct=False)),
            f"{COUNT} of one definition": Frames(device, row([builtin("standard")], distinct=True)),
            f"{COUNT} definitions": Frames(device, row(own, distinct=True)),
        }
        spent: dict[str, list[float]] = {name: [] for name in rows}
        for _ in range(frames):
            for name, drawn in rows.items():
                spent[name].append(drawn.microseconds())
    medians = {name: median(values) for name, values in spent.items()}
    base = medians["one material"]
    for name, value in medians.items():
        added = (value - base) / (COUNT - 1)
        print(f"{name:22} {rows[name].passes:3} passes {value:7.0f} us, {added:5.1f} us more each")


if __name__ == "__main__":
    main()
